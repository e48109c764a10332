// SPDX-License-Identifier: Apache-2.0
// Synthetic vessel trees for the tests of libblob, and f in long doubles.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "blob.h"

namespace lumen::blob::test {

using Point = std::array<double, 3>;

struct Closer {
  void operator()(blob_model* model) const { blob_model_close(model); }
};
using Model = std::unique_ptr<blob_model, Closer>;

/// Arrays of a definition. Blobs belong to the node that was added last.
struct Tree {
  std::vector<std::array<float, 3>> centre, blobCentre;
  std::vector<float> radius, blobWidth;
  std::vector<std::int32_t> parent;
  std::vector<std::array<std::uint32_t, 2>> links;
  std::vector<std::uint32_t> offset{0};
  blob_kernel kernel = BLOB_CAUCHY;
  double parameter = 0.2, level = 0.1;

  /// Returns the node's index.
  std::int32_t addNode(const Point& at, double r, std::int32_t parentNode = -1);
  void addBlob(const Point& at, double width);

  [[nodiscard]] blob_model_def definition() const;
  [[nodiscard]] Model build(blob_simd simd = BLOB_SIMD_BEST) const;
  /// f of one node.
  [[nodiscard]] long double value(std::uint32_t node, const std::array<long double, 3>& at) const;
};

/// One node at `at` of radius 1 with one blob of width `width` there.
Tree oneBlob(const Point& at = {0, 0, 0}, double width = 0.5);

/// The width of equal blobs, `spacing` apart on a line of `count`, with f = T at `radius` from the
/// middle one, by bisection.
double widthOfLine(const Tree& kernel, double radius, double spacing, int count);

/// Appends a chain of nodes of one radius along a polyline. Each node's five blobs follow the line.
/// `disagreement` scales widths by 1 +- that much from node to node, so that seams show.
/// Returns the last node.
std::int32_t addVessel(Tree& tree, const std::vector<Point>& line, double radius,
                       std::int32_t parentNode, double disagreement);

std::vector<Point> straight(const Point& from, const Point& to, int count);

/// A straight tube of radius 1 along x from 0 to (count - 1) * 0.6.
Tree tube(int count, double disagreement = 0.0);
/// A trunk along x and two arms, `halfAngle` radians to either side, radius 1 each.
Tree fork(double halfAngle, double disagreement);
/// A tube of radius 1 whose axis turns by 120 degrees in a circle of radius 0.5, so that cells of
/// nodes in the bend end within the lumen.
Tree bend(double disagreement);
/// Two tubes along x of radius 1 at y = 0 (nodes 0 to 29) and y = 2 + gap (nodes 30 to 59).
Tree kissing(double gap);
/// A helix of radius 4 and pitch 5 with a tube of radius 0.8.
Tree helix(int count, double disagreement);

bool sameBits(const blob_sample& a, const blob_sample& b);
double norm(const double* v);

}  // namespace lumen::blob::test
