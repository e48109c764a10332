// SPDX-License-Identifier: Apache-2.0
// The surface of vessels as an input: its file, its unit, and the centerline that it may come with.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "converters/base/progress.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_format.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/stages/repair/unit_guess.h"
#include "converters/stages/trees_from_surfaces/case_of_mesh.h"

namespace lumen::engine {

/// The user's statements about a mesh.
struct MeshArguments {
  std::string unit;             ///< empty: the file's, or the one that makes vessels plausible
  std::string centerline;       ///< a file; empty: the tree is found
  std::string centerlineFrame;  ///< lps or ras; empty: the file's, or the mesh's
  std::string centerlineUnit;   ///< empty: the file's, or the mesh's
  SceneArguments scene;         ///< options of a scene
};

/// Unit and axes that were taken for a mesh.
struct MeshFrame {
  std::string unit;          ///< mm, cm, m or um
  std::string unitFrom;      ///< "option", "file" or "guess"
  bool frameStated = false;  ///< the file names its axes

  /// "mm, by its size".
  [[nodiscard]] std::string unitText() const;
  /// "LPS", or "not stated; taken as LPS".
  [[nodiscard]] std::string axesText() const;
};

/// A line for the answer; empty without a mesh.
std::string meshFrameLine(const std::optional<MeshFrame>& frame);
/// The frame as an object; null without a mesh.
Json meshFrameJson(const std::optional<MeshFrame>& frame);

/// The case of a mesh, and the frame that the mesh was taken to have.
struct CaseOfMeshFile {
  formats::Case value;
  MeshFrame frame;
};

/// The unit of a mesh of this size whose file states none. Warns where another unit is plausible,
/// too, where it is not mm, and where none is plausible.
convert::UnitGuess guessUnitOf(const convert::VesselSize& size, const std::filesystem::path& file,
                               const convert::MeshFile& read, Progress& progress);

/// Tree and wall points of the mesh in `file`. Repairs and assumptions become warnings. Throws
/// Error(InvalidInput) for a mesh that is no surface of vessels, and for a centerline that does not
/// belong to it.
CaseOfMeshFile caseOfMeshFile(const std::filesystem::path& file, const FileFormat& format,
                              const MeshArguments& arguments, Progress& progress);

}  // namespace lumen::engine
