// SPDX-License-Identifier: Apache-2.0
// Declared in closed_mesh.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/stages/trees_from_surfaces/closed_mesh.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kVoxelsAcross = 4;  // voxels to the least width
constexpr double kMostVoxels = 3e5;  // inside
constexpr int kMostAlong = 2048;     // an axis of the grid
constexpr std::size_t kMostRays = 20000;
constexpr double kNarrowShare = 0.02;  // share of the length that may be narrower
// share of a voxel: no wall that a person designs lies on the lines through voxels' centres
constexpr double kOffGrid = 0.38196601;

/// A surface passed along a line of voxels.
struct Crossing {
  std::size_t line;
  double at;  ///< index position along the line
  int turns;  ///< 1: into the enclosed volume; -1: out
};

/// Twice the area of (a, b, p) in the plane of axes u and v, the same but for its sign whichever of
/// two triangles asks.
double side(const Vector3d& a, const Vector3d& b, double pu, double pv, int u, int v) {
  return (b[u] - a[u]) * (pv - a[v]) - (b[v] - a[v]) * (pu - a[u]);
}

/// Crossings with the lines of voxels along one axis.
class LineScan {
public:
  LineScan(const TriangleMesh& mesh, const VolumeGeometry& grid, int axis)
      : m_mesh(mesh), m_grid(grid), m_axis(axis), m_u((axis + 1) % 3), m_v((axis + 2) % 3) {}

  std::vector<std::size_t> voxels(const Progress& progress) {
    for (std::size_t t = 0; t < m_mesh.triangle.size(); ++t) {
      if (t % 4096 == 0) progress.check();
      cross(m_mesh.triangle[t]);
    }
    std::sort(m_crossings.begin(), m_crossings.end(), [](const Crossing& a, const Crossing& b) {
      return std::tuple(a.line, a.at, a.turns) < std::tuple(b.line, b.at, b.turns);
    });
    std::vector<std::size_t> out;
    int turns = 0;
    for (std::size_t i = 0; i < m_crossings.size(); ++i) {
      const bool starts = i == 0 || m_crossings[i].line != m_crossings[i - 1].line;
      if (!starts && turns != 0) fill(m_crossings[i - 1], m_crossings[i], out);
      turns = (starts ? 0 : turns) + m_crossings[i].turns;
      if (i % 65536 == 0) progress.check();
    }
    if (m_axis != 0) std::sort(out.begin(), out.end());
    return out;
  }

private:
  [[nodiscard]] int size(int a) const { return m_grid.size[static_cast<std::size_t>(a)]; }
  [[nodiscard]] Vector3d corner(std::uint32_t i) const {
    return m_grid.indexFromWorld(m_mesh.position[i]);
  }

  /// A side of a triangle, seen from the end of lower index, so that both triangles compute equal
  /// values.
  [[nodiscard]] double edgeSide(std::uint32_t i, std::uint32_t j, double pu, double pv) const {
    return i < j ? side(corner(i), corner(j), pu, pv, m_u, m_v)
                 : -side(corner(j), corner(i), pu, pv, m_u, m_v);
  }

  void cross(const Triangle& t) {
    const Vector3d a = corner(t[0]), b = corner(t[1]), c = corner(t[2]);
    const Vector3d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const double area = side(a, b, c[m_u], c[m_v], m_u, m_v);
    if (area == 0) return;
    const auto first = [&](int axis) {
      return std::max(0, static_cast<int>(std::ceil(low[axis])));
    };
    const auto last = [&](int axis) {
      return std::min(size(axis) - 1, static_cast<int>(std::floor(high[axis])));
    };
    for (int v = first(m_v); v <= last(m_v); ++v)
      for (int u = first(m_u); u <= last(m_u); ++u) {
        const double wa = edgeSide(t[1], t[2], u, v), wb = edgeSide(t[2], t[0], u, v),
                     wc = edgeSide(t[0], t[1], u, v);
        const bool isIn = area > 0 ? wa > 0 && wb > 0 && wc > 0 : wa < 0 && wb < 0 && wc < 0;
        if (!isIn && !(wa == 0 || wb == 0 || wc == 0)) continue;
        if (!isIn && !onEdge(wa, wb, wc, area)) continue;
        const double at = (wa * a[m_axis] + wb * b[m_axis] + wc * c[m_axis]) / (wa + wb + wc);
        m_crossings.push_back({lineOf(u, v), at, area > 0 ? -1 : 1});
      }
  }

  /// A line that runs exactly through an edge belongs to the triangle whose area is positive: the
  /// other one across that edge has the opposite way, or the surface folds back there.
  [[nodiscard]] static bool onEdge(double wa, double wb, double wc, double area) {
    return area > 0 && wa >= 0 && wb >= 0 && wc >= 0 && wa + wb + wc > 0;
  }

  [[nodiscard]] std::size_t lineOf(int u, int v) const {
    // in the order of the voxels along x
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(size(m_u)) +
           static_cast<std::size_t>(u);
  }

  void fill(const Crossing& from, const Crossing& to, std::vector<std::size_t>& out) const {
    const auto width = static_cast<std::size_t>(size(m_u));
    Cell cell;
    cell[m_u] = static_cast<int>(from.line % width);
    cell[m_v] = static_cast<int>(from.line / width);
    const int first = std::max(0, static_cast<int>(std::ceil(from.at)));
    const int last = std::min(size(m_axis) - 1, static_cast<int>(std::ceil(to.at)) - 1);
    for (int i = first; i <= last; ++i) {
      cell[m_axis] = i;
      out.push_back(m_grid.index(cell));
    }
  }

  const TriangleMesh& m_mesh;
  const VolumeGeometry& m_grid;
  int m_axis, m_u, m_v;
  std::vector<Crossing> m_crossings;
};

}  // namespace

double leastWidth(const ClosedMesh& surface, const TriangleTree& tree) {
  std::vector<std::pair<double, double>> widths;  // and the length that each stands for
  const std::size_t count = surface.mesh.triangle.size();
  const std::size_t stride = std::max<std::size_t>(1, count / kMostRays);
  double length = 0;
  for (std::size_t t = 0; t < count; t += stride) {
    if (surface.end[t] != ClosedMesh::kWall) continue;
    const Triangle& corners = surface.mesh.triangle[t];
    const auto& position = surface.mesh.position;
    const Vector3d a = position[corners[0]], b = position[corners[1]], c = position[corners[2]];
    const Vector3d normal = tree.normal(static_cast<std::uint32_t>(t));
    const double area = 0.5 * (b - a).cross(c - a).norm();
    const Vector3d from = (a + b + c) / 3;
    const auto hit = tree.firstHit(from, -normal, 1e-6 * std::sqrt(area));
    if (!hit || !hit->leaves || !(hit->distance > 0) || !(area > 0)) continue;
    widths.emplace_back(hit->distance, area / (std::numbers::pi * hit->distance));
    length += widths.back().second;
  }
  std::sort(widths.begin(), widths.end());
  double so = 0;
  for (const auto& [width, share] : widths)
    if ((so += share) >= kNarrowShare * length) return width;
  return 0;
}

VolumeGeometry insideGrid(const ClosedMesh& surface, double width) {
  Vector3d low = surface.mesh.position.front(), high = low;
  for (const Vector3d& p : surface.mesh.position) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double volume = std::abs(signedVolume(surface.mesh));
  const double edge = std::max({width / kVoxelsAcross, std::cbrt(volume / kMostVoxels),
                                (high - low).maxCoeff() / (kMostAlong - 3)});
  VolumeGeometry grid;
  grid.spacing.setConstant(edge);
  grid.origin = low.array() - (1 + kOffGrid) * edge;
  for (int a = 0; a < 3; ++a)
    grid.size[static_cast<std::size_t>(a)] = static_cast<int>((high - low)[a] / edge) + 4;
  return grid;
}

std::vector<std::size_t> insideVoxels(const TriangleMesh& mesh, const VolumeGeometry& grid,
                                      const Progress& progress) {
  std::array<std::vector<std::size_t>, 3> of;
  tbb::parallel_for(0, 3, [&](int axis) {
    of[static_cast<std::size_t>(axis)] = LineScan(mesh, grid, axis).voxels(progress);
  });
  std::vector<std::size_t> two, out;
  std::set_intersection(of[0].begin(), of[0].end(), of[1].begin(), of[1].end(),
                        std::back_inserter(two));
  std::vector<std::size_t> either, more;
  std::set_union(of[0].begin(), of[0].end(), of[1].begin(), of[1].end(),
                 std::back_inserter(either));
  std::set_intersection(either.begin(), either.end(), of[2].begin(), of[2].end(),
                        std::back_inserter(more));
  std::set_union(two.begin(), two.end(), more.begin(), more.end(), std::back_inserter(out));
  return out;
}

}  // namespace lumen::convert
