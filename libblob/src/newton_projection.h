// SPDX-License-Identifier: Apache-2.0
// The search for the nearest point of the wall, in parts that wait for the field.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "formats/field/vector.h"
#include "hessian.h"
#include "model.h"
#include "simd/backend.h"
#include "wall_step.h"

namespace lumen::blob {

using field::Vec;

/// A unit vector along the vessel at a node; any for a node alone.
inline Vec alongVessel(const blob_model& model, std::uint32_t node) {
  const NodeRecord& record = model.nodes[node];
  if (record.neighbourBlocks > 0) {
    const NeighbourBlock& block = model.neighbours[record.firstNeighbours];
    const Vec towards{block.nx[0], block.ny[0], block.nz[0]};
    if (dot(towards, towards) > 0) return (1.0 / norm(towards)) * towards;
  }
  return {1, 0, 0};
}

/// Newton's method to the wall and along it at once; where that does not lead on, to the wall after
/// each step along it.
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

  // `known`, if not null, is the answer of f at the query point.
  void run(const blob_sample* known, blob_nearest_point& nearest) {
    begin(known);
    while (isWaiting()) {
      blob_sample there;
      sampleAt(there, m_place.foot);
      resume(there);
    }
    finish(nearest);
  }

  // A search in parts, so that several can wait for the field at once: begin(), then resume() with
  // the sample of f at place() and its node while isWaiting(), then finish().
  void begin(const blob_sample* known) {
    m_place.foot = {m_query, m_best.node, 0};
    if (known != nullptr)
      m_first = *known;
    else
      sampleAt(m_first, m_place.foot);
    ++m_steps;
    if (m_maxSteps < kUsualSteps || !(m_first.value > kVanished)) return;
    m_place.foot = {m_query - m_first.distance * normalOf(m_first), m_first.node, 0};
    m_stage = Stage::Approaching;
  }
  [[nodiscard]] bool isWaiting() const {
    return m_stage == Stage::Approaching || m_stage == Stage::Gliding;
  }
  [[nodiscard]] const Vec& place() const { return m_place.foot.at; }
  [[nodiscard]] std::uint32_t node() const { return m_place.foot.node; }
  void resume(const blob_sample& there) {
    ++m_steps;
    m_place.here = there;
    m_place.foot.node = there.node;
    if (m_stage == Stage::Approaching && isAstray()) {
      approachAcross();
      return;
    }
    m_stage = Stage::Gliding;
    glide();
  }
  void finish(blob_nearest_point& nearest) {
    const bool inside = (m_first.state & BLOB_INSIDE) != 0;
    if (m_stage == Stage::Found) return report(m_place, inside, nearest);
    Foot foot = m_place.foot;
    blob_sample first = m_stage == Stage::Stuck ? m_place.here : m_first;
    if (m_stage == Stage::Alone && inside && leadsAstray(foot, first)) first = leaveAcross(foot);
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
  static constexpr double kDeep = 0.5;          // share of the radius: depth about an axis
  static constexpr double kAcross = 0.7;        // share of the radius: step off an axis
  static constexpr std::uint32_t kSides = 4;    // steps that are tried

  static constexpr int kMostGlides = 12;
  static constexpr double kOffWall = 0.1;  // share of the radius: go to the wall first
  static constexpr double kSlow = 0.6;     // of the step before: its shape of the wall misleads
  static constexpr int kMostSlow = 1;      // steps; then second derivatives of the blended field
  static constexpr double kMisjudged =
      0.3;  // of (off / R)^2: error of a distance this far off the wall
  static constexpr double kLeastShare = 0.1;  // of a step
  static constexpr double kShorten = 0.4;     // of a step after which the wall is farther

  struct Foot {
    Vec at;
    std::uint32_t node;
    double length;  // to the query point, mm
  };

  void sampleAt(blob_sample& here, Foot& foot) const {
    const double p[3] = {foot.at.x, foot.at.y, foot.at.z};
    m_model.backend->queryOne(m_model, m_flags, p, foot.node, here);
  }

  blob_sample sample(Foot& foot) {
    ++m_steps;
    blob_sample here;
    sampleAt(here, foot);
    return here;
  }

  // Whether a place is the nearest point but for the way to the wall, which is so short that it
  // needs no check.
  [[nodiscard]] bool isNearest(const WallStep& step, double offWall, double length) const {
    const double share = m_tolerance / kUsualTolerance;
    return offWall * offWall <= kGainShare * m_tolerance * share &&
           step.gain <= kGainShare * m_tolerance * length;
  }

  // A place about the wall with the answer of f there.
  struct Place {
    Foot foot;
    blob_sample here;
  };

  // Whether the normal of the query point leads along the vessel.
  [[nodiscard]] bool isAstray() const {
    const bool isDeep = (m_first.state & BLOB_INSIDE) != 0 && m_first.distance < -kDeep * m_radius;
    return isDeep && m_place.here.distance < 0.5 * m_first.distance;
  }

  // Waits for f at a place across the vessel.
  void approachAcross() {
    m_place.foot = {m_query, m_first.node, 0};
    const blob_sample across = leaveAcross(m_place.foot);
    m_place.foot.at = m_place.foot.at - across.distance * normalOf(across);
    m_stage = Stage::Gliding;
  }

  // Waits for f after a share of a step from a place.
  void goOn(const Place& place, const WallStep& glide, double share) {
    m_place.foot = place.foot;
    m_place.foot.at = place.foot.at + share * glide.step -
                      (place.here.distance + share * share * glide.sag) * normalOf(place.here);
  }

  // The wall at a place: by the model of the node alone or, many times slower, as it is.
  WallShape shapeAt(const Place& place, bool isExact) const {
    const Vec normal = normalOf(place.here), toQuery = m_query - place.foot.at;
    WallShape wall{toQuery, normal, dot(toQuery, normal) + place.here.distance, 0, {}};
    const double p[3] = {place.foot.at.x, place.foot.at.y, place.foot.at.z};
    if (isExact) {
      blob_hessian local;
      evaluateHessian(m_model, m_flags, p, place.foot.node, local);
      wall.slope = norm(Vec{local.gradient[0], local.gradient[1], local.gradient[2]});
      std::copy_n(local.hessian, 6, wall.hessian);
      return wall;
    }
    Shape shape;
    m_model.backend->shape(m_model, p, place.foot.node, shape);
    wall.slope = norm(Vec{shape.gradient[0], shape.gradient[1], shape.gradient[2]});
    std::copy_n(shape.hessian, 6, wall.hessian);
    return wall;
  }

  // The distance of the query point from the wall about a place, as if the wall were flat there.
  [[nodiscard]] double lengthAt(const Place& place) const {
    return norm(m_query - place.foot.at + place.here.distance * normalOf(place.here));
  }

  // A descent along the wall: the best place so far, the step from there, and its share that is
  // next.
  struct Descent {
    Place place;
    WallShape wall;
    WallStep step{};
    Vec foot;  // the point of the wall at which the last step began
    double share = 1, reached;
    int steps = 0, places = 0, slowSteps = 0;
  };

  // Goes on to the nearest point of the wall by a step to the wall and along it at once, which must
  // shorten the distance; where none does, the search is stuck at the best place.
  void glide() {
    Descent& d = m_descent;
    if (d.places == 0) d.place = m_place;
    if (d.places++ == kMostGlides || !(m_place.here.value > kVanished)) return stop();
    if (d.steps > 0 && lengthAt(m_place) > d.reached) {
      d.share *= kShorten;
      if (d.share < kLeastShare) return stop();
      return goOn(d.place, d.step, d.share);
    }
    d.place = m_place;
    if (std::abs(m_place.here.distance) > kOffWall * m_radius) return goOn(d.place, WallStep{}, 1);
    if (stepOn(d))
      m_stage = Stage::Found;
    else
      goOn(d.place, d.step, 1);
  }

  void stop() {
    m_place = m_descent.place;
    m_stage = Stage::Stuck;
  }

  // Finds the next step from the place of a descent; returns whether none is needed. After the
  // first, the turn of the normal along each step corrects the shape of the wall, without a look at
  // second derivatives.
  bool stepOn(Descent& d) const {
    const double off = d.place.here.distance, length = lengthAt(d.place);
    const double before = d.share < 1 ? 0 : d.step.length;
    const Vec normal = normalOf(d.place.here), foot = d.place.foot.at - off * normal;
    if (d.steps++ == 0 || d.slowSteps > kMostSlow) {
      d.wall = shapeAt(d.place, d.slowSteps > kMostSlow);
    } else {
      bendWall(d.wall, foot - d.foot, normal - d.wall.normal);
      d.wall.toQuery = m_query - d.place.foot.at;
      d.wall.normal = normal;
      d.wall.distance = dot(d.wall.toQuery, normal) + off;
    }
    d.foot = foot;
    d.reached = length + kMisjudged * off * off / m_radius;
    d.share = 1;
    if (!(d.wall.slope > 0)) return false;
    d.step = stepAlongWall(d.wall, {m_radius, m_tolerance});
    if (before > 0 && d.step.length > kSlow * before) ++d.slowSteps;
    return isNearest(d.step, off, length);
  }

  static Vec normalOf(const blob_sample& sample) {
    return {sample.normal[0], sample.normal[1], sample.normal[2]};
  }

  void report(const Place& place, bool inside, blob_nearest_point& nearest) const {
    const Vec normal = normalOf(place.here), at = place.foot.at - place.here.distance * normal;
    nearest.point[0] = at.x;
    nearest.point[1] = at.y;
    nearest.point[2] = at.z;
    nearest.normal[0] = normal.x;
    nearest.normal[1] = normal.y;
    nearest.normal[2] = normal.z;
    const double length = norm(m_query - at);
    nearest.distance = inside ? -length : length;
    nearest.node = place.foot.node;
    nearest.steps = m_steps;
    nearest.converged = 1;
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

  // Alone: no descent along the wall is tried. Stuck: it led on no farther.
  enum class Stage : std::uint8_t { Alone, Approaching, Gliding, Found, Stuck };

  const blob_model& m_model;
  std::uint32_t m_flags;
  Stage m_stage = Stage::Alone;
  blob_sample m_first;  // at the query point
  Place m_place;
  Descent m_descent;
  Vec m_query;
  double m_radius, m_tolerance;
  std::uint32_t m_maxSteps, m_steps = 0;
  Foot m_best{};
  bool m_converged = false;
};

}  // namespace lumen::blob
