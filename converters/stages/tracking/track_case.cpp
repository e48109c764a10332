// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/track_case.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/options/edit_steps.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/base/vectors.h"
#include "converters/geometry/automatic_names.h"
#include "converters/io/volume/write_volume.h"
#include "converters/stages/tracking/corrections.h"
#include "converters/stages/tracking/follow_courses.h"
#include "converters/stages/tracking/path_rules.h"
#include "converters/stages/tracking/sac_walls.h"
#include "converters/stages/tracking/track_by_depth.h"
#include "converters/stages/tracking/tracking_volume.h"
#include "converters/stages/tracking/wall_review.h"
#include "formats/case/motion.h"
#include "formats/case/node_origin.h"
#include "formats/case/validate.h"
#include "formats/case/vessel_system.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

using formats::BranchKind;

/// Corrects the wall points that a sac has added to a known vessel, behind those that it kept.
/// `before`: the branch without them.
void correctAdded(TrackedBranch& branch, const TrackedBranch& before, BranchKind kind,
                  const WallShape& shape) {
  for (std::size_t n = 0; n < branch.nodes.size(); ++n) {
    auto& points = branch.nodes[n].points;
    auto kept = points.begin();
    for (const formats::Vec3f& p : before.nodes[n].points)
      if (kept != points.end() && *kept == p) ++kept;
    if (kept == points.end()) continue;
    TrackedBranch added;
    added.nodes.push_back(branch.nodes[n]);
    added.nodes[0].points.assign(kept, points.end());
    correctWalls(added, kind, shape);
    std::copy(added.nodes[0].points.begin(), added.nodes[0].points.end(), kept);
  }
}

/// Conditions under which a tree is tracked.
struct TrackPlan {
  SeedPoints points;
  PlaceTest isNoVessel;
  std::optional<WallShape> shape;  ///< by which walls are corrected; measured if empty
  CourseRules rules = {};
};

/// Tracks the seeds of a tree that are not known, and joins and corrects their branches. Known
/// branches get wall points only, where new aneurysms open into them. Returns the shape by which
/// walls were corrected. Throws Error(Cancelled).
WallShape trackTree(const TrackingVolume& volume, const TrackPlan& plan, TrackedTree& tree,
                    Progress& progress) {
  TrackContext context(volume.spline(), volume.options(), volume.noiseFloor(), progress,
                       plan.isNoVessel);
  context.rules = plan.rules;
  context.points = plan.points;
  const bool areCourses = plan.points == SeedPoints::Courses;
  progress.begin("track", tree.seeds.size() - tree.known);
  areCourses ? followCourses(context, tree, progress) : trackByDepth(context, tree, progress);
  areCourses ? trimTips(context, tree) : extendTips(context, tree);
  joinTree(context, tree);
  reviewWalls(context, tree);
  if (areCourses) dropUnsupported(context, tree);
  progress.end();
  const WallShape shape = plan.shape ? *plan.shape : measureWallShape(volume, tree);
  const std::vector<TrackedBranch> before(
      tree.branches.begin(), tree.branches.begin() + static_cast<std::ptrdiff_t>(tree.known));
  captureSacs(context, tree);
  for (std::size_t i = 0; i < tree.known; ++i)
    correctAdded(tree.branches[i], before[i], tree.seeds[i].kind, shape);
  tbb::parallel_for(tree.known, tree.seeds.size(), [&](std::size_t i) {
    correctWalls(tree.branches[i], tree.seeds[i].kind, shape);
    if (tree.isVessel(i)) correctBends(tree.branches[i].nodes);
  });
  return shape;
}

/// Searches at random for cylinders where courses left bridged nodes, once all vessels are tracked.
void fillBridges(const TrackingVolume& volume, const TrackPlan& plan, TrackedTree& tree,
                 const Progress& progress) {
  if (plan.points != SeedPoints::Courses) return;
  const TrackContext context(volume.spline(), volume.options(), volume.noiseFloor(), progress,
                             plan.isNoVessel);
  searchBridged(context, *plan.shape, tree);
}

std::string quotedLabel(const std::string& label) {
  std::string text(1, '"');
  text += formats::printable(label);
  text += '"';
  return text;
}

void requireNewLabels(const formats::Case& known, const std::vector<SeedBranch>& seeds) {
  std::set<std::string> labels;
  for (const formats::Branch& branch : known.tree.branches) labels.insert(branch.label);
  for (const SeedBranch& seed : seeds) {
    if (seed.points.empty())
      throw invalidInput("the seed " + quotedLabel(seed.label) +
                         " has no points; expected one or more");
    if (!labels.insert(seed.label).second)
      throw invalidInput("the name " + quotedLabel(seed.label) +
                         " is that of another branch or seed; expected one that none has");
  }
}

/// Appends seeds to those of known branches, parents before their children.
void appendParentsFirst(std::vector<SeedBranch> seeds, std::vector<SeedBranch>& all) {
  std::set<std::string> known;
  for (const SeedBranch& seed : all) known.insert(seed.label);
  while (!seeds.empty()) {
    const std::size_t before = seeds.size();
    std::vector<SeedBranch> later;
    for (SeedBranch& seed : seeds) {
      const bool isDue = !seed.parent || known.contains(*seed.parent);
      if (isDue) known.insert(seed.label);
      (isDue ? all : later).push_back(std::move(seed));
    }
    seeds = std::move(later);
    if (seeds.size() == before)
      throw invalidInput("the parent of " + quotedLabel(seeds[0].label) + ", " +
                         quotedLabel(*seeds[0].parent) +
                         ", is no branch of the case and no seed that hangs on one");
  }
}

/// Writes the wall points of the known branches to the case. Returns the nodes whose points
/// changed.
std::vector<std::uint32_t> replacePoints(const TrackedTree& tree, formats::Case& out) {
  std::vector<std::uint32_t> changed;
  formats::PointSets points;
  points.offset.push_back(0);
  for (std::size_t b = 0; b < tree.known; ++b)
    for (const TrackedNode& node : tree.branches[b].nodes) {
      const auto index = static_cast<std::uint32_t>(points.offset.size() - 1);
      if (out.points) {
        const auto first = out.points->position.begin();
        const auto& offset = out.points->offset;
        if (!std::equal(first + offset[index], first + offset[index + 1], node.points.begin(),
                        node.points.end()))
          changed.push_back(index);
      }
      points.position.insert(points.position.end(), node.points.begin(), node.points.end());
      points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
    }
  out.points = std::move(points);
  return changed;
}

std::string sentenceOn(const SeedBranch& seed) {
  return "tracked " + quotedLabel(seed.label) + " from " + vectorText(seed.points[0].position) +
         " mm";
}

void dropOtherArrays(AddedTracks& out) {
  std::erase_if(out.result.nodeArrays, [&](const formats::NodeArray& array) {
    if (array.name == formats::kOriginArray || array.name == formats::kEditedWallArray ||
        array.name == formats::kSystemArray)
      return false;
    out.droppedArrays.push_back(array.name);
    return true;
  });
  if (out.result.motion) out.droppedArrays.emplace_back(formats::kMotionName);
  out.result.motion.reset();
}

/// Stricter rules in the remaining lumen: its courses may follow the rim of a known vessel.
constexpr CourseRules kRemainingLumenRules{0.5, true, 0.5};

/// Adds balls from one place to another, half as far apart as nodes: the rim of each holds what lies
/// between it and the next. `from` itself is left out unless it is `to`.
void addBalls(const WorldBall& from, const WorldBall& to, std::vector<WorldBall>& balls) {
  const double step = 0.5 * kSpacingRadii * std::min(from.radius, to.radius);
  const Eigen::Vector3d way = to.centre - from.centre;
  const double count = 1 + std::floor(way.norm() / step);
  for (double k = 1; k <= count; ++k)
    balls.push_back(
        {from.centre + k / count * way, from.radius + k / count * (to.radius - from.radius)});
}

/// Balls that hold the lumen of a tree: along its vessels, from the parent of each on and to the
/// faces of the volume, and in its sacs, which are not round, from the nodes to their wall.
std::vector<WorldBall> ballsIn(const TrackedTree& tree, const VolumeGeometry& geometry) {
  const double voxel = geometry.voxelSize();
  std::vector<WorldBall> balls;
  const auto ballOf = [](const TrackedNode& node) { return WorldBall{node.centre, node.radius}; };
  const auto addBeyond = [&](const TrackedNode& end, double sign) {
    const Eigen::Vector3d on = end.centre + sign * kEndRadii * end.radius * end.direction;
    if (!geometry.containsWorld(on)) addBalls(ballOf(end), {on, end.radius}, balls);
  };
  for (std::size_t i = 0; i < tree.branches.size(); ++i) {
    const TrackedBranch& branch = tree.branches[i];
    const TrackedNode* last = nullptr;
    if (branch.parentBranch >= 0 && branch.parentNode >= 0)
      last = &tree.branches[static_cast<std::size_t>(branch.parentBranch)]
                  .nodes[static_cast<std::size_t>(branch.parentNode)];
    for (const TrackedNode& node : branch.nodes) {
      addBalls(ballOf(last ? *last : node), ballOf(node), balls);
      last = &node;
      if (tree.isVessel(i)) continue;
      for (const formats::Vec3f& point : node.points)
        addBalls({node.centre, voxel}, {toEigen(point), voxel}, balls);
    }
    if (branch.nodes.empty() || !tree.isVessel(i)) continue;
    addBeyond(branch.nodes.back(), 1);
    if (branch.parentBranch < 0) addBeyond(branch.nodes.front(), -1);
  }
  return balls;
}

/// Adds the vessels along the courses in the lumen that a tree leaves to it.
void addVesselsInRemainingLumen(const TrackingVolume& volume, const GridFrame& frame,
                                const CoursesInRemainingLumen& remaining,
                                const PlaceTest& isNoVessel, const WallShape& shape,
                                TrackedTree& tree, Progress& progress) {
  std::vector<SeedBranch> courses = frame.toGrid(remaining(ballsIn(tree, volume.geometry())));
  std::erase_if(courses, [](const SeedBranch& c) { return c.kind != BranchKind::Vessel; });
  if (courses.empty()) return;
  std::set<std::string> labels;
  for (SeedBranch& course : courses) {
    labels.insert(course.label);
    if (course.parent && !labels.contains(*course.parent)) course.parent.reset();
  }
  TrackedTree all{std::move(tree.seeds), std::move(tree.branches)};
  all.known = all.seeds.size();
  for (SeedBranch& course : courses) {
    for (std::string* name : {&course.label, course.parent ? &*course.parent : nullptr})
      if (name) *name = "beside-" + *name;
    all.seeds.push_back(std::move(course));
  }
  trackTree(volume, {SeedPoints::Courses, isNoVessel, shape, kRemainingLumenRules}, all, progress);
  tree.seeds = std::move(all.seeds);
  tree.branches = std::move(all.branches);
}

TrackResult newCase(const Volume& volume, const std::vector<SeedBranch>& seeds,
                    const TrackOptions& options, SeedPoints points, const PlaceTest& isNoVessel,
                    Progress& progress, const CoursesInRemainingLumen& remaining = {}) {
  const GridFrame frame(volume.geometry);
  const TrackingVolume tracking(volume, frame, seeds, options, progress);
  TrackedTree tree{frame.toGrid(seeds)};
  TrackOptions used = tracking.options();
  PlaceTest inGrid;
  if (isNoVessel)
    inGrid = {[&](const Eigen::Vector3d& point) { return isNoVessel(frame.toWorld(point)); },
              isNoVessel.isByLevel};
  if (isNoVessel.isRim)
    inGrid.isRim = [&](const Eigen::Vector3d& point) {
      return isNoVessel.isRim(frame.toWorld(point));
    };
  const WallShape shape =
      trackTree(tracking, {points, inGrid, tracking.wallShape()}, tree, progress);
  used.pointSpread = shape.pointSpread;
  if (remaining)
    addVesselsInRemainingLumen(tracking, frame, remaining, inGrid, shape, tree, progress);
  fillBridges(tracking, {points, inGrid, shape}, tree, progress);
  for (TrackedBranch& branch : tree.branches) frame.toWorld(branch);

  TrackResult out{remarksOn(tree), caseOfTracks(tree)};
  out.result.metadata.voxelSize = volume.geometry.voxelSize();
  out.result.metadata.source = describeSource(volume);
  auto& steps = out.result.metadata.steps;
  steps.push_back({"track", "lumen " LUMEN_VERSION, used.parameters()});
  recordAssumptions(steps.back(), volume.assumptions);
  return out;
}

/// Tracks the seeds behind the known ones of `tree` into a case of the known ones.
AddedTracks intoCase(const TrackingVolume& volume, const formats::Case& known, TrackedTree& tree,
                     SeedPoints points, const PlaceTest& isNoVessel, Progress& progress) {
  AddedTracks out;
  out.result = known;
  out.firstNewNode = static_cast<std::uint32_t>(known.tree.nodeCount());
  out.firstNewBranch = static_cast<std::uint32_t>(tree.known);
  const std::size_t added = tree.seeds.size() - tree.known;
  if (added == 0) return out;
  const WallShape shape =
      trackTree(volume, {points, isNoVessel, volume.wallShape()}, tree, progress);
  fillBridges(volume, {points, isNoVessel, shape}, tree, progress);
  static_cast<TrackRemarks&>(out) = remarksOn(tree);
  if (out.failures.size() == added) return out;
  out.changed = replacePoints(tree, out.result);
  dropOtherArrays(out);
  appendTracks(tree, out.result);
  formats::dropDependentChunks(out.result);
  return out;
}

void requireValid(const formats::Case& result) {
  if (const auto valid = formats::validate(result); !valid)
    throw invalidInput("the tracked vessels break a rule of the format: " + valid.error().text());
}

/// Gives seeds names that no branch of a case has.
void giveNewLabels(const formats::Case& known, std::vector<SeedBranch>& seeds) {
  std::set<std::string> used;
  for (const formats::Branch& branch : known.tree.branches) used.insert(branch.label);
  std::map<std::string, std::string> names;
  std::size_t number = 0;
  for (SeedBranch& seed : seeds) {
    std::string name;
    do name = provisionalName(++number);
    while (!used.insert(name).second);
    names[seed.label] = name;
    seed.label = name;
    if (seed.parent) seed.parent = names.at(*seed.parent);
  }
}

}  // namespace

TrackResult trackFromSeeds(const Volume& volume, const std::vector<SeedBranch>& seeds,
                           const TrackOptions& options, Progress& progress,
                           const PlaceTest& isNoVessel) {
  return newCase(volume, seeds, options, SeedPoints::Clicks, isNoVessel, progress);
}

TrackResult trackAlongCourses(const Volume& volume, const std::vector<SeedBranch>& courses,
                              const PlaceTest& isNoVessel, const TrackOptions& options,
                              Progress& progress, const CoursesInRemainingLumen& remaining) {
  return newCase(volume, courses, options, SeedPoints::Courses, isNoVessel, progress, remaining);
}

AddedTracks addTracksFromSeeds(const TrackingVolume& volume, const formats::Case& known,
                               const std::vector<SeedBranch>& seeds, Progress& progress,
                               const PlaceTest& isNoVessel) {
  requireNewLabels(known, seeds);
  TrackedTree tree = makeTrackedTree(known);
  appendParentsFirst(seeds, tree.seeds);
  AddedTracks out = intoCase(volume, known, tree, SeedPoints::Clicks, isNoVessel, progress);
  for (std::size_t i = tree.known; i < tree.branches.size(); ++i)
    if (!tree.branches[i].nodes.empty()) recordEdit(out.result.metadata, sentenceOn(tree.seeds[i]));
  requireValid(out.result);
  return out;
}

AddedTracks addTracksAlongCourses(const TrackingVolume& volume, const formats::Case& known,
                                  const std::vector<SeedBranch>& courses,
                                  const PlaceTest& isNoVessel, Progress& progress) {
  TrackedTree tree = makeTrackedTree(known);
  std::vector<SeedBranch> stretches = stretchesOutside(courses, tree);
  giveNewLabels(known, stretches);
  tree.seeds.insert(tree.seeds.end(), stretches.begin(), stretches.end());
  AddedTracks out = intoCase(volume, known, tree, SeedPoints::Courses, isNoVessel, progress);
  const std::size_t found = out.result.tree.branches.size() - known.tree.branches.size();
  if (found > 0)
    recordEdit(out.result.metadata,
               "found " + counted(found, "vessel", "vessels") + " in the volume without seeds");
  requireValid(out.result);
  return out;
}

}  // namespace lumen::convert
