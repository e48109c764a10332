// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/labelled_vessels.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/io/volume/write_volume.h"
#include "converters/stages/trees_from_surfaces/branch_systems.h"
#include "converters/stages/trees_from_surfaces/case_of_mesh.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"
#include "converters/stages/trees_from_surfaces/label_systems.h"
#include "formats/container/printable.h"

namespace lumen::operations {

namespace {

/// Gives the labels of a mask names, where they are known.
void useNames(const convert::LabelNames& names, convert::LabelMask& mask) {
  for (std::size_t i = 0; i < mask.values.size(); ++i)
    if (const auto found = names.find(mask.values[i]); found != names.end())
      mask.names[i] = found->second;
}

/// Takes the labels that are stated to be no vessels, or regions, off a mask. True if others are
/// left.
bool leaveOutOthers(const std::vector<convert::LabelMeaning>& meanings, convert::LabelMask& mask) {
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
  return std::count(isLeftOut.begin(), isLeftOut.end(), true) <
         static_cast<std::ptrdiff_t>(mask.values.size());
}

/// The middle of a volume, mm, LPS, and the lengths of its edges.
std::string extentText(const convert::VolumeGeometry& geometry) {
  const Eigen::Vector3d size = geometry.cells().size.cast<double>();
  return convert::vectorText(geometry.worldFromIndex(0.5 * (size.array() - 1).matrix())) +
         " with edges of " + convert::vectorText(size.cwiseProduct(geometry.spacing)) + " mm";
}

/// Gives the remarks on ends the names of the branches on whose nodes they lie.
void renameByNodes(const formats::CenterlineTree& tree, std::vector<convert::TrackEnd>& ends) {
  for (convert::TrackEnd& end : ends) {
    const auto nearest = std::min_element(tree.centre.begin(), tree.centre.end(),
                                          [&](const formats::Vec3f& a, const formats::Vec3f& b) {
                                            return (toEigen(a) - end.position).squaredNorm() <
                                                   (toEigen(b) - end.position).squaredNorm();
                                          });
    if (nearest == tree.centre.end()) return;
    end.label =
        tree.branches[tree.branch[static_cast<std::size_t>(nearest - tree.centre.begin())]].label;
  }
}

/// The role of each label of a mask.
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

/// Tree and wall points of all labels of a mask in one, without names.
formats::Case vesselsOfMask(const convert::LabelMask& mask, const std::string& name,
                            std::size_t labels, Progress& progress) {
  progress.begin("surface", 0);
  convert::LabelSurface surface = convert::makeLabelSurface(mask, progress);
  progress.end();
  if (surface.cavities > 0)
    progress.warn(name + ": " + std::to_string(surface.cavities) +
                  (surface.cavities == 1 ? " hole" : " holes") + " within the labels filled");
  convert::MeshCase made =
      convert::caseOfLumen(convert::closeMesh(std::move(surface.mesh)), mask.geometry.voxelSize(),
                           name, {}, {{"labels", static_cast<std::int64_t>(labels)}}, progress);
  for (const std::string& note : made.notes) progress.warn(note);
  return std::move(made.result);
}

/// The trees of labels that touch and are apart, each part of the labels by its own surface. A part
/// without a vessel is left out.
formats::Case vesselsOfParts(const convert::LabelMask& mask, bool isNamed,
                             std::span<const convert::LabelRole> roles, const std::string& name,
                             Progress& progress) {
  const std::vector<std::uint8_t> parts = convert::partsOfLabels(mask, roles, progress);
  const std::uint8_t last = *std::max_element(parts.begin(), parts.end());
  std::optional<formats::Case> all;
  std::string whyNone;
  for (std::uint8_t part = 0; part <= last; ++part) {
    std::optional<convert::LabelMask> own;
    if (last > 0) own = convert::partOfMask(mask, parts, part);
    const convert::LabelMask& labels = own ? *own : mask;
    const auto count = static_cast<std::size_t>(std::count(parts.begin(), parts.end(), part));
    try {
      formats::Case made = vesselsOfMask(labels, name, count, progress);
      if (isNamed) convert::nameBranches(labels, made);
      convert::takeSystems(labels, roles, made);
      convert::spreadSystems(made);
      if (all)
        convert::appendTrees(made, *all);
      else
        all = std::move(made);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::InvalidInput || last == 0) throw;
      whyNone = error.what();
      progress.warn(whyNone);
    }
  }
  if (!all) throw invalidInput(whyNone);
  return *std::move(all);
}

}  // namespace

formats::Case labelledVessels(const LabelPart& labels, const std::set<std::int64_t>& chosen,
                              const Context& context) {
  Progress& progress = context.progress;
  const std::string name = formats::printable(labels.name);
  convert::LabelNames wanted;
  for (const std::int64_t label : chosen) wanted[label] = "label-" + std::to_string(label);
  convert::LabelMask mask = convert::makeLabelMask(labels.voxels, wanted, name);
  const convert::LabelNames names = convert::namesOf(labels.meanings);
  useNames(names, mask);
  if (mask.isGrey)
    progress.warn(name +
                  ": its voxels differ from their neighbours as grey values do, and are taken as "
                  "labels; expected a segmentation: an image is tracked from " +
                  context.field("seeds"));
  formats::Case made = vesselsOfParts(mask, mask.names.size() > 1 || !names.empty(),
                                      rolesOf(mask, labels.meanings), name, progress);
  recordAssumptions(made.metadata.steps.back(), labels.voxels.assumptions);
  // no wall is known better than to a voxel of the labels
  std::optional<double>& voxel = made.metadata.voxelSize;
  voxel = std::max(voxel.value_or(0), mask.geometry.voxelSize());
  return made;
}

namespace {

void nameByMap(const LabelPart& map, const convert::VolumeGeometry& geometry,
               const std::string& named, formats::Case& target, const Context& context) {
  const std::string name = formats::printable(map.name);
  if (!convert::holdsLabels(map.voxels))
    throw invalidInput(name +
                       ": its voxels are no labels; expected whole numbers that are equal to "
                       "their neighbours but at borders, and 0 around vessels");
  convert::LabelMask mask = convert::makeLabelMask(map.voxels, {}, name);
  if (convert::labelledWithin(mask, geometry) == 0)
    throw invalidInput(name + ": none of its labels lies within " + formats::printable(named) +
                       "; the labels' volume is around " + extentText(mask.geometry) +
                       ", expected labels of the volume around " + extentText(geometry));
  useNames(convert::namesOf(map.meanings), mask);
  if (!leaveOutOthers(map.meanings, mask)) return;
  const convert::Naming done = convert::nameBranches(mask, target);
  convert::takeSystems(mask, rolesOf(mask, map.meanings), target);
  if (done.named == 0) context.progress.warn(name + ": no branch lies on its labels; names stay");
  context.progress.detail(name + ": names " + std::to_string(done.named) + " branches, " +
                          std::to_string(done.bare) + " lie on no label, " +
                          std::to_string(done.divided) + " were divided between labels");
}

}  // namespace

void nameByMaps(const std::vector<LabelPart>& maps, const convert::VolumeGeometry& geometry,
                const std::string& named, formats::Case& target,
                std::vector<convert::TrackEnd>& ends, const Context& context) {
  if (maps.empty()) return;
  // names and systems of the first map are the last ones that branches get
  for (auto map = maps.rbegin(); map != maps.rend(); ++map)
    nameByMap(*map, geometry, named, target, context);
  convert::spreadSystems(target);
  renameByNodes(target.tree, ends);
  for (const LabelPart& map : maps)
    target.metadata.steps.push_back(
        {"label-map",
         "lumen " LUMEN_VERSION,
         {{"label-map-sha256", convert::describeSource(map.voxels).sha256}}});
}

}  // namespace lumen::operations
