// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/bright_voxels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/base/zeroed_array.h"
#include "converters/stages/finding/background.h"

namespace lumen::convert {
namespace {

constexpr double kAboveNoise = 4;    // standard deviations: excess that is no noise
constexpr std::size_t kBins = 1024;  // of the histogram of excess
constexpr double kMostLumen = 0.1;   // share of a volume that vessels may fill
/// Share of the background that is on a ridge by noise or texture: 24 % in white noise. A part
/// with ridges at a fifth of that or less is no background.
constexpr double kFewRidges = 0.05;
/// Multiples of the usual ridge: a vessel has one voxel of the latter at least, and goes on through
/// voxels of the former. In white noise one voxel of 1000 exceeds 3.2, and none of 885,000 5.6.
constexpr float kWeakRidge = 3.2F, kStrongRidge = 8;
/// Share of the contrast of wide vessels: no wall is found on a thin vessel that is fainter.
constexpr float kFaintest = 0.05F;
/// Strength of the ridge of a thin vessel as a share of its contrast, at the scale that suits it.
constexpr float kRidgeShare = 0.25F;
constexpr int kRidgeBlock = 32;      // voxels along an edge
constexpr std::size_t kSampled = 7;  // every seventh voxel shows the background's ridges

enum Mark : std::uint8_t { kBackground = 0, kWeak = 1, kLumen = 2, kNoImage = 3 };

/// Calls visit(z, index, excess) for every voxel of the image, row by row in parallel, with its
/// brightness over the background.
template <class Visit>
void forEachExcess(const Volume& volume, const Background& background, float sign,
                   const Progress& progress, const Visit& visit) {
  const CellBox cells = volume.geometry.cells();
  std::visit(
      [&](const auto& voxels) {
        tbb::parallel_for(0, cells.size[2], [&](int z) {
          progress.check();
          std::vector<float> row;
          for (int y = 0; y < cells.size[1]; ++y) {
            background.alongRow(y, z, row);
            const std::size_t first = cells.index(Cell(0, y, z));
            for (std::size_t x = 0; x < row.size(); ++x)
              if (volume.geometry.isImage(first + x))
                visit(z, first + x, sign * static_cast<float>(voxels[first + x]) - row[x]);
          }
        });
      },
      volume.voxels);
}

/// Counts of excess values in bins of equal width from `low` to `high`.
struct Histogram {
  float low = 0, high = 0;
  std::vector<std::size_t> count = std::vector<std::size_t>(kBins, 0);

  [[nodiscard]] std::size_t binOf(float value) const {
    const float at = (value - low) / (high - low) * static_cast<float>(kBins);
    return std::min(kBins - 1, static_cast<std::size_t>(std::max(at, 0.0F)));
  }
  [[nodiscard]] float middleOfBin(std::size_t bin) const {
    return low + (high - low) * static_cast<float>(bin) / static_cast<float>(kBins);
  }
  [[nodiscard]] std::size_t countFrom(std::size_t bin) const {
    std::size_t sum = 0;
    for (std::size_t i = bin; i < kBins; ++i) sum += count[i];
    return sum;
  }
  /// The bin from `first` on that splits the rest into two classes whose means differ the most, by
  /// the variance between them (N. Otsu, "A threshold selection method from gray-level histograms",
  /// 1979).
  [[nodiscard]] std::size_t split(std::size_t first) const {
    double all = 0, moment = 0;
    for (std::size_t i = first; i < kBins; ++i) {
      all += static_cast<double>(count[i]);
      moment += static_cast<double>(count[i]) * static_cast<double>(i);
    }
    double below = 0, belowMoment = 0, greatest = -1;
    std::size_t best = first;
    for (std::size_t i = first; i + 1 < kBins; ++i) {
      below += static_cast<double>(count[i]);
      belowMoment += static_cast<double>(count[i]) * static_cast<double>(i);
      if (below == 0 || below == all) continue;
      const double apart = belowMoment / below - (moment - belowMoment) / (all - below);
      const double between = below * (all - below) * apart * apart;
      if (between <= greatest) continue;
      greatest = between;
      best = i + 1;
    }
    return best;
  }
  /// The median of the values from a bin on.
  [[nodiscard]] float medianFrom(std::size_t bin) const {
    const std::size_t half = countFrom(bin) / 2;
    std::size_t sum = 0;
    while (bin + 1 < kBins && (sum += count[bin]) <= half) ++bin;
    return middleOfBin(bin);
  }
};

/// Excess of all voxels that stand out of the noise.
Histogram countExcess(const Volume& volume, const Background& background, float sign,
                      const Progress& progress) {
  const auto slices = static_cast<std::size_t>(volume.geometry.size[2]);
  std::vector<float> highest(slices, 0.0F);
  forEachExcess(volume, background, sign, progress, [&](int z, std::size_t, float excess) {
    float& high = highest[static_cast<std::size_t>(z)];
    high = std::max(high, excess);
  });
  Histogram all;
  all.low = static_cast<float>(kAboveNoise) * background.noise();
  all.high = *std::max_element(highest.begin(), highest.end());
  if (!(all.high > all.low)) return all;
  std::vector<Histogram> parts(slices, all);
  forEachExcess(volume, background, sign, progress, [&](int z, std::size_t, float excess) {
    Histogram& part = parts[static_cast<std::size_t>(z)];
    if (excess > part.low) ++part.count[part.binOf(excess)];
  });
  for (const Histogram& part : parts)
    for (std::size_t i = 0; i < kBins; ++i) all.count[i] += part.count[i];
  return all;
}

/// The excess of wide vessels: the median of the upper class, or of its own upper class, until it
/// is no more than vessels may fill.
float measureContrast(const Histogram& excess, std::size_t voxels) {
  std::size_t bin = excess.split(0);
  while (static_cast<double>(excess.countFrom(bin)) > kMostLumen * static_cast<double>(voxels)) {
    const std::size_t next = excess.split(bin);
    if (next == bin) break;
    bin = next;
  }
  return excess.medianFrom(bin);
}

/// The usual strength of the ridges in the background, by blocks of voxels: of noise and texture.
class UsualRidges {
public:
  UsualRidges(const CellBox& cells, const ZeroedArray<float>& strength,
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

  [[nodiscard]] float at(const Cell& cell) const {
    return m_median[m_blocks.index(cell / kRidgeBlock)];
  }

private:
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
  static CellBox blocksAround(const CellBox& cells) {
    return {Cell::Zero(), (cells.size.array() + kRidgeBlock - 1) / kRidgeBlock};
  }
  std::vector<float> m_median;
  CellBox m_blocks;
};

/// Adds the weak ridges that are connected with the lumen.
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

/// Marks the lumen of wide vessels where they are less bright than the rest.
void markFaded(const Volume& volume, const Background& background, float sign, float contrast,
               ZeroedArray<std::uint8_t>& mark, const Progress& progress) {
  Excess excess{volume.geometry.cells(), ZeroedArray<float>(mark.size()), [&](const Cell& cell) {
                  return static_cast<float>(kAboveNoise) * background.noiseAt(cell);
                }};
  forEachExcess(volume, background, sign, progress,
                [&](int, std::size_t i, float value) { excess.value[i] = value; });
  std::vector<bool> isLumen(mark.size());
  for (std::size_t i = 0; i < mark.size(); ++i) isLumen[i] = mark[i] == kLumen;
  growIntoFaded(excess, contrast, isLumen, progress);
  for (std::size_t i = 0; i < mark.size(); ++i)
    if (isLumen[i]) mark[i] = kLumen;
}

}  // namespace

BrightVoxels findBrightVoxels(const Volume& volume, bool dark, const Progress& progress) {
  const float sign = dark ? -1.0F : 1.0F;
  const Background background(volume, sign, progress);
  const Histogram excess = countExcess(volume, background, sign, progress);
  BrightVoxels out;
  out.noise = static_cast<double>(background.noise());
  if (excess.countFrom(0) == 0) return out;
  const CellBox cells = volume.geometry.cells();
  ZeroedArray<std::uint8_t> mark(cells.count());  // kBackground
  std::size_t imageSize = mark.size();
  for (std::size_t i = 0; i < mark.size(); ++i) {
    if (volume.geometry.isImage(i)) continue;
    mark[i] = kNoImage;
    --imageSize;
  }
  const float contrast = measureContrast(excess, imageSize);
  out.contrast = static_cast<double>(contrast);
  const float half = std::max(0.5F * contrast, excess.low);
  forEachExcess(volume, background, sign, progress, [&](int, std::size_t i, float value) {
    if (value > half) mark[i] = kLumen;
  });
  markFaded(volume, background, sign, contrast, mark, progress);
  const ZeroedArray<float> strength = ridgeStrength(volume, sign, progress);
  const UsualRidges usual(cells, strength, mark, progress);
  const float faintRidge = kFaintest * kRidgeShare * contrast;
  forEachExcess(volume, background, sign, progress, [&](int, std::size_t i, float value) {
    if (mark[i] == kLumen || !(strength[i] > faintRidge)) return;
    const Cell cell = cells.cell(i);
    const float noise =
        std::max(static_cast<float>(kAboveNoise) * background.noiseAt(cell), kFaintest * contrast);
    if (!(value > noise) || !(strength[i] > kWeakRidge * usual.at(cell))) return;
    const bool isStrong = strength[i] > std::max(kStrongRidge * usual.at(cell), 2 * faintRidge);
    mark[i] = isStrong ? kLumen : kWeak;
  });
  growIntoWeak(cells, mark, progress);
  for (std::size_t i = 0; i < mark.size(); ++i)
    if (mark[i] == kLumen) out.indices.push_back(i);
  return out;
}

}  // namespace lumen::convert
