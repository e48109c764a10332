// SPDX-License-Identifier: Apache-2.0
// Measures of the course of a vessel or a path (docs/measures.md, section 4).
#pragma once

#include <cstddef>
#include <vector>

#include "converters/base/progress.h"
#include "converters/judge/measure/measures.h"
#include "converters/judge/measure/vessel_course.h"

namespace lumen::convert {

inline constexpr double kFrenchPerMm = 3;  ///< French of a catheter for each mm of its diameter

/// A value whose half interval follows from a standard deviation and a bound of its bias.
Measured measured(double value, double sd, double bias = 0);
/// No value, for a reason.
Measured notDefined(std::string_view reason);

/// Length, chord, curvature and turning of places along an axis, in order. `endSd`: standard
/// deviation of where its ends lie along it, mm; `gap`: mm before the first place.
void measureCurve(const std::vector<AxisPlace>& places, double gap, double endSd,
                  CourseMeasures& out);

/// Sums over the calibres of the samples of one or several vessels.
class CalibreSums {
public:
  /// Adds the samples of a vessel up to `along` mm (all: infinity).
  void add(const VesselCourse& course, double along);
  /// Smallest and mean radius, volume and area. `endSd` as above; `shared`: standard deviation that
  /// all radii share, mm.
  void finish(double endSd, double shared, CourseMeasures& out) const;

private:
  double m_length = 0, m_radii = 0, m_volume = 0, m_wall = 0;
  double m_variance = 0, m_known = 0, m_count = 0;  // of the wall's random part
  double m_missing = 0;                             // mm without a section
  // samples of the courses that were added, which outlive the sums
  const CourseSample *m_smallest = nullptr, *m_first = nullptr, *m_last = nullptr;
};

/// Vessels of a case, those without a course too.
std::vector<VesselMeasures> measureVessels(const std::vector<VesselCourse>& courses, double shared);

// Loss of calibre along a vessel (docs/measures.md, section 3).

/// Loss of diameter for each mm of the samples [first, last), by a line of least squares through the
/// diameters of the circles of their sections' area.
Measured taperOf(const std::vector<CourseSample>& samples, std::size_t first, std::size_t last);

/// Diameter of the circle of a section's area, mm.
double calibreOf(const Section& section);

// Angles and calibres of forks (docs/measures.md, section 5).

/// One row for each pair of vessels that leave a fork, in the order of the forks' nodes.
std::vector<ForkMeasures> measureForks(const formats::CenterlineTree& tree,
                                       const std::vector<VesselCourse>& courses);

// Stenoses and dilations against a fitted healthy calibre (docs/measures.md, section 6).

/// Along a vessel, the values of a robust local line through others: Cleveland, "Robust locally
/// weighted regression and smoothing scatterplots", 1979. `half`: of the window, in the unit of
/// `x`, which ascends.
std::vector<double> robustTrend(const std::vector<double>& x, const std::vector<double>& y,
                                double half);

/// The narrowings and dilations of all vessels, in order.
std::vector<NarrowingMeasures> measureNarrowings(const std::vector<VesselCourse>& courses);

// Paths from an inlet to each end of its tree (docs/measures.md, section 4).

/// One path for each end of a vessel where no other goes on, in the order of the branches. `shared`:
/// standard deviation that all radii share, mm.
std::vector<PathMeasures> measurePaths(const formats::CenterlineTree& tree,
                                       const std::vector<VesselCourse>& courses,
                                       const std::vector<ForkMeasures>& forks, double shared,
                                       const Progress& progress);

}  // namespace lumen::convert
