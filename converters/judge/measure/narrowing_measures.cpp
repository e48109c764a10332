// SPDX-License-Identifier: Apache-2.0
// Declared in vessel_measures.h.

#include <algorithm>
#include <cmath>

#include "converters/base/statistics.h"
#include "converters/judge/measure/vessel_measures.h"

namespace lumen::convert {

namespace {

constexpr double kWindowRadii = 20;         // half-width of the trend: longer than a lesion
constexpr double kClearRadii = 1.5;         // from a fork or an end: the wall flares there
constexpr double kLeastRadii = 10;          // of a vessel with a trend
constexpr std::size_t kFewestSections = 8;  // sections of a vessel with a trend
constexpr double kListed = 0.2;  // share of the healthy calibre from which a stretch is listed
constexpr double kEdge = 0.1;    // share of the healthy calibre at which a stretch ends
constexpr double kLeastSpread = 0.001;  // of residuals, as a share of the calibre
constexpr int kRounds = 8;
constexpr double kBisquare = 6;  // medians of the absolute residuals

double tricube(double x) {
  const double rest = 1 - std::abs(x * x * x);
  return rest > 0 ? rest * rest * rest : 0;
}

/// Sections of a vessel that are clear of forks and ends.
struct Calibres {
  std::vector<const CourseSample*> sample;
  std::vector<double> along, circle, least;  // mm: place, diameter of equal area, least diameter
  double radius = 0;
};

Calibres calibresOf(const VesselCourse& course) {
  Calibres out;
  const auto& samples = course.samples;
  std::vector<double> radius;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double clear = kClearRadii * samples[i].axis.radius;
    bool isClear = samples[i].section.has_value() &&
                   samples[i].along - samples.front().along >= clear &&
                   samples.back().along - samples[i].along >= clear;
    for (std::size_t k = i; isClear && k-- > 0 && samples[i].along - samples[k].along < clear;)
      isClear = samples[k].section.has_value();
    for (std::size_t k = i + 1;
         isClear && k < samples.size() && samples[k].along - samples[i].along < clear; ++k)
      isClear = samples[k].section.has_value();
    if (!isClear) continue;
    out.sample.push_back(&samples[i]);
    out.along.push_back(samples[i].along);
    out.circle.push_back(calibreOf(*samples[i].section));
    out.least.push_back(samples[i].section->least);
    radius.push_back(samples[i].axis.radius);
  }
  if (!radius.empty()) out.radius = median(std::move(radius));
  return out;
}

/// The least of a parabola through a value and its neighbours, where that is between them.
double refinedLeast(const std::vector<double>& values, std::size_t i) {
  if (i == 0 || i + 1 >= values.size()) return values[i];
  const double bend = values[i - 1] + values[i + 1] - 2 * values[i];
  const double slope = 0.5 * (values[i + 1] - values[i - 1]);
  if (!(std::abs(bend) > 0) || std::abs(slope) > std::abs(bend)) return values[i];
  return values[i] - 0.5 * slope * slope / bend;
}

/// Where a share falls to the edge between two samples, mm.
double crossing(const Calibres& c, const std::vector<double>& share, std::size_t inside,
                std::size_t outside) {
  const double u = (share[inside] - kEdge) / (share[inside] - share[outside]);
  return c.along[inside] + u * (c.along[outside] - c.along[inside]);
}

class Findings {
public:
  Findings(const VesselCourse& course, std::vector<NarrowingMeasures>& out)
      : m_course(course), m_out(out), m_calibres(calibresOf(course)) {}

  void find() {
    const Calibres& c = m_calibres;
    if (c.along.size() < kFewestSections ||
        c.along.back() - c.along.front() < kLeastRadii * c.radius)
      return;
    m_circle = robustTrend(c.along, c.circle, kWindowRadii * c.radius);
    m_least = robustTrend(c.along, c.least, kWindowRadii * c.radius);
    std::vector<double> rest;
    for (std::size_t i = 0; i < c.along.size(); ++i)
      rest.push_back(std::abs(c.circle[i] / m_circle[i] - 1));
    m_spread = 1.4826 * median(std::move(rest));
    for (const bool isDilation : {false, true}) stretches(isDilation);
  }

private:
  void stretches(bool isDilation) {
    const Calibres& c = m_calibres;
    std::vector<double> share;
    for (std::size_t i = 0; i < c.along.size(); ++i)
      share.push_back((isDilation ? -1 : 1) * (1 - c.circle[i] / m_circle[i]));
    for (std::size_t first = 0, next = 0; first < share.size(); first = next) {
      next = first + 1;
      if (share[first] < kEdge) continue;
      while (next < share.size() && share[next] >= kEdge) ++next;
      const auto most = std::max_element(share.begin() + static_cast<std::ptrdiff_t>(first),
                                         share.begin() + static_cast<std::ptrdiff_t>(next));
      if (*most < kListed || *most < kBisquare * m_spread) continue;
      add(isDilation, share, first, next - 1, static_cast<std::size_t>(most - share.begin()));
    }
  }

  void add(bool isDilation, const std::vector<double>& share, std::size_t first, std::size_t last,
           std::size_t at) {
    const Calibres& c = m_calibres;
    NarrowingMeasures& out = m_out.emplace_back();
    const CourseSample& sample = *c.sample[at];
    out.branch = m_course.branch;
    out.isDilation = isDilation;
    out.place = sample.axis.position;
    const double step = c.along.size() > 1 ? c.along[1] - c.along[0] : 0;
    out.along = measured(sample.along, 0.5 * step);
    const double from = first > 0 ? crossing(c, share, first, first - 1) : c.along[first];
    const double to =
        last + 1 < c.along.size() ? crossing(c, share, last, last + 1) : c.along[last];
    out.length = measured(to - from, std::sqrt(2.0) * 0.5 * step);
    const double circle = refinedLeast(c.circle, at);
    const double healthy = m_circle[at], least = m_least[at];
    const double windows = std::max(1.0, (c.along.back() - c.along.front()) / (4 * c.radius));
    const double healthySd = m_spread * healthy / std::sqrt(windows);
    out.diameter = measured(circle, 2 * sample.meanSd);
    out.healthyDiameter = measured(healthy, healthySd);
    const auto degree = [&](double found, double whole, double sd) {
      const double ratio = found / whole;
      const double error = std::hypot(2 * sd / whole, ratio * healthySd / healthy);
      return std::pair{100 * (1 - ratio), 100 * error};
    };
    const auto [nascet, nascetSd] = degree(refinedLeast(c.least, at), least, sample.placeSd);
    out.diameterDegree = measured(nascet, nascetSd);
    const double ratio = circle / healthy;
    out.areaDegree = measured(100 * (1 - ratio * ratio),
                              2 * ratio * degree(circle, healthy, sample.meanSd).second);
  }

  const VesselCourse& m_course;
  std::vector<NarrowingMeasures>& m_out;
  Calibres m_calibres;
  std::vector<double> m_circle, m_least;  // the trends
  double m_spread = 0;                    // of the calibre around its trend, as a share
};

}  // namespace

std::vector<double> robustTrend(const std::vector<double>& x, const std::vector<double>& y,
                                double half) {
  const std::size_t count = x.size();
  std::vector<double> trend(count, median(y)), weight(count, 1), rest(count);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < count; ++i) rest[i] = std::abs(y[i] - trend[i]);
    const double scale = kBisquare * std::max(median(rest), kLeastSpread * std::abs(median(trend)));
    for (std::size_t i = 0; i < count; ++i) {
      const double u = rest[i] / scale;
      weight[i] = u < 1 ? (1 - u * u) * (1 - u * u) : 0;
    }
    for (std::size_t i = 0; i < count; ++i) {
      double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
      for (std::size_t k = 0; k < count; ++k) {
        const double u = (x[k] - x[i]) / half;
        if (std::abs(u) >= 1) continue;
        const double a = tricube(u) * weight[k], dx = x[k] - x[i];
        w += a, wx += a * dx, wy += a * y[k], wxx += a * dx * dx, wxy += a * dx * y[k];
      }
      const double spread = wxx * w - wx * wx;
      if (spread > 1e-12 * half * half * w * w)
        trend[i] = (wxx * wy - wx * wxy) / spread;
      else if (w > 0)
        trend[i] = wy / w;
    }
  }
  return trend;
}

std::vector<NarrowingMeasures> measureNarrowings(const std::vector<VesselCourse>& courses) {
  std::vector<NarrowingMeasures> out;
  for (const VesselCourse& course : courses)
    if (course.absent.empty()) Findings(course, out).find();
  return out;
}

}  // namespace lumen::convert
