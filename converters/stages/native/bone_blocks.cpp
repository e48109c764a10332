// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/native/bone_blocks.h"

#include <algorithm>

namespace lumen::convert {
namespace {

constexpr int kEdge = 2;   // voxels
constexpr int kReach = 2;  // blocks around one

}  // namespace

BoneBlocks::BoneBlocks(const VoxelSet& set) : m_set(set) {
  m_blocks.size = ((set.geometry().cells().size.array() + kEdge - 1) / kEdge).matrix();
  m_number.assign(m_blocks.count(), kNone);
  for (std::uint32_t i = 0; i < set.size(); ++i) {
    const Cell cell = (set.cell(i).array() / kEdge).matrix();
    std::uint32_t& number = m_number[m_blocks.index(cell)];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(m_cell.size());
      m_cell.push_back(cell);
    }
    m_blockOf.push_back(number);
  }
}

std::size_t BoneBlocks::countVoxels(std::span<const std::uint32_t> blocks) const {
  std::vector<bool> is(size(), false);
  for (const std::uint32_t b : blocks) is[b] = true;
  return static_cast<std::size_t>(
      std::count_if(m_blockOf.begin(), m_blockOf.end(), [&](std::uint32_t b) { return is[b]; }));
}

std::vector<Eigen::Vector3d> BoneBlocks::points(std::span<const std::uint32_t> blocks,
                                                std::size_t most) const {
  std::vector<bool> is(size(), false);
  for (const std::uint32_t b : blocks) is[b] = true;
  std::vector<std::uint32_t> voxels;
  for (std::uint32_t i = 0; i < m_blockOf.size(); ++i)
    if (is[m_blockOf[i]]) voxels.push_back(i);
  const std::size_t count = std::min(voxels.size(), most);
  std::vector<Eigen::Vector3d> out;
  for (std::size_t k = 0; k < count; ++k)
    out.push_back(m_set.position(voxels[k * voxels.size() / count]));
  return out;
}

std::vector<double> BoneBlocks::localMeansOf(const std::vector<float>& values) const {
  struct Sum {
    double value = 0;
    std::uint32_t known = 0, all = 0;
  };
  std::vector<Sum> sums(size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    Sum& sum = sums[m_blockOf[kStride * i]];
    ++sum.all;
    if (!std::isfinite(values[i])) continue;
    sum.value += static_cast<double>(values[i]);
    ++sum.known;
  }
  std::vector<double> means(size());
  const Cell reach = Cell::Constant(kReach);
  tbb::parallel_for(std::size_t{0}, size(), [&](std::size_t b) {
    Sum total;
    CellBox::between(m_cell[b] - reach, m_cell[b] + reach)
        .meet(m_blocks)
        .forEach([&](const Cell& cell) {
          const std::uint32_t other = m_number[m_blocks.index(cell)];
          if (other == kNone) return;
          total.value += sums[other].value;
          total.known += sums[other].known;
          total.all += sums[other].all;
        });
    means[b] = total.known > 0 && 2 * total.known > total.all
                   ? total.value / total.known
                   : std::numeric_limits<double>::quiet_NaN();
  });
  return means;
}

std::vector<std::uint32_t> BoneBlocks::largestOf(std::vector<bool> isWanted) const {
  std::vector<std::uint32_t> largest, group, voxels(size(), 0);
  for (const std::uint32_t b : m_blockOf) ++voxels[b];
  std::size_t most = 0;
  for (std::uint32_t first = 0; first < size(); ++first) {
    if (!isWanted[first]) continue;
    isWanted[first] = false;
    group.assign(1, first);
    std::size_t count = 0;
    for (std::size_t k = 0; k < group.size(); ++k) {
      count += voxels[group[k]];
      m_blocks.forEachNeighbour(m_cell[group[k]], [&](const Cell& cell) {
        const std::uint32_t other = m_number[m_blocks.index(cell)];
        if (other == kNone || !isWanted[other]) return;
        isWanted[other] = false;
        group.push_back(other);
      });
    }
    if (count <= most) continue;
    most = count;
    largest = group;
  }
  std::sort(largest.begin(), largest.end());
  return largest;
}

}  // namespace lumen::convert
