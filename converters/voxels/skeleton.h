// SPDX-License-Identifier: Apache-2.0
// Paths along the middle of a set of voxels, as TEASAR finds them (Sato, Bitter, Bender, Kaufman,
// Nakajima: TEASAR: tree-structure extraction algorithm for accurate and robust skeletons, 2000):
// from a root, cheapest paths to the voxels that are farthest and not covered by an earlier path.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "converters/base/progress.h"
#include "converters/voxels/search.h"
#include "converters/voxels/voxel_set.h"

namespace lumen::convert {

/// The price of a step of a skeleton's path: its length divided by a power of the depth at its end,
/// so that the middle is cheap.
struct SkeletonPrice {
  int power = 2;
  float unit = 1;  ///< mm: the unit of depths
  float rim = 0;   ///< addend of the depths, in that unit
};

/// Search and cover of a skeleton; the caller decides which steps are possible, and which paths
/// stay.
class Skeleton {
public:
  /// Extent covered by a path: TEASAR's scale and offset.
  static constexpr double kCoverDepths = 1.5, kCoverVoxels = 2;

  /// Both must outlive this object; `depths` are mm, > 0.
  Skeleton(const VoxelSet& set, std::span<const float> depths, const SkeletonPrice& price)
      : m_set(set),
        m_depths(depths),
        m_divisor(set.size()),
        m_length(set.size()),
        m_paths(set.size()) {
    for (std::size_t i = 0; i < set.size(); ++i) {
      const float depth = depths[i] / price.unit + price.rim;
      m_divisor[i] = depth;
      for (int k = 1; k < price.power; ++k) m_divisor[i] *= depth;
    }
  }

  /// Finds the cheapest paths from a root to all voxels connected with it by the steps of
  /// `eachBeside(i, visit)`, which calls visit(j, mm) for the voxels beside i. Throws
  /// Error(Cancelled).
  template <class EachBeside>
  void spread(std::uint32_t root, const EachBeside& eachBeside, const Progress& progress) {
    m_paths.clear();
    m_length[root] = 0;
    const auto eachStep = [&](std::uint32_t i, const auto& reach) {
      eachBeside(i, [&](std::uint32_t j, float length) {
        if (reach(j, [&] { return length / m_divisor[j]; })) m_length[j] = m_length[i] + length;
      });
    };
    m_paths.run(root, eachStep, [&](std::uint32_t, float) {
      progress.check();
      return SearchStep::GoOn;
    });
  }

  /// Cost of the voxels that spread() reached, in the order in which they were first reached, and
  /// the paths.
  [[nodiscard]] const CheapestPaths& paths() const { return m_paths; }
  [[nodiscard]] float length(std::uint32_t i) const { return m_length[i]; }  ///< mm from the root
  [[nodiscard]] float depth(std::uint32_t i) const { return m_depths[i]; }   ///< mm
  [[nodiscard]] const VoxelSet& voxels() const { return m_set; }

  /// Calls visit(j) for each voxel that a path through `i` covers.
  template <class Visit>
  void eachCovered(std::uint32_t i, Visit&& visit) const {
    const double more = kCoverVoxels * m_set.geometry().voxelSize();
    m_set.eachWithin(i, kCoverDepths * static_cast<double>(depth(i)) + more, visit);
  }

private:
  const VoxelSet& m_set;
  std::span<const float> m_depths;
  std::vector<float> m_divisor;  ///< divisor of a step that ends in a voxel
  std::vector<float> m_length;
  CheapestPaths m_paths;
};

}  // namespace lumen::convert
