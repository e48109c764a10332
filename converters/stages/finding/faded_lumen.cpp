// SPDX-License-Identifier: Apache-2.0
// Declared in bright_voxels.h.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <set>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/stages/finding/background.h"
#include "converters/stages/finding/bright_voxels.h"

namespace lumen::convert {
namespace {

constexpr int kWideInside = 2;  // voxels to all sides of an inner one of a wide vessel
constexpr int kNewInside = 1;   // the same of what has grown, which is no rim then

/// Whether all voxels near one, to six sides, are marked.
bool isInner(const CellBox& cells, const std::vector<bool>& isMarked, const Cell& cell,
             int inside) {
  return std::all_of(kFaceSteps.begin(), kFaceSteps.end(), [&](const Cell& step) {
    for (int n = 1; n <= inside; ++n) {
      const Cell other = cell + n * step;
      if (!cells.contains(other)) return true;
      if (!isMarked[cells.index(other)]) return false;
    }
    return true;
  });
}

/// The contrast of wide vessels by blocks of voxels.
class LocalContrast {
public:
  LocalContrast(const Excess& excess, const std::vector<bool>& isLumen)
      : m_excess(excess), m_isLumen(isLumen) {
    m_blocks.size = (excess.cells.size.array() + Background::kBlock - 1) / Background::kBlock;
    m_contrast.assign(m_blocks.count(), 0);
  }

  /// Measures the blocks that have none yet. Returns whether one has got one.
  bool measure(const Progress& progress) {
    std::atomic<bool> isNew = false;
    tbb::parallel_for(std::size_t{0}, m_contrast.size(), [&](std::size_t b) {
      if (m_contrast[b] > 0) return;
      progress.check();
      const CellBox block{m_blocks.cell(b) * Background::kBlock,
                          Cell::Constant(Background::kBlock)};
      m_contrast[b] = contrastIn(block.meet(m_excess.cells));
      if (m_contrast[b] > 0) isNew = true;
    });
    return isNew;
  }

  /// The contrast of the block around a voxel, or the greatest of those beside it; 0 if none is
  /// known.
  [[nodiscard]] float at(const Cell& cell) const {
    const Cell block = cell / Background::kBlock;
    float contrast = m_contrast[m_blocks.index(block)];
    if (contrast > 0) return contrast;
    m_blocks.forEachNeighbour(block, [&](const Cell& other) {
      contrast = std::max(contrast, m_contrast[m_blocks.index(other)]);
    });
    return contrast;
  }

private:
  [[nodiscard]] float contrastIn(const CellBox& block) const {
    std::vector<float> values;
    block.forEach([&](const Cell& cell) {
      const std::size_t i = m_excess.cells.index(cell);
      if (m_isLumen[i] && isInner(m_excess.cells, m_isLumen, cell, kWideInside))
        values.push_back(m_excess.value[i]);
    });
    return values.size() < kSpeck ? 0 : upperMedian(values);
  }

  const Excess& m_excess;
  const std::vector<bool>& m_isLumen;
  CellBox m_blocks;
  std::vector<float> m_contrast;  ///< for each block; 0: unknown
};

/// Calls visit(index) for each voxel that shares a face with another.
template <class Visit>
void eachBeside(const CellBox& cells, std::size_t voxel, Visit&& visit) {
  const Cell cell = cells.cell(voxel);
  for (const Cell& step : kFaceSteps)
    if (cells.contains(cell + step)) visit(cells.index(cell + step));
}

/// Lumen and what it grows by.
std::vector<bool> grown(const Excess& excess, float contrast, const std::vector<bool>& isLumen,
                        const Progress& progress) {
  std::vector<bool> all = isLumen;
  LocalContrast local(excess, all);
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i]) front.push_back(i);
  while (local.measure(progress))
    for (std::size_t k = 0; k < front.size(); ++k) {
      progress.check();
      eachBeside(excess.cells, front[k], [&](std::size_t i) {
        const Cell cell = excess.cells.cell(i);
        const float half = all[i] ? 0 : 0.5F * local.at(cell);
        if (half == 0 || 2 * half >= contrast) return;
        if (!(excess.value[i] > std::max(half, excess.leastAt(cell)))) return;
        all[i] = true;
        front.push_back(i);
      });
    }
  return all;
}

/// Voxels that have grown and are connected.
struct GrownPart {
  std::vector<std::size_t> voxels;
  bool isWide = false;  ///< it is more than a rim of the lumen
  bool isHole = true;   ///< lumen is all around it
};

std::vector<GrownPart> findGrownParts(const CellBox& cells, const std::vector<bool>& isNew,
                                      const std::vector<bool>& isLumen, const Progress& progress) {
  std::vector<GrownPart> parts;
  std::vector<bool> isSeen(isNew.size(), false);
  for (std::size_t first = 0; first < isNew.size(); ++first) {
    if (!isNew[first] || isSeen[first]) continue;
    GrownPart part{{first}};
    isSeen[first] = true;
    std::size_t inner = 0;
    for (std::size_t k = 0; k < part.voxels.size(); ++k) {
      progress.check();
      inner += isInner(cells, isNew, cells.cell(part.voxels[k]), kNewInside) ? 1 : 0;
      eachBeside(cells, part.voxels[k], [&](std::size_t i) {
        part.isHole = part.isHole && (isNew[i] || isLumen[i]);
        if (isNew[i] && !isSeen[i]) part.voxels.push_back(i);
        if (isNew[i]) isSeen[i] = true;
      });
    }
    part.isWide = inner >= kSpeck;
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

void growIntoFaded(const Excess& excess, float contrast, std::vector<bool>& isLumen,
                   const Progress& progress) {
  std::vector<bool> isNew = grown(excess, contrast, isLumen, progress);
  for (std::size_t i = 0; i < isNew.size(); ++i) isNew[i] = isNew[i] && !isLumen[i];
  const std::vector<GrownPart> parts = findGrownParts(excess.cells, isNew, isLumen, progress);
  std::set<std::array<int, 3>> blocks;  // those in which a vessel fades, which noise perforates
  const auto blockOf = [&](std::size_t voxel) {
    const Cell block = excess.cells.cell(voxel) / Background::kBlock;
    return std::array{block[0], block[1], block[2]};
  };
  for (const bool wide : {true, false})
    for (const GrownPart& part : parts) {
      if (part.isWide != wide) continue;
      if (!wide && !(part.isHole && blocks.contains(blockOf(part.voxels[0])))) continue;
      for (const std::size_t i : part.voxels) {
        isLumen[i] = true;
        if (wide) blocks.insert(blockOf(i));
      }
    }
}

}  // namespace lumen::convert
