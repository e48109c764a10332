// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/dark_seeds.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/stages/editing/checks.h"
#include "converters/stages/editing/hint_parents.h"
#include "converters/stages/editing/inlets.h"
#include "converters/stages/finding/click_level.h"
#include "converters/voxels/image_region.h"

namespace lumen::operations {
namespace {

using convert::ClickLevel;
using convert::SeedBranch;

/// The level at the first point of a seed all of whose points are dark; empty for the others.
std::optional<ClickLevel> darknessAt(const convert::ClickLevels& levels, const SeedBranch& seed) {
  std::optional<ClickLevel> first;
  for (const convert::SeedPoint& point : seed.points) {
    const ClickLevel level = levels.at(point.position);
    if (!level.isDark()) return std::nullopt;
    if (!first) first = level;
  }
  return first;
}

std::string reasonFor(const ClickLevel& level) {
  return "the volume shows no vessel there, as it has " + shownNumber(level.value, 3) +
         " around the seed, and in the background " + shownNumber(level.background, 3) +
         " with a noise of " + shownNumber(level.noise, 2);
}

}  // namespace

LitSeeds withoutDark(const convert::Volume& volume, std::vector<SeedBranch> seeds,
                     bool areVesselsDark, const Context& context) {
  LitSeeds out;
  if (seeds.empty()) return out;
  const std::shared_ptr<const convert::Volume> continued =
      convert::continueImage(volume, context.progress);
  const convert::ClickLevels levels(continued ? *continued : volume, areVesselsDark,
                                    context.progress);
  std::map<std::string, std::optional<std::string>> aboveDark;  // parents of dark seeds
  for (SeedBranch& seed : seeds) {
    while (seed.parent && aboveDark.contains(*seed.parent)) {
      const std::optional<std::string> above = aboveDark.at(*seed.parent);
      seed.parent = above;
    }
    if (const auto level = darknessAt(levels, seed)) {
      aboveDark[seed.label] = seed.parent;
      out.dark.push_back({seed.label, reasonFor(*level)});
    } else {
      out.lit.push_back(std::move(seed));
    }
  }
  return out;
}

std::string nearestText(const formats::CenterlineTree& tree, const Eigen::Vector3d& place) {
  const auto near = convert::nearestVessel(tree, place);
  if (!near) return {};
  const std::string name = convert::quoted(tree.branches[near->branch].label);
  if (near->toWall <= 0) return "it lies in " + name;
  return "the wall of the nearest vessel, " + name + ", is " + convert::millimetres(near->toWall) +
         " away";
}

void addNearestVessels(const formats::CenterlineTree& tree, const std::vector<SeedBranch>& seeds,
                       std::vector<convert::SeedFailure>& failures) {
  for (convert::SeedFailure& failure : failures)
    for (const SeedBranch& seed : seeds) {
      if (seed.label != failure.label) continue;
      const std::string near = nearestText(tree, seed.points.front().position);
      if (!near.empty()) failure.reason += "; " + near;
    }
}

}  // namespace lumen::operations
