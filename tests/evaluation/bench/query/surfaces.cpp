// SPDX-License-Identifier: Apache-2.0
#include "surfaces.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "converters/stages/surface/patches/polygonise.h"
#include "tests/unit/mesh/open_mesh.h"
#include "vessel.h"

namespace lumen::bench {
namespace {

using formats::Case;
using formats::Vec3f;

constexpr std::size_t kToolPoints = 200, kFrames = 50;
constexpr double kPi = 3.14159265358979323846;

// A line of 10 mm; the capsule of Yureidini's thesis measures 11.9 x 2.5 x 2.5 mm.
Case capsule() {
  std::vector<Vec3f> line;
  for (int i = 0; i <= 20; ++i) line.push_back({0.5f * static_cast<float>(i), 0, 0});
  return tubeAlong(line, 0.5, 1.25);
}

// An Archimedean spiral of one and a half turns and the thesis' size, 52.3 x 39.9 x 7.2 mm, at even
// steps of its length.
Case spiral() {
  constexpr double kStep = 1.5, kTube = 3.6;
  std::vector<Vec3f> line;
  for (double a = 0; a <= 3 * kPi;) {
    const double r = 8 + 16.0 * a / (3 * kPi), slope = 16.0 / (3 * kPi);
    line.push_back({static_cast<float>(r * std::cos(a)), static_cast<float>(r * std::sin(a)), 0});
    a += kStep / std::hypot(r, slope);
  }
  return tubeAlong(line, kStep, kTube);
}

convert::SurfaceMesh meshOf(const Case& source, double cell) {
  Progress progress;
  convert::PolygoniseOptions options;
  options.cell = cell;
  return convert::polygonise(source, options, progress).surface;
}

void append(const convert::SurfaceMesh& surface, Triangles& result) {
  const auto first = static_cast<std::uint32_t>(result.vertex.size());
  for (const convert::Float3& p : surface.position) result.vertex.push_back({p[0], p[1], p[2]});
  for (const convert::Triangle& t : surface.triangle)
    result.face.push_back({first + t[0], first + t[1], first + t[2]});
}

void appendDecimated(const convert::SurfaceMesh& surface, double share, Triangles& result) {
  test::TriMesh mesh = test::toOpenMesh(surface);
  OpenMesh::Decimater::DecimaterT<test::TriMesh> decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<test::TriMesh>::Handle quadric;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  decimater.initialize();
  const double faces = share * static_cast<double>(mesh.n_faces());
  decimater.decimate_to_faces(0, static_cast<std::size_t>(faces));
  mesh.garbage_collection();
  const auto first = static_cast<std::uint32_t>(result.vertex.size());
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    result.vertex.push_back({p[0], p[1], p[2]});
  }
  for (const auto f : mesh.faces()) {
    std::array<std::uint32_t, 3> corners{};
    std::size_t i = 0;
    for (const auto v : mesh.fv_range(f))
      corners[i++] = first + static_cast<std::uint32_t>(v.idx());
    result.face.push_back(corners);
  }
}

// About 100,000 triangles: their number goes with the inverse square of the cell, until thin
// vessels hold it up; then quadric error metrics take away the rest.
Triangles wantedMesh(const Case& source) {
  constexpr double kWanted = 1e5;
  double cell = 0.2;
  convert::SurfaceMesh surface = meshOf(source, cell);
  for (int i = 0; i < 2; ++i) {
    cell *= std::sqrt(static_cast<double>(surface.triangle.size()) / kWanted);
    surface = meshOf(source, cell);
  }
  const double share = kWanted / static_cast<double>(surface.triangle.size());
  Triangles result;
  if (share < 0.9)
    appendDecimated(surface, share, result);
  else
    append(surface, result);
  return result;
}

// The nodes from a root to the leaf that is farthest along the tree.
std::vector<std::size_t> longestPath(const formats::CenterlineTree& tree) {
  std::vector<double> length(tree.nodeCount(), 0.0);
  std::size_t farthest = 0;
  for (std::size_t i = 0; i < tree.nodeCount(); ++i) {
    if (tree.parent[i] < 0) continue;
    const auto p = static_cast<std::size_t>(tree.parent[i]);
    const Vec3f &a = tree.centre[i], &b = tree.centre[p];
    length[i] = length[p] + std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
    if (length[i] > length[farthest]) farthest = i;
  }
  std::vector<std::size_t> path{farthest};
  while (tree.parent[path.back()] >= 0)
    path.push_back(static_cast<std::size_t>(tree.parent[path.back()]));
  std::reverse(path.begin(), path.end());
  return path;
}

// A tool of 200 points along the path, 0.05 mm farther in each frame (50 mm/s at 1 ms), winding
// around the centerline between the axis and 0.95 of the radius, or all at 0.9 of it.
std::vector<double> toolPoints(const formats::CenterlineTree& tree, bool atWall) {
  const std::vector<std::size_t> path = longestPath(tree);
  std::vector<double> at{0};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vec3f &a = tree.centre[path[i - 1]], &b = tree.centre[path[i]];
    at.push_back(at.back() + std::hypot(a.x - b.x, a.y - b.y, a.z - b.z));
  }
  constexpr double kAdvance = 0.05;
  const double spacing = (at.back() - kAdvance * kFrames) / kToolPoints;
  std::vector<double> points;
  for (std::size_t frame = 0; frame < kFrames; ++frame)
    for (std::size_t n = 0; n < kToolPoints; ++n) {
      const double s = kAdvance * static_cast<double>(frame) + spacing * static_cast<double>(n);
      const auto next = std::upper_bound(at.begin() + 1, at.end() - 1, s);
      const auto i = static_cast<std::size_t>(next - at.begin());
      const double t = (s - at[i - 1]) / (at[i] - at[i - 1]);
      const Vec3f &a = tree.centre[path[i - 1]], &b = tree.centre[path[i]];
      const double d[3] = {(b.x - a.x) / (at[i] - at[i - 1]), (b.y - a.y) / (at[i] - at[i - 1]),
                           (b.z - a.z) / (at[i] - at[i - 1])};
      const double c[3] = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
      double e[3], length = 0;  // across the vessel
      const double any[3] = {0.36, 0.48, 0.8};
      const double along = d[0] * any[0] + d[1] * any[1] + d[2] * any[2];
      for (int k = 0; k < 3; ++k) {
        e[k] = any[k] - along * d[k];
        length += e[k] * e[k];
      }
      for (double& x : e) x /= std::sqrt(length);
      const double f[3] = {d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2],
                           d[0] * e[1] - d[1] * e[0]};
      const double share = atWall ? 0.9 : 0.95 * std::abs(std::sin(0.37 * s));
      const double off = share * ((1 - t) * tree.radius[path[i - 1]] + t * tree.radius[path[i]]);
      for (int k = 0; k < 3; ++k)
        points.push_back(c[k] + off * (std::cos(s) * e[k] + std::sin(s) * f[k]));
    }
  return points;
}

Case caseOf(const std::string& what) {
  if (what == "capsule") return capsule();
  if (what == "spiral") return spiral();
  return readCase(what);
}

}  // namespace

OwnedSurface makeSurface(const std::string& what, bool atWall) {
  constexpr double kMostCells = 2e7;
  OwnedSurface result;
  result.owned = openVessel(caseOf(what), std::filesystem::path(what).stem().string());
  Vessel& vessel = result.owned.vessel;
  vessel.mesh = wantedMesh(result.owned.source);
  vessel.gridCell = gridCell(vessel.model, vessel.voxel, kMostCells);
  result.surface.toolPoints = kToolPoints;
  result.surface.points = toolPoints(result.owned.source.tree, atWall);
  return result;
}

}  // namespace lumen::bench
