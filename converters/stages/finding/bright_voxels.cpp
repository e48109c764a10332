// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/bright_voxels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>

#include <tbb/parallel_for.h>

#include "converters/base/otsu.h"
#include "converters/base/statistics.h"
#include "converters/base/zeroed_array.h"
#include "converters/stages/finding/background.h"
#include "converters/stages/finding/ridge_marks.h"

namespace lumen::convert {
namespace {

constexpr double kAboveNoise = 4;    // standard deviations: excess that is no noise
constexpr std::size_t kBins = 1024;  // of the histogram of excess
constexpr double kMostLumen = 0.1;   // share of a volume that vessels may fill
/// Share of the contrast of wide vessels: no wall is found on a thin vessel that is fainter.
constexpr float kFaintest = 0.05F;
/// Strength of the ridge of a thin vessel as a share of its contrast, at the scale that suits it.
constexpr float kRidgeShare = 0.25F;

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
  std::size_t bin = otsuSplit(excess.count, 0);
  while (static_cast<double>(excess.countFrom(bin)) > kMostLumen * static_cast<double>(voxels)) {
    const std::size_t next = otsuSplit(excess.count, bin);
    if (next == bin) break;
    bin = next;
  }
  return excess.medianFrom(bin);
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

/// Takes what is no vessel off the lumen, and adds it to other bright tissue.
void takeAway(const Prior& prior, ZeroedArray<std::uint8_t>& mark, std::vector<std::size_t>& bone) {
  for (std::size_t i = 0; i < prior.systems.size(); ++i) {
    if (!prior.isNoVessel(i)) continue;
    if (mark[i] == kLumen) bone.push_back(i);
    mark[i] = kOtherTissue;
  }
}

}  // namespace

BrightVoxels findBrightVoxels(const Volume& volume, bool dark, const Prior& prior,
                              const Progress& progress) {
  if (!dark)
    if (const auto levels = measureCtLevels(volume, progress))
      return findCtLumen(volume, *levels, prior, BesideBone::Followed, progress);
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
    mark[i] = kOtherTissue;
    --imageSize;
  }
  const float contrast = measureContrast(excess, imageSize);
  out.contrast = static_cast<double>(contrast);
  const float half = std::max(0.5F * contrast, excess.low);
  forEachExcess(volume, background, sign, progress, [&](int, std::size_t i, float value) {
    if (value > half) mark[i] = kLumen;
  });
  markFaded(volume, background, sign, contrast, mark, progress);
  takeAway(prior, mark, out.bone);
  const ZeroedArray<float> strength = ridgeStrength(volume, sign, progress);
  const UsualRidges usual(cells, strength, mark, progress);
  const float faintRidge = kFaintest * kRidgeShare * contrast;
  forEachExcess(volume, background, sign, progress, [&](int, std::size_t i, float value) {
    if (mark[i] != kBackground || !(strength[i] > faintRidge)) return;
    const Cell cell = cells.cell(i);
    const float noise =
        std::max(static_cast<float>(kAboveNoise) * background.noiseAt(cell), kFaintest * contrast);
    if (!(value > noise) || !(strength[i] > kWeakRidge * usual.at(cell))) return;
    const bool isStrong = strength[i] > std::max(kStrongRidge * usual.at(cell), 2 * faintRidge);
    mark[i] = isStrong || prior.isLumen(i) ? kLumen : kWeak;
  });
  growIntoWeak(cells, mark, progress);
  for (std::size_t i = 0; i < mark.size(); ++i)
    if (mark[i] == kLumen) out.indices.push_back(i);
  return out;
}

}  // namespace lumen::convert
