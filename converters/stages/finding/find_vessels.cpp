// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/find_vessels.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "converters/stages/finding/bright_voxels.h"
#include "converters/voxels/depth.h"
#include "converters/voxels/vessel_paths.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kLeastPart = 27;  // voxels: fewer are a speck
constexpr double kLeastLength = 10;     // voxels of the longest vessel of a tree
constexpr double kLeastOfParent = 1;    // of the parent's depth: less is a bump on its wall
constexpr int kSmoothing = 6;           // passes of (1, 2, 1)/4 over a course
constexpr double kSacStep = 0.5;        // radii from one point of an aneurysm to the next

/// From voxels of the lumen to courses.
class CourseFinder {
public:
  CourseFinder(const VoxelSet& set, Progress& progress)
      : m_set(set),
        m_depths(depths(progress)),
        m_paths(set, m_depths, m_isOpen, progress, kLeastOfParent),
        m_progress(progress) {}

  std::vector<SeedBranch> find() {
    std::vector<bool> isSeen(m_set.size(), false);
    for (std::uint32_t i = 0; i < m_set.size(); ++i) {
      if (isSeen[i]) continue;
      const std::vector<std::uint32_t> part = partOf(i, isSeen);
      if (part.size() >= kLeastPart) addTree(i);
    }
    return std::move(m_out);
  }

private:
  std::vector<float> depths(const Progress& progress) const {
    return depthsOf(
        m_set, [this](std::size_t i) { return m_set.find(i) != VoxelSet::kNone; }, progress);
  }

  std::vector<std::uint32_t> partOf(std::uint32_t first, std::vector<bool>& isSeen) const {
    std::vector<std::uint32_t> part(1, first);
    isSeen[first] = true;
    for (std::size_t k = 0; k < part.size(); ++k) {
      if (k % 4096 == 0) m_progress.check();
      m_set.eachBeside(part[k], [&](std::uint32_t j, const Vector3d&) {
        if (!isSeen[j]) part.push_back(j);
        isSeen[j] = true;
      });
    }
    return part;
  }

  void addTree(std::uint32_t voxel) {
    const std::vector<VesselPath> paths =
        m_paths.find(m_paths.widestTip(voxel, m_progress), m_progress);
    const std::size_t first = m_out.size();
    for (const VesselPath& path : paths) {
      SeedBranch course = courseOf(path, first);
      if (path.parent == VesselPath::kNone && lengthOf(course) < kLeastLength * voxelSize()) return;
      m_out.push_back(std::move(course));
    }
  }

  [[nodiscard]] double voxelSize() const { return m_set.geometry().voxelSize(); }

  static double lengthOf(const SeedBranch& course) {
    double length = 0;
    for (std::size_t i = 1; i < course.points.size(); ++i)
      length += (course.points[i].position - course.points[i - 1].position).norm();
    return length;
  }

  [[nodiscard]] SeedBranch courseOf(const VesselPath& path, std::size_t first) const {
    SeedBranch course;
    course.label = "vessel-" + std::to_string(m_out.size() + 1);
    if (path.parent != VesselPath::kNone) course.parent = m_out[first + path.parent].label;
    for (const std::uint32_t i : path.voxels)
      course.points.push_back({m_set.position(i), static_cast<double>(m_depths[i])});
    for (int pass = 0; pass < kSmoothing; ++pass) smooth(course.points);
    if (path.isSac) thinToSac(course);
    return course;
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
  std::vector<SeedBranch> m_out;
};

}  // namespace

bool FoundVessels::isLumen(const Vector3d& point) const {
  const Vector3d at = geometry.indexFromWorld(point);
  const Cell cell = at.array().round().cast<int>().matrix();
  return geometry.cells().contains(cell) &&
         std::binary_search(lumen.begin(), lumen.end(), geometry.cells().index(cell));
}

FoundVessels findVessels(const Volume& volume, bool dark, Progress& progress) {
  progress.begin("find", 0);
  BrightVoxels bright = findBrightVoxels(volume, dark, progress);
  progress.detail("lumen: " + std::to_string(bright.indices.size()) + " voxels, contrast " +
                  std::to_string(bright.contrast) + ", noise " + std::to_string(bright.noise));
  FoundVessels found{volume.geometry, bright.indices, {}};
  const VoxelSet set(volume.geometry, std::move(bright.indices));
  found.courses = CourseFinder(set, progress).find();
  progress.end();
  return found;
}

}  // namespace lumen::convert
