// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/background.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <variant>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"

namespace lumen::convert {
namespace {

constexpr int kAround = 2;       // blocks on either side that a place compares
constexpr double kQuiet = 0.25;  // quantile of the blocks that hold background alone

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Median of a block's voxels, and the median absolute deviation from it. Unknown without image.
struct BlockLevel {
  float median = kUnknown, deviation = kUnknown;
};

template <class T>
BlockLevel measureLevel(const std::vector<T>& voxels, const VolumeGeometry& geometry,
                        const CellBox& block, float sign) {
  std::vector<float> values;
  values.reserve(block.count());
  block.forEach([&](const Cell& cell) {
    const std::size_t i = geometry.index(cell);
    if (geometry.isImage(i)) values.push_back(sign * static_cast<float>(voxels[i]));
  });
  if (values.empty()) return {};
  BlockLevel level;
  level.median = upperMedian(values);
  for (float& value : values) value = std::abs(value - level.median);
  level.deviation = upperMedian(values);
  return level;
}

}  // namespace

Background::Background(const Volume& volume, float sign, const Progress& progress)
    : m_voxels(volume.geometry.cells()) {
  m_blocks.size = (m_voxels.size.array() + kBlock - 1) / kBlock;
  std::vector<float> medians(m_blocks.count()), deviations(m_blocks.count());
  std::visit(
      [&](const auto& voxels) {
        tbb::parallel_for(std::size_t{0}, m_blocks.count(), [&](std::size_t b) {
          progress.check();
          const CellBox block{m_blocks.cell(b) * kBlock, Cell::Constant(kBlock)};
          const BlockLevel level =
              measureLevel(voxels, volume.geometry, block.meet(m_voxels), sign);
          medians[b] = level.median;
          deviations[b] = level.deviation;
        });
        using T = typename std::decay_t<decltype(voxels)>::value_type;
        if constexpr (std::is_integral_v<T>) m_noise = static_cast<float>(1 / std::sqrt(12.0));
      },
      volume.voxels);
  smoothOver(medians, deviations);
  for (int x = 0; x < m_voxels.size[0]; ++x) m_alongX.push_back(between(x, m_blocks.size[0]));
  std::vector<float> all = deviations;
  std::erase_if(all, [](float deviation) { return std::isnan(deviation); });
  m_noise = std::max(m_noise, static_cast<float>(kDeviationOfMedian) * lowerQuantile(all, kQuiet));
}

Background::Between Background::between(int voxel, int blocks) {
  const double at = (voxel + 0.5) / kBlock - 0.5;
  const int low = std::clamp(static_cast<int>(std::floor(at)), 0, blocks - 1);
  return {low, std::min(low + 1, blocks - 1), static_cast<float>(std::clamp(at - low, 0.0, 1.0))};
}

void Background::smoothOver(const std::vector<float>& medians,
                            const std::vector<float>& deviations) {
  m_level.resize(medians.size());
  m_unevenness.resize(medians.size());
  tbb::parallel_for(std::size_t{0}, medians.size(), [&](std::size_t b) {
    const Cell at = m_blocks.cell(b);
    std::vector<float> levels, spreads;
    m_blocks.meet(CellBox::between(at - Cell::Constant(kAround), at + Cell::Constant(kAround)))
        .forEach([&](const Cell& cell) {
          if (std::isnan(medians[m_blocks.index(cell)])) return;
          levels.push_back(medians[m_blocks.index(cell)]);
          spreads.push_back(deviations[m_blocks.index(cell)]);
        });
    const bool isKnown = !levels.empty();
    m_level[b] = isKnown ? lowerQuantile(levels, kQuiet) : kUnknown;
    m_unevenness[b] =
        isKnown ? static_cast<float>(kDeviationOfMedian) * upperMedian(spreads) : kUnknown;
  });
}

float Background::noiseAt(const Cell& cell) const {
  return std::max(m_noise, m_unevenness[m_blocks.index(cell / kBlock)]);
}

void Background::alongRow(int y, int z, std::vector<float>& row) const {
  const auto [y0, y1, sy] = between(y, m_blocks.size[1]);
  const auto [z0, z1, sz] = between(z, m_blocks.size[2]);
  std::vector<float> levels(static_cast<std::size_t>(m_blocks.size[0]));
  for (int bx = 0; bx < m_blocks.size[0]; ++bx) {
    const auto level = [&](int by, int bz) { return m_level[m_blocks.index(Cell(bx, by, bz))]; };
    const float low = level(y0, z0) + sy * (level(y1, z0) - level(y0, z0));
    const float high = level(y0, z1) + sy * (level(y1, z1) - level(y0, z1));
    levels[static_cast<std::size_t>(bx)] = low + sz * (high - low);
  }
  row.resize(m_alongX.size());
  for (std::size_t x = 0; x < row.size(); ++x) {
    const float low = levels[static_cast<std::size_t>(m_alongX[x].low)];
    row[x] = low + m_alongX[x].share * (levels[static_cast<std::size_t>(m_alongX[x].high)] - low);
  }
}

}  // namespace lumen::convert
