// SPDX-License-Identifier: Apache-2.0
// The table of formats: all that the command line knows of one is its row. Help, errors, the loss
// report and shell completion are made from the table.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "converters/base/memory_files.h"
#include "converters/base/progress.h"
#include "converters/engine/scene_input.h"
#include "converters/io/centerline/centerline_file.h"
#include "converters/io/content/file_content.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/io/mesh/write_options.h"
#include "converters/io/volume/read_volume.h"
#include "converters/operations/volume_mesh_of.h"
#include "formats/case/case.h"
#include "formats/case/case_file.h"

namespace lumen::engine {

enum class FormatKind { Volume, Case, Mesh, VolumeMesh, Centerline };

/// Options for writing a case; each format takes those that concern it.
struct OutputOptions {
  formats::EncodeOptions encoding;
  operations::SurfaceOptions surface;
  convert::WriteMeshOptions mesh;
  convert::VolumeMeshOptions cells;
};

/// Facts of a mesh that was made of a case.
struct MeshReports {
  std::optional<convert::SurfaceReport> surface;   ///< of a closed surface
  std::optional<convert::VolumeMeshReport> cells;  ///< of a volume mesh
};

/// A case, its surface, its inside or its tree as the bytes of a file.
struct EncodedCase {
  std::string bytes;
  MeshReports reports{};
};

/// One row. A function is null where the format cannot do its work; each throws lumen::Error with
/// the file's name.
struct FileFormat {
  using CaseReader = formats::Case (*)(const InputFile&);
  using VolumeReader = convert::Volume (*)(const InputFile&, const convert::ReadVolumeOptions&,
                                           const Progress&);
  using VolumeHeaderReader = convert::VolumeHeader (*)(const InputFile&,
                                                       const convert::ReadVolumeOptions&,
                                                       const Progress&);
  using CenterlineReader = convert::CenterlineFile (*)(const InputFile&);
  using MeshReader = convert::MeshFile (*)(const InputFile&);
  using SceneReader = convert::MeshFile (*)(const InputFile&, const SceneArguments&);
  using FolderTest = bool (*)(const std::filesystem::path&);
  using CaseEncoder = EncodedCase (*)(const formats::Case&, const std::filesystem::path&,
                                      const OutputOptions&, Progress&);
  using VolumeEncoder = std::string (*)(const convert::Volume&, const std::filesystem::path&);

  std::string_view name;   ///< as --from and --to take it
  std::string_view title;  ///< as a help text calls it; rows of one title are listed once
  FormatKind kind;
  std::vector<std::string_view> endings{};  ///< endings of a name, lower case; empty: a folder
  CaseReader readCase = nullptr;
  VolumeReader readVolume = nullptr;
  VolumeHeaderReader readVolumeHeader = nullptr;  ///< wherever readVolume is
  MeshReader readMesh = nullptr;
  CenterlineReader readCenterline = nullptr;
  SceneReader readScene = nullptr;  ///< for files with several meshes, or that name others
  FolderTest holds = nullptr;       ///< whether a folder's files are of this format, as one input
  // The bytes of a file. Its name serves messages, and nothing is written.
  CaseEncoder encodeCase = nullptr;
  VolumeEncoder encodeVolume = nullptr;

  /// Writes what encodeCase gives atomically. The reports are those of the mesh, if one was made.
  MeshReports writeCase(const formats::Case& value, const OutputFile& file,
                        const OutputOptions& options, Progress& progress) const;
  /// Writes what encodeVolume gives atomically.
  void writeVolume(const convert::Volume& volume, const OutputFile& file) const;
};

const std::vector<FileFormat>& fileFormats();

/// Size of the ending that makes a file of this name one of a format; 0 if none does.
std::size_t longestEnding(const std::string& name);

/// Kind of content of a file of this format.
convert::ContentKind contentKind(const FileFormat& format);

/// Whether a format belongs in a list of formats.
using FormatTest = bool (*)(const FileFormat&);
bool canRead(const FileFormat& format);
bool canReadVolume(const FileFormat& format);
bool canReadMesh(const FileFormat& format);
bool canReadCenterline(const FileFormat& format);
bool canWrite(const FileFormat& format);  ///< a case, in whatever form
bool canWriteCase(const FileFormat& format);
bool canWriteMesh(const FileFormat& format);
bool canWriteVolumeMesh(const FileFormat& format);
bool needsModels(const FileFormat& format);  ///< a mesh of either kind, which is made of models
bool canWriteCenterline(const FileFormat& format);
bool canWriteVolume(const FileFormat& format);

/// The formats that pass `test`, for a sentence: names "lumen, lumen.json, obj", endings ".lumen,
/// .lumen.json or .obj", titles "NRRD, NIfTI or a folder of DICOM".
std::string formatNames(FormatTest test);
std::string formatEndings(FormatTest test);
std::string formatTitles(FormatTest test);

/// The format that `override` names if it is not empty, otherwise that of the path's name. Throws
/// Error(Unsupported) if there is none that can be read (or written as a case, or as a volume); the
/// message lists those that can. `what` is the subject of a sentence, such as "the truth".
const FileFormat& inputFormat(const InputFile& file, std::string_view override);
const FileFormat& outputFormat(const OutputFile& file, std::string_view override);
const FileFormat& caseOutputFormat(const OutputFile& file, std::string_view override,
                                   const std::string& what);
const FileFormat& volumeOutputFormat(const OutputFile& file, const std::string& what);

/// A name of this format with a number of at least two digits before its ending: "beat-03.nii.gz".
std::string numberedName(const std::string& path, const FileFormat& format, std::size_t number);

}  // namespace lumen::engine
