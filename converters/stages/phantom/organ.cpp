// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/organ.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "converters/base/number_text.h"
#include "converters/base/random.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/phantom/render.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kAir = -1000;                              // HU
constexpr double kAirwayWall = 20, kAirwayThickness = 1.2;  // HU, mm
constexpr double kBreath = 1.2, kBreathLength = 9;          // mm along y, and along z
constexpr double kStreakLevel = 15, kStreakLength = 4;      // HU, mm
constexpr double kLeastStreaked = -300;                     // HU: air shows none
constexpr double kHangs = 2;                                // mm: a vessel that begins so near
constexpr std::uint64_t kStreakAngles = 0x73747265616bULL;

/// Shares of the contrast over the background, of which volumes are drawn.
double shareOfLevel(double level) {
  return (level - kBackground) / kContrast;
}

/// The share of a voxel of an edge length that lies on the inner side of a wall.
double shareInside(double depth, double voxel) {
  return std::clamp(0.5 + depth / voxel, 0.0, 1.0);
}

double depthIn(const OrganShape& shape, const Vector3d& place) {
  double sum = 0;
  for (int a = 0; a < 3; ++a)
    sum += std::pow(std::abs(place[a] - shape.centre[a]) / shape.half[a], shape.power);
  return (1 - std::pow(sum, 1 / shape.power)) * shape.half.minCoeff();
}

std::string systemLabel(formats::VesselSystem system) {
  return std::string(formats::kVesselSystemNames[static_cast<std::size_t>(system)]) + "-";
}

/// Appends courses, in the millimetres of a frame, as branches NAME000 and so on of one system.
void addCourses(const Courses& courses, const std::string& name, double scale,
                TreeBuilder& builder) {
  const auto first = static_cast<std::uint32_t>(builder.tree().branches.size());
  for (const Path& course : courses) {
    Path path = course;
    for (PathPoint& point : path) point = {scale * point.position, scale * point.radius};
    const formats::CenterlineTree& tree = builder.tree();
    std::int32_t parent = formats::kNoParent;
    double nearest = kHangs * scale;
    Vector3d start = path.front().position;
    for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
      const double away = (toEigen(tree.centre[n]) - path.front().position).norm();
      if (tree.branch[n] < first || away >= nearest) continue;
      nearest = away;
      parent = static_cast<std::int32_t>(tree.branch[n]);
      start = toEigen(tree.centre[n]);
    }
    path.front().position = start;
    builder.add(name + paddedNumber(tree.branches.size() - first, 3), parent, path);
  }
}

/// The level of the tissue around the vessels of an organ, as a share.
class Ground {
public:
  Ground(const Organ& organ, const Frame& frame)
      : m_shapes(organ.shapes), m_scale(frame.extent / kOrganEdge), m_voxel(frame.voxel / m_scale) {
    if (organ.airways.empty()) return;
    TreeBuilder builder(Frame{0.5, kOrganEdge});
    addCourses(organ.airways, "airway-", 1, builder);
    m_airways = std::make_shared<TubeTreeDistance>(builder.tree());
  }

  double operator()(const Vector3d& at) const {
    Vector3d place = at / m_scale;
    const double z = place.z();
    const Vector3d still = place;
    place.y() += kBreath * std::sin(2 * std::numbers::pi * z / kBreathLength);
    double level = kAir;
    for (const OrganShape& shape : m_shapes)
      level += shareInside(depthIn(shape, place), m_voxel) * (shape.level - level);
    if (m_airways) {
      const double beyond = m_airways->nearest(place).distance;
      level += shareInside(kAirwayThickness - beyond, m_voxel) * (kAirwayWall - level);
      level += shareInside(-beyond, m_voxel) * (kAir - level);
    }
    return shareOfLevel(level > kLeastStreaked ? level + streakAt(still) : level);
  }

private:
  /// Streaks of a slice, which have a direction of its own.
  [[nodiscard]] double streakAt(const Vector3d& place) const {
    Random random(kStreakAngles, static_cast<std::uint64_t>(std::lround(place.z() / m_voxel)));
    const double angle = random.uniform(0, std::numbers::pi);
    return kStreakLevel * std::cos(2 * std::numbers::pi / kStreakLength *
                                   (place.x() * std::cos(angle) + place.y() * std::sin(angle)));
  }

  std::vector<OrganShape> m_shapes;
  double m_scale, m_voxel;  // mm of the frame in one of the organ; mm of the organ
  std::shared_ptr<const TubeTreeDistance> m_airways;
};

}  // namespace

Design designOrgan(const Organ& organ, const Frame& frame) {
  TreeBuilder builder(frame);
  Design& design = builder.design();
  for (const OrganSystem& part : organ.systems) {
    const auto before = static_cast<std::ptrdiff_t>(design.contrast.size());
    addCourses(part.courses, systemLabel(part.system), frame.extent / kOrganEdge, builder);
    design.systems.resize(builder.tree().nodeCount(), part.system);
    std::fill(design.contrast.begin() + before, design.contrast.end(),
              static_cast<float>(shareOfLevel(part.level)));
  }
  design.ground = Ground(organ, frame);
  return design;
}

Path courseThrough(const std::vector<Vector3d>& places, double radius, double lastRadius) {
  constexpr int kAPlace = 12, kSmoothings = 12;
  const std::size_t count = kAPlace * places.size();
  Path path(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(count - 1);
    const double at = t * static_cast<double>(places.size() - 1);
    const std::size_t before = std::min(static_cast<std::size_t>(at), places.size() - 2);
    const double share = at - static_cast<double>(before);
    path[i] = {(1 - share) * places[before] + share * places[before + 1],
               radius + t * (lastRadius - radius)};
  }
  for (int k = 0; k < kSmoothings; ++k) {
    const Path old = path;
    for (std::size_t i = 1; i + 1 < count; ++i)
      path[i].position =
          0.25 * old[i - 1].position + 0.5 * old[i].position + 0.25 * old[i + 1].position;
  }
  return path;
}

namespace {

constexpr double kShorter = 0.75, kNarrower = 0.79, kBend = 0.12;  // shares of a vessel's own

class ForkingTree {
public:
  explicit ForkingTree(const Forking& forking) : m_forking(forking), m_random(forking.seed) {}

  void grow(const Vector3d& from, const Vector3d& along, const Vector3d& across, double length,
            double radius, int depth) {
    const Vector3d side = (across - across.dot(along) * along).normalized();
    const Vector3d next = along.cross(side);
    const double bend = (m_random.below(2) == 0 ? 1 : -1) * kBend * length;
    courses.push_back(sampleCurve(
        [&](double t) -> Vector3d {
          return from + t * length * along + bend * std::sin(std::numbers::pi * t) * next;
        },
        [&](double t) { return radius * (1 - 0.1 * t); }));
    if (depth == 0) return;
    for (const double sign : {1.0, -1.0}) {
      const double angle = m_forking.angle * m_random.uniform(0.8, 1.2);
      grow(from + length * along,
           (std::cos(angle) * along + sign * std::sin(angle) * side).normalized(),
           next + 0.2 * side, kShorter * length, kNarrower * radius, depth - 1);
    }
  }

  Courses courses;

private:
  const Forking& m_forking;
  Random m_random;
};

}  // namespace

Courses forkingTree(const Vector3d& from, const Vector3d& along, const Forking& forking) {
  ForkingTree tree(forking);
  tree.grow(from, along.normalized(), {0.9, 0.4, 0.2}, forking.length, forking.radius,
            forking.depth);
  return std::move(tree.courses);
}

Courses onBothSides(Courses courses) {
  const std::size_t count = courses.size();
  for (std::size_t i = 0; i < count; ++i) {
    Path mirrored = courses[i];
    for (PathPoint& point : mirrored) point.position.x() = kOrganEdge - point.position.x();
    courses.push_back(std::move(mirrored));
  }
  return courses;
}

}  // namespace lumen::convert
