// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/source_input.h"

#include <optional>
#include <utility>

#include "converters/engine/tracking_input.h"
#include "converters/io/labels/settled_labels.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"

namespace lumen::engine {

operations::Source loadSource(const InputFile& file, const FileFormat& format,
                              const SourceArguments& arguments, bool isSeeded, Progress& progress) {
  operations::Source source;
  if (format.kind == FormatKind::Volume) {
    source =
        volumeSource(readVolumeFile(file, format, arguments.volume, progress), file, arguments.mask,
                     isSeeded, progress, arguments.volume.volumeIndex.value_or(0));
    source.native = loadNative(arguments.native, progress);
    return source;
  }
  source.name = file.name();
  if (format.kind == FormatKind::Mesh) {
    const SceneArguments scene{arguments.mesh.sceneMesh, arguments.volume.allowDetached};
    source.mesh = loadMesh(file, format, scene, progress);
    stateAxes(source.mesh->file, arguments.frame);
    source.centerline = loadGivenCenterline(arguments.mesh, progress);
  } else {
    LoadedCenterline loaded =
        loadCenterline(file, format, arguments.volume, arguments.frame, progress);
    source.centerline =
        operations::CenterlinePart{std::move(loaded.file), source.name, loaded.frame};
  }
  return source;
}

operations::Source volumeSource(convert::Volume volume, const InputFile& file,
                                const MaskArguments& mask, bool isSeeded, Progress& progress,
                                std::int64_t layer) {
  operations::Source source;
  source.name = file.name();
  const bool isGuessed = !mask.isGiven() && !isSeeded;
  std::optional<convert::SettledLabels> settled;
  if (isGuessed || mask.isGiven()) settled = convert::settleLabels(volume, mask.chosen());
  const bool isGuess = isGuessed && convert::holdsLabels(settled ? settled->voxels : volume);
  if (isGuess)
    progress.detail(source.name + ": its voxels are labels, and all but 0 are taken for vessels");
  if (isGuess || mask.isGiven()) {
    if (settled) volume = takeSettled(*std::move(settled), source.name, progress);
    source.labels = operations::LabelPart{std::move(volume), source.name,
                                          convert::meaningsOf(mask.table(file, progress, layer))};
  } else {
    warnOfVoxels(volume, source.name, progress);
    source.grey = std::move(volume);
  }
  source.maps = loadLabelMaps(mask, source.grey ? &source.grey->geometry : nullptr, progress);
  return source;
}

}  // namespace lumen::engine
