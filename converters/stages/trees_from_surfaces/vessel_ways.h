// SPDX-License-Identifier: Apache-2.0
// The vessels of a set of voxels as ways that hang on one another.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "converters/base/progress.h"
#include "converters/voxels/voxel_set.h"

namespace lumen::convert {

/// A way through the middle of the lumen.
struct VesselWay {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> voxels;  ///< from where it begins, on its parent's way, to its tip
  std::uint32_t parent = kNone;       ///< a way before this one
  std::size_t parentVoxel = 0;        ///< which of the parent's voxels it begins at
  std::uint32_t meets = kNone;        ///< a way before this one whose lumen its tip lies in: a loop
  std::size_t meetsVoxel = 0;         ///< which of that one's voxels is nearest to the tip
  bool isSac = false;                 ///< it widens beyond a neck and ends there
};

/// Ways of one connected part of a set of voxels, found as TEASAR does (Sato, Bitter, Bender,
/// Kaufman, Nakajima: TEASAR: tree-structure extraction algorithm for accurate and robust skeletons,
/// 2000) from a root: cheapest ways, on which a step costs its length by the fourth power of the
/// depth, from the farthest voxel that is not yet covered back to what is there.
class VesselWays {
public:
  /// All must stay. The voxels are cubes; `depths`: mm from each to the wall, which isOpen(a, b) says
  /// is not between two places. Throws Error(Cancelled).
  using IsOpen = std::function<bool(const Eigen::Vector3d&, const Eigen::Vector3d&)>;
  VesselWays(const VoxelSet& set, std::span<const float> depths, const IsOpen& isOpen,
             const Progress& progress);

  /// The connected part of `root`: the first way begins there. A way is kept if what of it lies outside
  /// of the balls of those before it is longer than it is wide; or if it widens behind a neck by a
  /// fifth, as a sac does. Throws Error(Cancelled).
  std::vector<VesselWay> find(std::uint32_t root, const Progress& progress);

  /// The connected part of a voxel, itself first.
  [[nodiscard]] std::vector<std::uint32_t> partOf(std::uint32_t voxel) const;

  /// The voxel of the part of `from` that is the farthest from it.
  std::uint32_t farthest(std::uint32_t from, const Progress& progress);

private:
  enum Cover : std::uint8_t { kFree = 0, kNear = 1, kInBall = 2 };
  /// A voxel that shares a corner with another, with no wall in between; in the upper two bits the
  /// number of axes along which it lies beside it.
  using Step = std::uint32_t;
  static constexpr std::size_t kMostSteps = 26;
  static constexpr Step kNoStep = 0;
  static constexpr int kAxesShift = 30;
  static std::uint32_t voxelOf(Step step) { return step & ((1U << kAxesShift) - 1); }
  template <class Visit>
  void eachStep(std::uint32_t i, Visit&& visit) const {
    for (std::size_t k = kMostSteps * i; k < kMostSteps * (i + 1) && m_steps[k] != kNoStep; ++k)
      visit(voxelOf(m_steps[k]), m_lengthOf[m_steps[k] >> kAxesShift]);
  }
  void findSteps(const Progress& progress);
  void spread(std::uint32_t root, const Progress& progress);
  [[nodiscard]] VesselWay wayTo(std::uint32_t tip) const;
  [[nodiscard]] bool isVessel(VesselWay& way) const;
  void findLoop(VesselWay& way) const;
  void cover(const VesselWay& way);
  void coverAround(std::uint32_t i, bool isBall);
  [[nodiscard]] bool isOpen(std::uint32_t i, std::uint32_t j) const;

  const VoxelSet& m_set;
  std::span<const float> m_depths;
  const IsOpen& m_isOpen;
  std::vector<Step> m_steps;            ///< kMostSteps for each voxel, kNoStep behind the last
  std::array<float, 4> m_lengthOf{};    ///< mm of a step along 1, 2 or 3 axes
  std::vector<float> m_cost, m_length;  ///< from the root
  std::vector<std::uint32_t> m_from;    ///< the voxel before it on its way from the root
  std::vector<std::uint8_t> m_cover;
  std::vector<std::uint32_t> m_way;    ///< of voxels that are on a way: which
  std::vector<std::uint32_t> m_place;  ///< and which of its voxels
  std::vector<std::uint32_t> m_part;
};

}  // namespace lumen::convert
