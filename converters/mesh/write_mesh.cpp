// SPDX-License-Identifier: Apache-2.0
#include <span>

#include "converters/common/error.h"
#include "converters/mesh/encode_mesh.h"
#include "formats/case/case_file.h"

namespace lumen::convert {
namespace {

std::string encode(const std::vector<BranchMesh>& meshes, const std::string& format,
                   const WriteMeshOptions& options) {
  if (format == "glb" || format == "gltf") return encodeGltf(meshes, format == "glb", options);
  if (format == "obj") return encodeObj(meshes);
  if (format == "stl") return encodeStl(meshes);
  if (format == "ply") return encodePly(meshes);
  throw unsupported("mesh format \"" + format +
                    "\" is unknown: expected one of glb, gltf, obj, stl, ply");
}

}  // namespace

void writeMesh(const std::vector<BranchMesh>& meshes, const std::filesystem::path& file,
               const std::string& format, const WriteMeshOptions& options) {
  const std::string bytes = encode(meshes, format, options);
  const auto written = formats::writeFileAtomically(std::as_bytes(std::span(bytes)), file);
  if (!written) throw failed(file.string() + ": " + written.error().text());
}

}  // namespace lumen::convert
