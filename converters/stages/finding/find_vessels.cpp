// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/find_vessels.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include <tbb/parallel_for.h>

#include "converters/base/number_text.h"
#include "converters/stages/finding/bone.h"
#include "converters/stages/finding/bright_voxels.h"
#include "converters/stages/finding/ends_at_faces.h"
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
  CourseFinder(const VoxelSet& set, Progress& progress)
      : m_set(set),
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
    course.label = "vessel-" + std::to_string(m_out.size() + 1);
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

/// The voxels whose centres lie in no ball.
std::vector<std::size_t> outside(const VolumeGeometry& grid, const std::vector<std::size_t>& voxels,
                                 std::span<const WorldBall> balls, const Progress& progress) {
  std::vector<std::uint8_t> isIn(voxels.size(), 0);  // bytes, as balls overlap
  const VoxelSet set(grid, voxels);
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t b) {
    progress.check();
    set.eachIn(balls[b].centre, balls[b].radius, [&](std::uint32_t i) {
      std::atomic_ref(isIn[i]).store(1, std::memory_order_relaxed);
    });
  });
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < voxels.size(); ++i)
    if (isIn[i] == 0) out.push_back(voxels[i]);
  return out;
}

}  // namespace

bool FoundVessels::isIn(const std::vector<std::size_t>& voxels, const Vector3d& point) const {
  const Vector3d at = geometry.indexFromWorld(point);
  const Cell cell = at.array().round().cast<int>().matrix();
  return geometry.cells().contains(cell) &&
         std::binary_search(voxels.begin(), voxels.end(), geometry.cells().index(cell));
}

FoundVessels findVessels(const Volume& whole, bool dark, Progress& progress) {
  progress.begin("find", 0);
  const std::shared_ptr<const Volume> continued = continueImage(whole, progress);
  const Volume& volume = continued ? *continued : whole;
  if (const auto& image = volume.geometry.image)
    progress.detail(std::to_string(std::count(image->begin(), image->end(), false)) +
                    " voxels are no image");
  BrightVoxels bright = findBrightVoxels(volume, dark, progress);
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
  for (bool isMore = true; isMore;) {  // each pass takes bone away
    const VoxelSet set(grid, std::move(found.lumen));
    CourseFinder finder(set, progress);
    finder.findPaths();
    const std::vector<bool> isBone = finder.isBone(found.bone, brightness);
    found.lumen.clear();
    for (std::uint32_t i = 0; i < set.size(); ++i)
      (!isBone.empty() && isBone[i] ? found.bone : found.lumen).push_back(set.index(i));
    std::sort(found.bone.begin(), found.bone.end());
    isMore = !isBone.empty();
    if (!isMore) found.courses = finder.courses();
  }
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
  const VoxelSet set(grid, outside(grid, found.lumen, balls, progress));
  CourseFinder finder(set, progress);
  finder.findPaths();
  std::vector<SeedBranch> courses = finder.courses();
  toWorld(grid, found.geometry, courses);
  return courses;
}

}  // namespace lumen::convert
