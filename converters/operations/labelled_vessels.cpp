// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/labelled_vessels.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/operations/label_maps.h"
#include "converters/stages/trees_from_surfaces/case_of_mesh.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"
#include "formats/container/printable.h"

namespace lumen::operations {

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
  progress.begin("surface", 0);
  convert::LabelSurface surface = convert::makeLabelSurface(mask, progress);
  progress.end();
  if (surface.cavities > 0)
    progress.warn(name + ": " + std::to_string(surface.cavities) +
                  (surface.cavities == 1 ? " hole" : " holes") + " within the labels filled");
  convert::MeshCase made = convert::caseOfLumen(
      convert::closeMesh(std::move(surface.mesh)), mask.geometry.voxelSize(), name, {},
      {{"labels", static_cast<std::int64_t>(mask.names.size())}}, progress);
  for (const std::string& note : made.notes) progress.warn(note);
  recordAssumptions(made.result.metadata.steps.back(), labels.voxels.assumptions);
  // no wall is known better than to a voxel of the labels
  std::optional<double>& voxel = made.result.metadata.voxelSize;
  voxel = std::max(voxel.value_or(0), mask.geometry.voxelSize());
  if (mask.names.size() > 1 || !names.empty()) convert::nameBranches(mask, made.result);
  return std::move(made.result);
}

}  // namespace lumen::operations
