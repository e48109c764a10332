// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/find_vessels.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <queue>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include <tbb/parallel_for.h>

#include "converters/base/number_text.h"
#include "converters/geometry/automatic_names.h"
#include "converters/stages/finding/bone.h"
#include "converters/stages/finding/bright_voxels.h"
#include "converters/stages/finding/ends_at_faces.h"
#include "converters/stages/finding/recentre.h"
#include "converters/voxels/depth.h"
#include "converters/voxels/grid_geometry.h"
#include "converters/voxels/image_region.h"
#include "converters/voxels/vessel_paths.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kLeastLength = 10;   // voxels of the longest vessel of a tree
constexpr double kLeastOfParent = 1;  // of the parent's depth: less is a bump on its wall
constexpr int kSmoothing = 6;         // passes of (1, 2, 1)/4 over a course
constexpr double kSacStep = 0.5;      // radii from one point of an aneurysm to the next

/// From voxels of the lumen to courses.
class CourseFinder {
public:
  /// `named`: number of courses that have a name already.
  CourseFinder(const VoxelSet& set, Progress& progress, std::size_t named = 0)
      : m_named(named),
        m_set(set),
        m_depths(depths(progress)),
        m_paths(set, m_depths, m_isOpen, progress, kLeastOfParent),
        m_progress(progress) {}

  /// Call it first.
  void findPaths() {
    std::vector<bool> isSeen(m_set.size(), false);
    for (std::uint32_t i = 0; i < m_set.size(); ++i) {
      if (isSeen[i]) continue;
      const std::vector<std::uint32_t> part = connectedPart(i, isSeen);
      if (part.size() < kSpeck) continue;
      m_trees.push_back(m_paths.find(m_paths.widestTip(i, m_progress), m_progress));
    }
  }

  /// The voxels that are no vessels' (boneVoxels()).
  [[nodiscard]] std::vector<bool> isBone(
      std::span<const std::size_t> bone,
      const std::function<float(std::size_t)>& brightness) const {
    std::vector<VesselPath> all;
    for (const std::vector<VesselPath>& tree : m_trees)
      all.insert(all.end(), tree.begin(), tree.end());
    return boneVoxels({m_set, m_depths, all, brightness}, bone, m_progress);
  }

  /// mm from each voxel of the set to the wall.
  [[nodiscard]] std::span<const float> depthsToWall() const { return m_depths; }

  /// The courses along the paths that findPaths() found.
  std::vector<SeedBranch> courses() {
    for (const std::vector<VesselPath>& tree : m_trees) addTree(tree);
    return std::move(m_out);
  }

private:
  std::vector<float> depths(const Progress& progress) const {
    return measureDepths(
        m_set,
        [this](std::size_t i) {
          return m_set.find(i) != VoxelSet::kNone || !m_set.geometry().isImage(i);
        },
        progress);
  }

  std::vector<std::uint32_t> connectedPart(std::uint32_t first, std::vector<bool>& isSeen) const {
    std::vector<std::uint32_t> part(1, first);
    isSeen[first] = true;
    for (std::size_t k = 0; k < part.size(); ++k) {
      m_progress.check();
      m_set.eachBeside(part[k], [&](std::uint32_t j, const Vector3d&) {
        if (!isSeen[j]) part.push_back(j);
        isSeen[j] = true;
      });
    }
    return part;
  }

  void addTree(const std::vector<VesselPath>& paths) {
    const std::size_t first = m_out.size();
    for (const VesselPath& path : paths) {
      SeedBranch course = makeCourse(path, first);
      if (path.parent == VesselPath::kNone && measureLength(course) < kLeastLength * voxelSize())
        return;
      m_out.push_back(std::move(course));
    }
  }

  [[nodiscard]] double voxelSize() const { return m_set.geometry().voxelSize(); }

  static double measureLength(const SeedBranch& course) {
    double length = 0;
    for (std::size_t i = 1; i < course.points.size(); ++i)
      length += (course.points[i].position - course.points[i - 1].position).norm();
    return length;
  }

  [[nodiscard]] SeedBranch makeCourse(const VesselPath& path, std::size_t first) const {
    SeedBranch course;
    course.label = provisionalName(m_named + m_out.size() + 1);
    if (path.parent != VesselPath::kNone) course.parent = m_out[first + path.parent].label;
    for (const std::uint32_t i : voxelsOf(path))
      course.points.push_back({m_set.position(i), static_cast<double>(m_depths[i])});
    for (int pass = 0; pass < kSmoothing; ++pass) smooth(course.points);
    if (path.isSac) thinToSac(course);
    return course;
  }

  /// The voxels of a path, whose free ends lead into the middle of a face that cuts the vessel.
  [[nodiscard]] std::vector<std::uint32_t> voxelsOf(const VesselPath& path) const {
    std::vector<std::uint32_t> voxels = path.voxels;
    if (path.isSac) return voxels;
    if (path.meets == VesselPath::kNone) endAtFace(m_set, m_depths, voxels);
    if (path.parent != VesselPath::kNone) return voxels;
    std::reverse(voxels.begin(), voxels.end());
    endAtFace(m_set, m_depths, voxels);
    std::reverse(voxels.begin(), voxels.end());
    return voxels;
  }

  static void smooth(std::vector<SeedPoint>& points) {
    const std::vector<SeedPoint> before = points;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const SeedPoint &a = before[i - 1], &b = before[i], &c = before[i + 1];
      points[i].position = 0.25 * (a.position + 2 * b.position + c.position);
      points[i].radius = 0.25 * (*a.radius + 2 * *b.radius + *c.radius);
    }
  }

  /// Leaves the points of an aneurysm beyond its neck, half a radius apart.
  static void thinToSac(SeedBranch& course) {
    course.kind = formats::BranchKind::Aneurysm;
    const auto& points = course.points;
    const auto wider = [](const SeedPoint& a, const SeedPoint& b) { return *a.radius < *b.radius; };
    const double widest = *std::max_element(points.begin(), points.end(), wider)->radius;
    std::vector<SeedPoint> kept;
    for (const SeedPoint& point : points) {
      if (*point.radius < 0.5 * widest) continue;
      if (kept.empty() ||
          (point.position - kept.back().position).norm() > kSacStep * *kept.back().radius)
        kept.push_back(point);
    }
    course.points = std::move(kept);
  }

  std::size_t m_named;
  const VoxelSet& m_set;
  std::vector<float> m_depths;
  VesselPaths::IsOpen m_isOpen = [](const Vector3d&, const Vector3d&) { return true; };
  VesselPaths m_paths;
  Progress& m_progress;
  std::vector<std::vector<VesselPath>> m_trees;
  std::vector<SeedBranch> m_out;
};

/// Moves courses from the frame of the grid to LPS.
void toWorld(const VolumeGeometry& grid, const VolumeGeometry& world,
             std::vector<SeedBranch>& courses) {
  for (SeedBranch& course : courses)
    for (SeedPoint& point : course.points) point.position = inFrame(grid, world, point.position);
}

/// The system of each voxel of a set, as a prior has them; empty if these are fewer than two. Where
/// it has none, systems spread through the deepest voxels first, so that they meet where two lumens
/// touch. `depths`: mm from each voxel of the set to the wall.
std::vector<std::uint8_t> systemsOf(const VoxelSet& set, std::span<const float> depths,
                                    const Prior& prior) {
  struct Front {
    float depth;
    std::uint32_t voxel;
    bool operator<(const Front& other) const {
      return std::pair(depth, other.voxel) < std::pair(other.depth, voxel);
    }
  };
  std::vector<std::uint8_t> systems(set.size(), Prior::kNothing);
  std::priority_queue<Front> front;
  std::set<std::uint8_t> known;
  for (std::uint32_t i = 0; i < set.size(); ++i) {
    if (!prior.isLumen(set.index(i))) continue;
    systems[i] = prior.systems[set.index(i)];
    known.insert(systems[i]);
    front.push({depths[i], i});
  }
  if (known.size() < 2) return {};
  while (!front.empty()) {
    const std::uint32_t i = front.top().voxel;
    front.pop();
    set.eachBeside(i, [&](std::uint32_t j, const Vector3d&) {
      if (systems[j] != Prior::kNothing) return;
      systems[j] = systems[i];
      front.push({depths[j], j});
    });
  }
  return systems;
}

/// The courses through voxels, those of each system alone.
std::vector<SeedBranch> coursesOf(const VolumeGeometry& grid,
                                  const std::vector<std::size_t>& voxels,
                                  const std::vector<std::uint8_t>& systems, Progress& progress) {
  std::vector<SeedBranch> all;
  for (const std::uint8_t system : std::set<std::uint8_t>(systems.begin(), systems.end())) {
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < voxels.size(); ++i)
      if (systems[i] == system) own.push_back(voxels[i]);
    const VoxelSet set(grid, std::move(own));
    CourseFinder finder(set, progress, all.size());
    finder.findPaths();
    for (SeedBranch& course : finder.courses()) all.push_back(std::move(course));
  }
  return all;
}

/// The voxels of lumen whose centres lie in no ball, and their systems.
std::vector<std::size_t> outside(const VolumeGeometry& grid, const FoundVessels& found,
                                 std::span<const WorldBall> balls, const Progress& progress,
                                 std::vector<std::uint8_t>& systems) {
  std::vector<std::uint8_t> isIn(found.lumen.size(), 0);  // bytes, as balls overlap
  const VoxelSet set(grid, found.lumen);
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t b) {
    progress.check();
    set.eachIn(balls[b].centre, balls[b].radius, [&](std::uint32_t i) {
      std::atomic_ref(isIn[i]).store(1, std::memory_order_relaxed);
    });
  });
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < found.lumen.size(); ++i) {
    if (isIn[i] != 0) continue;
    out.push_back(found.lumen[i]);
    systems.push_back(found.systems.empty() ? Prior::kNothing : found.systems[i]);
  }
  return out;
}

}  // namespace

bool FoundVessels::isIn(const std::vector<std::size_t>& voxels, const Vector3d& point) const {
  const Vector3d at = geometry.indexFromWorld(point);
  const Cell cell = at.array().round().cast<int>().matrix();
  return geometry.cells().contains(cell) &&
         std::binary_search(voxels.begin(), voxels.end(), geometry.cells().index(cell));
}

FoundVessels findVessels(const Volume& whole, bool dark, const Prior& prior, Progress& progress) {
  progress.begin("find", 0);
  const std::shared_ptr<const Volume> continued = continueImage(whole, progress);
  const Volume& volume = continued ? *continued : whole;
  if (const auto& image = volume.geometry.image)
    progress.detail(std::to_string(std::count(image->begin(), image->end(), false)) +
                    " voxels are no image");
  BrightVoxels bright = findBrightVoxels(volume, dark, prior, progress);
  progress.detail("lumen: " + std::to_string(bright.indices.size()) + " voxels, contrast " +
                  fixedText(bright.contrast, 6) + ", noise " + fixedText(bright.noise, 6));
  const auto brightness = [&](std::size_t i) {
    return std::visit(
        [&](const auto& voxels) { return (dark ? -1.0F : 1.0F) * static_cast<float>(voxels[i]); },
        volume.voxels);
  };
  const VolumeGeometry grid = gridGeometry(volume.geometry);
  FoundVessels found;
  found.geometry = volume.geometry;
  found.lumen = std::move(bright.indices);
  found.bone = std::move(bright.bone);
  found.isBoneKnown = bright.isBoneKnown;
  found.continued = continued;
  found.folded = bright.folded;
  found.rim = bright.rim;
  for (bool isMore = true; isMore;) {  // each pass takes bone away
    const VoxelSet set(grid, std::move(found.lumen));
    CourseFinder finder(set, progress);
    finder.findPaths();
    const std::vector<bool> isBone =
        found.isBoneKnown ? std::vector<bool>() : finder.isBone(found.bone, brightness);
    found.lumen.clear();
    for (std::uint32_t i = 0; i < set.size(); ++i)
      (!isBone.empty() && isBone[i] ? found.bone : found.lumen).push_back(set.index(i));
    std::sort(found.bone.begin(), found.bone.end());
    isMore = !isBone.empty();
    if (isMore) continue;
    found.systems = systemsOf(set, finder.depthsToWall(), prior);
    found.courses = found.systems.empty() ? finder.courses()
                                          : coursesOf(grid, found.lumen, found.systems, progress);
  }
  if (bright.strength)
    for (SeedBranch& course : found.courses)
      if (course.kind == formats::BranchKind::Vessel)
        recentre(grid, *bright.strength, course.points);
  toWorld(grid, volume.geometry, found.courses);
  if (!found.bone.empty())
    progress.detail("bone, or other bright tissue without background around it: " +
                    std::to_string(found.bone.size()) + " voxels");
  progress.end();
  return found;
}

std::vector<SeedBranch> coursesInRemainingLumen(const FoundVessels& found,
                                                std::span<const WorldBall> vessels,
                                                Progress& progress) {
  const VolumeGeometry grid = gridGeometry(found.geometry);
  std::vector<WorldBall> balls(vessels.begin(), vessels.end());
  // the rim of a vessel: half a voxel for its wall, half a voxel for its section
  for (WorldBall& ball : balls) ball.radius += grid.voxelSize();
  std::vector<std::uint8_t> systems;
  const std::vector<std::size_t> rest = outside(grid, found, balls, progress, systems);
  std::vector<SeedBranch> courses = coursesOf(grid, rest, systems, progress);
  toWorld(grid, found.geometry, courses);
  return courses;
}

}  // namespace lumen::convert
