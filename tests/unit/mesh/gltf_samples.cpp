// SPDX-License-Identifier: Apache-2.0
// Writes the files that the glTF validator looks at: gltf_samples DIRECTORY
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include "converters/mesh/write_gltf.h"
#include "converters/surface/polygonise.h"
#include "synthetic.h"

namespace {

void write(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  using namespace lumen;
  const std::filesystem::path folder(argv[1]);
  formats::Case tree = test::tubeCase(6);
  test::addVessel(tree, "c\u00f4t\u00e9 \"B\"", test::straightPath({3, 1.3, 0}, {0.1, 0.7, 0}, 5),
                  0.6, 1.2, 3);
  test::addModels(tree);
  try {
    std::filesystem::create_directories(folder);
    Progress progress;
    const auto meshes = convert::polygonise(tree, {}, progress);
    write(folder / "tree.glb", convert::encodeGltf(meshes, true, {}));
    write(folder / "tree.gltf", convert::encodeGltf(meshes, false, {}));
    write(folder / "draco.glb", convert::encodeGltf(meshes, true, {.draco = true}));
    write(folder / "draco.gltf", convert::encodeGltf(meshes, false, {.draco = true}));
    // More vertices than 16-bit indices reach.
    const auto fine = convert::polygonise(test::sphereCase(1.0, 0.43), {0.015}, progress);
    if (fine[0].position.size() <= 65536) return 1;
    write(folder / "fine.glb", convert::encodeGltf(fine, true, {}));
    write(folder / "fine_draco.glb", convert::encodeGltf(fine, true, {.draco = true}));
    write(folder / "empty.glb", convert::encodeGltf({}, true, {.draco = true}));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
