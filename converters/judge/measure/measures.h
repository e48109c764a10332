// SPDX-License-Identifier: Apache-2.0
// The measures of a case, as plain structs (docs/measures.md defines each). Lengths in mm, places in
// LPS, angles in degrees.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "formats/case/case.h"

namespace lumen {

// A measure with its uncertainty.

/// One number with its uncertainty, or the reason why there is none.
struct Measured {
  double value = std::numeric_limits<double>::quiet_NaN();
  /// half of the 95 % interval, in the unit of the value; NaN where it is not known
  double plusMinus = std::numeric_limits<double>::quiet_NaN();
  /// why the value is not defined here; empty where it is
  std::string_view absent = {};
  /// a bound, where the volume does not show a value as small; else NaN
  double atMost = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace lumen

namespace lumen::convert {

// The measures of aneurysms (docs/measures.md, section Aneurysms).

class WallNoise;

/// An aneurysm with its lobes. Lengths in mm, angles in degrees.
struct SacMeasures {
  std::uint32_t branch = 0;        ///< the one that hangs on a vessel
  std::string_view position = {};  ///< "side-wall" or "bifurcation"; empty without a vessel
  /// Centroid of the neck's section; without a neck, the middle of the sac.
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Vector3d neckNormal = Eigen::Vector3d::Zero();  ///< unit, into the dome; zero without
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();         ///< farthest from `place`
  std::vector<Eigen::Vector3d> rim = {};                 ///< of the neck, in order
  Measured neckDiameter, neckArea, height, reach, width, volume, area, aspectRatio, sizeRatio,
      bottleneckFactor, undulation, ellipticity, nonSphericity, inflowAngle;
};

/// All aneurysms of a valid case, in the order of their branches. Where a measure is not defined, it
/// states the reason. `noise`: of the case's wall; null without models. Throws Error(Cancelled).
std::vector<SacMeasures> measureSacs(const formats::Case& source, const WallNoise* noise,
                                     const Progress& progress);

using Place = Eigen::Vector3d;  ///< mm, LPS

/// One place along a vessel.
struct StationMeasures {
  std::uint32_t branch = 0, node = 0;
  Place place = Place::Zero();
  Eigen::Vector3d tangent = Eigen::Vector3d::Zero();
  Measured along, curvature, torsion, radius, area, perimeter, leastDiameter, greatestDiameter,
      circularity, taper;
};

/// The course of a vessel or of a path.
struct CourseMeasures {
  Place place = Place::Zero();  ///< its middle
  Measured length, chord, tortuosity, sumOfAngles, inflectionCount, meanCurvature,
      greatestCurvature, turns, turning, smallestRadius, meanRadius, volume, wallArea;
  Place greatestCurvaturePlace = Place::Zero(), smallestRadiusPlace = Place::Zero();
};

struct VesselMeasures : CourseMeasures {
  std::uint32_t branch = 0;
  Measured taper;
};

/// From an inlet to one end of its tree.
struct PathMeasures : CourseMeasures {
  std::uint32_t inlet = 0, end = 0;     ///< branches
  std::vector<std::uint32_t> branches;  ///< from the inlet to the end
  Measured forks, takeOff, calibreStep, catheter;
  Place takeOffPlace = Place::Zero(), calibreStepPlace = Place::Zero();
};

/// A fork with two of the vessels that leave it; `larger` has the larger calibre.
struct ForkMeasures {
  std::uint32_t node = 0;                             ///< where the vessels part
  std::uint32_t parent = 0, larger = 0, smaller = 0;  ///< branches
  Place place = Place::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the fork's plane; zero if it has none
  /// Vectors of the arms along the blood's way: into the fork, and out of it.
  Eigen::Vector3d into = Eigen::Vector3d::Zero(), outLarger = into, outSmaller = into;
  Measured angle, takeOffLarger, takeOffSmaller, inPlaneLarger, inPlaneSmaller, outOfPlaneParent,
      outOfPlaneLarger, outOfPlaneSmaller, calibreLarger, calibreSmaller, areaRatio, murrayExponent,
      asymmetry;
};

/// A stretch that is narrower or wider than the vessel's fitted healthy calibre.
struct NarrowingMeasures {
  std::uint32_t branch = 0;
  bool isDilation = false;
  Place place = Place::Zero();  ///< where the calibre differs most
  Measured along, length, diameter, healthyDiameter, diameterDegree, areaDegree;
};

struct CaseMeasures {
  std::vector<StationMeasures> stations;
  std::vector<VesselMeasures> vessels;
  std::vector<PathMeasures> paths;
  std::vector<ForkMeasures> forks;
  std::vector<NarrowingMeasures> narrowings;
  std::vector<SacMeasures> sacs;
};

}  // namespace lumen::convert
