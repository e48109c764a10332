// SPDX-License-Identifier: Apache-2.0
// A synthetic computed tomogram with contrast and one without: two bones that moved apart between
// them, and a vessel through a canal of the first.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "converters/base/random.h"
#include "converters/voxels/volume.h"
#include "tests/unit/tracking/tube_volume.h"

namespace lumen::convert {

struct TwoBones {
  static constexpr double kSoft = 40, kBlood = 350;  // Hounsfield units
  static constexpr double kVesselRadius = 3;         // mm

  double blood = kSoft;
  double spacing = 1;  // mm
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  /// From the places of this scan to those of the one with contrast.
  Eigen::Isometry3d first = Eigen::Isometry3d::Identity(), second = first;
  bool hasRod = false;  ///< in place of both bones
  std::uint64_t seed = 3;

  static Eigen::Vector3d firstCentre() { return {17, 18, 27}; }
  static Eigen::Vector3d secondCentre() { return {44, 43, 24}; }
  static double toVessel(const Eigen::Vector3d& p) {
    return capsule(p, {17, 19, -9}, {17, 19, 70}, kVesselRadius);
  }
  static double toFirst(const Eigen::Vector3d& p) {
    return std::min(inBox(p, {7, 8, 5}, {27, 28, 49}), inBox(p, {27, 14, 20}, {32, 24, 32}));
  }
  static double toSecond(const Eigen::Vector3d& p) {
    return std::min(inBox(p, {40, 39, 14}, {48, 47, 34}), inBox(p, {42, 35, 18}, {46, 39, 24}));
  }

  [[nodiscard]] Volume draw() const {
    Volume volume;
    const int size = static_cast<int>(56 / spacing);
    volume.geometry.size = {size, size, size};
    volume.geometry.spacing.setConstant(spacing);
    volume.geometry.origin = origin;
    Random random(seed);
    std::vector<std::int16_t> voxels;
    volume.geometry.cells().forEach([&](const Cell& cell) {
      const Eigen::Vector3d p = volume.geometry.position(cell), a = first * p, b = second * p;
      double value = -1000;
      mix(value, kSoft, inBox(p, {4, 4, -20}, {52, 52, 80}));
      if (hasRod) {
        mix(value, 900, capsule(p, {28, 28, 8}, {28, 28, 48}, 6));
      } else {
        mix(value, level(a, toFirst(a)), toFirst(a));
        mix(value, level(b, toSecond(b)), toSecond(b));
      }
      mix(value, blood, toVessel(a));
      voxels.push_back(static_cast<std::int16_t>(std::lround(value + 10 * random.normal())));
    });
    volume.voxels = std::move(voxels);
    return volume;
  }

private:
  /// Marrow is an uneven texture, the cortex around it two millimetres thick.
  static double level(const Eigen::Vector3d& p, double distance) {
    if (distance > -2) return 900;
    return 300 + 60 * std::sin(p[0]) * std::sin(0.8 * p[1]) * std::sin(0.9 * p[2]);
  }
};

/// The motion about a place that turns by degrees about an axis and then shifts.
inline Eigen::Isometry3d motionAbout(const Eigen::Vector3d& place, double degrees,
                                     const Eigen::Vector3d& axis, const Eigen::Vector3d& shift) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translate(place + shift);
  motion.rotate(Eigen::AngleAxisd(degrees * 3.14159265358979 / 180, axis.normalized()));
  motion.translate(-place);
  return motion;
}

inline TwoBones withContrast() {
  TwoBones scan;
  scan.blood = TwoBones::kBlood;
  return scan;
}

/// Another grid, other places of both bones, other noise, no contrast.
inline TwoBones withoutContrast() {
  TwoBones scan;
  scan.spacing = 1.1;
  scan.origin = {-2, 1, -3};
  scan.first = motionAbout(TwoBones::firstCentre(), 4, {1, 2, 1}, {1.5, -2, 1});
  scan.second = motionAbout(TwoBones::secondCentre(), 3, {-1, 1, 3}, {0.3, -0.8, 2.2});
  scan.seed = 4;
  return scan;
}

}  // namespace lumen::convert
