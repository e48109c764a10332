// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/levenberg_marquardt.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "converters/base/simd.h"

namespace lumen::convert::fitting {
namespace {

/// Per step, a blob moves by at most its own width, and its width changes by at most this share of
/// itself. The energy has a second, useless minimum: a few wide blobs far away, whose field is T
/// and flat everywhere. Unbounded steps can jump into it.
constexpr double kLargestMove = 1.0;
constexpr double kLargestResize = 0.5;
constexpr double kFirstDamping = 1e-3;
constexpr double kLargestDamping = 1e12;
/// Share of the tolerance: a step that promises less is not worth an evaluation.
constexpr double kWorthTrying = 0.1;
/// Added to the diagonal, relative to its largest entry: an unknown without influence stays put.
constexpr double kFloor = 1e-14;

/// Moves a centre that is outside all balls to the surface of the nearest one.
void keepWithin(std::span<const FitBall> balls, Blob& blob) {
  const FitBall* nearest = nullptr;
  double away = 0, least = std::numeric_limits<double>::infinity();
  for (const FitBall& ball : balls) {
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

/// The system A x = -b for n unknowns, and its solution.
struct NormalEquations {
  std::span<double> a, b, factor, right, step;

  [[nodiscard]] std::size_t unknowns() const { return b.size(); }
};

/// Buffers only grow.
NormalEquations makeRoom(std::size_t n, MinimiseWorkspace& workspace) {
  for (auto* square : {&workspace.a, &workspace.factor})
    square->resize(std::max(square->size(), n * n));
  for (auto* row : {&workspace.b, &workspace.right, &workspace.step})
    row->resize(std::max(row->size(), n));
  return {std::span(workspace.a).first(n * n), std::span(workspace.b).first(n),
          std::span(workspace.factor).first(n * n), std::span(workspace.right).first(n),
          std::span(workspace.step).first(n)};
}

/// Stiffness of the springs that hold a centre at a wall, in largest entries of the diagonal: a step
/// leaves the wall by a millionth of what it would move across it.
constexpr double kStiffness = 1e6;

/// The step of (A + damping) x = -b, with springs that hold some centres at walls. False if this
/// matrix is not positive definite.
bool solveDamped(const NormalEquations& equations, double damping, std::span<const Wall> walls) {
  const std::size_t n = equations.unknowns();
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, equations.a[i * n + i]);
  std::copy(equations.a.begin(), equations.a.end(), equations.factor.begin());
  for (std::size_t i = 0; i < n; ++i) {
    equations.factor[i * n + i] += damping * equations.factor[i * n + i] + kFloor * largest;
  }
  std::copy(equations.b.begin(), equations.b.end(), equations.right.begin());
  for (const Wall& wall : walls) {
    for (std::size_t p = 0; p < 3; ++p) {
      const double pull = kStiffness * largest * wall.normal[p];
      equations.right[wall.unknown + p] -= pull * wall.distance;
      for (std::size_t q = p; q < 3; ++q)
        equations.factor[(wall.unknown + p) * n + wall.unknown + q] += pull * wall.normal[q];
    }
  }
  return solveSymmetric(equations.factor, equations.right, n, equations.step);
}

/// Shortens the step to the bounds on moves and resizings.
void shortenStep(std::span<const Blob> unknown, std::span<double> step) {
  double excess = 1;
  for (std::size_t j = 0; j < unknown.size(); ++j) {
    const double* s = step.data() + 4 * j;
    const double move = std::sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    excess = std::max(excess, move / (kLargestMove * unknown[j].width));
    excess = std::max(excess, std::abs(s[3]) / (kLargestResize * unknown[j].width));
  }
  for (double& value : step) value /= excess;
}

/// The blobs after a step, which is shortened before; projected into the reach and the lumen. Adds a
/// wall for each centre that the projection moved.
void moveWithinBounds(std::span<const Blob> blobs, std::size_t active,
                      const MinimiseOptions& options, std::span<double> step, std::span<Blob> moved,
                      std::vector<Wall>& walls) {
  shortenStep(blobs.subspan(active), step);
  for (std::size_t j = active; j < blobs.size(); ++j) {
    const double* s = step.data() + 4 * (j - active);
    const Blob& from = blobs[j];
    Blob& to = moved[j];
    to = {from.x + s[0], from.y + s[1], from.z + s[2], from.width + s[3]};
    const Blob free = to;
    keepWithin(options.lumen, to);
    const double distance = std::sqrt(to.x * to.x + to.y * to.y + to.z * to.z);
    if (distance > options.reach) {
      const double back = options.reach / distance;
      to.x *= back;
      to.y *= back;
      to.z *= back;
    }
    const double dx = free.x - to.x, dy = free.y - to.y, dz = free.z - to.z;
    const double beyond = std::sqrt(dx * dx + dy * dy + dz * dz);
    if (!(beyond > 0)) continue;
    const double nx = dx / beyond, ny = dy / beyond, nz = dz / beyond;
    walls.push_back({4 * (j - active),
                     {nx, ny, nz},
                     nx * (to.x - from.x) + ny * (to.y - from.y) + nz * (to.z - from.z)});
  }
}

/// Moves by the step of (A + damping) x = -b within the bounds. Where a centre would leave the lumen
/// or the reach, its wall is part of the problem: the step is solved for anew along the wall, as
/// projecting it alone would lower the energy by less than predicted, or raise it. False if the
/// matrix is not positive definite.
bool stepWithinBounds(const NormalEquations& equations, double damping, std::span<const Blob> blobs,
                      std::size_t active, const MinimiseOptions& options, std::vector<Wall>& walls,
                      std::span<Blob> moved) {
  walls.clear();
  if (!solveDamped(equations, damping, walls)) return false;
  moveWithinBounds(blobs, active, options, equations.step, moved, walls);
  if (walls.empty()) return true;
  if (!solveDamped(equations, damping, walls)) return false;
  moveWithinBounds(blobs, active, options, equations.step, moved, walls);
  return true;
}

/// The decrease of the quadratic model, |r|^2 - |r + J step|^2.
double predictDecrease(const NormalEquations& equations) {
  const std::size_t n = equations.unknowns();
  const std::span<const double> a = equations.a, step = equations.step;
  double predicted = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double product = a[i * n + i] * step[i];
    for (std::size_t j = i + 1; j < n; ++j) product += 2.0 * a[i * n + j] * step[j];
    predicted -= step[i] * (2.0 * equations.b[i] + product);
  }
  return predicted;
}

/// The factor of the damping after a step, by the ratio of the decrease of the energy to the
/// predicted one (K. Madsen, H. B. Nielsen, O. Tingleff: Methods for non-linear least squares
/// problems, 2004).
double dampingFactor(double gain) {
  const double surprise = 2.0 * gain - 1.0;
  return std::max(1.0 / 3.0, 1.0 - surprise * surprise * surprise);
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

MinimiseResult minimise(Energy& energy, std::span<Blob> blobs, std::size_t active,
                        const MinimiseOptions& options, MinimiseWorkspace& workspace,
                        std::vector<double>* trace) {
  const NormalEquations equations = makeRoom(4 * (blobs.size() - active), workspace);
  workspace.trial.assign(blobs.begin(), blobs.end());
  const std::span<Blob> trial = workspace.trial;

  MinimiseResult result{energy.linearise(blobs), 1};
  energy.normalEquations(blobs, equations.a, equations.b);
  if (trace) trace->assign(1, result.energy);
  double damping = kFirstDamping, growth = 2;
  bool fresh = true;  // the field of `energy` is that of `blobs`
  while (result.iterations < options.maxIterations && damping < kLargestDamping) {
    double predicted = 0, next = result.energy;
    if (stepWithinBounds(equations, damping, blobs, active, options, workspace.walls, trial)) {
      predicted = predictDecrease(equations);
      if (predicted < kWorthTrying * options.tolerance * result.energy) break;
      ++result.iterations;
      next = result.iterations < options.maxIterations ? energy.linearise(trial)
                                                       : energy.evaluate(trial);
      fresh = false;
    }
    if (!(next < result.energy)) {
      damping *= growth;
      growth *= 2;
      continue;
    }
    const double decrease = result.energy - next;
    damping *= dampingFactor(decrease / predicted);
    growth = 2;
    std::copy(trial.begin(), trial.end(), blobs.begin());
    result.energy = next;
    fresh = true;
    if (trace) trace->push_back(next);
    if (decrease < options.tolerance * next || result.iterations >= options.maxIterations) break;
    energy.normalEquations(blobs, equations.a, equations.b);
  }
  if (!fresh) energy.evaluate(blobs);
  return result;
}

}  // namespace lumen::convert::fitting
