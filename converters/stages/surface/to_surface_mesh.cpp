// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/to_surface_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "formats/case/case_field.h"
#include "formats/case/motion.h"
#include "formats/case/topology.h"
#include "formats/case/vessel_system.h"

namespace lumen::convert {

VesselValues vesselAt(const formats::CenterlineTree& tree, const formats::Neighbours& edges,
                      const Eigen::Vector3d& point, std::uint32_t node) {
  const Eigen::Vector3d from = toEigen(tree.centre[node]);
  double nearest = (point - from).squaredNorm(), share = 0;
  std::uint32_t other = node;
  for (const std::uint32_t neighbour : edges.of(node)) {
    const Eigen::Vector3d along = toEigen(tree.centre[neighbour]) - from;
    const double squared = along.squaredNorm();
    if (!(squared > 0)) continue;
    const double t = std::clamp((point - from).dot(along) / squared, 0.0, 1.0);
    const double distance = (point - from - t * along).squaredNorm();
    if (distance >= nearest) continue;
    nearest = distance;
    share = t;
    other = neighbour;
  }
  const auto between = [&](const auto& values) {
    return static_cast<float>((1 - share) * double(values[node]) + share * double(values[other]));
  };
  VesselValues result{between(tree.radius), {}};
  if (!tree.inlierRate.empty()) result.confidence = between(tree.inlierRate);
  return result;
}

namespace {

constexpr std::size_t kBatch = 256;
constexpr double kSameSide = 0.5;  // cosine: where the field jumps, its gradient is no normal

Float3 toFloat3(const Eigen::Vector3d& v) {
  const Eigen::Vector3f f = v.cast<float>();
  return {f.x(), f.y(), f.z()};
}

/// Sums of the normals of triangles, by their areas: those of the wall, and those of ends where
/// there is none.
std::vector<Eigen::Vector3d> sumNormals(const CaseSurface& surface) {
  const std::vector<Eigen::Vector3d>& position = surface.mesh.position;
  std::vector<Eigen::Vector3d> normal(position.size(), Eigen::Vector3d::Zero());
  std::vector<bool> hasWall(position.size(), false);
  for (const bool ends : {false, true})
    for (std::size_t i = 0; i < surface.mesh.triangle.size(); ++i) {
      const Triangle& t = surface.mesh.triangle[i];
      const bool isWall = surface.groups[surface.group[i]].kind == FaceKind::Wall;
      if (isWall == ends) continue;
      const Eigen::Vector3d area =
          (position[t[1]] - position[t[0]]).cross(position[t[2]] - position[t[0]]);
      for (const std::uint32_t v : t) {
        if (ends && hasWall[v]) continue;
        normal[v] += area;
        if (!ends) hasWall[v] = true;
      }
    }
  for (Eigen::Vector3d& n : normal) n = n.norm() > 0 ? n.normalized() : Eigen::Vector3d::UnitZ();
  return normal;
}

}  // namespace

SurfaceMesh toSurfaceMesh(const CaseSurface& surface, const SeparatedField& field, Normals normals,
                          Progress& progress) {
  const formats::CenterlineTree& tree = field.source().tree;
  const formats::Neighbours edges(tree);
  const std::vector<Eigen::Vector3d> normal = sumNormals(surface);
  const std::vector<Eigen::Vector3d>& position = surface.mesh.position;
  std::vector<std::uint8_t> isOnWall(position.size(), 0);
  for (std::size_t i = 0; i < surface.group.size(); ++i)
    if (surface.groups[surface.group[i]].kind == FaceKind::Wall)
      for (const std::uint32_t v : surface.mesh.triangle[i]) isOnWall[v] = 1;
  SurfaceMesh result;
  result.triangle = surface.mesh.triangle;
  result.group = surface.group;
  result.groups = surface.groups;
  for (const formats::Branch& branch : tree.branches) result.labels.push_back(branch.label);
  result.systems = formats::knownBranchSystems(field.source());
  result.position.resize(position.size());
  result.normal.resize(position.size());
  result.radius.resize(position.size());
  result.branch.resize(position.size());
  result.node = surface.node;
  if (!tree.inlierRate.empty()) result.confidence.resize(position.size());
  tbb::parallel_for(std::size_t{0}, position.size(), [&](std::size_t v) {
    if (v % kBatch == 0) progress.check();
    const std::uint32_t node = surface.node[v];
    const VesselValues values = vesselAt(tree, edges, position[v], node);
    result.position[v] = toFloat3(position[v]);
    result.normal[v] = toFloat3(normal[v]);
    // long triangles bend the sums of their normals
    if (normals == Normals::OfField && isOnWall[v] != 0) {
      const Eigen::Vector3d gradient = field.at(position[v], node).gradient;
      if (gradient.dot(normal[v]) > kSameSide) result.normal[v] = toFloat3(gradient);
    }
    result.radius[v] = values.radius;
    result.branch[v] = tree.branch[node];
    if (values.confidence) result.confidence[v] = *values.confidence;
  });
  return result;
}

namespace {

using field::BlendedField;
using field::Vec;
using formats::Motion;

constexpr std::uint16_t kWhole = 65535;  // of a vertex's weights
constexpr std::uint32_t kNoJoint = UINT32_MAX;

// The node that a vertex' field begins with: the stated one, or one of its branch.
std::uint32_t startOf(const formats::Case& source, const SurfaceMesh& surface, std::size_t vertex) {
  if (!surface.node.empty()) return surface.node[vertex];
  return source.tree.branches[surface.branch[vertex]].firstNode;
}

// Share of a joint in a vertex.
struct JointShare {
  std::uint32_t joint = 0;
  double share = 0;
};

// Adds the share of a joint to those of a vertex.
void addShare(std::vector<JointShare>& shares, std::uint32_t joint, double share) {
  const auto found = std::find_if(shares.begin(), shares.end(),
                                  [joint](const JointShare& s) { return s.joint == joint; });
  if (found != shares.end())
    found->share += share;
  else
    shares.push_back({joint, share});
}

// The four greatest shares, as whole numbers that add up to kWhole; the first takes what rounding
// leaves.
std::pair<MeshSkin::Four, MeshSkin::Four> fourGreatest(std::vector<JointShare> shares) {
  std::stable_sort(shares.begin(), shares.end(),
                   [](const JointShare& a, const JointShare& b) { return a.share > b.share; });
  shares.resize(std::min<std::size_t>(shares.size(), 4));
  double sum = 0;
  for (const JointShare& s : shares) sum += s.share;
  MeshSkin::Four joint{}, weight{};
  int left = kWhole;
  for (std::size_t i = 1; i < shares.size(); ++i) {
    weight[i] = static_cast<std::uint16_t>(std::lround(kWhole * shares[i].share / sum));
    left -= weight[i];
    if (weight[i] > 0) joint[i] = static_cast<std::uint16_t>(shares[i].joint);
  }
  joint[0] = static_cast<std::uint16_t>(shares.front().joint);
  weight[0] = static_cast<std::uint16_t>(left);
  return {joint, weight};
}

// Nodes become joints in the order of their indices.
class Joints {
public:
  Joints(const formats::Case& source, const BlendedField& blended)
      : m_of(source.tree.nodeCount(), kNoJoint), m_blended(blended) {
    const Motion& motion = *source.motion;
    for (std::uint32_t n = 0; n < motion.node.size(); ++n) m_of[motion.node[n]] = n;
  }

  // Shares of the moving nodes, by their place in the motion, and of kNoJoint for all others, at a
  // point on the way of the cursor from `start`.
  [[nodiscard]] std::vector<JointShare> sharesAt(const Float3& position,
                                                 std::uint32_t start) const {
    const double point[3] = {position[0], position[1], position[2]};
    const std::uint32_t node = m_blended.follow({point[0], point[1], point[2]}, start);
    std::vector<JointShare> shares;
    field::visitActiveNodes(node, [&](std::uint32_t k, field::ActiveNodes& active) {
      const double weight = field::blendWeight<1>(m_blended, k, point, active).value;
      if (!(weight > 0)) return false;
      addShare(shares, jointOf(k), weight);
      return true;
    });
    if (shares.empty()) shares.push_back({jointOf(node), 1});
    return shares;
  }

private:
  [[nodiscard]] std::uint32_t jointOf(std::uint32_t node) const {
    const std::uint32_t lender = m_blended.lender(node);
    return m_of[lender == field::kNowhere ? node : lender];
  }

  std::vector<std::uint32_t> m_of;
  const BlendedField& m_blended;
};

using VertexShares = std::vector<std::vector<JointShare>>;

VertexShares sharesOf(const formats::Case& source, const SurfaceMesh& surface,
                      const Joints& joints) {
  VertexShares shares(surface.position.size());
  tbb::parallel_for(std::size_t{0}, shares.size(), [&](std::size_t v) {
    shares[v] = joints.sharesAt(surface.position[v], startOf(source, surface, v));
  });
  return shares;
}

// Keys of the motion, and the first pose again after a period.
std::vector<std::size_t> keysOf(const Motion& motion, MeshSkin& skin) {
  std::vector<std::size_t> keys;
  skin.startTime = std::min(motion.time.front(), 0.0);
  const auto add = [&](double time, std::size_t key) {
    const auto at = static_cast<float>(time - skin.startTime);
    if (!skin.time.empty() && !(at > skin.time.back())) return;  // one float of two times
    skin.time.push_back(at);
    keys.push_back(key);
  };
  for (std::size_t t = 0; t < motion.time.size(); ++t) add(motion.time[t], t);
  if (motion.period > 0) add(motion.time.front() + motion.period, 0);
  return keys;
}

// Adds the joint of a moving node, or of all resting ones.
void addJoint(const formats::Case& source, std::uint32_t moving,
              const std::vector<std::size_t>& keys, MeshSkin& skin) {
  const Motion& motion = *source.motion;
  auto& places = skin.translation.emplace_back();
  auto& turns = skin.rotation.emplace_back();
  auto& scales = skin.scale.emplace_back();
  if (moving == kNoJoint) {
    skin.name.emplace_back("rest");
    skin.rest.push_back({0, 0, 0});
    return;
  }
  const std::uint32_t node = motion.node[moving];
  const formats::Vec3f& c = source.tree.centre[node];
  skin.name.push_back("node-" + std::to_string(node));
  skin.rest.push_back({c.x, c.y, c.z});
  for (const std::size_t key : keys) {
    const formats::Pose& pose = motion.pose[key * motion.node.size() + moving];
    std::array<float, 4> turn = pose.rotation;
    const auto length = static_cast<float>(
        std::sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3]));
    float product = 0;  // programs that go the longer way between opposite signs exist
    for (std::size_t i = 0; i < 4 && !turns.empty(); ++i) product += turn[i] * turns.back()[i];
    for (float& x : turn) x *= (product < 0 ? -1.0F : 1.0F) / length;
    places.push_back({pose.centre.x, pose.centre.y, pose.centre.z});
    turns.push_back(turn);
    scales.push_back(pose.factor);
  }
}

}  // namespace

MeshSkin skinOf(const formats::Case& source, const std::vector<SurfaceMesh>& levels) {
  const BlendedField blended = formats::caseField(source);
  const Joints joints(source, blended);
  std::vector<VertexShares> shares;
  std::vector<std::uint32_t> used;
  for (const SurfaceMesh& level : levels) {
    shares.push_back(sharesOf(source, level, joints));
    for (const auto& vertex : shares.back())
      for (const JointShare& share : vertex) used.push_back(share.joint);
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
  }
  if (used.size() > std::size_t{kWhole} + 1)
    throw unsupported("the motion has " + std::to_string(used.size()) +
                      " joints; expected at most 65536, the most that a vertex of glTF can name");
  MeshSkin skin;
  const std::vector<std::size_t> keys = keysOf(*source.motion, skin);
  for (const std::uint32_t moving : used) addJoint(source, moving, keys, skin);
  for (VertexShares& level : shares) {
    MeshSkin::Vertices& vertices = skin.levels.emplace_back();
    for (std::vector<JointShare>& vertex : level) {
      for (JointShare& share : vertex)
        share.joint = static_cast<std::uint32_t>(
            std::lower_bound(used.begin(), used.end(), share.joint) - used.begin());
      const auto [joint, weight] = fourGreatest(std::move(vertex));
      vertices.joint.push_back(joint);
      vertices.weight.push_back(weight);
    }
  }
  return skin;
}

}  // namespace lumen::convert
