// SPDX-License-Identifier: Apache-2.0
// First hits of segments, and the deepest points of capsules.
#include "segment.h"

#include <algorithm>
#include <cmath>

#include "formats/field/vector.h"
#include "nearest.h"
#include "simd/backend.h"

namespace lumen::blob {
namespace {

using field::Vec;

Vec vec(const double* p) {
  return {p[0], p[1], p[2]};
}
void store(const Vec& v, double* p) {
  p[0] = v.x;
  p[1] = v.y;
  p[2] = v.z;
}

// The part of a segment within the box that holds every wall; empty if first > last.
struct Range {
  double first = 0, last = 1;
};

Range clip(const blob_model& model, const double* from, const double* to) {
  Range range;
  for (int i = 0; i < 3; ++i) {
    const double delta = to[i] - from[i];
    double enter = (model.reachLow[i] - from[i]) / delta,
           leave = (model.reachHigh[i] - from[i]) / delta;
    if (delta < 0) std::swap(enter, leave);
    if (delta == 0) {
      if (from[i] < model.reachLow[i] || from[i] > model.reachHigh[i]) return {1, 0};
      continue;
    }
    range.first = std::max(range.first, enter);
    range.last = std::min(range.last, leave);
  }
  return range;
}

// Sphere tracing: steps as long as bounds on f in balls around the path allow (J. C. Hart, "Sphere
// tracing", 1996, with bounds in place of a Lipschitz constant).
class SphereTracing {
public:
  SphereTracing(const blob_model& model, std::uint32_t flags, const double* from, const double* to,
                std::uint32_t node, double tolerance, std::uint32_t maxSteps)
      : m_model(model),
        m_flags(flags),
        m_from(vec(from)),
        m_way(vec(to) - vec(from)),
        m_length(norm(m_way)),
        m_level(static_cast<float>(model.field.isoLevel)),
        m_tolerance(tolerance > 0 ? tolerance
                                  : kUsualTolerance * double{model.nodes[node].radius()}),
        m_maxSteps(maxSteps > 0 ? maxSteps : kUsualSteps),
        m_node(node) {}

  void run(const Range& range, blob_hit& hit) {
    double t = range.first;
    blob_sample here = sample(t);
    const std::uint32_t side = here.state & BLOB_INSIDE;
    while (t < range.last && m_steps < m_maxSteps) {
      const double step = safeStep(t, here, side != 0) / m_length;
      const double next = std::min(t + step, range.last);
      const std::uint32_t nodeBefore = m_node;
      const blob_sample there = sample(next);
      if ((there.state & BLOB_INSIDE) != side) {
        m_node = nodeBefore;
        report(crossing(t, next, side), hit);
        return;
      }
      t = next;
      here = there;
    }
    hit.complete = t >= range.last ? 1 : 0;
    hit.t = hit.complete != 0 ? 1.0 : t;
    store(m_from + hit.t * m_way, hit.point);
    for (int i = 0; i < 3; ++i) hit.normal[i] = here.normal[i];
    hit.node = m_node;
    hit.steps = m_steps;
  }

private:
  static constexpr double kUsualTolerance = 1e-3;  // share of the node's radius
  static constexpr std::uint32_t kUsualSteps = 16384;
  static constexpr double kDistanceShare = 0.6;  // share of the one-evaluation distance
  static constexpr double kLongestStep = 0.5;    // share of the radius, see Backend::bounds
  static constexpr double kBisectTo = 0.1;       // share of the tolerance

  blob_sample sample(double t) {
    ++m_steps;
    double p[3];
    store(m_from + t * m_way, p);
    blob_sample here;
    m_model.backend->queryOne(m_model, m_flags, p, m_node, here);
    return here;
  }

  // A length in which the wall is not crossed, mm: a ball in which bounds on f exclude it, or the
  // tolerance.
  double safeStep(double t, const blob_sample& here, bool inside) {
    double p[3];
    store(m_from + t * m_way, p);
    const double radius = m_model.nodes[m_node].radius();
    double step = std::min(kDistanceShare * std::abs(here.distance), kLongestStep * radius);
    for (; step > m_tolerance && m_steps < m_maxSteps; step *= 0.5) {
      ++m_steps;
      float least, greatest;
      m_model.backend->bounds(m_model, m_flags, p, m_node, static_cast<float>(step), &least,
                              &greatest);
      if (inside ? least > m_level : greatest < m_level) return step;
    }
    return m_tolerance;
  }

  // The crossing between t, on the side of the start, and `beyond`: at most the tolerance before
  // it.
  double crossing(double t, double beyond, std::uint32_t side) {
    constexpr int kMaxHalvings = 60;
    const std::uint32_t start = m_node;
    for (int i = 0; i < kMaxHalvings && (beyond - t) * m_length > kBisectTo * m_tolerance; ++i) {
      const double middle = 0.5 * (t + beyond);
      m_node = start;
      const blob_sample there = sample(middle);
      ((there.state & BLOB_INSIDE) == side ? t : beyond) = middle;
    }
    m_node = start;
    return t;
  }

  void report(double t, blob_hit& hit) {
    const blob_sample at = sample(t);
    hit.hit = 1;
    hit.complete = 1;
    hit.t = t;
    store(m_from + t * m_way, hit.point);
    for (int i = 0; i < 3; ++i) hit.normal[i] = at.normal[i];
    hit.node = m_node;
    hit.steps = m_steps;
  }

  const blob_model& m_model;
  std::uint32_t m_flags;
  Vec m_from, m_way;
  double m_length;
  float m_level;
  double m_tolerance;
  std::uint32_t m_maxSteps, m_steps = 0, m_node;
};

// The greatest distance along an axis: samples, then golden-section search between two of them.
class GoldenSectionSearch {
public:
  GoldenSectionSearch(const blob_model& model, std::uint32_t flags, const double* from,
                      const double* to, std::uint32_t node)
      : m_model(model),
        m_flags(flags),
        m_from(vec(from)),
        m_way(vec(to) - vec(from)),
        m_node(node) {}

  void run(blob_approach& approach) {
    constexpr double kLeastStep = 1.0 / 128;  // share of the axis
    constexpr double kStep = 0.25;            // share of the local radius
    const double length = norm(m_way);
    double before = 0, low = 0, high = 1;
    visit(0);
    for (double t = 0; t < 1;) {
      const double usual = kStep * double{m_model.nodes[m_node].radius()};
      const double next = std::min(1.0, t + std::max(kLeastStep, usual / std::max(length, usual)));
      if (m_bestAt == t) {  // the best so far is bracketed by the samples on either side
        low = before;
        high = next;
      }
      before = t;
      t = next;
      visit(t);
    }
    if (m_bestAt == 1) {
      low = before;
      high = 1;
    }
    refine(low, high);
    approach = m_best;
  }

private:
  double visit(double t) {
    double p[3];
    store(m_from + t * m_way, p);
    blob_sample at;
    sampleAt(m_model, m_flags, p, m_node, at);
    if (at.distance > m_best.distance || m_bestAt < 0) {
      m_bestAt = t;
      m_best.t = t;
      store(m_from + t * m_way, m_best.point);
      m_best.distance = at.distance;
      for (int i = 0; i < 3; ++i) m_best.normal[i] = at.normal[i];
      m_best.node = at.node;
      m_best.state = at.state;
    }
    return at.distance;
  }

  // Refines by golden sections; near its greatest value a distance hardly changes, so a few
  // suffice.
  void refine(double low, double high) {
    constexpr int kSections = 14;
    constexpr double kGolden = 0.6180339887498949;
    m_node = m_best.node;
    double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    double fa = visit(a), fb = visit(b);
    for (int i = 0; i < kSections; ++i) {
      if (fa > fb) {
        high = b;
        b = a;
        fb = fa;
        a = high - kGolden * (high - low);
        fa = visit(a);
      } else {
        low = a;
        a = b;
        fa = fb;
        b = low + kGolden * (high - low);
        fb = visit(b);
      }
    }
  }

  const blob_model& m_model;
  std::uint32_t m_flags;
  Vec m_from, m_way;
  std::uint32_t m_node;
  double m_bestAt = -1;
  blob_approach m_best{};
};

}  // namespace

void findHit(const blob_model& model, std::uint32_t flags, const double* from, const double* to,
             std::uint32_t node, double tolerance, std::uint32_t maxSteps, blob_hit& hit) noexcept {
  const Range range = clip(model, from, to);
  if (range.first <= range.last) {
    SphereTracing(model, flags, from, to, node, tolerance, maxSteps).run(range, hit);
    return;
  }
  hit.complete = 1;
  hit.t = 1;
  hit.node = node;
  store(vec(to), hit.point);
}

void findDeepest(const blob_model& model, std::uint32_t flags, const double* from, const double* to,
                 std::uint32_t node, blob_approach& approach) noexcept {
  GoldenSectionSearch(model, flags, from, to, node).run(approach);
}

}  // namespace lumen::blob
