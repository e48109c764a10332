// SPDX-License-Identifier: Apache-2.0
#include "converters/fitting/fit.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "converters/fitting/local_model.h"
#include "converters/fitting/open_edges.h"
#include "converters/fitting/seam.h"
#include "converters/fitting/unmeasured.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

/// Nodes within so many edges cut a seam.
constexpr int kSeamNeighbourhood = 2;
/// Of the radius of an aneurysm: the least lobe that tracking takes for a part of it.
constexpr double kLobe = 0.25;
/// Radii of a vessel: the farthest wall of a sac that a node of the vessel is fitted to, as on the
/// rays of tracking.
constexpr double kSeen = 2.4;

using fitting::Ball;
using fitting::Blob;
using formats::Vec3d;
using formats::Vec3f;

/// The unit in which the voxel measures fitting::kReferenceVoxel; without a voxel size, the
/// iso-level stands for half a voxel.
double frameScale(const formats::Case& value, const FitOptions& options) {
  const double voxel = value.metadata.voxelSize.value_or(0.0);
  return fitting::kReferenceVoxel / (voxel > 0 ? voxel : 2.0 * *options.isoLevel);
}

fitting::LocalModelOptions localOptions(const FitOptions& o, double scale) {
  fitting::LocalModelOptions local;
  local.energy = {o.kernel,         *o.kernelParameter, *o.isoLevel * scale,
                  o.cohesionWeight, o.curvatureWeight,  o.cohesionScale};
  local.maxSubdivisions = o.maxSubdivisions;
  local.accuracy = *o.accuracy * scale;
  local.maxDistance = *o.maxDistance * scale;
  local.minWidth = *o.minWidth * scale;
  return local;
}

/// The models of a case in the making. A node's frame is x' = (x - centre) * scale.
class Models {
public:
  Models(const formats::Case& value, const FitOptions& options)
      : m_case(value),
        m_tree(value.tree),
        m_options(options),
        m_scale(frameScale(value, options)),
        m_local(localOptions(options, m_scale)),
        m_neighbours(value.tree),
        m_models(value.tree.nodeCount()),
        m_seam(value.tree.nodeCount()),
        m_drawn(pointsOfUnmeasured(value, m_neighbours)) {}

  /// Fits every node for itself.
  void fit(Progress& progress) {
    forEachNode(progress, [&](std::uint32_t node, Worker& worker) {
      gatherPoints(node, worker);
      m_models[node] =
          fitting::fitLocalModel(m_local, data(node, worker), progress, worker.workspace);
    });
  }

  /// Brings the surfaces of adjacent models together where they meet. Reads the models of the sweep
  /// before only, so that the order of the nodes does not matter.
  void refine(Progress& progress) {
    tbb::parallel_for(std::uint32_t{0}, nodeCount(), [&](std::uint32_t node) { findSeam(node); });
    forEachNode(progress, [&](std::uint32_t node, Worker& worker) {
      gatherPoints(node, worker);
      gatherSeams(node, worker.seams);
      m_models[node].blobs = fitting::refineLocalModel(m_local, data(node, worker),
                                                       {worker.seams, m_options.seamWeight},
                                                       m_models[node], worker.workspace);
    });
  }

  [[nodiscard]] formats::BlobbyModels assemble() const;

private:
  struct Worker {
    fitting::FitWorkspace workspace;
    std::vector<Vec3d> points, seams;
    std::vector<Ball> lumen;
  };

  [[nodiscard]] std::uint32_t nodeCount() const {
    return static_cast<std::uint32_t>(m_tree.nodeCount());
  }
  [[nodiscard]] Vec3d toLocal(std::uint32_t node, const Vec3f& p) const {
    const Vec3f& c = m_tree.centre[node];
    return {(double{p.x} - c.x) * m_scale, (double{p.y} - c.y) * m_scale,
            (double{p.z} - c.z) * m_scale};
  }
  [[nodiscard]] bool isInSac(std::uint32_t node) const {
    return m_tree.branches[m_tree.branch[node]].kind == formats::BranchKind::Aneurysm;
  }
  /// The ball of a node, in the frame of another.
  [[nodiscard]] Ball ball(std::uint32_t frame, std::uint32_t node) const {
    return {toLocal(frame, m_tree.centre[node]), m_tree.radius[node] * m_scale};
  }
  [[nodiscard]] fitting::NodeData data(std::uint32_t node, const Worker& worker) const {
    const Vec3f& d = m_tree.direction[node];
    return {worker.points,
            m_tree.radius[node] * m_scale,
            {d.x, d.y, d.z},
            worker.lumen,
            {},
            isInSac(node) ? kLobe : 1.0};
  }

  template <class Action>
  void forEachNode(Progress& progress, const Action& action) {
    tbb::parallel_for(std::uint32_t{0}, nodeCount(), [&](std::uint32_t node) {
      progress.check();
      action(node, m_workers.local());
      progress.advance();
    });
  }

  void gatherPoints(std::uint32_t node, Worker& worker) const;
  void gatherSeams(std::uint32_t node, std::vector<Vec3d>& seams) const;
  void findSeam(std::uint32_t node);

  const formats::Case& m_case;
  const formats::CenterlineTree& m_tree;
  const FitOptions& m_options;
  double m_scale;
  fitting::LocalModelOptions m_local;
  formats::Neighbours m_neighbours;
  std::vector<fitting::LocalModel> m_models;  ///< in the frame of their node
  std::vector<std::vector<Vec3d>> m_seam;   ///< between a node and its parent, in the node's frame
  std::vector<std::vector<Vec3f>> m_drawn;  ///< of each node that has no measured points
  tbb::enumerable_thread_specific<Worker> m_workers;
};

/// What the nodes of the neighbourhood say about its wall and its inside.
void Models::gatherPoints(std::uint32_t node, Worker& worker) const {
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
void Models::gatherSeams(std::uint32_t node, std::vector<Vec3d>& seams) const {
  seams = m_seam[node];
  for (const std::uint32_t child : m_neighbours.of(node)) {
    if (m_tree.parent[child] != static_cast<std::int32_t>(node)) continue;
    const Vec3d shift = toLocal(node, m_tree.centre[child]);
    for (const Vec3d& p : m_seam[child]) {
      seams.push_back({p.x + shift.x, p.y + shift.y, p.z + shift.z});
    }
  }
}

/// Finds the seam of a node and its parent.
void Models::findSeam(std::uint32_t node) {
  if (m_tree.parent[node] == formats::kNoParent) return;
  const auto parent = static_cast<std::uint32_t>(m_tree.parent[node]);
  std::vector<Ball> others;
  for (const std::uint32_t end : {node, parent}) {
    for (const std::uint32_t near : m_neighbours.within(end, kSeamNeighbourhood)) {
      if (near != node && near != parent) others.push_back(ball(node, near));
    }
  }
  m_seam[node] = fitting::seamPoints(m_local.energy, {ball(node, node), m_models[node].blobs},
                                     {ball(node, parent), m_models[parent].blobs}, others);
}

formats::BlobbyModels Models::assemble() const {
  formats::BlobbyModels models;
  models.kernel = m_options.kernel;
  models.kernelParameter = *m_options.kernelParameter;
  models.isoLevel = *m_options.isoLevel;
  models.offset.reserve(m_models.size() + 1);
  models.offset.push_back(0);
  for (std::size_t i = 0; i < m_models.size(); ++i) {
    const Vec3f& c = m_tree.centre[i];
    for (const Blob& blob : m_models[i].blobs) {
      models.centre.push_back({static_cast<float>(c.x + blob.x / m_scale),
                               static_cast<float>(c.y + blob.y / m_scale),
                               static_cast<float>(c.z + blob.z / m_scale)});
      models.width.push_back(static_cast<float>(blob.width / m_scale));
    }
    models.offset.push_back(static_cast<std::uint32_t>(models.centre.size()));
  }
  return models;
}

}  // namespace

void fit(formats::Case& target, const FitOptions& options, Progress& progress) {
  if (!target.points) {
    throw invalidInput("fit: the case has no wall points; expected a tracked case with its points");
  }
  const FitOptions full = options.resolved(target.metadata.voxelSize.value_or(0.0));
  Models models(target, full);
  const auto passes = static_cast<std::size_t>(1 + full.seamSweeps);
  progress.begin("fit", passes * target.tree.nodeCount());
  models.fit(progress);
  for (int sweep = 0; sweep < full.seamSweeps; ++sweep) models.refine(progress);
  progress.end();
  target.models = models.assemble();
  openEdges(target);
  target.metadata.steps.push_back({"fit", "lumen " LUMEN_VERSION, full.parameters()});
}

}  // namespace lumen::convert
