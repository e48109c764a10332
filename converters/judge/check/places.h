// SPDX-License-Identifier: Apache-2.0
// Places where case and volume disagree: dark voxels inside of the case, and bright ones that
// belong to its vessels but lie outside (docs/method.md, section 7.2).
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/judge/check/lumen_voxels.h"
#include "converters/judge/check/wall_offsets.h"
#include "converters/voxels/volume.h"
#include "converters/voxels/voxel_set.h"
#include "formats/case/case.h"

namespace lumen::convert {

// The bright voxels outside of a case that are connected with its lumen (docs/method.md, section
// 7.2).

/// Criteria for the voxels of a volume.
struct Levels {
  const Volume& volume;
  bool dark;  ///< vessels are darker than their background
  std::span<const NodeLevels> node;
  /// For each voxel whether levels of tissue show that it is no vessel; empty where they do not.
  std::vector<bool> isNoVessel{};
};

/// Calls visit(value), where value(i) is the intensity of voxel i, brighter is more.
template <class Visit>
void withVoxels(const Levels& levels, Visit&& visit) {
  std::visit(
      [&](const auto& voxels) {
        visit([&voxels, dark = levels.dark](std::size_t i) {
          const auto value = static_cast<float>(voxels[i]);
          return dark ? -value : value;
        });
      },
      levels.volume.voxels);
}

/// Voxels outside, reached from the lumen through their 26 neighbours, that are brighter than the
/// half level of the node where the path began and than the faint level of the node nearest to
/// them.
struct BrightRegion {
  VoxelSet voxels;
  std::vector<std::uint32_t> node;   ///< for each voxel: node where its path began
  std::vector<std::uint32_t> order;  ///< all voxels as they were reached, nearest first
  std::size_t rim = 0;               ///< number of these that touch the lumen
  std::vector<float> depth;          ///< mm to the nearest voxel that is not bright
  std::vector<std::uint8_t>
      wide;  ///< 1: in a region too wide for a vessel, or reached only through one
};

/// The bright region; a part that holds a ball of radius `widest`, mm, is too wide. Throws
/// Error(Cancelled).
BrightRegion growBrightRegion(const LumenVoxels& lumen, const Levels& levels,
                              const formats::CenterlineTree& tree, double widest,
                              const Progress& progress);

/// A connected group of voxels.
struct Region {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< mm, LPS: the deepest place
  std::uint32_t node = 0;  ///< case's node whose lumen holds it, or that reached it
  std::size_t voxels = 0;
  double volume = 0;  ///< mm^3
  double radius = 0;  ///< mm; radius of the greatest ball in it
};

struct Regions {
  double volume = 0;            ///< mm^3; all such voxels, in regions or not
  std::vector<Region> regions;  ///< the greatest volume first
};

/// A place on the path of a vessel, and the node from which it was reached.
struct VesselPathPoint {
  Eigen::Vector3d position;  ///< mm, LPS
  std::uint32_t node;
};

/// A vessel of the volume that is not in the case.
struct MissingVessel {
  std::vector<VesselPathPoint> path;  ///< from where it begins to its tip
  std::size_t voxels = 0;
  double volume = 0;   ///< mm^3
  double length = 0;   ///< mm
  double radius = 0;   ///< mm
  bool atEnd = false;  ///< a branch of the case continues in it
};

struct Missing {
  double volume = 0;                   ///< mm^3, all bright voxels outside, but for `wide`
  std::vector<MissingVessel> vessels;  ///< the longest first
  Regions wide;  ///< regions too wide to be vessels, and all voxels beyond them
};

/// Voxels inside, deeper than a voxel, that are darker than the half level of their node. A region
/// has at least four voxels.
Regions darkInside(const LumenVoxels& lumen, const Levels& levels, const Progress& progress);

/// The vessels of the bright region that lie farther than two voxels from the lumen, of at least 20
/// voxels and four voxels' length. Regions over 1.5 times as wide as the widest vessel of the case
/// are not vessels.
Missing brightOutside(const LumenVoxels& lumen, const Levels& levels,
                      const formats::CenterlineTree& tree, const Progress& progress);

/// Points to click for tracking a missing vessel.
struct Clicks {
  std::vector<Eigen::Vector3d> points;  ///< on its path, mm, LPS
  double radius = 0;                    ///< mm
  std::uint32_t beside = 0;             ///< node of the case at which the vessel begins
};
/// One click in the middle of the vessel, where its lumen is separate; a second halfway to its tip,
/// if that is far enough to show the vessel's direction.
Clicks clicksOn(const MissingVessel& vessel);

/// Length, mm, of the tree's vessels whose axis the volume shows: where it is brighter than the
/// half level. Branches that lie in each other count once.
double shownLength(const formats::CenterlineTree& tree, const LumenVoxels& lumen,
                   const Levels& levels);

}  // namespace lumen::convert
