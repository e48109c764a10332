// SPDX-License-Identifier: Apache-2.0
#include "converters/io/labels/settled_labels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>

namespace lumen::convert {
namespace {

constexpr double kRounding = 1e-3;
constexpr double kLargestLabel = 1 << 24;  // floats hold all whole numbers up to it

struct LabelFacts {
  bool isMap = true;
  std::size_t rounded = 0, negative = 0;
  double least = 0;  // the negative number
  bool hasZero = false;
};

template <class T>
LabelFacts factsOf(const std::vector<T>& voxels) {
  LabelFacts facts;
  if constexpr (std::is_unsigned_v<T>) return facts;  // nothing to settle
  for (const T voxel : voxels) {
    double whole = static_cast<double>(voxel);
    if constexpr (std::is_floating_point_v<T>) {
      whole = std::round(whole);
      const double off = std::abs(static_cast<double>(voxel) - whole);
      if (!(off <= kRounding) || !(std::abs(whole) <= kLargestLabel)) return {false};
      facts.rounded += off > 0 ? 1 : 0;
    }
    facts.hasZero = facts.hasZero || whole == 0;
    if (!(whole < 0)) continue;
    if (facts.negative > 0 && whole != facts.least) return {false};
    facts.least = whole;
    ++facts.negative;
  }
  return facts;
}

}  // namespace

std::optional<SettledLabels> settleLabels(const Volume& volume,
                                          const std::set<std::int64_t>& chosen) {
  const LabelFacts facts =
      std::visit([](const auto& voxels) { return factsOf(voxels); }, volume.voxels);
  const bool isChosen = chosen.count(static_cast<std::int64_t>(facts.least)) > 0;
  const bool isAround = facts.negative > 0 && !isChosen && (facts.least == -1 || !facts.hasZero);
  if (!facts.isMap || (facts.rounded == 0 && !isAround)) return std::nullopt;
  SettledLabels settled{volume, {}};
  std::visit(
      [&](auto& voxels) {
        using T = typename std::decay_t<decltype(voxels)>::value_type;
        for (T& voxel : voxels) {
          const double whole = std::round(static_cast<double>(voxel)) + 0.0;
          voxel = isAround && whole < 0 ? T{} : static_cast<T>(whole);
        }
      },
      settled.voxels.voxels);
  if (facts.rounded > 0)
    settled.remarks.push_back(std::to_string(facts.rounded) +
                              " of its voxels are not quite whole numbers, and are rounded");
  if (isAround)
    settled.remarks.push_back(std::to_string(facts.negative) + " of its voxels are " +
                              std::to_string(static_cast<std::int64_t>(facts.least)) +
                              ", which is taken as what is around the labels, as 0 is");
  return settled;
}

}  // namespace lumen::convert
