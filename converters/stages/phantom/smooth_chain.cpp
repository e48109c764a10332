// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/smooth_chain.h"

#include <algorithm>
#include <cmath>

#include "formats/case/blobby.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kSigma = 1.5;  // samples: the steps of voxels go, bends of a few samples stay
constexpr int kKernelSamples = 6;

// The value at a sample beyond an end: of positions such that the end stays where it is, of radii
// that of the end.
PathPoint sampleAt(const Path& chain, int index) {
  const int last = static_cast<int>(chain.size()) - 1;
  if (index >= 0 && index <= last) return chain[static_cast<std::size_t>(index)];
  const bool before = index < 0;
  const PathPoint& end = before ? chain.front() : chain.back();
  const int mirrored = before ? std::min(-index, last) : std::max(0, 2 * last - index);
  return {2 * end.position - chain[static_cast<std::size_t>(mirrored)].position, end.radius};
}

Path smoothed(const Path& chain) {
  Path smooth;
  for (int i = 0; i < static_cast<int>(chain.size()); ++i) {
    PathPoint sum{Vector3d::Zero(), 0};
    double weights = 0;
    for (int k = -kKernelSamples; k <= kKernelSamples; ++k) {
      const double weight = formats::repeatableExp(-0.5 * k * k / (kSigma * kSigma));
      const PathPoint sample = sampleAt(chain, i + k);
      sum.position += weight * sample.position;
      sum.radius += weight * sample.radius;
      weights += weight;
    }
    smooth.push_back({sum.position / weights, sum.radius / weights});
  }
  smooth.front().position = chain.front().position;
  smooth.back().position = chain.back().position;
  return smooth;
}

// The knots' parameters: chord lengths, of coincident knots a little.
std::vector<double> computeIntervals(const Path& knots) {
  const double least = 1e-6 * pathLength(knots) + 1e-12;
  std::vector<double> h;
  for (std::size_t i = 1; i < knots.size(); ++i)
    h.push_back(std::max(least, (knots[i].position - knots[i - 1].position).norm()));
  return h;
}

// Second derivatives of the natural cubic spline at its knots.
std::vector<Vector3d> secondDerivatives(const Path& knots, const std::vector<double>& h) {
  const std::size_t n = knots.size();
  std::vector<Vector3d> second(n, Vector3d::Zero());
  std::vector<double> ratio(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Vector3d right = 6 * ((knots[i + 1].position - knots[i].position) / h[i] -
                                (knots[i].position - knots[i - 1].position) / h[i - 1]);
    const double pivot = 2 * (h[i - 1] + h[i]) - h[i - 1] * ratio[i - 1];
    ratio[i] = h[i] / pivot;
    second[i] = (right - h[i - 1] * second[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) second[i] -= ratio[i] * second[i + 1];
  return second;
}

// Slopes of the monotone cubic: the weighted harmonic mean of the two secants, 0 where they differ
// in sign and at the ends.
std::vector<double> computeSlopes(const Path& knots, const std::vector<double>& h) {
  std::vector<double> slopes(knots.size(), 0.0);
  for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
    const double a = (knots[i].radius - knots[i - 1].radius) / h[i - 1];
    const double b = (knots[i + 1].radius - knots[i].radius) / h[i];
    if (a * b <= 0) continue;
    const double wa = 2 * h[i] + h[i - 1], wb = h[i] + 2 * h[i - 1];
    slopes[i] = (wa + wb) / (wa / a + wb / b);
  }
  return slopes;
}

Path splined(const Path& knots, double step) {
  if (knots.size() < 2) return knots;
  const std::vector<double> h = computeIntervals(knots), slopes = computeSlopes(knots, h);
  const std::vector<Vector3d> second = secondDerivatives(knots, h);
  Path path{knots.front()};
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const PathPoint &from = knots[i], &to = knots[i + 1];
    const int pieces = std::max(1, static_cast<int>(std::ceil(h[i] / step)));
    for (int k = 1; k < pieces; ++k) {
      const double b = static_cast<double>(k) / pieces, a = 1 - b;
      const Vector3d position =
          a * from.position + b * to.position +
          h[i] * h[i] / 6 * ((a * a * a - a) * second[i] + (b * b * b - b) * second[i + 1]);
      const double radius = a * a * (1 + 2 * b) * from.radius + b * b * (1 + 2 * a) * to.radius +
                            h[i] * a * b * (a * slopes[i] - b * slopes[i + 1]);
      path.push_back({position, radius});
    }
    path.push_back(to);
  }
  return path;
}

}  // namespace

std::vector<SmoothVessel> smoothVessels(const CenterlineFile& file, double step) {
  const std::vector<CenterlineChain> chains = centerlineChains(file);
  std::vector<Path> knots;  // each chain's own points
  std::vector<SmoothVessel> vessels;
  for (const CenterlineChain& chain : chains) {
    Path path;
    for (const std::int32_t index : chain.points) {
      const CenterlinePoint& point = file.points[static_cast<std::size_t>(index)];
      path.push_back({point.position, point.radius});
    }
    if (chain.parent >= 0) {
      const Path& parent = knots[static_cast<std::size_t>(chain.parent)];
      path.insert(path.begin(), {parent[chain.parentSample].position, path.front().radius});
    }
    path = smoothed(path);
    vessels.push_back({chain.parent, splined(path, step)});
    if (chain.parent >= 0) path.erase(path.begin());
    knots.push_back(std::move(path));
  }
  return vessels;
}

}  // namespace lumen::convert
