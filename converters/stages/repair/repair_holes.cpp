// SPDX-License-Identifier: Apache-2.0
// Holes are distinguished from the ends of vessels by the wall beside them. Around an end the wall
// runs along the loop's axis; around a hole it faces along it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "converters/base/number_text.h"
#include "converters/stages/repair/repair_steps.h"

namespace lumen::convert {
namespace {

// The wall beside a hole faces along the loop's axis by more than this, 30 degrees from the plane
// of the loop; the wall around a tapered or obliquely cut end does so on one side at most.
constexpr double kFacing = 0.5;
// A loop whose area is below this part of a circle's of its length is a crack, not an end.
constexpr double kCrack = 0.05;
// Barequet and Sharir's triangulation takes the cube of this; wider holes become fans.
constexpr std::size_t kMostCorners = 128;

Eigen::Vector3d unitNormal(const TriangleMesh& mesh, const Triangle& t) {
  return vectorArea(mesh, t).normalized();
}

struct LoopShape {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();  // vector area, as the loop runs
  double length = 0;
};

LoopShape judgeLoop(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  LoopShape shape;
  const std::size_t n = loop.vertex.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d a = mesh.position[loop.vertex[i]] - loop.centre;
    const Eigen::Vector3d b = mesh.position[loop.vertex[(i + 1) % n]] - loop.centre;
    shape.area += 0.5 * a.cross(b);
    shape.length += (b - a).norm();
  }
  return shape;
}

/// Whether a loop is a hole; `sides` are its sides in order.
bool isHole(const TriangleMesh& mesh, const BoundaryLoop& loop,
            const std::vector<std::uint32_t>& sides) {
  if (sides.size() == 3) return true;  // a triangle that is missing
  const LoopShape shape = judgeLoop(mesh, loop);
  const double area = shape.area.norm();
  const double circle = shape.length * shape.length / (4 * std::numbers::pi);
  if (!(area > kCrack * circle)) return true;
  // seen from outside, a hole's boundary runs clockwise: its vector area points inward
  const Eigen::Vector3d outward = -shape.area / area;
  double facing = 0;
  for (const std::uint32_t s : sides) {
    const double length =
        (mesh.position[startOf(mesh.triangle, s)] - mesh.position[endOf(mesh.triangle, s)]).norm();
    facing += length * unitNormal(mesh, mesh.triangle[s / 3]).dot(outward);
  }
  return facing > kFacing * shape.length;
}

/// Boundary sides, loop by loop.
std::vector<std::vector<std::uint32_t>> loopSides(const MeshInRepair& work) {
  const std::vector<Triangle>& triangle = work.mesh.triangle;
  std::vector<bool> done(3 * triangle.size(), false);
  std::vector<std::vector<std::uint32_t>> loops;
  for (std::uint32_t s = 0; s < done.size(); ++s) {
    if (work.opposite[s] != kNoSide || done[s]) continue;
    std::vector<std::uint32_t>& loop = loops.emplace_back();
    for (std::uint32_t at = s; !done[at];) {
      done[at] = true;
      loop.push_back(at);
      at = nextSide(at);  // around the end point to the boundary
      while (work.opposite[at] != kNoSide) at = nextSide(work.opposite[at]);
    }
  }
  return loops;
}

BoundaryLoop makeLoop(const TriangleMesh& mesh, const std::vector<std::uint32_t>& sides) {
  BoundaryLoop loop;
  for (const std::uint32_t s : sides) loop.vertex.push_back(startOf(mesh.triangle, s));
  measureLoop(mesh, loop);
  return loop;
}

/// The triangulation of least area (Barequet and Sharir, "Filling gaps in the boundary of a
/// polyhedron", 1995) of a loop against its direction, without edges that the mesh has already.
class HoleFilling {
public:
  HoleFilling(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses,
              const std::vector<std::uint32_t>& vertex)
      : m_mesh(mesh), m_uses(uses), m_vertex(vertex), m_n(vertex.size()) {}

  /// Empty if there is none.
  std::vector<Triangle> triangles() {
    std::vector<Triangle> found;
    if (m_n > kMostCorners) return found;
    m_cost.assign(m_n * m_n, 0);
    m_middle.assign(m_n * m_n, 0);
    for (std::size_t span = 2; span < m_n; ++span)
      for (std::size_t i = 0; i + span < m_n; ++i) choose(i, i + span);
    if (std::isfinite(m_cost[m_n - 1])) collect(0, m_n - 1, found);
    return found;
  }

private:
  [[nodiscard]] bool isTaken(std::size_t i, std::size_t j) const {
    const auto [low, high] = std::minmax({m_vertex[i], m_vertex[j]});
    const EdgeUse edge{low, high, 0};
    const auto at = std::lower_bound(m_uses.begin(), m_uses.end(), edge,
                                     [](const EdgeUse& a, const EdgeUse& b) {
                                       return std::tie(a.low, a.high) < std::tie(b.low, b.high);
                                     });
    return at != m_uses.end() && at->sameEdge(edge);
  }

  void choose(std::size_t i, std::size_t j) {
    double best = std::numeric_limits<double>::infinity();
    const bool isDiagonal = j - i < m_n - 1;
    if (!isDiagonal || !isTaken(i, j))
      for (std::size_t m = i + 1; m < j; ++m) {
        const double cost = m_cost[i * m_n + m] + m_cost[m * m_n + j] +
                            vectorArea(m_mesh, {m_vertex[i], m_vertex[m], m_vertex[j]}).norm();
        if (!(cost < best)) continue;
        best = cost;
        m_middle[i * m_n + j] = m;
      }
    m_cost[i * m_n + j] = best;
  }

  void collect(std::size_t i, std::size_t j, std::vector<Triangle>& found) const {
    if (j < i + 2) return;
    const std::size_t m = m_middle[i * m_n + j];
    found.push_back({m_vertex[j], m_vertex[m], m_vertex[i]});
    collect(i, m, found);
    collect(m, j, found);
  }

  const TriangleMesh& m_mesh;
  const std::vector<EdgeUse>& m_uses;
  const std::vector<std::uint32_t>& m_vertex;
  std::size_t m_n;
  std::vector<double> m_cost;
  std::vector<std::size_t> m_middle;
};

std::vector<Triangle> makeFan(TriangleMesh& mesh, const BoundaryLoop& loop) {
  const auto centre = static_cast<std::uint32_t>(mesh.position.size());
  mesh.position.push_back(loop.centre);
  std::vector<Triangle> fan;
  const std::size_t n = loop.vertex.size();
  for (std::size_t i = 0; i < n; ++i)
    fan.push_back({loop.vertex[(i + 1) % n], loop.vertex[i], centre});
  return fan;
}

}  // namespace

void measureLoop(const TriangleMesh& mesh, BoundaryLoop& loop) {
  const std::size_t n = loop.vertex.size();
  const auto at = [&](std::size_t i) { return mesh.position[loop.vertex[i % n]]; };
  double length = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const double side = (at(i + 1) - at(i)).norm();
    length += side;
    sum += side * 0.5 * (at(i + 1) + at(i));
  }
  loop.centre = length > 0 ? Eigen::Vector3d(sum / length) : at(0);
  double radii = 0;
  for (std::size_t i = 0; i < n; ++i)
    radii += (at(i + 1) - at(i)).norm() * (0.5 * (at(i + 1) + at(i)) - loop.centre).norm();
  loop.radius = length > 0 ? radii / length : 0;
}

std::vector<BoundaryLoop> findBoundaryLoops(const MeshInRepair& work) {
  std::vector<BoundaryLoop> loops;
  for (const auto& sides : loopSides(work)) loops.push_back(makeLoop(work.mesh, sides));
  return loops;
}

void fillHoles(MeshInRepair& work) {
  std::vector<EdgeUse> uses;
  std::size_t filled = 0;
  double widest = 0;
  for (const auto& sides : loopSides(work)) {
    const BoundaryLoop loop = makeLoop(work.mesh, sides);
    if (!isHole(work.mesh, loop, sides)) continue;
    if (uses.empty()) uses = edgeUses(work.mesh.triangle);
    std::vector<Triangle> patch = HoleFilling(work.mesh, uses, loop.vertex).triangles();
    if (patch.empty()) patch = makeFan(work.mesh, loop);
    work.mesh.triangle.insert(work.mesh.triangle.end(), patch.begin(), patch.end());
    work.source.resize(work.mesh.triangle.size(), RepairResult::kFilled);
    widest = std::max(widest, 2 * loop.radius);
    ++filled;
  }
  if (filled == 0) return;
  work.repairs.push_back("filled " + std::to_string(filled) +
                         (filled == 1 ? " hole" : " holes, the widest") + " " +
                         shownNumber(widest, 3) + " across");
  work.opposite = oppositeSides(work.mesh.triangle);
}

}  // namespace lumen::convert
