// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/mujoco/wire.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "converters/base/vectors.h"
#include "converters/export/shared/mujoco_text.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/geometry/triangle_tree.h"

namespace lumen::convert {

namespace {

// Armature in squares of the time step; the least that is stable is a quarter. A link swings once
// in 40 pi steps, 0.13 s, which is fast beside an insertion of millimetres a second. With less, a
// wire that leans on a wall snaps when the engine misses its contact for a step.
constexpr double kArmature = 400;
// N/m, of the servo that holds the hub at its target: soft, as a hand is; a stop costs it 0.2 mm
// for each mN.
constexpr double kServo = 5;

double secondMoment(double radius) {
  return std::numbers::pi * std::pow(radius, 4) / 4;
}

std::string attribute(const char* name, const std::string& value) {
  return " " + std::string(name) + "=\"" + value + "\"";
}

std::string frameOf(const Eigen::Vector3d& position, const Eigen::Vector3d& direction) {
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), direction);
  return attribute("pos", mujocoNumbers(position)) +
         attribute("quat", mujocoNumbers({turn.w(), turn.x(), turn.y(), turn.z()}));
}

/// Four boxes around a square channel along x, from 0 to `length`.
std::string channel(const Wire& wire) {
  const double half = wire.length() / 2;
  // room for a wire that is a little bent, not for one that folds
  const double room = 1.6 * wire.radius, side = 1e-3;
  std::string text;
  int count = 0;
  for (const auto& [y, z] :
       std::initializer_list<std::array<double, 2>>{{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
    text += "      <geom name=\"introducer_" + std::to_string(count++) +
            "\" class=\"wall\" type=\"box\"" +
            attribute("pos", mujocoNumbers({half, y * (room + side), z * (room + side)})) +
            attribute("size", mujocoNumbers({half, y != 0 ? side : room, z != 0 ? side : room})) +
            " rgba=\"0.6 0.6 0.6 0.3\"/>\n";
  return text;
}

}  // namespace

double Wire::mass() const {
  return density * std::numbers::pi * radius * radius * length();
}

double Wire::jointStiffness() const {
  return modulus * secondMoment(radius) / link;
}

double Wire::armature() const {
  return kArmature * jointStiffness() * kMujocoStep * kMujocoStep;
}

double Wire::damping() const {
  // c = 2 z sqrt(k J) with J = kArmature k h^2
  constexpr double kShare = 0.95;
  return 2 * kShare * std::sqrt(kArmature) * jointStiffness() * kMujocoStep;
}

std::string wireBodies(const Wire& wire, const Eigen::Vector3d& tip,
                       const Eigen::Vector3d& direction, WireSprings springs) {
  const bool isPlugin = springs == WireSprings::Plugin;
  const std::string frame = frameOf(tip - direction * wire.length(), direction);
  std::string text =
      "    <body name=\"introducer\"" + frame + ">\n" + channel(wire) + "    </body>\n";
  text += "    <body name=\"hub\"" + frame + ">\n" +
          "      <joint name=\"advance\" type=\"slide\" axis=\"1 0 0\"/>\n" +
          "      <inertial pos=\"0 0 0\"" + attribute("mass", mujocoNumbers({wire.mass()})) +
          " diaginertia=\"1e-9 1e-9 1e-9\"/>\n";
  text += "      <composite type=\"cable\" prefix=\"wire_\" curve=\"s\" initial=\"none\"" +
          attribute("count", std::to_string(wire.links + 1) + " 1 1") +
          attribute("size", mujocoNumbers({wire.length()})) + ">\n";
  if (isPlugin)
    text += "        <plugin plugin=\"mujoco.elasticity.cable\">\n          <config key=\"twist\"" +
            attribute("value", mujocoNumbers({wire.shearModulus()})) +
            "/>\n          <config key=\"bend\"" +
            attribute("value", mujocoNumbers({wire.modulus})) + "/>\n        </plugin>\n";
  text += "        <joint kind=\"main\"";
  if (!isPlugin) text += attribute("stiffness", mujocoNumbers({wire.jointStiffness()}));
  text += attribute("damping", mujocoNumbers({wire.damping()})) +
          attribute("armature", mujocoNumbers({wire.armature()})) + "/>\n";
  text += "        <geom type=\"capsule\"" + attribute("size", mujocoNumbers({wire.radius})) +
          attribute("density", mujocoNumbers({wire.density})) +
          " contype=\"1\" conaffinity=\"2\" rgba=\"0.25 0.3 0.85 1\"/>\n";
  return text + "      </composite>\n    </body>\n";
}

std::string wireControls(const Wire& wire, const std::string& keys) {
  std::string text = "  <actuator>\n    <intvelocity name=\"advance\" joint=\"advance\"" +
                     attribute("kp", mujocoNumbers({kServo})) + " dampratio=\"1\"" +
                     attribute("actrange", mujocoNumbers({0, wire.length()})) +
                     " ctrlrange=\"-0.1 0.1\"/>\n  </actuator>\n";
  text += "  <keyframe>\n    <key name=\"insertion\" qpos=\"0";
  for (int joint = 1; joint < wire.links; ++joint) text += " 1 0 0 0";
  return text + "\" act=\"0\" ctrl=\"0\"/>\n" + keys + "  </keyframe>\n";
}

namespace {

using formats::CenterlineTree;

std::vector<std::vector<std::uint32_t>> findNeighbours(const CenterlineTree& tree) {
  std::vector<std::vector<std::uint32_t>> neighbours(tree.nodeCount());
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  };
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    if (tree.parent[n] >= 0) join(n, static_cast<std::uint32_t>(tree.parent[n]));
  for (const auto& [a, b] : tree.links) join(a, b);
  return neighbours;
}

/// mm from `node` to each node; infinity where there is no path.
std::vector<double> distancesFrom(const CenterlineTree& tree, std::uint32_t node) {
  const auto neighbours = findNeighbours(tree);
  std::vector<double> distance(tree.nodeCount(), std::numeric_limits<double>::infinity());
  const auto position = [&](std::uint32_t n) {
    const formats::Vec3f& c = tree.centre[n];
    return Eigen::Vector3d(c.x, c.y, c.z);
  };
  using Place = std::pair<double, std::uint32_t>;
  std::priority_queue<Place, std::vector<Place>, std::greater<>> next;
  next.emplace(distance[node] = 0, node);
  while (!next.empty()) {
    const auto [here, at] = next.top();
    next.pop();
    if (here > distance[at]) continue;
    for (const std::uint32_t to : neighbours[at]) {
      const double there = here + (position(to) - position(at)).norm();
      if (there < distance[to]) next.emplace(distance[to] = there, to);
    }
  }
  return distance;
}

/// A piece as MuJoCo sees it: a box, in which the nearest triangle decides the side.
class PieceSolid {
public:
  explicit PieceSolid(const SurfaceMesh& piece) : m_mesh(makeMesh(piece)), m_tree(m_mesh) {
    const Box3d box = boundingBox(m_mesh);
    m_low = box.low;
    m_high = box.high;
  }
  PieceSolid(const PieceSolid&) = delete;
  PieceSolid& operator=(const PieceSolid&) = delete;

  [[nodiscard]] bool isTouched(const Eigen::Vector3d& p, double radius) const {
    if (((p - m_low).array() < -radius).any() || ((p - m_high).array() > radius).any())
      return false;
    const NearestPoint near = m_tree.nearest(p);
    return near.distance < radius || m_tree.normal(near.triangle).dot(p - near.position) < 0;
  }

private:
  static TriangleMesh makeMesh(const SurfaceMesh& piece) {
    TriangleMesh mesh;
    for (const Float3& p : piece.position) mesh.position.push_back(toEigen(p));
    mesh.triangle = piece.triangle;
    return mesh;
  }

  TriangleMesh m_mesh;
  TriangleTree m_tree;
  Eigen::Vector3d m_low, m_high;
};

}  // namespace

double freeBehind(const std::vector<SurfaceMesh>& pieces, const Eigen::Vector3d& tip,
                  const Eigen::Vector3d& direction, double length, double radius) {
  double free = length;
  for (const SurfaceMesh& piece : pieces) {
    if (piece.triangle.empty()) continue;
    const PieceSolid solid(piece);
    for (double behind = 0; behind < free; behind += radius)
      if (solid.isTouched(tip - behind * direction, radius)) free = behind;
  }
  return free;
}

SurfaceMesh wallsInReach(SurfaceMesh mesh, const CenterlineTree& tree, std::uint32_t node,
                         double length) {
  if (mesh.node.size() != mesh.position.size()) return mesh;
  const std::vector<double> distance = distancesFrom(tree, node);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    bool isNear = false;
    for (const std::uint32_t v : mesh.triangle[t])
      isNear = isNear || (mesh.node[v] < distance.size() && distance[mesh.node[v]] <= length);
    if (!isNear) continue;
    mesh.triangle[kept] = mesh.triangle[t];
    mesh.group[kept++] = mesh.group[t];
  }
  mesh.triangle.resize(kept);
  mesh.group.resize(kept);
  return mesh;
}

}  // namespace lumen::convert
