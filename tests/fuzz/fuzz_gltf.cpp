// SPDX-License-Identifier: Apache-2.0
// Meshes as glTF.
#include "fuzz/fuzz_support.h"
#include "fuzz/mesh_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lumen::fuzz::checkMesh(data, size, lumen::convert::MeshFormat::Gltf);
  return 0;
}
