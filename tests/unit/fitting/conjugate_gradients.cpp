// SPDX-License-Identifier: Apache-2.0
#include "conjugate_gradients.h"

#include <algorithm>
#include <cmath>

namespace lumen::test {
namespace {

using convert::fitting::Blob;
using convert::fitting::Energy;

/// Unknown i of the model: x, y, z, width of blob i / 4.
double& unknown(std::vector<Blob>& blobs, std::size_t i) {
  Blob& b = blobs[i / 4];
  switch (i % 4) {
    case 0:
      return b.x;
    case 1:
      return b.y;
    case 2:
      return b.z;
    default:
      return b.width;
  }
}

/// The gradient, zero for the unknowns that are held.
double gradient(Energy& energy, const std::vector<Blob>& blobs, bool widths,
                std::vector<double>& g) {
  const std::size_t n = 4 * blobs.size();
  std::vector<double> a(n * n);
  const double value = energy.linearise(blobs);
  energy.normalEquations(blobs, a, g);
  for (std::size_t i = 0; i < n; ++i) g[i] = (i % 4 == 3) == widths ? 2 * g[i] : 0;
  return value;
}

double energyAt(Energy& energy, const std::vector<Blob>& from, const std::vector<double>& direction,
                double t, std::vector<Blob>& to) {
  to = from;
  for (std::size_t i = 0; i < direction.size(); ++i) unknown(to, i) += t * direction[i];
  const bool legal = std::all_of(to.begin(), to.end(), [](const Blob& b) { return b.width > 0; });
  return legal ? energy.evaluate(to) : 1e300;
}

/// The best step found by doubling from a short one, then halving around it.
double lineSearch(Energy& energy, std::vector<Blob>& blobs, const std::vector<double>& direction,
                  double value) {
  double longest = 0;
  for (const double w : direction) longest = std::max(longest, std::abs(w));
  if (longest == 0) return value;
  std::vector<Blob> trial, best = blobs;
  double step = 1e-4 / longest, at = 0;
  for (int i = 0; i < 40 && step > 1e-12 / longest; ++i) {
    const double next = energyAt(energy, blobs, direction, at + step, trial);
    if (next < value) {
      value = next;
      at += step;
      best = trial;
      step *= 2;
    } else {
      step *= 0.25;
    }
  }
  blobs = best;
  return value;
}

}  // namespace

double minimiseByConjugateGradients(Energy& energy, std::vector<Blob>& blobs, int rounds,
                                    int steps) {
  const std::size_t n = 4 * blobs.size();
  energy.freeze(blobs, 0);
  double value = energy.evaluate(blobs);
  for (int half = 0; half < 2 * rounds; ++half) {
    std::vector<double> g(n), previous(n), direction(n, 0.0);
    for (int step = 0; step < steps; ++step) {
      gradient(energy, blobs, half % 2 == 1, g);
      double above = 0, below = 0;
      for (std::size_t i = 0; i < n; ++i) {
        above += g[i] * (g[i] - previous[i]);
        below += previous[i] * previous[i];
      }
      const double beta = step > 0 && below > 0 ? std::max(0.0, above / below) : 0;
      for (std::size_t i = 0; i < n; ++i) direction[i] = beta * direction[i] - g[i];
      value = lineSearch(energy, blobs, direction, value);
      previous = g;
    }
  }
  return value;
}

}  // namespace lumen::test
