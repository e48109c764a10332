// SPDX-License-Identifier: Apache-2.0
#include "nearest.h"

#include <algorithm>
#include <cmath>

#include "formats/field/vector.h"
#include "hessian.h"
#include "simd/backend.h"

namespace lumen::blob {
namespace {

using field::Vec;

// A unit vector along the vessel at a node; any for a node alone.
Vec alongVessel(const blob_model& model, std::uint32_t node) {
  const NodeRecord& record = model.nodes[node];
  if (record.neighbourBlocks > 0) {
    const NeighbourBlock& block = model.neighbours[record.firstNeighbours];
    const Vec towards{block.nx[0], block.ny[0], block.nz[0]};
    if (dot(towards, towards) > 0) return (1.0 / norm(towards)) * towards;
  }
  return {1, 0, 0};
}

// Newton's method to the wall, then along it.
class NewtonProjection {
public:
  NewtonProjection(const blob_model& model, std::uint32_t flags, const double* point,
                   std::uint32_t node, double tolerance, std::uint32_t maxSteps)
      : m_model(model),
        m_flags(flags),
        m_query{point[0], point[1], point[2]},
        m_radius(model.nodes[node].radius()),
        m_tolerance(tolerance > 0 ? tolerance : kUsualTolerance * m_radius),
        m_maxSteps(maxSteps > 0 ? maxSteps : kUsualSteps) {
    m_best.at = m_query;
    m_best.node = node;
  }

  void run(blob_nearest_point& nearest) {
    Foot foot{m_query, m_best.node, 0};
    blob_sample first = sample(foot);
    const bool inside = (first.state & BLOB_INSIDE) != 0;
    if (inside && leadsAstray(foot, first)) first = leaveAcross(foot);
    if (project(foot, first)) {
      m_best = foot;
      while (m_steps < m_maxSteps && !m_converged && improve()) {
      }
    } else {
      m_best = foot;
    }
    report(inside, nearest);
  }

private:
  static constexpr double kUsualTolerance = 1e-5;  // share of the node's radius
  static constexpr std::uint32_t kUsualSteps = 40;
  static constexpr int kMaxShortenings = 8;     // halvings of a step along the wall
  static constexpr double kGainShare = 0.1;     // share of the tolerance: least gain of a step
  static constexpr double kStalledGain = 1e-3;  // share of squared distance: converged if stalled
  static constexpr double kLongestStep = 0.5;   // share of the node's radius
  static constexpr double kFlat = 0.02;         // least eigenvalue that a step is divided by
  static constexpr double kLeaveMaximum = 0.1;  // share of the radius: step off a farthest point
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
    const double p[3] = {foot.at.x, foot.at.y, foot.at.z};
    blob_sample here;
    m_model.backend->queryOne(m_model, m_flags, p, foot.node, here);
    return here;
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
      if (std::abs(here.distance) <= 0.5 * m_tolerance) return true;
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
    Vec step = stepAlong(gradient, slope, local.hessian);
    // the decrease of the distance that the step could still give
    const Vec toQuery = m_query - m_best.at;
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

  // Solves (I + d S) step = tangential part of the vector to the query point, S the shape operator
  // of the wall and d the distance. Directions in which the foot is a farthest point are followed
  // downhill.
  [[nodiscard]] Vec stepAlong(const Vec& gradient, double slope, const double* h) const {
    const Vec normal = (-1.0 / slope) * gradient;
    const Vec toQuery = m_query - m_best.at;
    const double distance = dot(toQuery, normal);
    const Vec e1 = perpendicular(normal), e2 = cross(normal, e1);
    const Vec h1 = multiply(h, e1), h2 = multiply(h, e2);
    const double scale = -distance / slope;
    const double a = 1.0 + scale * dot(e1, h1), b = scale * dot(e1, h2),
                 c = 1.0 + scale * dot(e2, h2);
    const double mean = 0.5 * (a + c), root = std::hypot(0.5 * (a - c), b);
    const double angle = 0.5 * std::atan2(2.0 * b, a - c);
    const Vec v1 = std::cos(angle) * e1 + std::sin(angle) * e2;
    const Vec v2 = std::cos(angle) * e2 - std::sin(angle) * e1;
    const Vec step = along(v1, toQuery, mean + root) + along(v2, toQuery, mean - root);
    const double length = norm(step), longest = kLongestStep * m_radius;
    return length > longest ? (longest / length) * step : step;
  }

  [[nodiscard]] Vec along(const Vec& direction, const Vec& toQuery, double eigenvalue) const {
    const double part = dot(direction, toQuery);
    if (eigenvalue < -kFlat && std::abs(part) < m_tolerance)
      return (kLeaveMaximum * m_radius) * direction;
    return (part / std::max(std::abs(eigenvalue), kFlat)) * direction;
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

}  // namespace

void findNearest(const blob_model& model, std::uint32_t flags, const double* point,
                 std::uint32_t node, double tolerance, std::uint32_t maxSteps,
                 blob_nearest_point& nearest) noexcept {
  NewtonProjection(model, flags, point, node, tolerance, maxSteps).run(nearest);
}

void sampleAt(const blob_model& model, std::uint32_t flags, const double* point,
              std::uint32_t& node, blob_sample& sample) noexcept {
  const bool inRange = model.backend->queryOne(model, flags, point, node, sample);
  if ((flags & BLOB_DISTANCE_EXACT) != 0 && inRange) refineSample(model, flags, point, sample);
}

void refineSample(const blob_model& model, std::uint32_t flags, const double* point,
                  blob_sample& sample) noexcept {
  blob_nearest_point nearest;
  findNearest(model, flags, point, sample.node, 0, 0, nearest);
  sample.distance = nearest.distance;
  for (int i = 0; i < 3; ++i) sample.normal[i] = nearest.normal[i];
  if (nearest.converged == 0) sample.state |= BLOB_NOT_CONVERGED;
}

}  // namespace lumen::blob
