// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/clutter.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/stages/phantom/clutter_shapes.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kVeinContrast = 0.6, kStentContrast = 2.0;  // shares of the vessels' contrast
constexpr double kVeinReach = 1e6, kStentReach = 4, kVoidReach = 2.5;  // radii to either side
constexpr double kVoidCore = 1.5;   // radii to either side, where the loss is full
constexpr double kVoidLoss = 0.95;  // share of the contrast that flow loses
constexpr std::uint64_t kStream = 0x636c7574746572ULL;  // a stream of its own for each kind

Random seededRandom(Clutter kind, std::uint64_t seed) {
  return Random(seed, kStream + static_cast<std::uint64_t>(kind));
}

bool isUniform(const Design& design) {
  return std::all_of(design.contrast.begin(), design.contrast.end(),
                     [](float c) { return c == 1.0F; });
}

/// The shapes of a phantom's clutter; those that are not wanted are empty.
struct Shapes {
  std::optional<Bone> bone;
  std::optional<Streaks> streaks;
  std::optional<Image> vein, stent;  ///< occupancy
  std::optional<Image> inside;       ///< occupancy of the vessels, where it is not the image's
};

Shapes makeShapes(const std::set<Clutter>& kinds, const Design& design, const VolumeGeometry& grid,
                  std::uint64_t seed, Progress& progress) {
  const double voxel = grid.spacing.x();
  const formats::CenterlineTree& tree = design.tree;
  Shapes shapes;
  const auto drawn = [&](Clutter kind, double reach, auto make) -> std::optional<Image> {
    if (!kinds.contains(kind)) return std::nullopt;
    Random random = seededRandom(kind, seed);
    const std::optional<BranchStretch> stretch = pickStretch(tree, reach, random);
    if (!stretch || stretch->first == stretch->last) return std::nullopt;
    return drawOccupancy(make(tree, *stretch, voxel, random), grid, progress);
  };
  shapes.vein = drawn(Clutter::Vein, kVeinReach, veinAlong);
  shapes.stent = drawn(Clutter::Stent, kStentReach, stentIn);
  if (kinds.contains(Clutter::Bone)) {
    Random random = seededRandom(Clutter::Bone, seed);
    const double extent = voxel * *std::max_element(grid.size.begin(), grid.size.end());
    if (const auto stretch = pickStretch(tree, 0, random))
      shapes.bone.emplace(tree, *stretch, extent, voxel, random);
  }
  if (kinds.contains(Clutter::Streaks)) {
    Random random = seededRandom(Clutter::Streaks, seed);
    if (const auto stretch = pickStretch(tree, 0, random))
      shapes.streaks.emplace(tree, *stretch, voxel, random);
  }
  if (!isUniform(design)) {
    Design full = design;
    std::fill(full.contrast.begin(), full.contrast.end(), 1.0F);
    shapes.inside = drawOccupancy(full, grid, progress);
  }
  return shapes;
}

/// The value of a voxel among the shapes; `at` is its index in the images.
double withShapes(const Shapes& shapes, double value, std::size_t at, const Vector3d& place) {
  const double inside = shapes.inside ? static_cast<double>(shapes.inside->value[at]) : value;
  double other = shapes.vein ? kVeinContrast * static_cast<double>(shapes.vein->value[at]) : 0;
  if (shapes.bone) other = std::max(other, shapes.bone->at(place));
  if (shapes.streaks) other = std::max(other, shapes.streaks->ball(place));
  value += (1 - std::clamp(inside, 0.0, 1.0)) * other;
  if (shapes.stent) {
    const auto wire = static_cast<double>(shapes.stent->value[at]);
    value += wire * (kStentContrast - value);
  }
  return value + (shapes.streaks ? shapes.streaks->streak(place) : 0);
}

}  // namespace

const std::vector<std::string>& clutterNames() {
  static const std::vector<std::string> names = {"bone", "vein", "streaks", "stent", "void"};
  return names;
}

std::set<std::size_t> chosenWords(const std::string& list, const std::vector<std::string>& names,
                                  const std::string& field, const std::string& kind) {
  std::set<std::size_t> chosen;
  for (std::size_t at = 0; !list.empty() && at <= list.size();) {
    const std::size_t end = std::min(list.find(',', at), list.size());
    const std::string word = list.substr(at, end - at);
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end())
      throw Error(ErrorKind::Usage, field + ": found '" + formats::printable(word) +
                                        "', expected " + kind + " with commas between them: " +
                                        alternatives(names) + didYouMean(word, names));
    if (!chosen.insert(static_cast<std::size_t>(found - names.begin())).second)
      throw Error(ErrorKind::Usage,
                  field + ": names " + word + " twice, expected each of the " + kind + " once");
    at = end + 1;
  }
  return chosen;
}

std::set<Clutter> parseClutter(const std::string& list, const FieldWord& fieldWord) {
  std::set<Clutter> kinds;
  for (const std::size_t kind :
       chosenWords(list, clutterNames(), fieldWord("clutter"), "kinds of clutter"))
    kinds.insert(static_cast<Clutter>(kind));
  return kinds;
}

void loseFlow(const std::set<Clutter>& kinds, std::uint64_t seed, Design& design) {
  if (!kinds.contains(Clutter::Void)) return;
  Random random = seededRandom(Clutter::Void, seed);
  const std::optional<BranchStretch> stretch = pickStretch(design.tree, kVoidReach, random);
  if (!stretch) return;
  const formats::CenterlineTree& tree = design.tree;
  const auto radius = static_cast<double>(tree.radius[stretch->middle]);
  const auto height = static_cast<double>(tree.height[stretch->middle]);
  for (std::uint32_t n = stretch->first; n <= stretch->last; ++n) {
    const double away =
        std::abs(static_cast<double>(n) - static_cast<double>(stretch->middle)) * height / radius;
    const double rim = std::clamp((kVoidReach - away) / (kVoidReach - kVoidCore), 0.0, 1.0);
    design.contrast[n] *= static_cast<float>(1 - kVoidLoss * rim);
  }
}

std::size_t clutterSteps(const std::set<Clutter>& kinds, const Design& design,
                         const VolumeGeometry& grid) {
  if (kinds.empty()) return 0;
  const std::size_t drawings = kinds.count(Clutter::Vein) + kinds.count(Clutter::Stent) +
                               static_cast<std::size_t>(!isUniform(design)) + 1;
  return drawings * static_cast<std::size_t>(grid.size[2]);
}

void addClutter(const std::set<Clutter>& kinds, const Design& design, const VolumeGeometry& grid,
                std::uint64_t seed, Image& image, Progress& progress) {
  if (kinds.empty()) return;
  const Shapes shapes = makeShapes(kinds, design, grid, seed, progress);
  tbb::parallel_for(0, grid.size[2], [&](int z) {
    progress.check();
    for (int y = 0; y < grid.size[1]; ++y) {
      const std::size_t row = image.index(y, z);
      for (int x = 0; x < grid.size[0]; ++x) {
        const std::size_t at = row + static_cast<std::size_t>(x);
        image.value[at] =
            static_cast<float>(withShapes(shapes, static_cast<double>(image.value[at]), at,
                                          grid.worldFromIndex(Vector3d(x, y, z))));
      }
    }
    progress.advance();
  });
}

}  // namespace lumen::convert
