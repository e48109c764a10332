// SPDX-License-Identifier: Apache-2.0
// The vessels' mesh of a scene of SOFA.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "converters/base/input_file.h"
#include "converters/io/mesh/read_mesh.h"

namespace lumen::engine {

/// The user's statements about a scene.
struct SceneArguments {
  std::string mesh;                        ///< --mesh; empty: the one that the scene shows it is
  std::vector<std::string> allowDetached;  ///< files and folders besides the scene's own
};

/// The mesh that `file` loads as its vessels, where the scene places it; its axes are taken as LPS.
/// Throws Error(InvalidInput) and Error(Unsupported) for a file that is no scene, does not state
/// which mesh the vessels are, or takes it from elsewhere than it may; and as the mesh's reader.
convert::MeshFile readSceneMesh(const InputFile& file, const SceneArguments& arguments);

}  // namespace lumen::engine
