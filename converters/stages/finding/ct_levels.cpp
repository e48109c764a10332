// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/ct_levels.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include <tbb/enumerable_thread_specific.h>

namespace lumen::convert {
namespace {

// Hounsfield units: air is at -1000 and water at 0 by definition. The ranges of tissue hold the
// commonest levels of four real scans, fat from -106 to -84 and soft tissue from 25 to 69.
struct Range {
  float low, high;
};
constexpr Range kAir{-1050, -950}, kFat{-140, -60}, kSoft{0, 100}, kBody{-140, 100};
/// Offsets of files of whole numbers that are not negative.
constexpr std::array<float, 3> kOffsets = {0, -1000, -1024};

constexpr Range kLevels{-1100, 4000};
constexpr float kLevelWidth = 10, kMostDeviation = 256;
constexpr float kLungs = 450;  // they may fill more of a volume than tissue does: above air
constexpr double kLeastPresent = 0.001;  // of the volume, of air or fat that is there
constexpr double kLeastBody = 0.1;       // the same, of soft tissue and fat: more than vessels fill

/// Counts of voxels by the mean and the deviation around them.
class LevelCounts {
public:
  LevelCounts() : m_count(kLevelBins * kDeviationBins, 0) {}

  void add(const Neighbourhood& around) {
    if (!(around.mean >= kLevels.low && around.mean < kLevels.high) ||
        !(around.deviation < kMostDeviation))
      return;
    ++m_count[binOf(around.mean) * kDeviationBins + static_cast<std::size_t>(around.deviation)];
  }
  void add(const LevelCounts& other) {
    for (std::size_t i = 0; i < m_count.size(); ++i) m_count[i] += other.m_count[i];
  }

  [[nodiscard]] std::size_t count(std::size_t level) const {
    std::size_t sum = 0;
    for (std::size_t d = 0; d < kDeviationBins; ++d) sum += m_count[level * kDeviationBins + d];
    return sum;
  }
  [[nodiscard]] std::size_t count(const Range& range) const {
    std::size_t sum = 0;
    for (std::size_t b = binOf(range.low); b < binOf(range.high); ++b) sum += count(b);
    return sum;
  }
  /// The level of a range that most voxels have.
  [[nodiscard]] float mode(const Range& range) const {
    std::size_t best = binOf(range.low);
    for (std::size_t b = best; b < binOf(range.high); ++b)
      if (count(b) > count(best)) best = b;
    return levelOf(best);
  }
  /// The lower quartile of the deviation at a level.
  [[nodiscard]] float quietDeviation(float level) const {
    const std::size_t bin = binOf(level), quarter = count(bin) / 4;
    std::size_t sum = 0, d = 0;
    while (d + 1 < kDeviationBins && (sum += m_count[bin * kDeviationBins + d]) <= quarter) ++d;
    return static_cast<float>(d) + 0.5F;
  }

  static constexpr std::size_t kLevelBins = static_cast<std::size_t>((kLevels.high - kLevels.low) /
                                                                     kLevelWidth),
                               kDeviationBins = static_cast<std::size_t>(kMostDeviation);
  static std::size_t binOf(float level) {
    return static_cast<std::size_t>((level - kLevels.low) / kLevelWidth);
  }
  static float levelOf(std::size_t bin) {
    return kLevels.low + (static_cast<float>(bin) + 0.5F) * kLevelWidth;
  }

private:
  std::vector<std::uint32_t> m_count;
};

LevelCounts countLevels(const Volume& volume, const Progress& progress) {
  tbb::enumerable_thread_specific<LevelCounts> parts;
  forEachNeighbourhood(volume, 0, progress, [&](std::size_t, const Neighbourhood& around) {
    parts.local().add(around);
  });
  LevelCounts all;
  parts.combine_each([&](const LevelCounts& part) { all.add(part); });
  return all;
}

Range moved(const Range& range, float offset) {
  return {range.low - offset, range.high - offset};
}

/// Whether the counts are those of a body on Hounsfield's scale less an offset.
bool isBody(const LevelCounts& counts, float offset, double voxels) {
  const Range body = moved(kBody, offset);
  const float level = counts.mode({kAir.high - offset + kLungs, kLevels.high});
  if (level < body.low || level > body.high) return false;
  const auto share = [&](const Range& range) {
    return static_cast<double>(counts.count(range)) / voxels;
  };
  if (share(body) < kLeastBody) return false;
  return share(moved(kAir, offset)) > kLeastPresent || (offset == 0 && share(kFat) > kLeastPresent);
}

}  // namespace

std::optional<CtLevels> measureCtLevels(const Volume& volume, const Progress& progress) {
  if (std::holds_alternative<std::vector<std::uint8_t>>(volume.voxels)) return {};
  const bool isFloat = std::holds_alternative<std::vector<float>>(volume.voxels);
  const LevelCounts counts = countLevels(volume, progress);
  const auto voxels = static_cast<double>(volume.geometry.voxelCount());
  for (const float offset : kOffsets) {
    if ((isFloat && offset != 0) || !isBody(counts, offset, voxels)) continue;
    CtLevels levels;
    levels.soft = counts.mode(moved(kSoft, offset));
    levels.noise = counts.quietDeviation(levels.soft);
    return levels;
  }
  return {};
}

}  // namespace lumen::convert
