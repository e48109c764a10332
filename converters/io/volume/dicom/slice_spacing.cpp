// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/slice_spacing.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <variant>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "converters/voxels/label_voxels.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

using Slices = std::vector<DicomFrame>;

// Share of the mean distance within which distances between slices of a regular grid agree.
constexpr double kGapTolerance = 0.02;
// Share of the mean distance by which rounded positions may lie off a regular grid.
constexpr double kRoundedTolerance = 0.1;
// The same where the decimals of positions explain more; a missing slice takes half.
constexpr double kMostRounded = 0.25;
constexpr std::size_t kMostNamed = 5;  // gaps that a message names
// Slices for each one that is there: of a volume of which more is missing little is known.
constexpr std::size_t kMostMissing = 2;

/// Distances between neighbours, mm.
struct Gaps {
  std::vector<double> each;
  double least = 0, most = 0, usual = 0, mean = 0;
  [[nodiscard]] bool isUsual(double gap) const {
    return gap > 0 && std::abs(gap - usual) <= kGapTolerance * usual;
  }
};

Gaps gapsOf(const Slices& slices) {
  Gaps gaps;
  for (std::size_t n = 1; n < slices.size(); ++n)
    gaps.each.push_back(slices[n].position - slices[n - 1].position);
  std::vector<double> sorted = gaps.each;
  std::sort(sorted.begin(), sorted.end());
  gaps.least = sorted.front();
  gaps.most = sorted.back();
  gaps.usual = sorted[sorted.size() / 2];
  gaps.mean =
      (slices.back().position - slices.front().position) / static_cast<double>(gaps.each.size());
  return gaps;
}

/// The coarsest decimal place, mm, of which all coordinates of positions are multiples, from 1 mm to
/// 0.001 mm; 0: of none.
double decimalOf(const Slices& slices) {
  constexpr double kExact = 1e-6;  // of the place
  for (const double decimal : {1.0, 0.1, 0.01, 0.001}) {
    const bool isAll = std::all_of(slices.begin(), slices.end(), [&](const DicomFrame& slice) {
      const Eigen::Array3d places = slice.plane.position->array() / decimal;
      return ((places - places.round()).abs() <= kExact * (1 + places.abs())).all();
    });
    if (isAll) return decimal;
  }
  return 0;
}

/// Whether slices lie at these numbers of a regular grid up to the rounding of their positions: within a
/// tenth of their distance, or within the rounding of their decimals. A slice that is missing moves
/// others by half a distance.
bool isOnGrid(const Slices& slices, const std::vector<std::size_t>& numbers, double step) {
  double least = 0, most = 0;
  for (std::size_t n = 0; n < slices.size(); ++n) {
    const double off =
        slices[n].position - slices.front().position - static_cast<double>(numbers[n]) * step;
    least = std::min(least, off);
    most = std::max(most, off);
  }
  // along a normal that is no axis the rounding of three coordinates adds up
  const double decimals = std::sqrt(3.0) / 2 * decimalOf(slices);
  const double allowed =
      std::max(kRoundedTolerance * step, std::min(decimals, kMostRounded * step));
  return step > 0 && 0.5 * (most - least) <= allowed;
}

std::vector<std::size_t> inTurn(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  for (std::size_t n = 0; n < count; ++n) numbers[n] = n;
  return numbers;
}

/// The numbers of the slices on a regular grid from which some are missing; empty if they lie on none.
std::vector<std::size_t> numbersWithGaps(const Slices& slices, const Gaps& gaps) {
  if (!(gaps.least > 0) || gaps.most > static_cast<double>(slices.size()) * gaps.usual) return {};
  std::vector<std::size_t> numbers = {0};
  for (const double gap : gaps.each)
    numbers.push_back(
        numbers.back() +
        std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(gap / gaps.usual))));
  const double step =
      (slices.back().position - slices.front().position) / static_cast<double>(numbers.back());
  return isOnGrid(slices, numbers, step) ? numbers : std::vector<std::size_t>();
}

std::string millimetres(double value) {
  return shownNumber(value) + " mm";
}

/// "1 slice is missing between a and b (12 to 16 mm)", for each gap.
std::string missingText(const Slices& slices, const std::vector<std::size_t>& numbers) {
  std::string text;
  std::size_t named = 0, missing = 0;
  for (std::size_t n = 1; n < slices.size(); ++n) {
    const std::size_t count = numbers[n] - numbers[n - 1] - 1;
    missing += count;
    if (count == 0 || named++ >= kMostNamed) continue;
    text += (named == 1 ? " " : ", ") + std::to_string(count) + " between " + slices[n - 1].name() +
            " and " + slices[n].name() + " (" + shownNumber(slices[n - 1].position) + " to " +
            millimetres(slices[n].position) + " along their normal)";
  }
  return counted(missing, "slice is", "slices are") + " missing:" + text +
         (named > kMostNamed ? " and at " + std::to_string(named - kMostNamed) + " more places"
                             : std::string());
}

/// "slices are 1 mm apart up to a, and 3 mm from there on", if there are two such blocks; else empty.
std::string blocksText(const Slices& slices, const Gaps& gaps) {
  const auto equal = [](double a, double b) { return std::abs(a - b) <= kGapTolerance * a; };
  std::size_t change = 1;
  while (change < gaps.each.size() && equal(gaps.each[0], gaps.each[change])) ++change;
  const bool isSecond =
      change > 1 && change + 1 < gaps.each.size() &&
      std::all_of(gaps.each.begin() + static_cast<std::ptrdiff_t>(change), gaps.each.end(),
                  [&](double gap) { return equal(gaps.each[change], gap); });
  if (!isSecond) return {};
  return "slices are " + millimetres(gaps.each[0]) + " apart up to " + slices[change].name() +
         ", and " + millimetres(gaps.each[change]) + " from there on";
}

[[noreturn]] void refuseGaps(const Slices& slices, const Gaps& gaps,
                             const ReadVolumeOptions& options, const fs::path& path) {
  std::size_t n = 0;
  while (gaps.each[n] > 0 && gaps.isUsual(gaps.each[n])) ++n;
  if (gaps.least <= 0)
    while (gaps.each[n] > 0) ++n;
  const DicomFrame &one = slices[n], &other = slices[n + 1];
  std::string text = path.string() + ": slices " + one.name() + " and " + other.name() + " are " +
                     shownNumber(gaps.each[n]) + " mm apart, where most are " +
                     millimetres(gaps.usual);
  if (!(gaps.least > 0))
    throw invalidInput(text +
                       ", and differ in their voxels, and in no element that tells several "
                       "volumes apart; expected a regular stack with one image for each "
                       "position; move one of the two files out of the folder");
  const std::vector<std::size_t> numbers = numbersWithGaps(slices, gaps);
  const std::string blocks = blocksText(slices, gaps);
  if (!blocks.empty())
    text += "; " + blocks;
  else if (!numbers.empty())
    text += "; " + missingText(slices, numbers);
  throw invalidInput(text + "; expected a regular stack with one image for each position; " +
                     options.word("fill-gaps") + " interpolates slices in between");
}

/// Slices of a regular grid with those that are missing between their neighbours.
void fillMissing(const Slices& slices, const std::vector<std::size_t>& numbers,
                 SliceSpacing& spacing) {
  spacing.step =
      (slices.back().position - slices.front().position) / static_cast<double>(numbers.back());
  for (std::size_t n = 0; n + 1 < slices.size(); ++n) {
    const std::size_t steps = numbers[n + 1] - numbers[n];
    for (std::size_t k = 0; k < steps; ++k)
      spacing.places.push_back(static_cast<double>(n) +
                               static_cast<double>(k) / static_cast<double>(steps));
  }
  spacing.places.push_back(static_cast<double>(slices.size() - 1));
  spacing.filled =
      missingText(slices, numbers) + "; they are interpolated between their neighbours";
}

/// Slices of several distances at the least of them.
void fillUneven(const Slices& slices, const Gaps& gaps, SliceSpacing& spacing) {
  double sum = 0, count = 0;
  for (const double gap : gaps.each)
    if (gap <= (1 + kMostRounded) * gaps.least) {
      sum += gap;
      ++count;
    }
  const double length = slices.back().position - slices.front().position;
  const double steps = std::round(length / (sum / count));
  if (!(steps <= static_cast<double>(kMostMissing * slices.size()))) return;
  spacing.step = length / steps;
  std::size_t below = 0, between = 0;
  for (std::size_t k = 0; static_cast<double>(k) <= steps; ++k) {
    const double at = static_cast<double>(k) * spacing.step;
    while (below + 2 < slices.size() && slices[below + 1].position - slices.front().position <= at)
      ++below;
    double part = (at - (slices[below].position - slices.front().position)) / gaps.each[below];
    if (std::abs(part - std::round(part)) <= kGapTolerance) part = std::round(part);
    between += part > 0 && part < 1 ? 1 : 0;
    spacing.places.push_back(static_cast<double>(below) + std::clamp(part, 0.0, 1.0));
  }
  const std::string blocks = blocksText(slices, gaps);
  spacing.filled = (blocks.empty() ? "its slices are " + shownNumber(gaps.least) + " to " +
                                         millimetres(gaps.most) + " apart"
                                   : "its " + blocks) +
                   "; they are resampled to " + std::to_string(spacing.places.size()) + " slices " +
                   millimetres(spacing.step) + " apart, of which " + std::to_string(between) +
                   " are interpolated";
}

}  // namespace

SliceSpacing sliceSpacing(const Slices& slices, const ReadVolumeOptions& options,
                          const fs::path& path, std::vector<std::string>& assumptions) {
  const Gaps gaps = gapsOf(slices);
  SliceSpacing spacing;
  spacing.step = gaps.mean;
  if (std::all_of(gaps.each.begin(), gaps.each.end(),
                  [&](double gap) { return gaps.isUsual(gap); }))
    return spacing;
  if (gaps.least > 0 && isOnGrid(slices, inTurn(slices.size()), gaps.mean)) {
    assumptions.push_back("its slices are " + shownNumber(gaps.least) + " to " +
                          shownNumber(gaps.most) +
                          " mm apart, as positions that are rounded; their mean distance, " +
                          shownNumber(gaps.mean) + " mm, is used");
    return spacing;
  }
  if (!options.fillGaps || !(gaps.least > 0)) refuseGaps(slices, gaps, options, path);
  const std::vector<std::size_t> numbers = numbersWithGaps(slices, gaps);
  if (!numbers.empty() && blocksText(slices, gaps).empty())
    fillMissing(slices, numbers, spacing);
  else
    fillUneven(slices, gaps, spacing);
  if (spacing.places.empty() || spacing.places.size() > kMostMissing * slices.size())
    throw invalidInput(path.string() + ": its " + std::to_string(slices.size()) + " slices are " +
                       shownNumber(gaps.least) + " to " + millimetres(gaps.most) +
                       " apart, so more would be interpolated than are there; expected a volume");
  return spacing;
}

Voxels slicesAt(const std::vector<double>& places, const Voxels& slices, std::size_t slice,
                const std::optional<std::array<float, 2>>& padding) {
  const bool areLabels = holdsLabels(slices);
  return std::visit(
      [&]<class T>(const std::vector<T>& from) -> Voxels {
        const auto isPadding = [&](T v) {
          return padding && static_cast<float>(v) >= (*padding)[0] &&
                 static_cast<float>(v) <= (*padding)[1];
        };
        std::vector<T> to;
        to.reserve(places.size() * slice);
        const std::size_t last = from.size() / slice - 1;
        for (const double place : places) {
          const auto below = std::min(static_cast<std::size_t>(place), last);
          const std::size_t above = std::min(below + 1, last);
          const double part = place - static_cast<double>(below);
          for (std::size_t i = 0; i < slice; ++i) {
            const T one = from[below * slice + i], other = from[above * slice + i];
            const double value =
                (1 - part) * static_cast<double>(one) + part * static_cast<double>(other);
            if (areLabels || isPadding(one) || isPadding(other))
              to.push_back(part < 0.5 ? one : other);
            else
              to.push_back(static_cast<T>(std::is_integral_v<T> ? std::round(value) : value));
          }
        }
        return to;
      },
      slices);
}

}  // namespace lumen::convert
