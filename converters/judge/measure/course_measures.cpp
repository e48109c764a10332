// SPDX-License-Identifier: Apache-2.0
// Declared in vessel_measures.h.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "converters/judge/measure/vessel_measures.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kMmPerCm = 10;
constexpr double kRightAngle = 0.5 * std::numbers::pi;
// Squared difference of two unit normals beyond which the axis bends the other way: Bullitt 2003.
constexpr double kInflection = 1;
// Curvature times radius below which a vessel counts as straight: a bend of twenty radii.
constexpr double kStraightBend = 0.05;
constexpr double kOnPlace = 1e-6;     // steps: a sample as near is at a place
constexpr double kMostMissing = 0.5;  // share of a length that sections may lack
constexpr std::string_view kTooShort =
    "too short for its width: no place is far enough from both ends for the curve";
constexpr std::string_view kFewSections = "more than half of its length has no cross-section";

/// Curvature and torsion along places: those near an end take the nearest defined one's.
struct Bends {
  std::vector<double> step;       // mm that a place stands for
  std::vector<double> curvature;  // 1/mm
  std::vector<double> torsion;    // 1/mm, 0 where it is not defined
  std::vector<bool> isBent;       // the curvature is significant
  double length = 0, windows = 1;
  bool isDefined = false;
};

Bends bendsOf(const std::vector<AxisPlace>& places) {
  Bends bends;
  const std::size_t count = places.size();
  std::size_t first = count, last = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (places[i].isWhole) first = std::min(first, i), last = i;
  bends.isDefined = first < count;
  if (!bends.isDefined) return bends;
  for (std::size_t i = 0; i < count; ++i) {
    const double before = i > 0 ? places[i].along - places[i - 1].along : 0;
    const double after = i + 1 < count ? places[i + 1].along - places[i].along : 0;
    const AxisPlace& place = places[std::clamp(i, first, last)];
    bends.step.push_back(0.5 * (before + after));
    bends.curvature.push_back(place.curvature);
    bends.torsion.push_back(std::isfinite(place.torsion) ? place.torsion : 0);
    bends.isBent.push_back(place.isWhole && i >= first && i <= last &&
                           place.curvature > kHalfInterval * place.curvatureSd &&
                           place.curvature * place.radius > kStraightBend);
  }
  bends.length = places.back().along - places.front().along;
  // a window's fit rests on about as much of the axis as its half-width
  bends.windows = std::max(1.0, bends.length / places[count / 2].half);
  return bends;
}

/// Places where the axis begins to bend the other way.
std::vector<bool> inflections(const std::vector<AxisPlace>& places, const Bends& bends) {
  std::vector<bool> found(places.size(), false);
  const AxisPlace* before = nullptr;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!bends.isBent[i]) continue;
    if (before != nullptr) {
      // the normal before, turned as the tangent turns
      const Eigen::Quaterniond turn =
          Eigen::Quaterniond::FromTwoVectors(before->tangent, places[i].tangent);
      found[i] = (turn * before->normal - places[i].normal).squaredNorm() > kInflection;
    }
    before = &places[i];
  }
  return found;
}

/// Number of bends that turn by more than 90 degrees: a bend ends at an inflection and where the
/// axis is straight.
std::size_t countTurns(const Bends& bends, const std::vector<bool>& inflection) {
  std::size_t turns = 0;
  double turned = 0;
  for (std::size_t i = 0; i <= bends.step.size(); ++i) {
    const bool ends = i == bends.step.size() || !bends.isBent[i] || inflection[i];
    if (ends) {
      if (turned > kRightAngle) ++turns;
      turned = 0;
    }
    if (i < bends.step.size() && bends.isBent[i]) turned += bends.curvature[i] * bends.step[i];
  }
  return turns;
}

void measureBends(const std::vector<AxisPlace>& places, CourseMeasures& out) {
  const Bends bends = bendsOf(places);
  if (!bends.isDefined) {
    out.sumOfAngles = out.inflectionCount = out.meanCurvature = out.greatestCurvature = out.turns =
        out.turning = notDefined(kTooShort);
    return;
  }
  double turning = 0, angles = 0, variance = 0, torsionVariance = 0, bias = 0, both = 0;
  const AxisPlace* greatest = nullptr;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double step = bends.step[i];
    turning += bends.curvature[i] * step;
    const double rate = std::hypot(bends.curvature[i], bends.torsion[i]);
    angles += rate * step;
    if (!places[i].isWhole) continue;
    variance += std::pow(places[i].curvatureSd, 2) * step;
    torsionVariance += std::pow(places[i].torsionSd, 2) * step;
    bias += places[i].curvatureBias * step;
    both += step;
    if (greatest == nullptr || places[i].curvature > greatest->curvature) greatest = &places[i];
  }
  both = std::max(both, std::numeric_limits<double>::min());
  const double sd = std::sqrt(variance / both / bends.windows);
  const double torsionSd = std::sqrt(torsionVariance / both / bends.windows);
  const double mean = turning / bends.length;
  bias /= both;
  out.meanCurvature = measured(mean, sd, bias);
  out.turning =
      measured(mean * kDegrees * kMmPerCm, sd * kDegrees * kMmPerCm, bias * kDegrees * kMmPerCm);
  out.sumOfAngles = measured(angles / bends.length * kMmPerCm, std::hypot(sd, torsionSd) * kMmPerCm,
                             bias * kMmPerCm);
  out.greatestCurvature =
      measured(greatest->curvature, greatest->curvatureSd, greatest->curvatureBias);
  out.greatestCurvaturePlace = greatest->position;
  const std::vector<bool> inflection = inflections(places, bends);
  const auto count = static_cast<double>(std::count(inflection.begin(), inflection.end(), true));
  out.turns = measured(static_cast<double>(countTurns(bends, inflection)), 0);
  out.turns.plusMinus = std::numeric_limits<double>::quiet_NaN();
  const double straightness = out.tortuosity.absent.empty() ? out.tortuosity.value + 1 : NAN;
  out.inflectionCount =
      out.tortuosity.absent.empty()
          ? Measured{(count + 1) * straightness, (count + 1) * out.tortuosity.plusMinus, {}}
          : notDefined(out.tortuosity.absent);
}

}  // namespace

Measured measured(double value, double sd, double bias) {
  return {value, kHalfInterval * sd + bias, {}};
}

Measured notDefined(std::string_view reason) {
  Measured none;
  none.absent = reason;
  return none;
}

void measureCurve(const std::vector<AxisPlace>& places, double gap, double endSd,
                  CourseMeasures& out) {
  const AxisPlace &first = places.front(), &last = places.back();
  out.place = places[places.size() / 2].position;
  const Vector3d begin = first.position - gap * first.tangent;
  const double length = gap + last.along - first.along;
  const Vector3d across = last.position - begin;
  const double chord = across.norm();
  // errors of the centres lengthen the curve by half of their slopes' variance in two directions
  double slopes = 0;
  for (const AxisPlace& place : places) slopes += place.tangentSd * place.tangentSd;
  const double excess = length * slopes / static_cast<double>(places.size());
  const double ends = std::sqrt(2.0) * std::hypot(endSd, first.positionSd);
  out.length = measured(length, ends, excess);
  if (!(chord > 0)) {
    out.chord = out.tortuosity = notDefined("its ends are at one place");
  } else {
    const double slope = std::abs(first.tangent.dot(across)) / chord;
    out.chord = measured(chord, std::sqrt(2.0) * std::hypot(endSd * slope, first.positionSd));
    // ends that move along the axis change both
    const double both = std::abs(length / chord * slope - 1) / chord;
    out.tortuosity =
        measured(length / chord - 1,
                 std::hypot(std::sqrt(2.0) * endSd * both,
                            std::sqrt(2.0) * first.positionSd * (length - chord) / (chord * chord)),
                 excess / chord);
  }
  measureBends(places, out);
}

void CalibreSums::add(const VesselCourse& course, double along) {
  const std::vector<CourseSample>& samples = course.samples;
  if (samples.size() < 2) return;
  const double step = samples[1].along - samples[0].along;
  const double end = std::min(along, samples.back().along);
  // trapezoids between places that have a section; the ends take the nearest one's
  const auto stretch = [&](const CourseSample& a, const CourseSample& b, double length) {
    if (length > 1.5 * step) m_missing += length;
    m_length += length;
    m_volume += 0.5 * length * (a.section->volumeRate + b.section->volumeRate);
    m_wall += 0.5 * length * (a.section->wallRate + b.section->wallRate);
    m_radii += 0.5 * length * (a.radius + b.radius);
    m_count += length / std::max(2 * a.axis.radius, 1e-9);
    if (!std::isfinite(a.meanSd)) return;  // no wall points near by
    m_variance += a.meanSd * a.meanSd * length;
    m_known += length;
  };
  const CourseSample* before = nullptr;
  for (const CourseSample& sample : samples) {
    if (sample.along > end + kOnPlace * step) break;
    if (std::isfinite(sample.radius) && (!m_smallest || sample.radius < m_smallest->radius))
      m_smallest = &sample;
    if (!sample.section) continue;
    stretch(before ? *before : sample, sample,
            sample.along - (before ? before->along : samples.front().along));
    before = &sample;
    if (!m_first) m_first = &sample;
    m_last = &sample;
  }
  if (before) {
    stretch(*before, *before, std::max(0.0, end - before->along));
  } else {
    m_missing += end - samples.front().along;
    m_length += end - samples.front().along;
  }
}

void CalibreSums::finish(double endSd, double shared, CourseMeasures& out) const {
  if (m_smallest == nullptr) {
    out.smallestRadius = notDefined("the axis lies outside of the lumen");
  } else {
    out.smallestRadius = measured(m_smallest->radius, m_smallest->placeSd);
    out.smallestRadiusPlace = m_smallest->axis.position;
  }
  if (!(m_length > 0) || m_missing > kMostMissing * m_length) {
    const bool isTree = m_smallest && m_smallest->absent == kNoModels;
    out.meanRadius = out.volume = out.wallArea = notDefined(isTree ? kNoModels : kFewSections);
    return;
  }
  const double random = m_variance / m_known / std::max(m_count, 1.0);
  const double sd = std::sqrt(random + shared * shared);
  out.meanRadius = measured(m_radii / m_length, sd);
  const auto withEnds = [&](double rate, double first, double last) {
    return std::sqrt(std::pow(rate * sd, 2) + std::pow(endSd * first, 2) +
                     std::pow(endSd * last, 2));
  };
  out.volume = measured(m_volume, withEnds(m_wall, m_first->section->area, m_last->section->area));
  out.wallArea =
      measured(m_wall, withEnds(2 * std::numbers::pi * m_length, m_first->section->perimeter,
                                m_last->section->perimeter));
}

std::vector<VesselMeasures> measureVessels(const std::vector<VesselCourse>& courses,
                                           double shared) {
  std::vector<VesselMeasures> vessels;
  for (const VesselCourse& course : courses) {
    VesselMeasures& out = vessels.emplace_back();
    out.branch = course.branch;
    if (!course.absent.empty()) {
      for (Measured* m :
           {&out.length, &out.chord, &out.tortuosity, &out.sumOfAngles, &out.inflectionCount,
            &out.meanCurvature, &out.greatestCurvature, &out.turns, &out.turning,
            &out.smallestRadius, &out.meanRadius, &out.volume, &out.wallArea, &out.taper})
        *m = notDefined(course.absent);
      continue;
    }
    std::vector<AxisPlace> places;
    for (const CourseSample& sample : course.samples) places.push_back(sample.axis);
    measureCurve(places, course.gap, course.endSd, out);
    CalibreSums sums;
    sums.add(course, std::numeric_limits<double>::infinity());
    sums.finish(course.endSd, shared, out);
    out.taper = taperOf(course.samples, 0, course.samples.size());
  }
  return vessels;
}

}  // namespace lumen::convert
