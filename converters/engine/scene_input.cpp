// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/scene_input.h"

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/text.h"
#include "converters/base/vectors.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/io/mesh/sofa_scene.h"
#include "converters/io/volume/detached_data.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace fs = std::filesystem;

convert::MeshFile readSceneMesh(const InputFile& file, const SceneArguments& arguments) {
  const std::string name = formats::printable(file.path().string());
  const std::vector<convert::SofaLoader> loaders =
      convert::sofaLoaders(file.read("scene", kAnySize), name);
  const convert::SofaLoader& loader = convert::vesselLoader(loaders, arguments.mesh, name);
  const fs::path mesh =
      convert::detachedFiles(file, convert::namesOfList({loader.filename}),
                             {arguments.allowDetached.begin(), arguments.allowDetached.end()},
                             optionWord(), "the vessels' mesh is")
          .front();
  const bool isObj = lowerCase(loader.component) == "meshobjloader";
  convert::MeshFile read =
      convert::readMesh(mesh, isObj ? convert::MeshFormat::Obj : convert::MeshFormat::Stl);
  for (Eigen::Vector3d& p : read.mesh.position) {
    p = loader.toScene * p;
    if (!isWithin(p, 1e12))
      throw invalidInput(name + ": line " + std::to_string(loader.line) +
                         ": places the mesh farther away than 1e12");
  }
  read.notes.push_back(
      "the vessels are " + formats::printable(loader.filename) + ", loaded by " +
      formats::printable(loader.name) + " in " + formats::printable(loader.node) +
      (loader.isMovedTwice ? ", placed by it and by the MechanicalObject there" : ""));
  return read;
}

}  // namespace lumen::engine
