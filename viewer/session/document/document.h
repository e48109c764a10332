// SPDX-License-Identifier: Apache-2.0
// The open document at one moment. Its parts never change: a change makes other parts and another
// document, so any number of threads and of moments of the history share parts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "converters/io/labels/label_meaning.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/io/seeds/seeds.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::viewer {

enum class FileRole : std::uint8_t { Volume, Second, Labels, Case, Truth, Seeds, Mesh };

/// The word for a role, as the state has it.
std::string roleName(FileRole role);

/// The version of a file that was read: a file with another stamp was written since.
struct FileStamp {
  std::int64_t time = 0;  ///< time of its last change, ns
  std::uintmax_t size = 0;
  std::uintmax_t serial = 0;  ///< inode
  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

/// Zeros for a file that is not there.
FileStamp readFileStamp(const std::filesystem::path& file);

struct OpenFile {
  int id = 0;
  FileRole role = FileRole::Volume;
  std::string label;           ///< for people; any text
  std::filesystem::path path;  ///< empty for a dropped file
  FileStamp stamp;
  std::string series{};  ///< instance UID, of a folder of DICOM
};

struct OpenMesh {
  int id = 0;  ///< id of its file
  std::string label;
  std::shared_ptr<const convert::MeshFile> mesh;  ///< in mm
};

/// A label map beside the volume, and the labels that its voxels have by ascending values, each with
/// the number of these voxels.
struct OpenLabels {
  std::shared_ptr<const convert::Volume> voxels;
  std::vector<std::pair<convert::LabelMeaning, std::size_t>> labels;
};

using Seeds = std::vector<convert::SeedBranch>;

/// A missing part is null, except `seeds`.
struct Document {
  std::shared_ptr<const convert::Volume> volume;
  std::shared_ptr<const formats::SourceVolume> volumeSource;  ///< of `volume`
  /// A volume to look at beside the first; nothing is tracked in it, and no case takes anything of
  /// it.
  std::shared_ptr<const convert::Volume> second;
  std::shared_ptr<const formats::SourceVolume> secondSource;  ///< of `second`
  std::shared_ptr<const OpenLabels> labels;  ///< states what lies where in `volume`
  std::shared_ptr<const formats::Case> value;
  std::shared_ptr<const formats::Case> truth;
  std::shared_ptr<const Seeds> seeds = std::make_shared<const Seeds>();
  /// Vessels that were found and wait to be accepted (proposals.h): tree and wall points.
  std::shared_ptr<const formats::Case> proposals;
  std::vector<OpenMesh> meshes;
  std::vector<OpenFile> files;

  [[nodiscard]] bool hasModels() const { return value && value->models.has_value(); }
  /// The label of the first file of that role; empty if there is none.
  [[nodiscard]] std::string labelOf(FileRole role) const;
  /// The file of that role, or null.
  [[nodiscard]] const OpenFile* fileOf(FileRole role) const;
};

/// Labels of the vessels of a case, or none for null: a seed with one of them is tracked. They live as
/// the case does.
std::set<std::string_view> vesselLabels(const std::shared_ptr<const formats::Case>& value);

/// The labels of the vessels and of the seeds of a document.
std::set<std::string> takenLabels(const Document& document);

/// The stem with the first number that makes a label that is not `taken`.
std::string numberedLabel(const std::string& stem, const std::set<std::string>& taken);

/// Bytes in memory of the parts of these documents, each part once.
std::size_t countBytes(const std::vector<const Document*>& documents);

}  // namespace lumen::viewer
