// SPDX-License-Identifier: Apache-2.0
#include "nearest.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "formats/field/vector.h"
#include "hessian.h"
#include "simd/backend.h"
#include "wall_step.h"

namespace lumen::blob {
namespace {

using field::Vec;

/// Newton's method to the wall, and again after each step along it.
class NewtonProjection {
public:
  static constexpr std::uint32_t kUsualSteps = 40;

  NewtonProjection(const blob_model& model, std::uint32_t flags, const double* point,
                   std::uint32_t node, double tolerance, std::uint32_t maxSteps)
      : m_model(model),
        m_flags(flags),
        m_query{point[0], point[1], point[2]},
        m_radius(model.nodes[node].radius()),
        m_tolerance(tolerance > 0 ? tolerance : kUsualTolerance * m_radius),
        m_maxSteps(maxSteps > 0 ? maxSteps : kUsualSteps) {}

  // From the query point; `first` is the answer of f there.
  void run(const blob_sample& first, blob_nearest_point& nearest) {
    m_steps = 1;
    Foot foot{m_query, first.node, 0};
    const bool inside = (first.state & BLOB_INSIDE) != 0;
    blob_sample here = first;
    if (inside && leadsAstray(foot, first)) here = leaveAcross(foot);
    descend(foot, here, inside, nearest);
  }

  // From a place about the wall to which a search has led.
  void run(const blob_sample& first, const WallFoot& start, blob_nearest_point& nearest) {
    m_steps = start.steps;
    Foot foot{Vec{start.at[0], start.at[1], start.at[2]}, start.node, 0};
    const blob_sample here = sample(foot);
    descend(foot, here, (first.state & BLOB_INSIDE) != 0, nearest);
  }

private:
  static constexpr double kUsualTolerance = 1e-5;  // share of the node's radius
  static constexpr int kMaxShortenings = 8;        // halvings of a step along the wall
  static constexpr double kGainShare = 0.1;        // share of the tolerance: least gain of a step
  static constexpr double kRoundedOff = 2e-6;      // share of the radius: floats come no nearer
  static constexpr double kStalledGain = 1e-3;  // share of squared distance: converged if stalled
  static constexpr double kDeep = 0.5;          // share of the radius: depth about an axis
  static constexpr double kAcross = 0.7;        // share of the radius: step off an axis
  static constexpr std::uint32_t kSides = 4;    // steps that are tried

  struct Foot {
    Vec at;
    std::uint32_t node;
    double length;  // to the query point, mm
  };

  blob_sample sample(Foot& foot) {
    ++m_steps;
    blob_sample here;
    const double p[3] = {foot.at.x, foot.at.y, foot.at.z};
    m_model.backend->queryOne(m_model, m_flags, p, foot.node, here);
    return here;
  }

  void descend(Foot foot, const blob_sample& here, bool inside, blob_nearest_point& nearest) {
    const bool isAtWall = project(foot, here);
    m_best = foot;
    while (isAtWall && m_steps < m_maxSteps && !m_converged && improve()) {
    }
    report(inside, nearest);
  }

  // Whether the normal at a point in the lumen leads along the vessel instead of to the wall. About
  // an axis grad f is no more than the ripple of the blobs, which lie along it.
  bool leadsAstray(const Foot& foot, const blob_sample& here) {
    if (here.distance > -kDeep * m_radius || m_steps + kSides + 1 >= m_maxSteps) return false;
    const Vec normal{here.normal[0], here.normal[1], here.normal[2]};
    Foot there{foot.at - here.distance * normal, foot.node, 0};
    return sample(there).distance < 0.5 * here.distance;
  }

  // Moves a point off the axis to one of kSides, where the wall is nearest, and evaluates f there.
  blob_sample leaveAcross(Foot& foot) {
    const Vec along = alongVessel(m_model, foot.node), first = field::perpendicular(along),
              second = cross(along, first);
    const Foot from = foot;
    blob_sample best{};
    int tried = 0;
    for (const Vec& side : {first, -1.0 * first, second, -1.0 * second}) {
      Foot there{from.at + kAcross * m_radius * side, from.node, 0};
      const blob_sample here = sample(there);
      if (tried++ > 0 && here.distance <= best.distance) continue;
      best = here;
      foot = there;
    }
    return best;
  }

  // Projects a point to the wall by Newton's method along the normals.
  bool project(Foot& foot, blob_sample here) {
    for (;;) {
      if (!(here.value > kVanished) && !(std::abs(here.distance) > 0)) return false;
      Vec normal{here.normal[0], here.normal[1], here.normal[2]};
      if (!(dot(normal, normal) > 0))
        normal = field::perpendicular(alongVessel(m_model, foot.node));
      foot.at = foot.at - here.distance * normal;
      foot.length = norm(m_query - foot.at);
      if (std::abs(here.distance) <= std::max(0.5 * m_tolerance, kRoundedOff * m_radius))
        return true;
      if (m_steps >= m_maxSteps) return false;
      here = sample(foot);
    }
  }

  // Makes one step along the wall, halved until the distance decreases; false if none does.
  bool improve() {
    ++m_steps;
    const double p[3] = {m_best.at.x, m_best.at.y, m_best.at.z};
    blob_hessian local;
    evaluateHessian(m_model, m_flags, p, m_best.node, local);
    const Vec gradient{local.gradient[0], local.gradient[1], local.gradient[2]};
    const double slope = norm(gradient);
    if (!(slope > 0)) return false;
    const Vec toQuery = m_query - m_best.at, normal = (-1.0 / slope) * gradient;
    WallShape wall{toQuery, normal, dot(toQuery, normal), slope, {}};
    std::copy_n(local.hessian, 6, wall.hessian);
    Vec step = stepDownhill(wall, {m_radius, m_tolerance});
    // the decrease of the distance that the step could still give
    const double gain = 0.5 * dot(toQuery, step);
    m_converged = norm(step) <= m_tolerance || gain <= kGainShare * m_tolerance * m_best.length;
    if (m_converged) return true;
    for (int tries = 0; tries < kMaxShortenings && m_steps < m_maxSteps;
         ++tries, step = 0.5 * step) {
      Foot foot{m_best.at + step, m_best.node, 0};
      const blob_sample there = sample(foot);
      if (!project(foot, there)) return false;
      if (foot.length < m_best.length) {
        m_best = foot;
        return true;
      }
    }
    // the distance does not decrease in this direction: rounding, or a ring of equally near points
    m_converged = m_steps < m_maxSteps && gain <= kStalledGain * m_best.length * m_best.length;
    return false;
  }

  void report(bool inside, blob_nearest_point& nearest) {
    const blob_sample at = sample(m_best);
    nearest.point[0] = m_best.at.x;
    nearest.point[1] = m_best.at.y;
    nearest.point[2] = m_best.at.z;
    for (int i = 0; i < 3; ++i) nearest.normal[i] = at.normal[i];
    nearest.distance = inside ? -m_best.length : m_best.length;
    nearest.node = m_best.node;
    nearest.steps = m_steps;
    nearest.converged = m_converged ? 1 : 0;
  }

  const blob_model& m_model;
  std::uint32_t m_flags;
  Vec m_query;
  double m_radius, m_tolerance;
  std::uint32_t m_maxSteps, m_steps = 0;
  Foot m_best{};
  bool m_converged = false;
};

void refineBy(const blob_nearest_point& nearest, blob_sample& sample) {
  sample.distance = nearest.distance;
  for (int i = 0; i < 3; ++i) sample.normal[i] = nearest.normal[i];
  if (nearest.converged == 0) sample.state |= BLOB_NOT_CONVERGED;
}

void reportFoot(const double* point, const blob_sample& first, const WallFoot& foot,
                blob_nearest_point& nearest) {
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    nearest.point[i] = foot.at[i];
    nearest.normal[i] = foot.normal[i];
    const double way = point[i] - foot.at[i];
    square += way * way;
  }
  const double length = std::sqrt(square);
  nearest.distance = (first.state & BLOB_INSIDE) != 0 ? -length : length;
  nearest.node = foot.node;
  nearest.steps = foot.steps;
  nearest.converged = 1;
}

// The answer to a search of a back end, which goes on in doubles if it has ended early.
void finishSearch(const blob_model& model, std::uint32_t flags, const double* point,
                  const blob_sample& first, const WallFoot& foot, blob_nearest_point& nearest) {
  if (foot.state == FootState::Found) return reportFoot(point, first, foot, nearest);
  NewtonProjection search(model, flags, point, first.node, 0, 0);
  if (foot.state == FootState::None)
    search.run(first, nearest);
  else
    search.run(first, foot, nearest);
}

}  // namespace

void findNearest(const blob_model& model, std::uint32_t flags, const double* point,
                 std::uint32_t node, double tolerance, std::uint32_t maxSteps,
                 blob_nearest_point& nearest) noexcept {
  blob_sample first;
  model.backend->queryOne(model, flags, point, node, first);
  NewtonProjection search(model, flags, point, node, tolerance, maxSteps);
  if (maxSteps > 0 && maxSteps < NewtonProjection::kUsualSteps) return search.run(first, nearest);
  WallFoot foot;
  const bool inRange = true;
  const double at[1][3] = {{point[0], point[1], point[2]}};
  model.backend->findFeet(model, flags, FootJob{1, at, &inRange, &first, &foot});
  const bool isPlain = !(tolerance > 0) && maxSteps == 0;
  if (isPlain || foot.state == FootState::None)
    finishSearch(model, flags, point, first, foot, nearest);
  else
    search.run(first, foot, nearest);
}

void sampleAt(const blob_model& model, std::uint32_t flags, const double* point,
              std::uint32_t& node, blob_sample& sample) noexcept {
  const bool inRange = model.backend->queryOne(model, flags, point, node, sample);
  if ((flags & BLOB_DISTANCE_EXACT) == 0 || !inRange) return;
  const double at[1][3] = {{point[0], point[1], point[2]}};
  refineSamples(model, flags, 1, at, &inRange, &sample);
}

void refineSamples(const blob_model& model, std::uint32_t flags, std::size_t count,
                   const double (*points)[3], const bool* inRange, blob_sample* samples) noexcept {
  WallFoot feet[kMostRefined];
  model.backend->findFeet(model, flags, FootJob{count, points, inRange, samples, feet});
  for (std::size_t i = 0; i < count; ++i) {
    if (!inRange[i]) continue;
    blob_nearest_point nearest;
    finishSearch(model, flags, points[i], samples[i], feet[i], nearest);
    refineBy(nearest, samples[i]);
  }
}

}  // namespace lumen::blob
