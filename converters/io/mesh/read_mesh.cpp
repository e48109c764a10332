// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/read_mesh.h"

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "formats/container/printable.h"

namespace lumen::convert {

MeshFile readMesh(const InputFile& file, MeshFormat format) {
  const std::string name = formats::printable(file.path().string());
  if (format == MeshFormat::DicomSurface) return readDicomSurface(file, name);
  const std::string bytes = file.read("mesh", kAnySize);
  switch (format) {
    case MeshFormat::Stl:
      return parseStl(bytes, name);
    case MeshFormat::Obj:
      return parseObj(bytes, name);
    case MeshFormat::Ply:
      return parsePly(bytes, name);
    case MeshFormat::Gltf:
      return parseGltf(bytes, file);
    case MeshFormat::Vtp:
      return parseVtp(bytes, name);
    case MeshFormat::Vtk:
      return parseVtk(bytes, name);
    case MeshFormat::DicomSurface:
      break;
  }
  throw unsupported(name + ": lumen cannot read meshes of this format");
}

}  // namespace lumen::convert
