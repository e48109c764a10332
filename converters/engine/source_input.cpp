// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/source_input.h"

#include <utility>

#include "converters/engine/tracking_input.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"

namespace lumen::engine {

namespace {

void addVolume(convert::Volume volume, const InputFile& input, const MaskArguments& mask,
               bool isSeeded, operations::Source& source, Progress& progress) {
  const std::string& file = source.name;
  const bool isGuess = !mask.isGiven() && !isSeeded && convert::holdsLabels(volume);
  if (isGuess)
    progress.detail(file + ": its voxels are labels, and all but 0 are taken for vessels");
  if (isGuess || mask.isGiven()) {
    source.labels = operations::LabelPart{std::move(volume), file, mask.names(input)};
  } else {
    if (isSeeded) warnOfVoxels(volume, file, progress);
    source.grey = std::move(volume);
  }
}

}  // namespace

operations::Source loadSource(const InputFile& file, const FileFormat& format,
                              const SourceArguments& arguments, bool isSeeded, Progress& progress) {
  operations::Source source;
  source.name = file.path().string();
  if (format.kind == FormatKind::Mesh) {
    const SceneArguments scene{arguments.mesh.sceneMesh, arguments.volume.allowDetached};
    source.mesh = loadMesh(file, format, scene, progress);
    source.centerline = loadGivenCenterline(arguments.mesh, progress);
  } else if (format.kind == FormatKind::Centerline) {
    LoadedCenterline loaded =
        loadCenterline(file, format, arguments.volume, arguments.centerline, progress);
    source.centerline = operations::CenterlinePart{std::move(loaded.file), source.name};
  } else {
    addVolume(readVolumeFile(file, format, arguments.volume, progress), file, arguments.mask,
              isSeeded, source, progress);
    source.regions = loadRegions(arguments.mask, progress);
  }
  return source;
}

}  // namespace lumen::engine
