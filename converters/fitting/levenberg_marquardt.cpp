// SPDX-License-Identifier: Apache-2.0
#include "converters/fitting/levenberg_marquardt.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "converters/common/simd.h"

namespace lumen::convert::fitting {
namespace {

/// Per step, a blob moves by at most its own width, and its width changes by at most this share of
/// itself. The energy has a second, useless minimum: a few wide blobs far away, whose field is T
/// and flat everywhere. Unbounded steps can jump into it.
constexpr double kLargestMove = 1.0;
constexpr double kLargestResize = 0.5;
constexpr double kFirstDamping = 1e-3;
constexpr double kLargestDamping = 1e12;
/// Added to the diagonal, relative to its largest entry: an unknown without influence stays put.
constexpr double kFloor = 1e-14;

/// Moves a centre that is outside all balls to the surface of the one that it is least far from.
void keepWithin(std::span<const Ball> balls, Blob& blob) {
  const Ball* nearest = nullptr;
  double away = 0, least = std::numeric_limits<double>::infinity();
  for (const Ball& ball : balls) {
    const double dx = blob.x - ball.centre.x, dy = blob.y - ball.centre.y;
    const double dz = blob.z - ball.centre.z;
    const double distance = std::sqrt(dx * dx + dy * dy + dz * dz);
    if (distance <= ball.radius) return;
    if (distance - ball.radius >= least) continue;
    least = distance - ball.radius;
    away = distance;
    nearest = &ball;
  }
  if (nearest == nullptr) return;
  const double back = nearest->radius / away;
  blob.x = nearest->centre.x + back * (blob.x - nearest->centre.x);
  blob.y = nearest->centre.y + back * (blob.y - nearest->centre.y);
  blob.z = nearest->centre.z + back * (blob.z - nearest->centre.z);
}

}  // namespace

// Right-looking, so that the inner loop adds a multiple of one row to another: it vectorises
// without changing the order of any sum.
LUMEN_SIMD_CLONES
bool solveSymmetric(std::span<double> a, std::span<const double> b, std::size_t n,
                    std::span<double> x) {
  for (std::size_t k = 0; k < n; ++k) {
    double* __restrict row = a.data() + k * n;
    if (!(row[k] > 0)) return false;
    const double inverse = 1.0 / std::sqrt(row[k]);
    for (std::size_t j = k; j < n; ++j) row[j] *= inverse;
    for (std::size_t i = k + 1; i < n; ++i) {
      double* __restrict below = a.data() + i * n;
      const double factor = row[i];
      for (std::size_t j = i; j < n; ++j) below[j] -= factor * row[j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) x[i] = -b[i];
  for (std::size_t k = 0; k < n; ++k) {
    x[k] /= a[k * n + k];
    for (std::size_t j = k + 1; j < n; ++j) x[j] -= a[k * n + j] * x[k];
  }
  for (std::size_t k = n; k-- > 0;) {
    double value = x[k];
    for (std::size_t j = k + 1; j < n; ++j) value -= a[k * n + j] * x[j];
    x[k] = value / a[k * n + k];
  }
  return true;
}

bool LevenbergMarquardt::solve(std::size_t n, double damping) {
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, m_a[i * n + i]);
  std::copy_n(m_a.begin(), n * n, m_factor.begin());
  for (std::size_t i = 0; i < n; ++i) {
    m_factor[i * n + i] += damping * m_factor[i * n + i] + kFloor * largest;
  }
  return solveSymmetric(std::span(m_factor).first(n * n), std::span(m_b).first(n), n,
                        std::span(m_step).first(n));
}

double LevenbergMarquardt::tryStep(std::span<const Blob> blobs, std::size_t active,
                                   const MinimiseOptions& options) {
  const std::size_t n = 4 * (blobs.size() - active);
  double excess = 1;
  for (std::size_t j = active; j < blobs.size(); ++j) {
    const double* step = m_step.data() + 4 * (j - active);
    const double move = std::sqrt(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]);
    excess = std::max(excess, move / (kLargestMove * blobs[j].width));
    excess = std::max(excess, std::abs(step[3]) / (kLargestResize * blobs[j].width));
  }
  for (std::size_t i = 0; i < n; ++i) m_step[i] /= excess;
  for (std::size_t j = active; j < blobs.size(); ++j) {
    const double* step = m_step.data() + 4 * (j - active);
    const Blob& from = blobs[j];
    Blob& to = m_trial[j];
    to = {from.x + step[0], from.y + step[1], from.z + step[2], from.width + step[3]};
    keepWithin(options.lumen, to);
    const double distance = std::sqrt(to.x * to.x + to.y * to.y + to.z * to.z);
    if (distance <= options.reach) continue;
    const double back = options.reach / distance;
    to.x *= back;
    to.y *= back;
    to.z *= back;
  }
  // the decrease of the quadratic model, |r|^2 - |r + J step|^2
  double predicted = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double product = m_a[i * n + i] * m_step[i];
    for (std::size_t j = i + 1; j < n; ++j) product += 2.0 * m_a[i * n + j] * m_step[j];
    predicted -= m_step[i] * (2.0 * m_b[i] + product);
  }
  return predicted;
}

MinimiseResult LevenbergMarquardt::minimise(Energy& energy, std::span<Blob> blobs,
                                            std::size_t active, const MinimiseOptions& options,
                                            std::vector<double>* trace) {
  const std::size_t n = 4 * (blobs.size() - active);
  m_a.resize(std::max(m_a.size(), n * n));
  m_factor.resize(m_a.size());
  m_b.resize(std::max(m_b.size(), n));
  m_step.resize(m_b.size());
  m_trial.assign(blobs.begin(), blobs.end());
  const std::span<double> a = std::span(m_a).first(n * n), b = std::span(m_b).first(n);

  MinimiseResult result{energy.linearise(blobs), 1};
  energy.normalEquations(blobs, a, b);
  if (trace) trace->assign(1, result.energy);
  double damping = kFirstDamping, growth = 2;
  bool fresh = true;  // the field of `energy` is that of `blobs`
  while (result.iterations < options.maxIterations && damping < kLargestDamping) {
    double predicted = 0, next = result.energy;
    if (solve(n, damping)) {
      predicted = tryStep(blobs, active, options);
      if (predicted < 0.1 * options.tolerance * result.energy) break;
      next = energy.linearise(m_trial);
      ++result.iterations;
      fresh = false;
    }
    if (!(next < result.energy)) {
      damping *= growth;
      growth *= 2;
      continue;
    }
    // K. Madsen, H. B. Nielsen, O. Tingleff: Methods for non-linear least squares problems, 2004
    const double decrease = result.energy - next;
    const double surprise = 2.0 * decrease / predicted - 1.0;
    damping *= std::max(1.0 / 3.0, 1.0 - surprise * surprise * surprise);
    growth = 2;
    std::copy(m_trial.begin(), m_trial.end(), blobs.begin());
    result.energy = next;
    fresh = true;
    if (trace) trace->push_back(next);
    if (decrease < options.tolerance * next) break;
    energy.normalEquations(blobs, a, b);
  }
  if (!fresh) energy.evaluate(blobs);
  return result;
}

}  // namespace lumen::convert::fitting
