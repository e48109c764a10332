// SPDX-License-Identifier: Apache-2.0
// Meshes as VTK's legacy files.
#include "fuzz/fuzz_support.h"
#include "fuzz/mesh_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lumen::fuzz::checkMesh(data, size, lumen::convert::MeshFormat::Vtk);
  return 0;
}
