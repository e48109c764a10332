// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/opening.h"

#include <algorithm>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/warning.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/file_format.h"
#include "converters/engine/mask_input.h"
#include "converters/engine/source_input.h"
#include "converters/engine/tracking_input.h"
#include "converters/io/content/file_content.h"
#include "converters/io/seeds/place_seeds.h"
#include "converters/io/volume/write_volume.h"
#include "converters/operations/case_of.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/document_labels.h"
#include "viewer/session/document/document_seeds.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

Seeds placed(const convert::Volume* volume, Seeds seeds, const Opening& opening,
             Progress& progress) {
  const bool inVoxels = std::any_of(seeds.begin(), seeds.end(), [](const auto& seed) {
    return seed.frame.system == convert::SeedSystem::Voxel;
  });
  if (!inVoxels) return seeds;
  if (volume == nullptr)
    throw invalidInput(opening.label + ": these seeds are in voxels; open their volume first");
  auto result =
      convert::placeSeeds(seeds, volume->geometry, opening.file.path(), engine::optionWord());
  for (const convert::SeedFailure& failure : result.leftOut)
    warn(progress, {WarningCode::SeedLeftOut, opening.label + ": seed \"" + failure.label +
                                                  "\" is left out: " + failure.reason});
  return std::move(result.seeds);
}

formats::Case caseOf(const Opening& opening, const engine::FileFormat& format,
                     const engine::VolumeArguments& volume, Progress& progress) {
  if (format.kind == engine::FormatKind::Case) return format.readCase(opening.file);
  operations::Source source =
      engine::loadSource(opening.file, format, {volume, {}, {}, {}}, false, progress);
  source.name = opening.label;
  operations::CaseOptions options;
  options.models.emplace();
  return operations::caseOf(std::move(source), options, engine::operationContext(progress)).value;
}

/// A mesh in mm, as one without a unit is taken to be. The arguments state its unit, and from where a
/// scene may take it.
convert::MeshFile meshOf(const Opening& opening, const engine::VolumeArguments& arguments,
                         Progress& progress) {
  const engine::FileFormat& format = engine::inputFormat(opening.file, "");
  convert::MeshFile mesh =
      engine::loadMesh(opening.file, format, {{}, arguments.allowDetached}, progress).file;
  const std::optional<double> stated = arguments.options().unit;
  const double scale = stated ? mesh.scaleFor(*stated) : mesh.unitMm;
  if (scale > 0)
    for (Eigen::Vector3d& p : mesh.mesh.position) p *= scale;
  mesh.unitMm = 1;
  return mesh;
}

/// A volume. Files of a folder of DICOM that cannot be read are left out, and reported.
std::shared_ptr<const convert::Volume> volumeOf(const Opening& opening,
                                                engine::VolumeArguments arguments,
                                                Progress& progress) {
  if (!opening.series.empty()) arguments.series = opening.series;
  arguments.skipFaulty = true;
  return std::make_shared<const convert::Volume>(
      engine::loadVolume(opening.file, engine::inputFormat(opening.file, ""), arguments, progress));
}

/// Options of the command line are for the first volume. A second one keeps where its header may
/// lead, and the series that a page has chosen.
engine::VolumeArguments secondArguments(const engine::VolumeArguments& arguments) {
  engine::VolumeArguments second;
  second.allowDetached = arguments.allowDetached;
  return second;
}

void dropFiles(Document& document, FileRole role) {
  std::erase_if(document.files, [role](const OpenFile& file) { return file.role == role; });
}

void closeSecond(Document& document) {
  document.second.reset();
  document.secondSource.reset();
  dropFiles(document, FileRole::Second);
}

void closeLabels(Document& document) {
  document.labels.reset();
  dropFiles(document, FileRole::Labels);
}

std::shared_ptr<const OpenLabels> labelsOf(const Opening& opening, const Document& document,
                                           engine::MaskArguments arguments, Progress& progress) {
  if (!document.volume) refuse(opening.label + ": open the volume first that its labels are of");
  // options are for the map of the command line
  if (opening.file.isInMemory()) arguments = {};
  arguments.labelMaps = {opening.file};
  return openLabels(engine::loadLabelMaps(arguments, &document.volume->geometry, progress),
                    document);
}

Document add(Document document, const Opening& opening, FileRole role, int id,
             const SessionOptions& options, Progress& progress) {
  const engine::VolumeArguments& arguments = options.volume;
  const fs::path named = opening.file.isInMemory() ? fs::path() : opening.file.path();
  const FileStamp stamp = readFileStamp(named);
  switch (role) {
    case FileRole::Volume:
      document.volume = volumeOf(opening, arguments, progress);
      document.volumeSource =
          std::make_shared<const formats::SourceVolume>(convert::describeSource(*document.volume));
      document.proposals.reset();
      break;
    case FileRole::Second:
      if (!document.volume)
        refuse(opening.label + ": open the volume first that it is to be seen beside");
      document.second = volumeOf(opening, secondArguments(arguments), progress);
      document.secondSource =
          std::make_shared<const formats::SourceVolume>(convert::describeSource(*document.second));
      break;
    case FileRole::Labels:
      document.labels = labelsOf(opening, document, options.labels, progress);
      break;
    case FileRole::Case:
    case FileRole::Truth: {
      auto value = std::make_shared<const formats::Case>(
          caseOf(opening, engine::inputFormat(opening.file, ""), arguments, progress));
      if (role == FileRole::Truth) {
        document.truth = std::move(value);
        break;
      }
      document.seeds = joined(seedsInCase(*value, opening.label, progress), waitingSeeds(document));
      document.value = std::move(value);
      document.proposals.reset();
      break;
    }
    case FileRole::Seeds:
      document.seeds =
          joined(placed(document.volume.get(),
                        convert::readSeeds(opening.file, engine::TrackArguments().reading()),
                        opening, progress),
                 trackedSeeds(document));
      break;
    case FileRole::Mesh:
      document.meshes.push_back(
          {id, opening.label,
           std::make_shared<const convert::MeshFile>(meshOf(opening, arguments, progress))});
      break;
  }
  if (role != FileRole::Mesh) dropFiles(document, role);
  document.files.push_back({id, role, opening.label, named, stamp, opening.series});
  return document;
}

}  // namespace

FileRole openingRole(const Opening& opening) {
  if (!opening.file.isInMemory()) engine::requireInput(opening.file.path(), "file");
  if (opening.as == OpenAs::Labels && convert::isLabelFolder(opening.file)) return FileRole::Labels;
  if (convert::detectContent(opening.file).kind == convert::ContentKind::Seeds)
    return FileRole::Seeds;
  const engine::FileFormat& format = engine::inputFormat(opening.file, "");
  if (opening.as == OpenAs::Truth && format.kind != engine::FormatKind::Case)
    refuse(opening.label + ": the truth must be a case");
  if (opening.as == OpenAs::Second && format.kind != engine::FormatKind::Volume)
    refuse(opening.label + ": only a volume can be seen beside the first volume");
  if (opening.as == OpenAs::Labels && format.kind != engine::FormatKind::Volume)
    refuse(opening.label + ": only a volume can be a label map");
  switch (format.kind) {
    case engine::FormatKind::Volume:
      return opening.as == OpenAs::Second   ? FileRole::Second
             : opening.as == OpenAs::Labels ? FileRole::Labels
                                            : FileRole::Volume;
    case engine::FormatKind::Mesh:
    case engine::FormatKind::VolumeMesh:
      return FileRole::Mesh;
    case engine::FormatKind::Case:
    case engine::FormatKind::Centerline:
      break;
  }
  return opening.as == OpenAs::Truth ? FileRole::Truth : FileRole::Case;
}

Document withFile(const Document& document, const Opening& opening, int id,
                  const SessionOptions& options, Progress& progress) {
  return add(document, opening, openingRole(opening), id, options, progress);
}

Document withoutFile(const Document& document, int id) {
  Document result = document;
  const auto file = std::find_if(result.files.begin(), result.files.end(),
                                 [id](const OpenFile& f) { return f.id == id; });
  if (file == result.files.end()) refuse("no file of number " + std::to_string(id) + " is open");
  const FileRole role = file->role;
  switch (role) {
    case FileRole::Volume:
      result.volume.reset();
      result.volumeSource.reset();
      result.proposals.reset();
      closeSecond(result);
      closeLabels(result);
      break;
    case FileRole::Second:
      closeSecond(result);
      return result;
    case FileRole::Labels:
      closeLabels(result);
      return result;
    case FileRole::Case:
      result.seeds = std::make_shared<const Seeds>(waitingSeeds(document));
      result.value.reset();
      result.proposals.reset();
      break;
    case FileRole::Truth:
      result.truth.reset();
      break;
    case FileRole::Seeds:
      result.seeds = std::make_shared<const Seeds>(trackedSeeds(document));
      break;
    case FileRole::Mesh:
      std::erase_if(result.meshes, [id](const OpenMesh& mesh) { return mesh.id == id; });
      break;
  }
  std::erase_if(result.files, [id](const OpenFile& f) { return f.id == id; });
  return result;
}

}  // namespace lumen::viewer
