// SPDX-License-Identifier: Apache-2.0
#include "tree.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace lumen::blob::test {
namespace {

long double phi(blob_kernel kernel, long double p, long double x) {
  switch (kernel) {
    case BLOB_CAUCHY:
      return 1 / ((1 + p * x) * (1 + p * x));
    case BLOB_GAUSSIAN:
      return std::exp(-p * x);
    case BLOB_QUARTIC:
      return x < 1 ? (1 - x) * (1 - x) : 0;
    case BLOB_SOFT_OBJECT:
      break;
  }
  return x < 1 ? 1 - x * x * x * 4 / 9 + x * x * 17 / 9 - x * 22 / 9 : 0;
}

std::array<float, 3> toFloat(const Point& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

}  // namespace

std::int32_t Tree::addNode(const Point& at, double r, std::int32_t parentNode) {
  centre.push_back(toFloat(at));
  radius.push_back(static_cast<float>(r));
  parent.push_back(parentNode);
  offset.push_back(static_cast<std::uint32_t>(blobWidth.size()));
  return static_cast<std::int32_t>(centre.size()) - 1;
}

void Tree::addBlob(const Point& at, double width) {
  blobCentre.push_back(toFloat(at));
  blobWidth.push_back(static_cast<float>(width));
  offset.back() = static_cast<std::uint32_t>(blobWidth.size());
}

blob_model_def Tree::definition() const {
  blob_model_def def = blob_model_def_default();
  def.node_count = centre.size();
  def.centre = reinterpret_cast<const float(*)[3]>(centre.data());
  def.radius = radius.data();
  def.parent = parent.data();
  def.link_count = links.size();
  def.link = reinterpret_cast<const std::uint32_t(*)[2]>(links.data());
  std::memcpy(&def.blobs.kernel, &kernel,
              sizeof kernel);  // a test may have stored no kernel at all
  def.blobs.kernel_parameter = parameter;
  def.blobs.iso_level = level;
  def.blobs.offset = offset.data();
  def.blobs.centre = reinterpret_cast<const float(*)[3]>(blobCentre.data());
  def.blobs.width = blobWidth.data();
  return def;
}

Model Tree::build(blob_simd simd) const {
  blob_model_def def = definition();
  def.simd = simd;
  blob_model* model = nullptr;
  const blob_status status = blob_model_create(&def, &model);
  if (status != BLOB_OK) throw std::runtime_error(blob_status_text(status));
  return Model(model);
}

long double Tree::value(std::uint32_t node, const std::array<long double, 3>& at) const {
  long double f = 0;
  for (std::uint32_t j = offset[node]; j < offset[node + 1]; ++j) {
    const long double w = blobWidth[j];
    long double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const long double d = at[i] - blobCentre[j][i];
      square += d * d;
    }
    f += w * phi(kernel, parameter, square / (w * w));
  }
  return f;
}

Tree oneBlob(const Point& at, double width) {
  Tree tree;
  tree.addNode(at, 1.0);
  tree.addBlob(at, width);
  return tree;
}

double widthOfLine(const Tree& tree, double radius, double spacing, int count) {
  double low = 1e-3, high = 10 * radius;
  for (int i = 0; i < 60; ++i) {
    const double w = 0.5 * (low + high);
    long double f = 0;
    for (int j = 0; j < count; ++j) {
      const double along = spacing * (j - (count - 1) / 2.0);
      const double square = along * along + radius * radius;
      f += w * phi(tree.kernel, tree.parameter, square / (w * w));
    }
    (f < tree.level ? low : high) = w;
  }
  return low;
}

std::int32_t addVessel(Tree& tree, const std::vector<Point>& line, double radius,
                       std::int32_t parentNode, double disagreement) {
  const Point d{line[1][0] - line[0][0], line[1][1] - line[0][1], line[1][2] - line[0][2]};
  const double width = widthOfLine(tree, radius, norm(d.data()), 5);
  for (int i = 0; i < static_cast<int>(line.size()); ++i) {
    parentNode = tree.addNode(line[static_cast<std::size_t>(i)], radius, parentNode);
    const double scale = 1.0 + disagreement * (i % 2 == 0 ? 1.0 : -1.0);
    for (int j = -2; j <= 2; ++j) {
      const int last = static_cast<int>(line.size()) - 1;
      tree.addBlob(line[static_cast<std::size_t>(std::clamp(i + j, 0, last))], width * scale);
    }
  }
  return parentNode;
}

std::vector<Point> straight(const Point& from, const Point& to, int count) {
  std::vector<Point> line;
  for (int i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / (count - 1);
    Point p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = from[k] + t * (to[k] - from[k]);
    line.push_back(p);
  }
  return line;
}

Tree tube(int count, double disagreement) {
  Tree tree;
  addVessel(tree, straight({0, 0, 0}, {0.6 * (count - 1), 0, 0}, count), 1.0, -1, disagreement);
  return tree;
}

Tree fork(double halfAngle, double disagreement) {
  Tree tree;
  const std::int32_t end =
      addVessel(tree, straight({-6, 0, 0}, {0, 0, 0}, 11), 1.0, -1, disagreement);
  for (const double side : {1.0, -1.0}) {
    const double x = std::cos(halfAngle), y = side * std::sin(halfAngle);
    addVessel(tree, straight({0.6 * x, 0.6 * y, 0}, {9 * x, 9 * y, 0}, 15), 1.0, end, disagreement);
  }
  return tree;
}

Tree bend(double disagreement) {
  constexpr double kTurn = 2.0943951023931953, kCurve = 0.5, kSpacing = 0.25;
  Tree tree;
  std::vector<Point> line;
  for (int i = -12; i <= 16; ++i) {
    const double along = kSpacing * i, arc = std::clamp(along, 0.0, kTurn * kCurve),
                 rest = along - arc;
    const double a = arc / kCurve;
    line.push_back({kCurve * std::sin(a) + rest * std::cos(a),
                    kCurve * (1 - std::cos(a)) + rest * std::sin(a), 0.02 * (i % 3)});
  }
  addVessel(tree, line, 1.0, -1, disagreement);
  return tree;
}

Tree kissing(double gap) {
  Tree tree;
  addVessel(tree, straight({0, 0, 0}, {17.4, 0, 0}, 30), 1.0, -1, 0);
  addVessel(tree, straight({0, 2 + gap, 0}, {17.4, 2 + gap, 0}, 30), 1.0, -1, 0);
  return tree;
}

Tree helix(int count, double disagreement) {
  Tree tree;
  std::vector<Point> line;
  for (int i = 0; i < count; ++i) {
    const double a = 0.14 * i;
    line.push_back({4 * std::cos(a), 4 * std::sin(a), 5 * a / 6.283185307179586});
  }
  addVessel(tree, line, 0.8, -1, disagreement);
  return tree;
}

bool sameBits(const blob_sample& a, const blob_sample& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

double norm(const double* v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

}  // namespace lumen::blob::test
