// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/volume_doubt.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <variant>

#include "converters/base/error.h"

namespace lumen::convert {
namespace {

std::string numberText(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

/// The first two different values, in the order of the voxels, and whether there is a third.
struct Values {
  double first = 0;
  std::optional<double> second;
  bool hasMore = false;
};

template <class T>
Values valuesOf(const std::vector<T>& voxels) {
  Values out;
  if (voxels.empty()) return out;
  const T first = voxels.front();
  out.first = static_cast<double>(first);
  const auto isOther = [&](T v) { return v != first; };
  const auto other = std::find_if(voxels.begin(), voxels.end(), isOther);
  if (other == voxels.end()) return out;
  const T second = *other;
  out.second = static_cast<double>(second);
  out.hasMore = std::any_of(other, voxels.end(), [&](T v) { return v != first && v != second; });
  return out;
}

}  // namespace

std::optional<std::string> doubtAbout(const Volume& volume) {
  const Values values =
      std::visit([](const auto& voxels) { return valuesOf(voxels); }, volume.voxels);
  if (!values.second)
    throw invalidInput("every voxel is " + numberText(values.first) +
                       ", so there is nothing to track; expected an angiogram");
  if (values.hasMore) return std::nullopt;
  const auto [low, high] = std::minmax(values.first, *values.second);
  return "its voxels are " + numberText(low) + " or " + numberText(high) +
         " only, as in a mask; expected the intensities of an angiogram: walls will be as coarse "
         "as "
         "the voxels, so give the image that the mask was made from, if there is one";
}

}  // namespace lumen::convert
