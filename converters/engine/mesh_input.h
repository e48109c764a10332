// SPDX-License-Identifier: Apache-2.0
// The surface of vessels as an input: its file, its unit, and the centerline that it may come with.
#pragma once

#include <filesystem>
#include <string>

#include "converters/base/progress.h"
#include "converters/engine/file_format.h"
#include "converters/stages/trees_from_surfaces/case_of_mesh.h"

namespace lumen::engine {

/// What a user says of a mesh.
struct MeshArguments {
  std::string unit;             ///< empty: as its file says, or what makes vessels plausible
  std::string centerline;       ///< a file; empty: the tree is found
  std::string centerlineFrame;  ///< lps or ras; empty: as its file says, or the mesh's
  std::string centerlineUnit;   ///< empty: as its file says, or the mesh's
  SceneArguments scene;         ///< of a scene
};

/// Tree and wall points of the mesh in `file`. What had to be repaired or assumed becomes warnings. Throws
/// Error(InvalidInput) for what is no surface of vessels, and for a centerline that is not one of it.
formats::Case caseOfMeshFile(const std::filesystem::path& file, const FileFormat& format,
                             const MeshArguments& arguments, Progress& progress);

}  // namespace lumen::engine
