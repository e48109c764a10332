// SPDX-License-Identifier: Apache-2.0
// Cheapest paths from a voxel to the voxels of a cube around it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/voxels/search.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// A ball in space, mm, LPS.
struct WorldBall {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// One search from one start, over voxels that are numbered in their cube. The cost of a step is
/// its length times the mean price of a millimetre at its ends.
class CubeSearch {
public:
  static constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

  /// A cube of half edge `reach` mm. `geometry` must outlive the search.
  CubeSearch(const VolumeGeometry& geometry, const Eigen::Vector3d& start, double reach);

  /// False if no search is possible: the start lies outside of the volume, or the cube holds more
  /// voxels than the limit of a search.
  [[nodiscard]] bool isPossible() const { return m_first != kNowhere; }

  /// The voxel nearest to a position, mm, LPS; kNowhere outside of the cube.
  [[nodiscard]] std::size_t voxelAt(const Eigen::Vector3d& world) const;
  [[nodiscard]] Eigen::Vector3d position(std::size_t voxel) const {  ///< mm, LPS
    return m_geometry.position(m_box.cell(voxel));
  }
  [[nodiscard]] std::size_t count() const { return m_paths.count(); }

  /// The voxels in the cube whose centres lie in a ball.
  [[nodiscard]] std::vector<std::size_t> voxelsIn(const WorldBall& ball) const;
  /// Excludes a voxel from the search, unless it is the start.
  void exclude(std::size_t voxel) {
    if (voxel != m_first) m_paths.block(static_cast<std::uint32_t>(voxel));
  }
  /// True for voxels that share a face, an edge or a corner.
  [[nodiscard]] bool areNeighbours(std::size_t a, std::size_t b) const {
    return (m_box.cell(a) - m_box.cell(b)).cwiseAbs().maxCoeff() <= 1;
  }

  /// Visits voxels by rising cost of the path to them. `price(cell)` is the price of a millimetre
  /// at a voxel, > 0, called once for each; voxels whose price is at least `limit` are not entered.
  /// `visit(voxel, cost)` returns a SearchStep. Throws Error(Cancelled).
  template <class Price, class Visit>
  void run(const Price& price, float limit, const Visit& visit, const Progress& progress);

  /// The predecessor on the cheapest path; the first voxel is its own. For voxels that run()
  /// reached.
  [[nodiscard]] std::size_t before(std::size_t voxel) const {
    return voxel == m_first ? voxel : m_paths.before(static_cast<std::uint32_t>(voxel));
  }
  /// The path from the start to a voxel that run() reached, through voxels' centres, mm, LPS.
  [[nodiscard]] std::vector<Eigen::Vector3d> pathTo(std::size_t voxel) const;

private:
  /// A step to a neighbour.
  struct Step {
    Cell step;
    std::ptrdiff_t offset;  ///< difference of the voxels' numbers
    float half;             ///< mm: half of its length
  };
  static constexpr std::size_t kCheckEvery = 1024;  ///< voxels between polls of `progress`
  static constexpr float kUnknown = -1;             ///< a price that was not computed yet
  [[nodiscard]] std::vector<Step> steps() const;

  const VolumeGeometry& m_geometry;
  Eigen::Vector3d m_start;
  CellBox m_box;
  std::size_t m_first = kNowhere;
  CheapestPaths m_paths;
};

template <class Price, class Visit>
void CubeSearch::run(const Price& price, float limit, const Visit& visit,
                     const Progress& progress) {
  const std::vector<Step> neighbours = steps();
  std::vector<float> known(count(), kUnknown);
  const auto priceAt = [&](std::uint32_t voxel, const Cell& cell) {
    if (known[voxel] < 0) known[voxel] = price(cell);
    return known[voxel];
  };
  const auto eachStep = [&](std::uint32_t voxel, const auto& reach) {
    const Cell here = m_box.cell(voxel);
    const float hereCosts = priceAt(voxel, here);
    for (const Step& to : neighbours) {
      const Cell there = here + to.step;
      if (!m_box.contains(there)) continue;
      const auto next = static_cast<std::uint32_t>(voxel + to.offset);
      reach(next, [&] {
        const float thereCosts = priceAt(next, there);
        return thereCosts >= limit ? CheapestPaths::kInfiniteCost
                                   : to.half * (hereCosts + thereCosts);
      });
    }
  };
  std::size_t taken = 0;
  m_paths.run(static_cast<std::uint32_t>(m_first), eachStep, [&](std::uint32_t voxel, float cost) {
    if (taken++ % kCheckEvery == 0) progress.check();
    return visit(std::size_t{voxel}, double{cost});
  });
}

}  // namespace lumen::convert
