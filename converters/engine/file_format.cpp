// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/file_format.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "converters/base/warning.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_access.h"
#include "converters/export/shared/paths.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/centerline/write_centerline.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/io/mesh/write_gltf.h"
#include "converters/io/mesh/write_plain.h"
#include "converters/io/volume/write_volume.h"
#include "converters/stages/surface/to_surface_mesh.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace fs = std::filesystem;
using convert::MeshFormat;
using convert::VolumeFormat;

namespace {

template <const VolumeFormat& format>
convert::Volume readVolumeAs(const InputFile& file, const convert::ReadVolumeOptions& options,
                             const Progress& progress) {
  return convert::readVolume(file, format, options, progress);
}

template <const VolumeFormat& format>
convert::VolumeHeader readHeaderAs(const InputFile& file, const convert::ReadVolumeOptions& options,
                                   const Progress& progress) {
  return convert::readVolumeHeader(file, format, options, progress);
}

template <const VolumeFormat& format, bool compressed>
std::string encodeVolumeAs(const convert::Volume& volume, const fs::path& file) {
  return convert::encodeVolume(volume, format, compressed, file);
}

template <convert::MeshFormat format>
convert::MeshFile readMeshAs(const InputFile& file) {
  return convert::readMesh(file, format);
}

convert::MeshFile readVesselsOfScene(const InputFile& file) {
  return readSceneMesh(file, {});
}

template <formats::CaseEncoding encoding>
EncodedCase encodeCaseAs(const formats::Case& value, const fs::path& file,
                         const OutputOptions& options, Progress&) {
  return {encodeCase(value, file, encoding, options.encoding), {}};
}

using Levels = std::vector<convert::SurfaceMesh>;

std::string encodeStl(const Levels& levels, const convert::WriteMeshOptions& options) {
  return convert::encodeStl(levels.front(), options.stlSolids);
}
template <std::string (*encode)(const convert::SurfaceMesh&)>
std::string encodePlain(const Levels& levels, const convert::WriteMeshOptions&) {
  return encode(levels.front());
}

/// The encoder of a mesh format: the case's surface as triangles, encoded.
template <std::string (*encode)(const Levels&, const convert::WriteMeshOptions&)>
EncodedCase encodeMeshAs(const formats::Case& value, const fs::path& file,
                         const OutputOptions& options, Progress& progress) {
  operations::SurfaceOptions surface = options.surface;
  surface.closed.levels = 1;
  operations::Surface mesh =
      operations::surfaceOf(value, surface, file.string(), operationContext(progress));
  return {encode(mesh.levels, options.mesh), {std::move(mesh.report), {}}};
}

/// The encoder of volume meshes.
EncodedCase encodeCells(const formats::Case& value, const fs::path& file,
                        const OutputOptions& options, Progress& progress) {
  operations::VolumeMesh made = operations::volumeMeshOf(
      value, options.surface.closed, options.cells, file.string(), operationContext(progress));
  return {convert::encodeVtu(made.mesh), {std::move(made.surface), made.cells}};
}

/// The encoder of glTF, which alone holds the motion of a case.
template <bool binary>
EncodedCase encodeGltfAs(const formats::Case& value, const fs::path& file,
                         const OutputOptions& options, Progress& progress) {
  operations::Surface mesh =
      operations::surfaceOf(value, options.surface, file.string(), operationContext(progress));
  std::optional<convert::MeshSkin> skin;
  if (value.motion && options.mesh.skin) skin = convert::skinOf(value, mesh.levels);
  return {convert::encodeGltf(mesh.levels, binary, options.mesh, skin ? &*skin : nullptr),
          {std::move(mesh.report), {}}};
}

constexpr auto kEncodeGlb = encodeGltfAs<true>;
constexpr auto kEncodeGltf = encodeGltfAs<false>;
constexpr auto kEncodeVtp = encodeMeshAs<encodePlain<convert::encodeVtp>>;
constexpr auto kEncodeObj = encodeMeshAs<encodePlain<convert::encodeObj>>;
constexpr auto kEncodeStl = encodeMeshAs<encodeStl>;
constexpr auto kEncodePly = encodeMeshAs<encodePlain<convert::encodePly>>;

/// The encoder of a centerline format: the case's tree, encoded. A network holds links, too.
template <std::string (*encode)(const formats::CenterlineTree&), bool isNetwork = false>
EncodedCase encodeTreeAs(const formats::Case& value, const fs::path& file, const OutputOptions&,
                         Progress& progress) {
  for (const std::string& loss : treeLosses(value.tree, "this format", isNetwork))
    warn(progress, about(formats::printable(file.string()), {WarningCode::FormatLoss, loss}));
  return {encode(value.tree), {}};
}

// clang-format off
std::vector<FileFormat> makeTable() {
  using enum FormatKind;
  return {
      // cases
      {.name = "lumen", .title = "a case", .kind = Case, .endings = {".lumen"},
       .readCase = readCase, .encodeCase = encodeCaseAs<formats::CaseEncoding::Binary>},
      {.name = "lumen.json", .title = "a case", .kind = Case, .endings = {".lumen.json", ".json"},
       .readCase = readCase, .encodeCase = encodeCaseAs<formats::CaseEncoding::Json>},
      // meshes
      {.name = "glb", .title = "glTF", .kind = Mesh, .endings = {".glb"},
       .readMesh = readMeshAs<MeshFormat::Gltf>, .encodeCase = kEncodeGlb},
      {.name = "gltf", .title = "glTF", .kind = Mesh, .endings = {".gltf"},
       .readMesh = readMeshAs<MeshFormat::Gltf>, .encodeCase = kEncodeGltf},
      {.name = "vtp", .title = "VTK", .kind = Mesh, .endings = {".vtp"},
       .readMesh = readMeshAs<MeshFormat::Vtp>, .encodeCase = kEncodeVtp},
      {.name = "vtk", .title = "VTK", .kind = Mesh, .endings = {".vtk"}, .readMesh = readMeshAs<MeshFormat::Vtk>},
      {.name = "obj", .title = "OBJ", .kind = Mesh, .endings = {".obj"},
       .readMesh = readMeshAs<MeshFormat::Obj>, .encodeCase = kEncodeObj},
      {.name = "stl", .title = "STL", .kind = Mesh, .endings = {".stl"},
       .readMesh = readMeshAs<MeshFormat::Stl>, .encodeCase = kEncodeStl},
      {.name = "ply", .title = "PLY", .kind = Mesh, .endings = {".ply"},
       .readMesh = readMeshAs<MeshFormat::Ply>, .encodeCase = kEncodePly},
      {.name = "scn", .title = "a scene of SOFA", .kind = Mesh, .endings = {".scn"},
       .readMesh = readVesselsOfScene, .readScene = readSceneMesh},
      {.name = "dicom-surface", .title = "surfaces of DICOM", .kind = Mesh, .endings = {".surface.dcm"},
       .readMesh = readMeshAs<MeshFormat::DicomSurface>},
      {.name = "vtu", .title = "cells of VTK", .kind = VolumeMesh, .endings = {".vtu"}, .encodeCase = encodeCells},
      // centerlines
      {.name = "swc", .title = "SWC", .kind = Centerline, .endings = {".swc"}, .readCenterline = convert::readSwc,
       .encodeCase = encodeTreeAs<convert::encodeSwc>},
      {.name = "tre", .title = "TubeTK", .kind = Centerline, .endings = {".tre"}, .readCenterline = convert::readTre,
       .encodeCase = encodeTreeAs<convert::encodeTre>},
      {.name = "centerline.vtp", .title = "VTK lines", .kind = Centerline, .endings = {".centerline.vtp"},
       .readCenterline = convert::readVtpCenterline, .encodeCase = encodeTreeAs<convert::encodeVtpCenterline>},
      {.name = "centerline.vtk", .title = "VTK lines", .kind = Centerline, .endings = {".centerline.vtk"},
       .readCenterline = convert::readVtkCenterline},
      {.name = "mrk.json", .title = "Slicer curves", .kind = Centerline, .endings = {".mrk.json"},
       .readCenterline = convert::readCurves, .holds = convert::hasCurves, .encodeCase = encodeTreeAs<convert::encodeCurves>},
      {.name = "simvascular", .title = "SimVascular", .kind = Centerline, .endings = {".ctgr", ".pth"},
       .readCenterline = convert::readSimVascular, .holds = convert::hasSimVascular},
      {.name = "graphml", .title = "GraphML", .kind = Centerline, .endings = {".graphml"},
       .readCenterline = convert::readGraphml, .encodeCase = encodeTreeAs<convert::encodeGraphml, true>},
      {.name = "csv", .title = "tables of nodes and edges", .kind = Centerline, .endings = {".csv", ".tsv"},
       .readCenterline = convert::readGraphCsv, .holds = convert::hasGraphTables},
      {.name = "am", .title = "Amira", .kind = Centerline, .endings = {".am"},
       .readCenterline = convert::readSpatialGraph, .encodeCase = encodeTreeAs<convert::encodeSpatialGraph, true>},
      {.name = "vmv", .title = "VessMorphoVis", .kind = Centerline, .endings = {".vmv"},
       .readCenterline = convert::readVmv, .encodeCase = encodeTreeAs<convert::encodeVmv, true>},
      // volumes
      {.name = "nrrd", .title = "NRRD", .kind = Volume, .endings = {".nrrd"},
       .readVolume = readVolumeAs<VolumeFormat::Nrrd>, .readVolumeHeader = readHeaderAs<VolumeFormat::Nrrd>,
       .encodeVolume = encodeVolumeAs<VolumeFormat::Nrrd, true>},
      {.name = "nhdr", .title = "NRRD", .kind = Volume, .endings = {".nhdr"},
       .readVolume = readVolumeAs<VolumeFormat::Nrrd>, .readVolumeHeader = readHeaderAs<VolumeFormat::Nrrd>},
      {.name = "nii", .title = "NIfTI", .kind = Volume, .endings = {".nii"},
       .readVolume = readVolumeAs<VolumeFormat::Nifti>, .readVolumeHeader = readHeaderAs<VolumeFormat::Nifti>,
       .encodeVolume = encodeVolumeAs<VolumeFormat::Nifti, false>},
      {.name = "nii.gz", .title = "NIfTI", .kind = Volume, .endings = {".nii.gz"},
       .readVolume = readVolumeAs<VolumeFormat::Nifti>, .readVolumeHeader = readHeaderAs<VolumeFormat::Nifti>,
       .encodeVolume = encodeVolumeAs<VolumeFormat::Nifti, true>},
      {.name = "mha", .title = "MetaImage", .kind = Volume, .endings = {".mha"},
       .readVolume = readVolumeAs<VolumeFormat::MetaImage>, .readVolumeHeader = readHeaderAs<VolumeFormat::MetaImage>,
       .encodeVolume = encodeVolumeAs<VolumeFormat::MetaImage, true>},
      {.name = "mhd", .title = "MetaImage", .kind = Volume, .endings = {".mhd"},
       .readVolume = readVolumeAs<VolumeFormat::MetaImage>, .readVolumeHeader = readHeaderAs<VolumeFormat::MetaImage>},
      {.name = "dicom", .title = "a folder of DICOM", .kind = Volume,
       .readVolume = readVolumeAs<VolumeFormat::Dicom>, .readVolumeHeader = readHeaderAs<VolumeFormat::Dicom>},
  };
}
// clang-format on

const FileFormat* findByName(std::string_view name) {
  for (const FileFormat& format : fileFormats())
    if (format.name == name) return &format;
  return nullptr;
}

/// The format that a folder is read as.
const FileFormat* findFolder(const InputFile& folder) {
  if (!folder.isInMemory())
    for (const FileFormat& format : fileFormats())
      if (format.holds != nullptr && format.holds(folder.path())) return &format;
  for (const FileFormat& format : fileFormats())
    if (format.endings.empty()) return &format;
  return nullptr;
}

/// The format of a file whose name may stand for several kinds.
const FileFormat* findByContent(const InputFile& file) {
  const convert::FileContent content = convert::detectContent(file);
  const std::string ending = lowerCase(file.path().extension().string());
  if (ending == ".vtp" && content.kind == convert::ContentKind::Centerline)
    return findByName("centerline.vtp");
  if (convert::isDicom(content)) return findByName("dicom");
  if (content.name == "a mesh (DICOM)") return findByName("dicom-surface");
  return ending == ".vtk" && convert::holdsLegacyLines(file) ? findByName("centerline.vtk")
                                                             : nullptr;
}

/// The format with the longest ending that the name of a file has, and the size of that ending.
std::pair<const FileFormat*, std::size_t> endingOf(const fs::path& path) {
  const std::string file = lowerCase(path.filename().string());
  std::pair<const FileFormat*, std::size_t> best{};
  for (const FileFormat& format : fileFormats())
    for (const std::string_view ending : format.endings)
      if (ending.size() > best.second && file.size() > ending.size() && file.ends_with(ending))
        best = {&format, ending.size()};
  return best;
}

const FileFormat* findByEnding(const fs::path& path) {
  return endingOf(path).first;
}

/// `text(format)` of each format that passes `test`, each text once.
template <class Text>
std::vector<std::string> listed(FormatTest test, Text text) {
  std::vector<std::string> words;
  for (const FileFormat& format : fileFormats()) {
    if (!test(format)) continue;
    const std::string word(text(format));
    if (!word.empty() && std::find(words.begin(), words.end(), word) == words.end())
      words.push_back(word);
  }
  return words;
}

std::vector<std::string> namesWhere(FormatTest test) {
  return listed(test, [](const FileFormat& format) { return format.name; });
}

std::vector<std::string> endingsWhere(FormatTest test) {
  return listed(test, [](const FileFormat& format) {
    return format.endings.empty() ? std::string_view() : format.endings.front();
  });
}

/// `format` if it is not null and passes `test`.
const FileFormat& require(const FileFormat* format, const fs::path& path, std::string_view override,
                          FormatTest test, const std::string& verb, const std::string& option) {
  if (format != nullptr && test(*format)) return *format;
  const std::string known = "; lumen " + verb + "s " + formatNames(test);
  if (!override.empty())
    throw unsupported(option + " " + std::string(override) + ": lumen cannot " + verb +
                      " this format" + known + didYouMean(override, namesWhere(test)));
  if (format != nullptr)
    throw unsupported(path.string() + ": lumen cannot " + verb + " the format " +
                      std::string(format->name) + known);
  throw unsupported(path.string() + ": the name's ending is not that of a format that lumen " +
                    verb + "s" + known + " (" + option + " chooses one whatever the name)" +
                    didYouMean(path.extension().string(), endingsWhere(test)));
}

/// Refuses an input whose format its content shows, though its name does not.
void refuseByContent(const InputFile& file) {
  const fs::path& path = file.path();
  const convert::FileContent content = convert::detectContent(file);
  if (content.kind == convert::ContentKind::Volume || content.kind == convert::ContentKind::Case ||
      content.kind == convert::ContentKind::Mesh ||
      content.kind == convert::ContentKind::Centerline)
    throw unsupported(path.string() + ": " + content.sentence() +
                      ", but its name does not show it; --from states the format, one of " +
                      formatNames(canRead));
  if (content.kind != convert::ContentKind::Unknown)
    throw unsupported(path.string() + ": " + convert::notA(convert::ContentKind::Volume, file));
}

std::string joined(const std::vector<std::string>& words, const std::string& last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? last : ", ";
    text += words[i];
  }
  return text;
}

}  // namespace

MeshReports FileFormat::writeCase(const formats::Case& value, const OutputFile& file,
                                  const OutputOptions& options, Progress& progress) const {
  EncodedCase encoded = encodeCase(value, file.path(), options, progress);
  writeText(encoded.bytes, file);
  return std::move(encoded.reports);
}

void FileFormat::writeVolume(const convert::Volume& volume, const OutputFile& file) const {
  writeText(encodeVolume(volume, file.path()), file);
}

const std::vector<FileFormat>& fileFormats() {
  static const std::vector<FileFormat> table = makeTable();
  return table;
}

std::size_t longestEnding(const std::string& name) {
  return endingOf(name).second;
}

convert::ContentKind contentKind(const FileFormat& format) {
  switch (format.kind) {
    case FormatKind::Volume:
      return convert::ContentKind::Volume;
    case FormatKind::Mesh:
    case FormatKind::VolumeMesh:
      return convert::ContentKind::Mesh;
    case FormatKind::Centerline:
      return convert::ContentKind::Centerline;
    case FormatKind::Case:
      break;
  }
  return convert::ContentKind::Case;
}

bool canRead(const FileFormat& format) {
  return format.readCase != nullptr || format.readVolume != nullptr || canReadMesh(format) ||
         canReadCenterline(format);
}

bool canReadVolume(const FileFormat& format) {
  return format.readVolume != nullptr;
}

bool canReadMesh(const FileFormat& format) {
  return format.readMesh != nullptr;
}

bool canReadCenterline(const FileFormat& format) {
  return format.readCenterline != nullptr;
}

bool canWriteCenterline(const FileFormat& format) {
  return format.kind == FormatKind::Centerline && canWrite(format);
}

bool canWrite(const FileFormat& format) {
  return format.encodeCase != nullptr;
}

bool canWriteCase(const FileFormat& format) {
  return format.kind == FormatKind::Case && canWrite(format);
}

bool canWriteMesh(const FileFormat& format) {
  return format.kind == FormatKind::Mesh && canWrite(format);
}

bool canWriteVolumeMesh(const FileFormat& format) {
  return format.kind == FormatKind::VolumeMesh && canWrite(format);
}

bool needsModels(const FileFormat& format) {
  return canWriteMesh(format) || canWriteVolumeMesh(format);
}

bool canWriteVolume(const FileFormat& format) {
  return format.encodeVolume != nullptr;
}

std::string formatNames(FormatTest test) {
  return joined(namesWhere(test), ", ");
}

std::string formatEndings(FormatTest test) {
  return joined(endingsWhere(test), " or ");
}

std::string formatTitles(FormatTest test) {
  return joined(listed(test, [](const FileFormat& format) { return format.title; }), " or ");
}

const FileFormat& inputFormat(const InputFile& file, std::string_view override) {
  const fs::path& path = file.path();
  const FileFormat* format = !override.empty() ? findByName(override)
                             : file.isFolder() ? findFolder(file)
                                               : findByContent(file);
  if (format == nullptr && override.empty()) format = findByEnding(path);
  if (override.empty() && (format == nullptr || !canRead(*format))) refuseByContent(file);
  return require(format, path, override, canRead, "read", "--from");
}

const FileFormat& outputFormat(const OutputFile& file, std::string_view override) {
  const fs::path& path = file.path();
  if (std::error_code ignored; file.bytes() == nullptr && fs::is_directory(path, ignored))
    throw failed(path.string() + ": this is a folder, but the output must be a file");
  const FileFormat* format = override.empty() ? findByEnding(path) : findByName(override);
  return require(format, path, override, canWrite, "write", "--to");
}

const FileFormat& caseOutputFormat(const OutputFile& file, std::string_view override,
                                   const std::string& what) {
  const FileFormat& format = outputFormat(file, override);
  if (canWriteCase(format)) return format;
  throw unsupported(file.name() + ": " + what + " is written as a case, " +
                    formatEndings(canWriteCase));
}

const FileFormat& volumeOutputFormat(const OutputFile& file, const std::string& what) {
  const FileFormat* format = findByEnding(file.path());
  if (format != nullptr && canWriteVolume(*format)) return *format;
  throw unsupported(file.name() + ": " + what + " is written as " + formatEndings(canWriteVolume));
}

std::string numberedName(const std::string& path, const FileFormat& format, std::size_t number) {
  constexpr std::size_t kDigits = 2;
  std::size_t end = path.size();
  for (const std::string_view ending : format.endings)
    if (path.size() > ending.size() &&
        lowerCase(path.substr(path.size() - ending.size())) == ending)
      end = std::min(end, path.size() - ending.size());
  return path.substr(0, end) + "-" + paddedNumber(number, kDigits) + path.substr(end);
}

}  // namespace lumen::engine
