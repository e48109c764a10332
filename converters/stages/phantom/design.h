// SPDX-License-Identifier: Apache-2.0
// The design of a phantom before it is drawn: a tree of tubes, its contrast, and the clicks on it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/base/random.h"
#include "converters/base/vectors.h"
#include "converters/io/seeds/seeds.h"
#include "formats/case/case.h"
#include "formats/case/vessel_system.h"

namespace lumen::convert {

/// The space that a phantom lives in. Every coordinate of voxel centres is in [0, extent] mm.
struct Frame {
  double voxel = 0;   ///< mm
  double extent = 0;  ///< mm between the first and the last voxel centre of an edge

  /// Radii of the small phantoms are given for an extent of 25.4 mm and follow other extents within
  /// limits.
  [[nodiscard]] double radiusScale() const;
  /// Distance of the truth's nodes along a branch, mm (each branch rounds it to divide its length).
  [[nodiscard]] double nodeSpacing() const { return 0.5 * voxel; }
};

struct PathPoint {
  Eigen::Vector3d position;  ///< mm, LPS
  double radius;             ///< mm
};
using Path = std::vector<PathPoint>;

/// A finely sampled curve: `position` and `radius` over t in [0, 1].
Path sampleCurve(const std::function<Eigen::Vector3d(double)>& position,
                 const std::function<double(double)>& radius);

/// From one point to another; `radius` over t in [0, 1].
Path straightPath(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                  const std::function<double(double)>& radius);

/// A radius that is `value` everywhere.
std::function<double(double)> constant(double value);

double pathLength(const Path& path);

/// The path at even arc lengths, about `spacing` apart; both ends are kept.
Path resamplePath(const Path& path, double spacing);

struct Design {
  formats::CenterlineTree tree;
  std::vector<float> contrast;  ///< for each node, the share of the full contrast
  std::vector<SeedBranch> seeds;
  std::map<std::string, formats::ParameterValue>
      notes;  ///< what else a reader of the truth should know
  /// Signed distance to the wall, mm, negative inside, right to first order near it and to a factor of
  /// two elsewhere; empty: the wall is that of the tree taken as tubes. Contrast is full.
  std::function<double(const Eigen::Vector3d&)> wall;
  /// Intensity around the vessels, as a share of the full contrast; empty: none. May be negative.
  std::function<double(const Eigen::Vector3d&)> ground;
  std::vector<formats::VesselSystem> systems;  ///< one for each node; empty: unknown
};

/// Appends branches to a design, resampled to the frame's node spacing.
class TreeBuilder {
public:
  explicit TreeBuilder(const Frame& frame) : m_frame(frame) {}

  /// Returns the branch's index. A child's path begins on its parent's axis; the child is tied to
  /// the node of `parent` (a branch index, or kNoParent) that is nearest to the beginning.
  std::uint32_t add(const std::string& label, std::int32_t parent, const Path& path,
                    formats::BranchKind kind = formats::BranchKind::Vessel);

  /// Links the last node of a branch to the node of another branch that is nearest to it.
  void link(std::uint32_t from, std::uint32_t to);

  [[nodiscard]] const formats::CenterlineTree& tree() const { return m_design.tree; }
  Design& design() { return m_design; }

private:
  [[nodiscard]] std::int32_t nearestNode(std::uint32_t branch, const Eigen::Vector3d& point) const;

  Frame m_frame;
  Design m_design;
};

double radiusOf(const formats::CenterlineTree& tree, std::uint32_t node);

/// Two unit vectors that make a right-handed orthonormal frame with the unit vector `w`. Not
/// planeBasis() of vectors.h, which turns them otherwise: phantoms would change.
std::pair<Eigen::Vector3d, Eigen::Vector3d> perpendiculars(const Eigen::Vector3d& w);

/// Uniform in the cube [-1, 1)^3. The coordinates are drawn one after the other: the order in which
/// a call's arguments are evaluated depends on the compiler.
Eigen::Vector3d randomInCube(Random& random);

/// The clicks that start every branch of the design, in the order of its branches.
/// - A root: one point half a radius past its start, up to a tenth of a radius off the axis; a
///   radius within 10 % of the truth; a direction within 10 degrees.
/// - A child: one point where its axis is 1.5 to 1.75 parent radii away from the parent's axis, up
///   to a quarter of the child's radius off its own axis; a radius (within 10 %) only if the child
///   is under half of the parent's width.
/// - An aneurysm: points from behind the neck through the sac's centre to beyond it, each with its
///   distance to the wall (within 10 %).
std::vector<SeedBranch> clickSeeds(const formats::CenterlineTree& tree, Random& random);

/// The clicks on a tree that came from a file, parents first: one for each vessel that is longer
/// than 5 mm and has a median radius of at least 1.5 voxels. Each lies a fifth of the radius off
/// the axis: of a root half a radius past its start, of a child where its axis is 1.5 to 1.75
/// parent radii away from its parent's, or four along the vessel. A child of a vessel that has no
/// click is joined to the nearest one upstream that has one, or is a root. Radii and directions are
/// given where clickSeeds() gives them.
std::vector<SeedBranch> clickLargeVessels(const formats::CenterlineTree& tree, double voxel,
                                          Random& random);

/// The clicks of a person in a hurry: on the vessels of clickLargeVessels(), a fifth of the radius
/// off the axis, of a child where its axis is 1.5 of its own radii beyond the wall of its parent, or
/// four of the parent's along the vessel, without radii and directions. The clicks of aneurysms are
/// those of clickSeeds().
std::vector<SeedBranch> clickCarelessly(const formats::CenterlineTree& tree, double voxel,
                                        Random& random);

/// Lowers the contrast in proportion to the distance along the tree from the root, by `share` of it
/// at the farthest end.
void fadeContrast(Design& design, double share);

Design designTube(const Frame& frame);
Design designHelix(const Frame& frame);
Design designBifurcation(const Frame& frame);
Design designKissing(const Frame& frame);
Design designAneurysm(const Frame& frame);
Design designStenosis(const Frame& frame);
Design designDropout(const Frame& frame);
Design designSacLobes(const Frame& frame);
Design designCompanion(const Frame& frame);
Design designHairpin(const Frame& frame);
Design designRightAngle(const Frame& frame);
Design designFading(const Frame& frame);
Design designThickSlices(const Frame& frame);
Design designCoil(const Frame& frame);
Design designArc(const Frame& frame);
Design designCone(const Frame& frame);
Design designEllipseTube(const Frame& frame);
Design designFork(const Frame& frame);
Design designSacSphere(const Frame& frame);
Design designSacEllipsoid(const Frame& frame);
Design designSacFork(const Frame& frame);
/// Names of the arteries of a circle of Willis that may be missing: A1 and P1 are the first parts of
/// the anterior and the posterior cerebral artery.
const std::vector<std::string>& willisParts();

/// A circle of Willis without some of willisParts(); what only they would feed is missing, too.
Design designWillis(const Frame& frame, const std::set<std::string>& missing);
Design designCoronary(const Frame& frame);
Design designHepatic(const Frame& frame);
Design designHeart(const Frame& frame);
Design designLiver(const Frame& frame);
Design designLungs(const Frame& frame);
Design designDissection(const Frame& frame);
Design designKidneys(const Frame& frame);
Design designLegs(const Frame& frame);
Design designRetina(const Frame& frame);
Design designPatient(const Frame& frame, std::uint64_t seed, Progress& progress);

}  // namespace lumen::convert
