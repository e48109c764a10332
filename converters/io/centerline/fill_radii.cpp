// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/fill_radii.h"

#include <limits>
#include <vector>

#include "converters/base/error.h"

namespace lumen::convert {
namespace {

// The nearest radius in one direction along the tree, with its distance.
struct Known {
  double radius = 0;
  double distance = std::numeric_limits<double>::infinity();
};

double between(const Known& a, const Known& b) {
  if (b.radius <= 0) return a.radius;
  if (a.radius <= 0) return b.radius;
  const double whole = a.distance + b.distance;
  return whole > 0 ? (a.radius * b.distance + b.radius * a.distance) / whole : a.radius;
}

}  // namespace

void fillRadii(CenterlineFile& file, const std::string& name, const char* expected) {
  const std::size_t missing = file.radiiMissing();
  if (missing == 0) return;
  std::vector<CenterlinePoint>& points = file.points;
  std::vector<Known> above(points.size()), below(points.size());
  const auto step = [&](std::size_t i) {
    return (points[i].position - points[std::size_t(points[i].parent)].position).norm();
  };
  for (std::size_t i = points.size(); i-- > 0;) {
    if (points[i].radius > 0) below[i] = {points[i].radius, 0};
    if (points[i].parent == kNoPoint || below[i].radius <= 0) continue;
    Known& parent = below[std::size_t(points[i].parent)];
    const double distance = below[i].distance + step(i);
    if (distance < parent.distance) parent = {below[i].radius, distance};
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].parent != kNoPoint) {
      above[i] = above[std::size_t(points[i].parent)];
      above[i].distance += step(i);
    }
    if (points[i].radius > 0) above[i] = {points[i].radius, 0};
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(points[i].radius > 0)) points[i].radius = between(above[i], below[i]);
    if (!(points[i].radius > 0))
      throw invalidInput(name + ": has no radius at any point of " +
                         (missing == points.size() ? "it" : "one of its trees") + "; expected " +
                         expected);
  }
  file.remarks.push_back(std::to_string(missing) + " of " + std::to_string(points.size()) +
                         " points have no radius (0 or less); theirs are taken from the points "
                         "before and behind them");
}

}  // namespace lumen::convert
