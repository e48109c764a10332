// SPDX-License-Identifier: Apache-2.0
// Voxels around a place by rising cost of the way there: Dijkstra's search on the lattice of a volume.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// Intensities, bright or dark as the vessels are: of the lumen's middle, and halfway down its wall.
struct LumenLevels {
  double middle = 0, wall = 0;
};

/// A ball in space, mm, LPS.
struct Ball {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// One search from one place. A millimetre costs 1 in the lumen's middle, more the darker it is, and
/// much more beyond the wall's level.
class VoxelSearch {
public:
  static constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);
  static constexpr double kBeyondWall = 60;  ///< cost of a millimetre there

  /// Looks at voxels within a cube of half edge `reach` mm. `context` must outlive it.
  VoxelSearch(const TrackContext& context, const LumenLevels& levels, const Eigen::Vector3d& start,
              double reach);

  /// False where there is nothing to search: the start lies outside of the volume, or the cube
  /// holds more voxels than a search may look at.
  [[nodiscard]] bool isPossible() const { return m_first != kNowhere; }

  /// The voxel nearest to a place, mm, LPS; kNowhere outside of the cube.
  [[nodiscard]] std::size_t voxelAt(const Eigen::Vector3d& world) const;
  [[nodiscard]] Eigen::Vector3d position(std::size_t voxel) const;  ///< mm, LPS

  /// The voxels in the cube whose centres lie in a ball.
  [[nodiscard]] std::vector<std::size_t> voxelsIn(const Ball& ball) const;
  /// Keeps the search out of a voxel, if it does not start there.
  void exclude(std::size_t voxel) { m_isDone[voxel] = voxel != m_first; }
  [[nodiscard]] std::size_t count() const { return m_isDone.size(); }

  /// What to do with a voxel that the search has come to.
  enum class Then : std::uint8_t { GoOn, GoNoFurther, Stop };
  /// Takes voxels in the order of the cost of the way to them. `stayInside`: never enters what is
  /// darker than the wall. Throws Error(Cancelled).
  void run(bool stayInside, const std::function<Then(std::size_t voxel, double cost)>& visit);

  /// The voxel before on the cheapest way; of the first, itself. Of voxels that run() came to.
  [[nodiscard]] std::size_t before(std::size_t voxel) const { return m_from[voxel]; }
  /// From the start to a voxel that run() came to, through voxels' centres, mm, LPS.
  [[nodiscard]] std::vector<Eigen::Vector3d> wayTo(std::size_t voxel) const;
  /// Voxels that touch one another by a face, an edge or a corner.
  [[nodiscard]] bool areNeighbours(std::size_t a, std::size_t b) const;

  /// The price of a millimetre at an intensity.
  [[nodiscard]] static double price(const LumenLevels& levels, double value);

private:
  [[nodiscard]] Eigen::Vector3i cell(std::size_t voxel) const;
  [[nodiscard]] std::size_t voxelOf(const Eigen::Vector3i& cell) const;
  [[nodiscard]] bool holds(const Eigen::Vector3i& cell) const;
  [[nodiscard]] float priceOf(std::size_t voxel, const Eigen::Vector3i& cell);

  const TrackContext& m_context;
  LumenLevels m_levels;
  Eigen::Vector3d m_start;
  Eigen::Vector3i m_low, m_size;
  std::size_t m_first = kNowhere;
  std::vector<bool> m_isDone;
  std::vector<float> m_cost, m_price;
  std::vector<std::uint32_t> m_from;
};

}  // namespace lumen::convert
