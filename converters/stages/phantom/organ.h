// SPDX-License-Identifier: Apache-2.0
// Organs as computed tomography shows them: shapes of even tissue around two systems of vessels.
//
// Lengths are mm in a cube of kOrganEdge mm, whose axes are those of LPS; other cubes scale them all.
// Levels are Hounsfield units.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "converters/stages/phantom/design.h"
#include "formats/case/vessel_system.h"

namespace lumen::convert {

/// Between the first and the last voxel centre of an edge.
constexpr double kOrganEdge = 112;

/// An ellipsoid of tissue, or with a greater power of its norm rather a box; an infinite half axis makes a
/// cylinder.
struct OrganShape {
  Eigen::Vector3d centre, half;
  double level = 0;
  double power = 2;
};

/// Vessels or airways; one that begins within 2 mm of an earlier one's axis hangs on it.
using Courses = std::vector<Path>;

struct OrganSystem {
  formats::VesselSystem system = formats::VesselSystem::Artery;
  Courses courses;
  double level = 0;
};

struct Organ {
  std::vector<OrganShape> shapes;  ///< each painted over those before it; air around all
  Courses airways;                 ///< lumens of air within walls of soft tissue
  std::vector<OrganSystem> systems;
};

/// The design of an organ: trees with their systems, in branches SYSTEM-000 and so on, contrasts, and
/// the ground around them, whose edges breathe from slice to slice and which has streaks.
Design designOrgan(const Organ& organ, const Frame& frame);

/// A smooth vessel through places; its radius changes evenly.
Path courseThrough(const std::vector<Eigen::Vector3d>& places, double radius, double lastRadius);

/// The shape of a tree that divides into two, each time in a plane across the one before.
struct Forking {
  double length = 0, radius = 0;  ///< of the first vessel
  int depth = 0;                  ///< divisions one after another
  double angle = 0.6;             ///< radians between a vessel and each of its children
  std::uint64_t seed = 1;
};
Courses forkingTree(const Eigen::Vector3d& from, const Eigen::Vector3d& along,
                    const Forking& forking);

/// The courses, and their mirror images across the middle of x.
Courses onBothSides(Courses courses);

}  // namespace lumen::convert
