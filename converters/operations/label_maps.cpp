// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/label_maps.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/base/warning.h"
#include "converters/io/volume/write_volume.h"
#include "converters/stages/editing/selection.h"
#include "converters/stages/trees_from_surfaces/branch_systems.h"
#include "converters/stages/trees_from_surfaces/label_systems.h"
#include "formats/container/printable.h"

namespace lumen::operations {
namespace {

/// Takes the labels that are stated to be no vessels, or regions, off a mask.
void leaveOutOthers(const std::vector<convert::LabelMeaning>& meanings, convert::LabelMask& mask) {
  std::vector<bool> isLeftOut(mask.values.size() + 1, false);
  for (const convert::LabelMeaning& meaning : meanings) {
    if (!meaning.isStated) continue;
    if (!convert::isNotVessel(meaning.role) && meaning.role != convert::LabelRole::Region) continue;
    const auto at = std::lower_bound(mask.values.begin(), mask.values.end(), meaning.value);
    if (at != mask.values.end() && *at == meaning.value)
      isLeftOut[static_cast<std::size_t>(at - mask.values.begin()) + 1] = true;
  }
  for (std::uint8_t& label : mask.label)
    if (isLeftOut[label]) label = 0;
}

/// The middle of a volume, mm, LPS, and the lengths of its edges.
std::string extentText(const convert::VolumeGeometry& geometry) {
  const Eigen::Vector3d size = geometry.cells().size.cast<double>();
  return convert::vectorText(geometry.worldFromIndex(0.5 * (size.array() - 1).matrix())) +
         " with edges of " + convert::vectorText(size.cwiseProduct(geometry.spacing)) + " mm";
}

NamingMap namingMap(const LabelPart& map, const convert::VolumeGeometry& geometry,
                    const std::string& named) {
  NamingMap made;
  made.name = formats::printable(map.name);
  if (!convert::holdsLabels(map.voxels))
    throw invalidInput(made.name +
                       ": its voxels are no labels; expected whole numbers that are equal to "
                       "their neighbours but at borders, and 0 around vessels");
  made.mask = convert::makeLabelMask(map.voxels, {}, made.name);
  if (convert::labelledWithin(made.mask, geometry) == 0)
    throw invalidInput(made.name + ": none of its labels lies within " + formats::printable(named) +
                       "; the labels' volume is around " + extentText(made.mask.geometry) +
                       ", expected labels of the volume around " + extentText(geometry));
  useNames(convert::namesOf(map.meanings), made.mask);
  made.roles = rolesOf(made.mask, map.meanings);
  leaveOutOthers(map.meanings, made.mask);
  return made;
}

void nameByMap(const NamingMap& map, formats::Case& target, const Context& context) {
  const auto isSet = [](std::uint8_t label) { return label != 0; };
  if (std::none_of(map.mask.label.begin(), map.mask.label.end(), isSet)) return;
  const convert::Naming done = convert::nameBranches(map.mask, target);
  convert::takeSystems(map.mask, map.roles, target);
  if (done.named == 0)
    warn(context.progress,
         about(map.name, {WarningCode::LabelsBare, "no branch lies on its labels; names stay"}));
  context.progress.detail(map.name + ": names " + std::to_string(done.named) + " branches, " +
                          std::to_string(done.bare) + " lie on no label, " +
                          std::to_string(done.divided) + " were divided between labels");
}

}  // namespace

void useNames(const convert::LabelNames& names, convert::LabelMask& mask) {
  for (std::size_t i = 0; i < mask.values.size(); ++i)
    if (const auto found = names.find(mask.values[i]); found != names.end())
      mask.names[i] = found->second;
}

std::vector<convert::LabelRole> rolesOf(const convert::LabelMask& mask,
                                        const std::vector<convert::LabelMeaning>& meanings) {
  std::vector<convert::LabelRole> roles(mask.values.size(), convert::LabelRole::Unknown);
  for (const convert::LabelMeaning& meaning : meanings) {
    const auto at = std::lower_bound(mask.values.begin(), mask.values.end(), meaning.value);
    if (at != mask.values.end() && *at == meaning.value)
      roles[static_cast<std::size_t>(at - mask.values.begin())] = meaning.role;
  }
  return roles;
}

std::vector<NamingMap> namingMaps(const std::vector<LabelPart>& maps,
                                  const convert::VolumeGeometry& geometry,
                                  const std::string& named) {
  std::vector<NamingMap> made;
  for (const LabelPart& map : maps) made.push_back(namingMap(map, geometry, named));
  return made;
}

std::vector<BranchLabel> labelsOfBranches(const std::vector<NamingMap>& maps,
                                          const formats::CenterlineTree& tree) {
  std::vector<BranchLabel> labels(tree.branches.size());
  for (std::size_t m = maps.size(); m-- > 0;) {
    const std::vector<convert::NamedStretch> along = convert::labelsAlong(maps[m].mask, tree);
    for (std::size_t b = 0; b < labels.size(); ++b)
      if (along[b].label != 0) labels[b] = {m, along[b]};
  }
  return labels;
}

void nameByMaps(const std::vector<NamingMap>& maps, formats::Case& target, const Context& context) {
  if (maps.empty()) return;
  // names and systems of the first map are the last ones that branches get
  for (auto map = maps.rbegin(); map != maps.rend(); ++map) nameByMap(*map, target, context);
  convert::spreadSystems(target);
}

void leaveOutUnlabelled(const std::vector<NamingMap>& maps, formats::Case& target,
                        const std::string& named) {
  const formats::CenterlineTree& tree = target.tree;
  const std::vector<BranchLabel> labels = labelsOfBranches(maps, tree);
  std::vector<bool> goes(labels.size());
  std::transform(labels.begin(), labels.end(), goes.begin(),
                 [](const BranchLabel& label) { return label.stretch.label == 0; });
  if (std::find(goes.begin(), goes.end(), false) == goes.end())
    throw failed(formats::printable(named) +
                 ": no vessel that is found in it lies on a label of a vessel; nothing is written");
  const auto above = [&](std::size_t b) {
    return tree.branch[static_cast<std::size_t>(tree.branches[b].parentNode)];
  };
  // parents come before their children
  for (std::size_t b = goes.size(); b-- > 0;)
    if (!goes[b] && tree.branches[b].parentNode != formats::kNoParent) goes[above(b)] = false;
  for (std::size_t b = 0; b < goes.size(); ++b)
    if (tree.branches[b].kind == formats::BranchKind::Aneurysm &&
        tree.branches[b].parentNode != formats::kNoParent && !goes[above(b)])
      goes[b] = false;
  convert::leaveOutBranches(target, goes);
}

void renameEnds(const formats::CenterlineTree& tree, std::vector<convert::TrackEnd>& ends) {
  constexpr double kSamePlace = 1e-3;  // mm: positions of a case are floats
  std::erase_if(ends, [&](convert::TrackEnd& end) {
    for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
      if ((toEigen(tree.centre[n]) - end.position).norm() < kSamePlace) {
        end.label = tree.branches[tree.branch[n]].label;
        return false;
      }
    return true;
  });
}

void recordVolume(const std::string& name, const convert::Volume& volume, formats::Case& target) {
  target.metadata.steps.push_back(
      {name, "lumen " LUMEN_VERSION, {{name + "-sha256", convert::describeSource(volume).sha256}}});
}

void recordMaps(const std::vector<LabelPart>& maps, formats::Case& target) {
  for (const LabelPart& map : maps) recordVolume("label-map", map.voxels, target);
}

}  // namespace lumen::operations
