// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/convert_options.h"

#include "converters/engine/mesh_options.h"
#include "converters/engine/scope.h"
#include "converters/io/centerline/case_of_centerline.h"
#include "converters/stages/surface/patches/polygonise.h"

namespace lumen::engine {

void ConvertOptions::addRows(OptionTable& table) {
  addVolumeRows(table, source.volume);
  addFrameRow(table, source.frame);
  addNativeRow(table, source.native);
  addTrackRows(table, track);
  table
      .file("corrections", corrected,
            "Repeat the manual corrections of this case of the same volume, each at its place; "
            "corrections that no longer fit are reported, and the case keeps them")
      .forInputs(kImage);
  addMeshRows(table, source.mesh);
  addMaskRows(table, source.mask);
  addFitRows(table, fit);
  addMeshFileRows(table, output);
  addEncodingRows(table, output.encoding);
}

operations::CaseOptions ConvertOptions::caseOptions(FormatKind kind) const {
  operations::CaseOptions options;
  options.vessels = track.vessels();
  options.repeats = track.repeats;
  if (kind == FormatKind::Volume) options.chosenLabels = source.mask.chosen();
  options.isOnlyLabelled = source.mask.isOnlyLabelled;
  options.meshUnit = source.volume.options().unit;
  return options;
}

operations::ModelOptions ConvertOptions::modelOptions(const operations::Source& from,
                                                      const OptionTable& table,
                                                      Progress& progress) const {
  const bool isStated = table.find("cohesion-weight")->isGiven;
  const bool hasVoxels =
      from.value ? from.value->metadata.voxelSize.has_value() : from.mesh || !from.centerline;
  const OptionRow& scale = *table.find("cohesion-scale");
  if (scale.isGiven && !(isStated ? fit.cohesionWeight > 0 : hasVoxels))
    refuseUnused(scale,
                 "does nothing without --cohesion-weight, which is 0 for a case without voxels",
                 progress);
  return {fit, isStated};
}

void ConvertOptions::takeCellsOf(const operations::Source& from) {
  if (from.mesh || !from.centerline) return;
  double& cell = output.surface.patches.cell;
  const double thinnest = convert::measureExtent(from.centerline->file).least;
  if (cell == 0 && thinnest > 0) cell = convert::coarsestCellFor(thinnest);
}

}  // namespace lumen::engine
