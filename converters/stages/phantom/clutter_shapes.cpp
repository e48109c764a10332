// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/clutter_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <Eigen/Geometry>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

// Shares of the vessels' contrast. Cortical bone and metal are brighter than contrast medium in CT.
constexpr double kCortex = 1.5, kTrabecula = 1.0, kMarrow = 0.3, kMetal = 3.0;
constexpr double kStreak = 1.0;      // amplitude at the ball's surface, as a share of the contrast
constexpr double kVeinWidth = 1.3;   // radii of the artery
constexpr double kVeinApart = 1.1;   // sums of both radii, between the axes
constexpr int kWires = 4;            // of a stent, in either direction
constexpr double kWireWidth = 0.1;   // radii of the vessel
constexpr double kLeastWire = 0.3;   // voxels: thinner wires vanish between subvoxels
constexpr double kSlabShare = 0.35;  // half width of the bone, as a share of the volume's edge

// A unit vector across the vessel at a node.
Vector3d randomSide(const formats::CenterlineTree& tree, std::uint32_t node, Random& random) {
  const auto [u, v] = perpendiculars(toEigen(tree.direction[node]));
  const double angle = 2 * kPi * random.uniform();
  return std::cos(angle) * u + std::sin(angle) * v;
}

// The share of a voxel at this distance from a surface that lies within it.
double shareWithin(double distance, double voxel) {
  return std::clamp(0.5 - distance / voxel, 0.0, 1.0);
}

// Unit vectors across the vessel at each node of a stretch, which turn with it and no more.
std::vector<std::pair<Vector3d, Vector3d>> framesAlong(const formats::CenterlineTree& tree,
                                                       const BranchStretch& stretch) {
  std::vector<std::pair<Vector3d, Vector3d>> frames;
  Vector3d u = perpendiculars(toEigen(tree.direction[stretch.first])).first;
  for (std::uint32_t n = stretch.first; n <= stretch.last; ++n) {
    const Vector3d w = toEigen(tree.direction[n]);
    const Vector3d across = u - u.dot(w) * w;
    u = across.norm() > 1e-6 ? across.normalized() : perpendiculars(w).first;
    frames.emplace_back(u, w.cross(u));
  }
  return frames;
}

}  // namespace

std::optional<BranchStretch> pickStretch(const formats::CenterlineTree& tree, double reach,
                                         Random& random) {
  std::vector<float> radii = tree.radius;
  if (radii.empty()) return std::nullopt;
  std::nth_element(radii.begin(), radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2),
                   radii.end());
  const float median = radii[radii.size() / 2];
  std::vector<std::uint32_t> nodes;
  for (const formats::Branch& branch : tree.branches) {
    if (branch.kind != formats::BranchKind::Vessel) continue;
    const std::uint32_t quarter = branch.nodeCount / 4;
    for (std::uint32_t i = quarter; i + quarter < branch.nodeCount; ++i)
      if (tree.radius[branch.firstNode + i] >= median) nodes.push_back(branch.firstNode + i);
  }
  if (nodes.empty()) return std::nullopt;
  const std::uint32_t middle = nodes[random.below(static_cast<std::uint32_t>(nodes.size()))];
  const formats::Branch& branch = tree.branches[tree.branch[middle]];
  const double height = static_cast<double>(tree.height[middle]);
  const auto steps =
      static_cast<std::uint32_t>(std::min(1e9, reach * radiusOf(tree, middle) / height));
  const std::uint32_t before = middle - branch.firstNode,
                      after = branch.firstNode + branch.nodeCount - 1 - middle;
  return BranchStretch{middle, middle - std::min(before, steps), middle + std::min(after, steps)};
}

Bone::Bone(const formats::CenterlineTree& tree, const BranchStretch& stretch, double extent,
           double voxel, Random& random)
    : m_voxel(voxel) {
  const double radius = radiusOf(tree, stretch.middle);
  m_axis = randomSide(tree, stretch.middle, random);
  const double gap = random.uniform(0, 0.5) * radius;
  m_half = kSlabShare * extent;
  m_bend = 2 * m_half;
  m_thickness = std::max(3 * radius, 10 * voxel);
  m_cortex = std::max(0.15 * m_thickness, 1.5 * voxel);
  m_pore = std::max(0.5 * m_thickness, 5 * voxel);
  m_centre = toEigen(tree.centre[stretch.middle]) + (radius + gap - m_bend) * m_axis;
}

// A gyroid has struts and pores of equal width.
double Bone::spongy(const Vector3d& place) const {
  const Vector3d a = 2 * kPi / m_pore * (place - m_centre);
  const double gyroid = std::sin(a.x()) * std::cos(a.y()) + std::sin(a.y()) * std::cos(a.z()) +
                        std::sin(a.z()) * std::cos(a.x());
  return gyroid > 0 ? kTrabecula : kMarrow;
}

double Bone::at(const Vector3d& place) const {
  const Vector3d from = place - m_centre;
  const double distance = from.norm();
  const double depth = std::min(distance - m_bend, m_bend + m_thickness - distance);
  if (depth < -m_voxel) return 0;
  const double along =
      m_bend * std::acos(std::clamp(from.dot(m_axis) / std::max(distance, 1e-9), -1.0, 1.0));
  const double inner = std::min(depth, m_half - along);
  if (inner < -m_voxel) return 0;
  const double cortex = shareWithin(inner - m_cortex, m_voxel);
  return shareWithin(-inner, m_voxel) * (cortex * kCortex + (1 - cortex) * spongy(place));
}

Streaks::Streaks(const formats::CenterlineTree& tree, const BranchStretch& stretch, double voxel,
                 Random& random)
    : m_voxel(voxel) {
  const double radius = radiusOf(tree, stretch.middle);
  m_radius = std::max(0.75 * radius, 2 * voxel);
  m_centre = toEigen(tree.centre[stretch.middle]) +
             (4 * radius + m_radius) * randomSide(tree, stretch.middle, random);
  m_phase = 2 * kPi * random.uniform();
  m_phase2 = 2 * kPi * random.uniform();
}

double Streaks::ball(const Vector3d& place) const {
  return kMetal * shareWithin((place - m_centre).norm() - m_radius, m_voxel);
}

// Rays in the plane of a slice, whose strength falls with the distance.
double Streaks::streak(const Vector3d& place) const {
  const Vector3d from = place - m_centre;
  const double across = std::abs(from.z()) / (2 * m_radius);
  if (across >= 1) return 0;
  const double away = std::max(m_radius, std::hypot(from.x(), from.y()));
  const double angle = std::atan2(from.y(), from.x());
  const double rays = 0.5 * (std::cos(7 * angle + m_phase) + std::cos(12 * angle + m_phase2));
  return kStreak * (1 - across * across) * m_radius / away * rays;
}

Design veinAlong(const formats::CenterlineTree& tree, const BranchStretch& stretch, double voxel,
                 Random& random) {
  const auto frames = framesAlong(tree, stretch);
  const double begin = 2 * kPi * random.uniform();
  Path path;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto node = stretch.first + static_cast<std::uint32_t>(i);
    const double radius = radiusOf(tree, node), vein = kVeinWidth * radius;
    const double angle = begin + kPi * static_cast<double>(i) /
                                     std::max(1.0, static_cast<double>(frames.size() - 1));
    path.push_back({toEigen(tree.centre[node]) + kVeinApart * (radius + vein) *
                                                     (std::cos(angle) * frames[i].first +
                                                      std::sin(angle) * frames[i].second),
                    vein});
  }
  TreeBuilder builder(Frame{voxel, 0});
  builder.add("vein", formats::kNoParent, path);
  return builder.design();
}

Design stentIn(const formats::CenterlineTree& tree, const BranchStretch& stretch, double voxel,
               Random& random) {
  const auto frames = framesAlong(tree, stretch);
  const double begin = 2 * kPi * random.uniform();
  TreeBuilder builder(Frame{voxel, 0});
  for (int wire = 0; wire < 2 * kWires; ++wire) {
    const double hand = wire < kWires ? 1 : -1;
    double angle = begin + 2 * kPi * wire / kWires;
    Path path;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const auto node = stretch.first + static_cast<std::uint32_t>(i);
      const double radius = radiusOf(tree, node);
      path.push_back({toEigen(tree.centre[node]) + radius * (std::cos(angle) * frames[i].first +
                                                             std::sin(angle) * frames[i].second),
                      std::max(kWireWidth * radius, kLeastWire * voxel)});
      angle += hand * static_cast<double>(tree.height[node]) / radius;
    }
    builder.add("wire-" + std::to_string(wire), formats::kNoParent, path);
  }
  return builder.design();
}

}  // namespace lumen::convert
