// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/patches/cell_size.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

/// A vessel narrower than this many cells gets a finer lattice, halved up to kMaxHalvings times.
constexpr double kMinRadiusCells = 2;
constexpr int kMaxHalvings = 3;
/// Rows of a node's lattice, and triangles of a mesh: about a hundred bytes each while it is made.
constexpr double kMaxRows = 1 << 23, kMaxTriangles = 1 << 26;
/// Extent of a node's grid around it, in radii.
constexpr double kGridRadii = 2.4;
/// The factor by which the search for a sufficient cell proceeds.
constexpr double kCoarser = 1.1;

/// Length of vessel that a node draws, mm: at least to its parent.
double lengthAt(const formats::CenterlineTree& tree, std::size_t node) {
  const double own = tree.height[node];
  const std::int32_t parent = tree.parent[node];
  if (parent < 0) return own;
  return std::max(
      own,
      (toEigen(tree.centre[node]) - toEigen(tree.centre[static_cast<std::size_t>(parent)])).norm());
}

bool isFeasible(const formats::Case& source, double cell) {
  const formats::CenterlineTree& tree = source.tree;
  double triangles = 0;
  for (std::size_t node = 0; node < tree.nodeCount(); ++node) {
    if (source.models->offset[node] == source.models->offset[node + 1]) continue;
    const double radius = tree.radius[node], length = lengthAt(tree, node);
    const double size = cellForRadius(cell, radius);
    const double across = 2 * (kGridRadii * radius + 0.5 * double{tree.height[node]}) / size;
    const double samples =
        4 * radius * radius * std::min(length, across * size) / (size * size * size);
    triangles += 4 * std::numbers::pi * radius * length / (size * size);
    const double farthest = toEigen(tree.centre[node]).cwiseAbs().maxCoeff();
    if (across > kMaxAcross || across * across > kMaxRows ||
        samples > static_cast<double>(kMaxSamples) || farthest > kMaxPosition * size)
      return false;
  }
  return triangles <= kMaxTriangles;
}

/// Two digits, rounded up.
double twoDigitsUp(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::ceil(value / unit) * unit;
}

}  // namespace

double cellForRadius(double cell, double radius) {
  for (int i = 0; i < kMaxHalvings && radius < kMinRadiusCells * cell; ++i) cell *= 0.5;
  return cell;
}

double coarsestCellFor(double radius) {
  return radius / kMinRadiusCells * (1 << kMaxHalvings);
}

void checkCell(const formats::Case& source, double cell) {
  if (isFeasible(source, cell)) return;
  double enough = cell;
  while (std::isfinite(enough) && !isFeasible(source, enough)) enough *= kCoarser;
  throw invalidInput("a cell of " + shownNumber(cell) +
                     " mm is too small for this case: its mesh would not fit into memory; "
                     "expected a cell of " +
                     shownNumber(twoDigitsUp(enough)) + " mm or more");
}

}  // namespace lumen::convert
