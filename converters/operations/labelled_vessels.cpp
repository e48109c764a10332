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
#include "converters/base/warning.h"
#include "converters/operations/label_maps.h"
#include "converters/stages/trees_from_surfaces/branch_systems.h"
#include "converters/stages/trees_from_surfaces/case_of_mesh.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"
#include "converters/stages/trees_from_surfaces/label_systems.h"
#include "formats/container/printable.h"

namespace lumen::operations {

namespace {

/// Tree and wall points of all labels of a mask in one, without names.
formats::Case vesselsOfMask(const convert::LabelMask& mask, const std::string& name,
                            std::size_t labels, Progress& progress) {
  progress.begin("surface", 0);
  convert::LabelSurface surface = convert::makeLabelSurface(mask, progress);
  progress.end();
  if (surface.cavities > 0)
    warn(progress,
         about(name, {WarningCode::LabelsSettled, std::to_string(surface.cavities) +
                                                      (surface.cavities == 1 ? " hole" : " holes") +
                                                      " within the labels filled"}));
  convert::MeshCase made =
      convert::caseOfLumen(convert::closeMesh(std::move(surface.mesh)), mask.geometry.voxelSize(),
                           name, {}, {{"labels", static_cast<std::int64_t>(labels)}}, progress);
  for (const std::string& note : made.notes) warn(progress, {WarningCode::LabelsSettled, note});
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
      warn(progress, {WarningCode::LabelsBare, whyNone});
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
    warn(progress,
         about(name, {WarningCode::VolumeDoubt,
                      "its voxels differ from their neighbours as grey values do, and are taken as "
                      "labels; expected a segmentation",
                      "an image is tracked from " + context.field("seeds")}));
  formats::Case made = vesselsOfParts(mask, mask.names.size() > 1 || !names.empty(),
                                      rolesOf(mask, labels.meanings), name, progress);
  recordAssumptions(made.metadata.steps.back(), labels.voxels.assumptions);
  // no wall is known better than to a voxel of the labels
  std::optional<double>& voxel = made.metadata.voxelSize;
  voxel = std::max(voxel.value_or(0), mask.geometry.voxelSize());
  return made;
}

}  // namespace lumen::operations
