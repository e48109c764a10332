// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/ridge_marks.h"

#include <algorithm>
#include <cstddef>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"

namespace lumen::convert {
namespace {

/// Share of the background that is on a ridge by noise or texture: 24 % in white noise. A part
/// with ridges at a fifth of that or less is no background.
constexpr double kFewRidges = 0.05;
constexpr int kRidgeBlock = 32;      // voxels along an edge
constexpr std::size_t kSampled = 7;  // every seventh voxel shows the background's ridges

/// Voxels of the background, and the strengths of those on a ridge.
struct Samples {
  std::size_t count = 0;
  std::vector<float> ridges;

  void add(float strength) {
    ++count;
    if (strength > 0) ridges.push_back(strength);
  }
  void add(const Samples& more) {
    count += more.count;
    ridges.insert(ridges.end(), more.ridges.begin(), more.ridges.end());
  }
  /// The median of the ridges, 0 if these are few. Reorders them.
  float medianRidge() {
    const auto few = kFewRidges * static_cast<double>(count);
    return ridges.empty() || static_cast<double>(ridges.size()) < few ? 0 : upperMedian(ridges);
  }
};

CellBox blocksAround(const CellBox& cells) {
  return {Cell::Zero(), (cells.size.array() + kRidgeBlock - 1) / kRidgeBlock};
}

}  // namespace

UsualRidges::UsualRidges(const CellBox& cells, const ZeroedArray<float>& strength,
                         const ZeroedArray<std::uint8_t>& mark, const Progress& progress)
    : m_median(blocksAround(cells).count()), m_blocks(blocksAround(cells)) {
  std::vector<Samples> found(m_blocks.count());
  tbb::parallel_for(std::size_t{0}, m_blocks.count(), [&](std::size_t b) {
    progress.check();
    std::size_t n = 0;
    CellBox{m_blocks.cell(b) * kRidgeBlock, Cell::Constant(kRidgeBlock)}.meet(cells).forEach(
        [&](const Cell& cell) {
          if (++n % kSampled != 0) return;
          const std::size_t i = cells.index(cell);
          if (mark[i] == kBackground) found[b].add(strength[i]);
        });
  });
  Samples all;
  for (const Samples& some : found) all.add(some);
  const float everywhere = all.medianRidge();
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t b) {
    Samples around;
    const Cell at = m_blocks.cell(b);
    m_blocks.meet(CellBox::between(at - Cell::Ones(), at + Cell::Ones()))
        .forEach([&](const Cell& cell) { around.add(found[m_blocks.index(cell)]); });
    m_median[b] = std::max(everywhere, around.medianRidge());
  });
}

float UsualRidges::at(const Cell& cell) const {
  return m_median[m_blocks.index(cell / kRidgeBlock)];
}

void growIntoWeak(const CellBox& cells, ZeroedArray<std::uint8_t>& mark, const Progress& progress) {
  std::vector<std::size_t> reached;
  const auto from = [&](std::size_t i) {
    cells.forEachNeighbour(cells.cell(i), [&](const Cell& cell) {
      const std::size_t j = cells.index(cell);
      if (mark[j] != kWeak) return;
      mark[j] = kLumen;
      reached.push_back(j);
    });
  };
  for (std::size_t i = 0; i < mark.size(); ++i)
    if (mark[i] == kLumen) from(i);
  for (std::size_t k = 0; k < reached.size(); ++k) {
    progress.check();
    from(reached[k]);
  }
}

}  // namespace lumen::convert
