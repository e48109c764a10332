// SPDX-License-Identifier: Apache-2.0
// Our meshes as OpenMesh's, for its readers and its decimation.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::test {

struct MeshTraits : OpenMesh::DefaultTraits {
  VertexAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
};
using TriMesh = OpenMesh::TriMesh_ArrayKernelT<MeshTraits>;

/// A face that would make the mesh no manifold is left out.
inline TriMesh toOpenMesh(const convert::SurfaceMesh& source) {
  TriMesh mesh;
  for (std::size_t v = 0; v < source.position.size(); ++v) {
    const auto handle = mesh.add_vertex(TriMesh::Point(source.position[v].data()));
    mesh.set_normal(handle, TriMesh::Normal(source.normal[v].data()));
  }
  const auto handleOf = [](std::uint32_t v) { return TriMesh::VertexHandle(static_cast<int>(v)); };
  for (const convert::Triangle& t : source.triangle)
    mesh.add_face(handleOf(t[0]), handleOf(t[1]), handleOf(t[2]));
  return mesh;
}

}  // namespace lumen::test
