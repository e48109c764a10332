// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/source_input.h"

#include <utility>

#include "converters/engine/tracking_input.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"

namespace lumen::engine {

operations::Source loadSource(const InputFile& file, const FileFormat& format,
                              const SourceArguments& arguments, bool isSeeded, Progress& progress) {
  if (format.kind == FormatKind::Volume)
    return volumeSource(readVolumeFile(file, format, arguments.volume, progress), file,
                        arguments.mask, isSeeded, progress);
  operations::Source source;
  source.name = file.name();
  if (format.kind == FormatKind::Mesh) {
    const SceneArguments scene{arguments.mesh.sceneMesh, arguments.volume.allowDetached};
    source.mesh = loadMesh(file, format, scene, progress);
    source.centerline = loadGivenCenterline(arguments.mesh, progress);
  } else {
    LoadedCenterline loaded =
        loadCenterline(file, format, arguments.volume, arguments.centerline, progress);
    source.centerline = operations::CenterlinePart{std::move(loaded.file), source.name};
  }
  return source;
}

operations::Source volumeSource(convert::Volume volume, const InputFile& file,
                                const MaskArguments& mask, bool isSeeded, Progress& progress) {
  operations::Source source;
  source.name = file.name();
  const bool isGuess = !mask.isGiven() && !isSeeded && convert::holdsLabels(volume);
  if (isGuess)
    progress.detail(source.name + ": its voxels are labels, and all but 0 are taken for vessels");
  if (isGuess || mask.isGiven()) {
    source.labels = operations::LabelPart{std::move(volume), source.name,
                                          convert::meaningsOf(mask.table(file, progress))};
  } else {
    if (isSeeded) warnOfVoxels(volume, source.name, progress);
    source.grey = std::move(volume);
  }
  source.maps = loadLabelMaps(mask, progress);
  return source;
}

}  // namespace lumen::engine
