// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/measure_case.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <tbb/parallel_invoke.h>

#include "converters/judge/measure/course_measures.h"
#include "converters/judge/measure/fork_measures.h"
#include "converters/judge/measure/narrowing_measures.h"
#include "converters/judge/measure/path_measures.h"
#include "converters/judge/measure/taper.h"
#include "converters/judge/measure/vessel_course.h"

namespace lumen::convert {

namespace {

constexpr double kTaperRadii = 3;  // to either side: the stretch of a station's taper
// Standard deviations by which the least of four independent normal errors lies below none: the
// wall's noise brings the nearest of its places nearer.
constexpr double kLeastOfFour = 1.029;
constexpr std::string_view kNearEnd = "too near to an end of the vessel for the curve's window";
constexpr std::string_view kNoTorsion = "the curvature is not significant: a line has no torsion";
constexpr std::string_view kAxisOutside = "the axis lies outside of the lumen";

void addSection(const CourseSample& sample, StationMeasures& out) {
  if (!sample.section) {
    out.area = out.perimeter = out.leastDiameter = out.greatestDiameter = out.circularity =
        notDefined(sample.absent);
    return;
  }
  const Section& s = *sample.section;
  out.area = measured(s.area, s.perimeter * sample.meanSd);
  out.perimeter = measured(s.perimeter, 2 * std::numbers::pi * sample.meanSd);
  out.leastDiameter = measured(s.least, 2 * sample.placeSd);
  out.greatestDiameter = measured(s.greatest, 2 * sample.placeSd);
  // the ring's bends change the perimeter beside the area
  out.circularity =
      measured(s.circularity, 2 * s.circularity * std::sqrt(std::max(0.0, 1 - s.circularity)) *
                                      sample.placeSd / sample.radius +
                                  std::pow(sample.placeSd / sample.radius, 2));
}

StationMeasures stationOf(std::uint32_t branch, const std::vector<CourseSample>& samples,
                          std::size_t i, double endSd) {
  const CourseSample& sample = samples[i];
  StationMeasures out;
  out.branch = branch;
  out.node = sample.node;
  out.place = sample.axis.position;
  out.tangent = sample.axis.tangent;
  out.along = measured(sample.along, endSd);
  if (!sample.axis.isWhole) {
    out.curvature = out.torsion = notDefined(kNearEnd);
  } else {
    const AxisPlace& axis = sample.axis;
    out.curvature = measured(axis.curvature, axis.curvatureSd, axis.curvatureBias);
    out.torsion = std::isfinite(axis.torsion)
                      ? measured(axis.torsion, axis.torsionSd, axis.torsionBias)
                      : notDefined(kNoTorsion);
  }
  out.radius = std::isfinite(sample.radius)
                   ? measured(sample.radius, sample.placeSd, kLeastOfFour * sample.placeSd)
                   : notDefined(kAxisOutside);
  addSection(sample, out);
  std::size_t first = i, last = i + 1;
  const double reach = kTaperRadii * sample.axis.radius;
  while (first > 0 && sample.along - samples[first - 1].along <= reach) --first;
  while (last < samples.size() && samples[last].along - sample.along <= reach) ++last;
  out.taper = sample.section ? taperOf(samples, first, last) : notDefined(sample.absent);
  return out;
}

void addStations(const formats::CenterlineTree& tree, const VesselCourse& course,
                 const MeasureOptions& options, const Wall* wall, const WallNoise* noise,
                 std::vector<StationMeasures>& out) {
  std::vector<CourseSample> own;
  if (options.step) {
    std::vector<double> along;
    const double length = course.length();
    for (std::size_t i = 0; static_cast<double>(i) * *options.step <= length; ++i) {
      const double at = static_cast<double>(i) * *options.step - course.gap + course.begin;
      if (at >= 0) along.push_back(at);
    }
    own = sampleCourse(tree, course, along, wall, noise);
  }
  const std::vector<CourseSample>& samples = options.step ? own : course.samples;
  for (std::size_t i = 0; i < samples.size(); ++i)
    out.push_back(stationOf(course.branch, samples, i, course.endSd));
}

/// All measures but those of aneurysms.
void measureVesselsOf(const formats::Case& source, const MeasureOptions& options, const Wall* wall,
                      const WallNoise* noise, Progress& progress, CaseMeasures& out) {
  const std::vector<VesselCourse> courses = vesselCourses(source, wall, noise, progress);
  const double shared = noise ? noise->shared() : 0;
  for (const VesselCourse& course : courses)
    if (course.absent.empty()) addStations(source.tree, course, options, wall, noise, out.stations);
  out.vessels = measureVessels(courses, shared);
  out.forks = measureForks(source.tree, courses);
  out.paths = measurePaths(source.tree, courses, out.forks, shared, progress);
  out.narrowings = measureNarrowings(courses);
}

}  // namespace

CaseMeasures measureCase(const formats::Case& source, const MeasureOptions& options,
                         Progress& progress) {
  const bool hasWall = source.models && source.tree.nodeCount() > 0;
  const std::optional<Wall> wall = hasWall ? std::optional<Wall>(source) : std::nullopt;
  const std::optional<WallNoise> noise =
      wall ? std::optional<WallNoise>(std::in_place, source, *wall) : std::nullopt;
  const Wall* cut = wall ? &*wall : nullptr;
  const WallNoise* spread = noise ? &*noise : nullptr;
  CaseMeasures out;
  // a sac is the work of one thread, which is as long as that of all vessels
  tbb::parallel_invoke([&] { out.sacs = measureSacs(source, spread, progress); },
                       [&] { measureVesselsOf(source, options, cut, spread, progress, out); });
  return out;
}

}  // namespace lumen::convert
