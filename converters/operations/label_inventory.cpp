// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/label_inventory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <variant>

#include <tbb/parallel_for.h>

#include "converters/base/radius_range.h"
#include "converters/base/vectors.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/judge/measure/vessel_length.h"
#include "formats/case/node_origin.h"

namespace lumen::operations {
namespace {

using formats::CenterlineTree;

/// The place of a label among those of a mask, counted from 1; 0 if it has none.
std::size_t placeOf(const convert::LabelMask& mask, std::int64_t value) {
  const auto at = std::lower_bound(mask.values.begin(), mask.values.end(), value);
  if (at == mask.values.end() || *at != value) return 0;
  return static_cast<std::size_t>(at - mask.values.begin()) + 1;
}

/// The value of the voxel nearest to a place; negative for dark vessels, so that the vessels of
/// every image are bright. Nothing outside.
std::optional<double> lightAt(const ImageBesideMaps& image, const Eigen::Vector3d& place) {
  const convert::VolumeGeometry& geometry = image.volume.geometry;
  const auto cell = geometry.cells().nearest(geometry.indexFromWorld(place));
  if (!cell) return {};
  const double light = std::visit(
      [&](const auto& voxels) { return static_cast<double>(voxels[geometry.index(*cell)]); },
      image.volume.voxels);
  return image.dark ? -light : light;
}

/// Light along the axes of vessels.
struct VesselLight {
  double median = 0, leastUsual = 0, mostUsual = 0;  ///< all but a twentieth lie above, and below
};

VesselLight vesselLight(const ImageBesideMaps& image, const CenterlineTree& tree) {
  std::vector<double> light;
  for (const formats::Vec3f& centre : tree.centre)
    if (const auto one = lightAt(image, toEigen(centre))) light.push_back(*one);
  if (light.empty()) return {};
  std::sort(light.begin(), light.end());
  const std::size_t last = light.size() - 1;
  return {light[light.size() / 2], light[light.size() / 20], light[last - last / 20]};
}

LeftOut whyLeftOut(const ImageBesideMaps& image, const VesselLight& vessels,
                   const Eigen::Vector3d& place, double light) {
  const convert::VolumeGeometry& geometry = image.volume.geometry;
  const auto cell = geometry.cells().nearest(geometry.indexFromWorld(place));
  if (cell && image.prior.isNoVessel(geometry.index(*cell))) return LeftOut::NotVessel;
  if (light < vessels.leastUsual) return LeftOut::Faint;
  return light > vessels.mostUsual ? LeftOut::Strong : LeftOut::NoWall;
}

/// Counts of the voxels of a label that lie in the volume.
struct LabelCounts {
  std::size_t inside = 0, held = 0, dark = 0;
  std::array<std::size_t, kLeftOutCount> leftOut{};
  std::map<std::uint32_t, std::size_t> byBranch;  ///< of those that are held
};

/// Counts of all labels of a map that name branches, by their places; `light` is null without image.
std::vector<LabelCounts> countVoxels(const convert::LabelMask& mask, const CenterlineTree& tree,
                                     const convert::VolumeGeometry& geometry,
                                     const ImageBesideMaps* image, const VesselLight& light,
                                     const Progress& progress) {
  const TubeTreeDistance tubes(tree);
  const double half = 0.5 * mask.geometry.voxelSize();
  const convert::CellBox cells = mask.geometry.cells();
  const auto slices = static_cast<std::size_t>(cells.size[2]);
  std::vector<std::vector<LabelCounts>> counts(slices,
                                               std::vector<LabelCounts>(mask.names.size() + 1));
  tbb::parallel_for(std::size_t{0}, slices, [&](std::size_t z) {
    progress.check();
    convert::CellBox slice = cells;
    slice.low[2] = static_cast<int>(z);
    slice.size[2] = 1;
    slice.forEach([&](const convert::Cell& cell) {
      const std::uint8_t label = mask.label[cells.index(cell)];
      const Eigen::Vector3d place = mask.geometry.position(cell);
      if (label == 0 || !geometry.containsWorld(place)) return;
      LabelCounts& count = counts[z][label];
      ++count.inside;
      const WallHit hit = tubes.nearest(place);
      if (hit.distance <= half) {
        ++count.held;
        ++count.byBranch[hit.branch];
      }
      if (!image) return;
      const double own = lightAt(*image, place).value_or(light.leastUsual);
      if (own < light.leastUsual) ++count.dark;
      if (hit.distance > half)
        ++count.leftOut[static_cast<std::size_t>(whyLeftOut(*image, light, place, own))];
    });
  });
  std::vector<LabelCounts> sums(mask.names.size() + 1);
  for (const std::vector<LabelCounts>& slice : counts)
    for (std::size_t l = 0; l < sums.size(); ++l) {
      sums[l].inside += slice[l].inside;
      sums[l].held += slice[l].held;
      sums[l].dark += slice[l].dark;
      for (std::size_t why = 0; why < kLeftOutCount; ++why)
        sums[l].leftOut[why] += slice[l].leftOut[why];
      for (const auto& [branch, count] : slice[l].byBranch) sums[l].byBranch[branch] += count;
    }
  return sums;
}

/// Volume, mm^3, of each label of no vessel that is as bright as vessels, by its value.
std::map<std::int64_t, double> refusedVolumes(const LabelPart& map, const ImageBesideMaps& image,
                                              double light) {
  std::map<std::int64_t, double> refused;
  const convert::VolumeGeometry& own = map.voxels.geometry;
  const convert::VolumeGeometry& grid = image.volume.geometry;
  for (const convert::LabelMeaning& meaning : map.meanings)
    if (meaning.isStated &&
        (convert::isNotVessel(meaning.role) || meaning.role == convert::LabelRole::Chamber))
      refused[meaning.value] = 0;
  if (refused.empty() || image.prior.systems.empty()) return refused;
  std::visit(
      [&](const auto& labels) {
        grid.cells().forEach([&](const convert::Cell& cell) {
          const std::size_t i = grid.index(cell);
          if (!image.prior.isNoVessel(i)) return;
          const Eigen::Vector3d place = grid.position(cell);
          const auto at = own.cells().nearest(own.indexFromWorld(place));
          if (!at) return;
          const auto found = refused.find(static_cast<std::int64_t>(labels[own.index(*at)]));
          if (found != refused.end() && lightAt(image, place).value_or(-HUGE_VAL) >= light)
            found->second += grid.spacing.prod();
        });
      },
      map.voxels.voxels);
  return refused;
}

/// Length along the nodes [first, last], mm.
double lengthAlong(const CenterlineTree& tree, std::uint32_t first, std::uint32_t last) {
  double length = 0;
  for (std::uint32_t n = first; n < last; ++n)
    length += (toEigen(tree.centre[n + 1]) - toEigen(tree.centre[n])).norm();
  return length;
}

/// Adds the ends of a branch that lie beyond its label. Those within a radius of the label's last
/// node are none.
void addEnds(const CenterlineTree& tree, const formats::Branch& branch,
             const convert::NamedStretch& stretch, bool isContinued, MappedLabel& label) {
  const auto add = [&](bool isStart, std::uint32_t at, double length) {
    if (length > static_cast<double>(tree.radius[at]))
      label.beyond.push_back({branch.label, isStart, length});
  };
  if (!isContinued) add(true, stretch.first, lengthAlong(tree, branch.firstNode, stretch.first));
  const std::uint32_t last = branch.firstNode + branch.nodeCount - 1;
  add(false, stretch.end - 1, lengthAlong(tree, stretch.end - 1, last));
}

/// Adds the branches that are named after a label, which has this place in this map.
void addBranches(const formats::Case& value, const std::vector<double>& lengths,
                 const std::vector<BranchLabel>& labels, std::size_t map, std::size_t place,
                 MappedLabel& label) {
  const CenterlineTree& tree = value.tree;
  const std::vector<formats::NodeOrigin> origins = formats::readNodeOrigins(value);
  std::vector<float> radii;
  for (std::size_t b = 0; b < labels.size(); ++b) {
    if (labels[b].map != map || labels[b].stretch.label != place) continue;
    const formats::Branch& branch = tree.branches[b];
    const auto above = static_cast<std::size_t>(std::max(branch.parentNode, 0));
    const bool isContinued =
        branch.parentNode != formats::kNoParent && labels[tree.branch[above]].stretch.label != 0;
    label.branches.push_back(branch.label);
    label.length += lengths[b];
    for (std::uint32_t n = branch.firstNode + 1; n < branch.firstNode + branch.nodeCount; ++n)
      if (origins[n] == formats::NodeOrigin::Given) label.stated += lengthAlong(tree, n - 1, n);
    addEnds(tree, branch, labels[b].stretch, isContinued, label);
    const auto first = tree.radius.begin() + branch.firstNode;
    radii.insert(radii.end(), first, first + branch.nodeCount);
  }
  if (radii.empty()) return;
  const RadiusRange range = radiusRange(radii);
  label.leastRadius = static_cast<double>(range.min);
  label.meanRadius = static_cast<double>(range.mean);
  label.greatestRadius = static_cast<double>(range.max);
}

/// Reason why a label of vessels has no branch.
std::string whyMissing(const LabelCounts& counts, const CenterlineTree& tree, bool isImage) {
  if (counts.inside == 0) return "it lies outside of the volume";
  if (2 * counts.held > counts.inside) {
    const auto most =
        std::max_element(counts.byBranch.begin(), counts.byBranch.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    return "its voxels lie in " + tree.branches[most->first].label;
  }
  if (isImage && 2 * counts.dark > counts.inside)
    return "most of its voxels are outside of the levels of the vessels that are found";
  return "no cylinder fits along it";
}

std::array<double, kLeftOutCount> volumesOf(const LabelCounts& counts, double voxel) {
  std::array<double, kLeftOutCount> volumes{};
  for (std::size_t why = 0; why < kLeftOutCount; ++why)
    volumes[why] = static_cast<double>(counts.leftOut[why]) * voxel;
  return volumes;
}

bool isOfVessels(convert::LabelRole role) {
  return convert::isVessel(role) ||
         (convert::isOtherLumen(role) && role != convert::LabelRole::Chamber);
}

}  // namespace

LabelInventory inventoryOf(const std::vector<LabelPart>& maps, const std::vector<NamingMap>& naming,
                           const formats::Case& value, const convert::VolumeGeometry& geometry,
                           const ImageBesideMaps* image, const Context& context) {
  if (maps.empty()) return {};
  const CenterlineTree& tree = value.tree;
  const std::vector<BranchLabel> labels = labelsOfBranches(naming, tree);
  const std::vector<double> lengths = convert::vesselLengths(tree).branch;
  const VesselLight light = image ? vesselLight(*image, tree) : VesselLight();
  LabelInventory made;
  for (std::size_t m = 0; m < maps.size(); ++m) {
    const convert::LabelMask& mask = naming[m].mask;
    const std::vector<LabelCounts> counts =
        countVoxels(mask, tree, geometry, image, light, context.progress);
    const std::map<std::int64_t, double> refused =
        image ? refusedVolumes(maps[m], *image, light.median) : std::map<std::int64_t, double>();
    const std::map<std::int64_t, std::size_t> voxels = convert::countLabels(maps[m].voxels);
    MappedLabels& map = made.maps.emplace_back();
    map.name = maps[m].name;
    for (const convert::LabelMeaning& meaning : maps[m].meanings) {
      if (!voxels.contains(meaning.value)) continue;
      MappedLabel& label = map.labels.emplace_back();
      label.meaning = meaning;
      label.voxels = voxels.at(meaning.value);
      if (const auto found = refused.find(meaning.value); found != refused.end())
        label.refused = found->second;
      const std::size_t place = placeOf(mask, meaning.value);
      const LabelCounts& count = counts[place];
      if (count.inside > 0)
        label.heldShare = static_cast<double>(count.held) / static_cast<double>(count.inside);
      addBranches(value, lengths, labels, m, place, label);
      if (!isOfVessels(meaning.role)) continue;
      if (label.branches.empty()) label.missing = whyMissing(count, tree, image != nullptr);
      if (image && tree.nodeCount() > 0)
        label.leftOut = volumesOf(count, mask.geometry.spacing.prod());
    }
  }
  for (std::size_t b = 0; b < labels.size(); ++b) {
    if (labels[b].stretch.label != 0) continue;
    made.unlabelled.push_back(tree.branches[b].label);
    made.unlabelledLength += lengths[b];
  }
  return made;
}

}  // namespace lumen::operations
