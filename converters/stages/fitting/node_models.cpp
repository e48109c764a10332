// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/node_models.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "converters/base/vectors.h"
#include "converters/stages/fitting/seam.h"
#include "formats/case/node_origin.h"

namespace lumen::convert::fitting {

namespace {

/// Nodes within this many edges cut a seam.
constexpr int kSeamNeighbourhood = 2;
/// The least lobe that tracking takes for a part of an aneurysm, as a share of its radius.
constexpr double kLobe = 0.25;
/// Distance of the farthest wall of a sac that a node of a vessel is fitted to, in radii of the
/// vessel, as on the rays of tracking.
constexpr double kSeen = 2.4;

using formats::Vec3d;
using formats::Vec3f;

/// The unit in which the voxel measures kReferenceVoxel; without a voxel size, the iso-level counts
/// as half a voxel.
double frameScale(const formats::Case& value, const FitOptions& options) {
  const double voxel = value.metadata.voxelSize.value_or(0.0);
  return kReferenceVoxel / (voxel > 0 ? voxel : 2.0 * *options.isoLevel);
}

LocalModelOptions localOptions(const FitOptions& o, double scale) {
  LocalModelOptions local;
  local.energy = {o.kernel,         *o.kernelParameter, *o.isoLevel * scale,
                  o.cohesionWeight, o.curvatureWeight,  o.cohesionScale};
  local.maxSubdivisions = o.maxSubdivisions;
  local.accuracy = *o.accuracy * scale;
  local.maxDistance = *o.maxDistance * scale;
  local.minWidth = *o.minWidth * scale;
  return local;
}

std::vector<std::uint32_t> allNodes(const formats::Case& value) {
  std::vector<std::uint32_t> nodes(value.tree.nodeCount());
  std::iota(nodes.begin(), nodes.end(), std::uint32_t{0});
  return nodes;
}

}  // namespace

NodeModels::NodeModels(const formats::Case& value, const FitOptions& options)
    : NodeModels(value, options, allNodes(value)) {}

NodeModels::NodeModels(const formats::Case& value, const FitOptions& options,
                       std::span<const std::uint32_t> nodes)
    : m_case(value),
      m_tree(value.tree),
      m_options(options),
      m_scale(frameScale(value, options)),
      m_local(localOptions(options, m_scale)),
      m_neighbours(value.tree),
      m_nodes(nodes.begin(), nodes.end()),
      m_isKept(value.tree.nodeCount(), true),
      m_models(value.tree.nodeCount()),
      m_seam(value.tree.nodeCount()),
      m_drawn(pointsOfUnmeasured(value, m_neighbours)) {
  for (const std::uint32_t node : m_nodes) m_isKept[node] = false;
  for (std::uint32_t node = 0; node < m_tree.nodeCount(); ++node) {
    if (m_isKept[node]) takeModels(node);
    const std::int32_t parent = m_tree.parent[node];
    if (parent != formats::kNoParent &&
        !(m_isKept[node] && m_isKept[static_cast<std::size_t>(parent)]))
      m_seams.push_back(node);
  }
}

/// The blobs that a node has in the case.
void NodeModels::takeModels(std::uint32_t node) {
  const formats::BlobbyModels& models = *m_case.models;
  for (std::uint32_t k = models.offset[node]; k < models.offset[node + 1]; ++k) {
    const Vec3d c = toLocal(node, models.centre[k]);
    m_models[node].blobs.push_back({c.x, c.y, c.z, models.width[k] * m_scale});
  }
}

void NodeModels::fit(Progress& progress) {
  forEachNode(progress, [&](std::uint32_t node, Worker& worker) {
    gatherPoints(node, worker);
    m_models[node] = fitLocalModel(m_local, data(node, worker), progress, worker.workspace);
  });
}

void NodeModels::refine(Progress& progress) {
  tbb::parallel_for(std::size_t{0}, m_seams.size(), [&](std::size_t i) { findSeam(m_seams[i]); });
  forEachNode(progress, [&](std::uint32_t node, Worker& worker) {
    gatherPoints(node, worker);
    gatherSeams(node, worker.seams);
    m_models[node].blobs =
        refineLocalModel(m_local, data(node, worker), {worker.seams, m_options.seamWeight},
                         m_models[node], worker.workspace);
  });
}

Vec3d NodeModels::toLocal(std::uint32_t node, const Vec3f& p) const {
  const Vec3f& c = m_tree.centre[node];
  return {(double{p.x} - c.x) * m_scale, (double{p.y} - c.y) * m_scale,
          (double{p.z} - c.z) * m_scale};
}

bool NodeModels::isInSac(std::uint32_t node) const {
  return m_tree.branches[m_tree.branch[node]].kind == formats::BranchKind::Aneurysm;
}

/// The ball of a node, in the frame of another.
FitBall NodeModels::ball(std::uint32_t frame, std::uint32_t node) const {
  return {toLocal(frame, m_tree.centre[node]), m_tree.radius[node] * m_scale};
}

NodeData NodeModels::data(std::uint32_t node, const Worker& worker) const {
  const Vec3f& d = m_tree.direction[node];
  return {worker.points,
          m_tree.radius[node] * m_scale,
          {d.x, d.y, d.z},
          worker.lumen,
          {},
          isInSac(node) ? kLobe : 1.0};
}

/// Collects the wall points and the inside from the nodes of the neighbourhood.
void NodeModels::gatherPoints(std::uint32_t node, Worker& worker) const {
  const std::vector<std::uint32_t>& offset = m_case.points->offset;
  worker.points.clear();
  worker.lumen.clear();
  for (const std::uint32_t near : m_neighbours.within(node, m_options.neighbourhood)) {
    worker.lumen.push_back(ball(node, near));
    const bool seesAll = isInSac(node) || !isInSac(near);
    const double seen = kSeen * m_tree.radius[node] * m_scale;
    for (std::uint32_t k = offset[near]; k < offset[near + 1]; ++k) {
      const Vec3d p = toLocal(node, m_case.points->position[k]);
      if (seesAll || p.x * p.x + p.y * p.y + p.z * p.z < seen * seen) worker.points.push_back(p);
    }
    for (const Vec3f& p : m_drawn[near]) worker.points.push_back(toLocal(node, p));
  }
}

/// The points of all seams of a node, in its frame.
void NodeModels::gatherSeams(std::uint32_t node, std::vector<Vec3d>& seams) const {
  seams = m_seam[node];
  for (const std::uint32_t child : m_neighbours.of(node)) {
    if (m_tree.parent[child] != static_cast<std::int32_t>(node)) continue;
    const Vec3d shift = toLocal(node, m_tree.centre[child]);
    for (const Vec3d& p : m_seam[child]) {
      seams.push_back({p.x + shift.x, p.y + shift.y, p.z + shift.z});
    }
  }
}

/// Finds the seam of a node and its parent: halfway, or on the surface of the one that is kept.
void NodeModels::findSeam(std::uint32_t node) {
  const auto parent = static_cast<std::uint32_t>(m_tree.parent[node]);
  std::vector<FitBall> others;
  for (const std::uint32_t end : {node, parent}) {
    for (const std::uint32_t near : m_neighbours.within(end, kSeamNeighbourhood)) {
      if (near != node && near != parent) others.push_back(ball(node, near));
    }
  }
  const double share = m_isKept[node] ? 0.0 : m_isKept[parent] ? 1.0 : 0.5;
  m_seam[node] = seamPoints(m_local.energy, {ball(node, node), m_models[node].blobs},
                            {ball(node, parent), m_models[parent].blobs}, others, share);
}

formats::BlobbyModels NodeModels::assemble() const {
  formats::BlobbyModels models;
  models.kernel = m_options.kernel;
  models.kernelParameter = *m_options.kernelParameter;
  models.isoLevel = *m_options.isoLevel;
  models.offset.reserve(m_models.size() + 1);
  models.offset.push_back(0);
  for (std::uint32_t node = 0; node < m_models.size(); ++node) {
    if (m_isKept[node]) {
      const formats::BlobbyModels& kept = *m_case.models;
      for (std::uint32_t k = kept.offset[node]; k < kept.offset[node + 1]; ++k) {
        models.centre.push_back(kept.centre[k]);
        models.width.push_back(kept.width[k]);
      }
    } else {
      const Vec3f& c = m_tree.centre[node];
      for (const Blob& blob : m_models[node].blobs) {
        models.centre.push_back({static_cast<float>(c.x + blob.x / m_scale),
                                 static_cast<float>(c.y + blob.y / m_scale),
                                 static_cast<float>(c.z + blob.z / m_scale)});
        models.width.push_back(static_cast<float>(blob.width / m_scale));
      }
    }
    models.offset.push_back(static_cast<std::uint32_t>(models.centre.size()));
  }
  return models;
}

}  // namespace lumen::convert::fitting

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

/// Edges along the tree within which another branch's lumen opens the wall: a bridge that leaves
/// its parent has that many nodes beside it.
constexpr int kNearEdges = 12;

}  // namespace

std::vector<std::vector<formats::Vec3f>> pointsOfUnmeasured(const formats::Case& value,
                                                            const formats::Neighbours& neighbours) {
  const formats::CenterlineTree& tree = value.tree;
  const auto origins = formats::readNodeOrigins(value);
  std::vector<std::vector<formats::Vec3f>> points(tree.nodeCount());
  for (std::uint32_t node = 0; node < tree.nodeCount(); ++node) {
    const bool hasPoints =
        value.points && value.points->offset[node] < value.points->offset[node + 1];
    if (origins[node] == formats::NodeOrigin::Measured || hasPoints) continue;
    const std::vector<std::uint32_t> near = neighbours.within(node, kNearEdges);
    const Vector3d centre = toEigen(tree.centre[node]);
    const auto [u, v] = planeBasis(toEigen(tree.direction[node]));
    for (std::size_t i = 0; i < fitting::kRingSize; ++i) {
      const Vector3d p = centre + double{tree.radius[node]} * fitting::ringDirection(i, u, v);
      const bool isOpen = std::any_of(near.begin(), near.end(), [&](std::uint32_t other) {
        return tree.branch[other] != tree.branch[node] &&
               (p - toEigen(tree.centre[other])).norm() < double{tree.radius[other]};
      });
      if (!isOpen) points[node].push_back(toVec3f(p));
    }
  }
  return points;
}

}  // namespace lumen::convert
