// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/bright_region.h"

#include <algorithm>
#include <deque>
#include <limits>
#include <utility>

#include "converters/base/vectors.h"
#include "converters/voxels/depth.h"

namespace lumen::convert {
namespace {

constexpr double kCorner = 1.5;               // radii of a ball: it does not fill a right angle
constexpr std::size_t kCheckEvery = 1 << 14;  // voxels: well below 100 ms

/// The node nearest to a place, by cells of several voxels, as levels vary slowly.
class NearestNode {
public:
  NearestNode(const VolumeGeometry& geometry, const formats::CenterlineTree& tree)
      : m_geometry(geometry), m_tree(tree) {
    const Cell last = geometry.cells().high();
    m_blocks = CellBox::between(Cell::Zero(), last / kEdge);
    m_node.resize(m_blocks.count(), VoxelSet::kNone);
  }

  std::uint32_t of(const Cell& cell) {
    const Cell block = cell / kEdge;
    std::uint32_t& node = m_node[m_blocks.index(block)];
    if (node == VoxelSet::kNone) node = search(block);
    return node;
  }

private:
  static constexpr int kEdge = 8;  // voxels

  [[nodiscard]] std::uint32_t search(const Cell& block) const {
    const Eigen::Vector3d middle = (block.cast<double>().array() + 0.5) * kEdge - 0.5;
    const Eigen::Vector3d at = m_geometry.worldFromIndex(middle);
    double best = std::numeric_limits<double>::infinity();
    std::uint32_t node = 0;
    for (std::uint32_t n = 0; n < m_tree.nodeCount(); ++n) {
      const double away =
          (toEigen(m_tree.centre[n]) - at).norm() - static_cast<double>(m_tree.radius[n]);
      if (away < best) {
        best = away;
        node = n;
      }
    }
    return node;
  }

  const VolumeGeometry& m_geometry;
  const formats::CenterlineTree& m_tree;
  CellBox m_blocks;
  std::vector<std::uint32_t> m_node;
};

struct Reached {
  std::size_t index;
  std::uint32_t node;
};

/// The bright voxels outside, nearest first, of which the first `rim` touch the lumen; `bright` is
/// 1 inside and becomes 1 there.
template <class Value>
std::vector<Reached> grow(const LumenVoxels& lumen, const Levels& levels, NearestNode& nearest,
                          const Value& value, std::vector<std::uint8_t>& bright, std::size_t& rim,
                          const Progress& progress) {
  std::vector<Reached> reached;
  const CellBox cells = levels.volume.geometry.cells();
  const auto from = [&](std::size_t index, std::uint32_t node) {
    cells.forEachNeighbour(cells.cell(index), [&](const Cell& cell) {
      const std::size_t next = cells.index(cell);
      if (bright[next] != 0 || !(value(next) > levels.node[node].half) ||
          !(value(next) > levels.node[nearest.of(cell)].faint))
        return;
      bright[next] = 1;
      reached.push_back({next, node});
    });
  };
  for (const LumenVoxel& voxel : lumen.voxels()) from(voxel.index, voxel.node);
  rim = reached.size();
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (i % kCheckEvery == 0) progress.check();
    const Reached here = reached[i];
    from(here.index, here.node);
  }
  return reached;
}

/// Spreads from the voxels of `seeds` to the neighbours that take(j, offset) accepts; the offset
/// from the seed is in mm along the axes of the grid.
template <class Take>
void flood(const VoxelSet& voxels, const std::vector<std::uint32_t>& seeds,
           const Progress& progress, Take&& take) {
  std::deque<std::pair<std::uint32_t, Eigen::Vector3f>> queue;
  for (const std::uint32_t seed : seeds) queue.emplace_back(seed, Eigen::Vector3f::Zero());
  for (; !queue.empty(); queue.pop_front()) {
    const auto [i, here] = queue.front();
    if (i % kCheckEvery == 0) progress.check();
    voxels.eachBeside(i, [&, from = here](std::uint32_t j, const Eigen::Vector3d& step) {
      const Eigen::Vector3f there = from + step.cast<float>();
      if (take(j, there)) queue.emplace_back(j, there);
    });
  }
}

/// Marks (1) voxels within kCorner of the centres of balls of radius `widest` inside the region,
/// and those connected with the lumen only through them.
std::vector<std::uint8_t> wideParts(const BrightRegion& region, double widest,
                                    const Progress& progress) {
  const VoxelSet& voxels = region.voxels;
  std::vector<std::uint8_t> wide(voxels.size(), 0);
  std::vector<std::uint32_t> seeds;
  for (std::uint32_t i = 0; i < voxels.size(); ++i)
    if (static_cast<double>(region.depth[i]) > widest) {
      seeds.push_back(i);
      wide[i] = 1;
    }
  if (seeds.empty()) return wide;
  const auto reach = static_cast<float>(kCorner * widest + voxels.geometry().voxelSize());
  flood(voxels, seeds, progress, [&](std::uint32_t j, const Eigen::Vector3f& offset) {
    if (wide[j] != 0 || offset.norm() > reach) return false;
    wide[j] = 1;
    return true;
  });
  std::vector<std::uint8_t> apart(voxels.size(), 1);
  seeds.clear();
  for (std::size_t i = 0; i < region.rim; ++i)
    if (wide[region.order[i]] == 0) {
      seeds.push_back(region.order[i]);
      apart[region.order[i]] = 0;
    }
  flood(voxels, seeds, progress, [&](std::uint32_t j, const Eigen::Vector3f&) {
    if (wide[j] != 0 || apart[j] == 0) return false;
    apart[j] = 0;
    return true;
  });
  return apart;
}

}  // namespace

BrightRegion growBrightRegion(const LumenVoxels& lumen, const Levels& levels,
                              const formats::CenterlineTree& tree, double widest,
                              const Progress& progress) {
  std::vector<std::uint8_t> bright = lumen.inside();
  NearestNode nearest(levels.volume.geometry, tree);
  std::vector<Reached> reached;
  std::size_t rim = 0;
  withVoxels(levels, [&](const auto& value) {
    reached = grow(lumen, levels, nearest, value, bright, rim, progress);
  });
  std::vector<std::size_t> indices;
  indices.reserve(reached.size());
  for (const Reached& voxel : reached) indices.push_back(voxel.index);
  std::sort(indices.begin(), indices.end());
  BrightRegion region{VoxelSet(levels.volume.geometry, std::move(indices)), {}, {}, rim, {}, {}};
  region.node.resize(reached.size());
  for (const Reached& voxel : reached) {
    region.order.push_back(region.voxels.find(voxel.index));
    region.node[region.order.back()] = voxel.node;
  }
  progress.check();
  region.depth = measureDepths(
      region.voxels, [&](std::size_t i) { return bright[i] != 0; }, progress);
  progress.check();
  region.wide = wideParts(region, widest, progress);
  return region;
}

}  // namespace lumen::convert
