// SPDX-License-Identifier: Apache-2.0
// The measures of a case, as plain structs (docs/measures.md defines each). Lengths in mm, places in
// LPS, angles in degrees.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/judge/measure/measured.h"
#include "converters/judge/measure/sac_measures.h"

namespace lumen::convert {

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
