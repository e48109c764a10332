// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/openfoam/openfoam_cells.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/geometry/triangle_tree.h"
#include "formats/case/topology.h"

namespace lumen::convert {

namespace {

struct Preset {
  int across, layers;
  double most;  ///< cells
};
/// Across: cells that resolve a parabola of speeds, of which layers take the steep part. Most: a
/// steady flow takes some 2 s a thousand cells on one core.
constexpr std::array<Preset, 3> kPresets = {{{6, 2, 3e5}, {9, 3, 1.2e6}, {14, 4, 5e6}}};
constexpr double kMostInBlock = 3e5;  // cells before they are halved
constexpr int kMostLevels = 8;
constexpr int kShifts = 8;  // sizes of a block's cubes that are tried, within a factor of two

const Preset& presetOf(FoamGrain grain) {
  return kPresets[static_cast<std::size_t>(grain)];
}

Box3d boxOf(const formats::CenterlineTree& tree) {
  Box3d box;
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    box.add(toEigen(tree.centre[n]), static_cast<double>(tree.radius[n]));
  return box;
}

/// Cells inside of all vessels, and in the layers at their walls.
double estimate(const formats::CenterlineTree& tree, const FoamCells& cells) {
  double count = 0;
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    const auto r = static_cast<double>(tree.radius[n]);
    const double e = cells.edgeAt(cells.level(r));
    count += formats::edgeLength(tree, n) * std::numbers::pi * r *
             (r / (e * e * e) + 2 * cells.layers / (e * e));
  }
  return count;
}

/// Removes the links at which a vessel is thinner than `limit` mm. Returns the labels of the branches
/// between which they were.
std::vector<std::array<std::string, 2>> openThinLinks(formats::CenterlineTree& tree, double limit) {
  std::vector<std::array<std::string, 2>> opened;
  std::erase_if(tree.links, [&](const auto& link) {
    const auto [a, b] = link;
    if (static_cast<double>(std::min(tree.radius[a], tree.radius[b])) >= limit) return false;
    opened.push_back({tree.branches[tree.branch[a]].label, tree.branches[tree.branch[b]].label});
    return true;
  });
  return opened;
}

TriangleMesh trianglesOf(const SurfaceMesh& surface) {
  TriangleMesh mesh;
  for (const Float3& p : surface.position) mesh.position.push_back(toEigen(p));
  mesh.triangle = surface.triangle;
  return mesh;
}

}  // namespace

int FoamCells::level(double radius) const {
  const double halvings = std::ceil(std::log2(edge * across / (2 * radius)) - 1e-9);
  return std::clamp(static_cast<int>(halvings), 1, mostLevels);
}

FoamCells foamCells(const formats::CenterlineTree& tree, FoamGrain grain) {
  const Preset& preset = presetOf(grain);
  const auto widest =
      static_cast<double>(*std::max_element(tree.radius.begin(), tree.radius.end()));
  const double least = std::cbrt(boxOf(tree).size().prod() / kMostInBlock);
  FoamCells best;
  for (int shift = 0; shift < kShifts; ++shift) {
    FoamCells cells{std::max(4 * widest / preset.across, least) *
                        std::exp2(static_cast<double>(shift) / kShifts),
                    preset.across, preset.layers, 0, kMostLevels};
    cells.count = estimate(tree, cells);
    if (shift == 0 || cells.count < best.count) best = cells;
  }
  return best;
}

double mostCells(FoamGrain grain) {
  return presetOf(grain).most;
}

Unresolved trimToCells(formats::Case& target, FoamGrain grain) {
  constexpr double kStep = 1.1;
  formats::Case tree = target;  // without the parts that are costly to change
  tree.points.reset();
  tree.models.reset();
  const auto& radius = target.tree.radius;
  double least = static_cast<double>(*std::min_element(radius.begin(), radius.end()));
  const auto most = static_cast<double>(*std::max_element(radius.begin(), radius.end()));
  double limit = 0;
  while (foamCells(tree.tree, grain).count > mostCells(grain) && least < most) {
    least *= kStep;
    openThinLinks(tree.tree, least);
    try {
      trimEnds(tree, {least, 0});
    } catch (const Error&) {
      break;  // nothing would be left
    }
    limit = least;
  }
  if (limit == 0) return {};
  Unresolved gone;
  gone.radius = limit;
  gone.links = openThinLinks(target.tree, limit);
  gone.ends = trimEnds(target, {limit, 0}).ends;
  return gone;
}

FoamBlock foamBlock(const Box3d& box, double edge) {
  // no face of a cell may lie in a flat end, so the block begins at an uneven share of a cell
  // before the surface
  constexpr double kMargin = 1.37;
  FoamBlock block;
  block.low = box.low - Eigen::Vector3d::Constant(kMargin * edge);
  for (int a = 0; a < 3; ++a)
    block.count[static_cast<std::size_t>(a)] =
        static_cast<int>(std::ceil((box.high[a] - block.low[a]) / edge + kMargin));
  block.high = block.low + edge * Eigen::Vector3d(block.count[0], block.count[1], block.count[2]);
  return block;
}

std::vector<Eigen::Vector3d> deepestPoints(const formats::CenterlineTree& tree,
                                           const SurfaceMesh& surface, const ExportFrame& frame,
                                           const Progress& progress) {
  DisjointSets sets(tree.nodeCount());
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    if (tree.parent[n] != formats::kNoParent)
      sets.join(static_cast<std::uint32_t>(tree.parent[n]), n);
  for (const auto& [a, b] : tree.links) sets.join(a, b);
  const TriangleMesh mesh = trianglesOf(surface);
  const TriangleTree triangles(mesh);
  struct Deepest {
    double depth = 0;
    Eigen::Vector3d point;
  };
  std::map<std::uint32_t, Deepest> deepest;  // keys: the tree's least node
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    progress.check();
    const Eigen::Vector3d centre = frame.position(toEigen(tree.centre[n]));
    Deepest& best = deepest[sets.find(n)];
    const double depth = triangles.nearest(centre).distance;
    if (depth > best.depth && triangles.contains(centre)) best = {depth, centre};
  }
  std::vector<Eigen::Vector3d> points;
  for (const auto& [least, best] : deepest)
    if (best.depth > 0) points.push_back(best.point);
  return points;
}

}  // namespace lumen::convert
