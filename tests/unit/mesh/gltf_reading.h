// SPDX-License-Identifier: Apache-2.0
// Parts of a glTF file that tests read, by tinygltf.
#pragma once

#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include "converters/io/mesh/surface_mesh.h"
#include "converters/io/mesh/write_gltf.h"

namespace lumen::test {

inline std::string gltfOf(const convert::SurfaceMesh& surface,
                          const convert::WriteMeshOptions& options = {}, bool binary = true) {
  return convert::encodeGltf(std::span(&surface, 1), binary, options);
}

inline tinygltf::Model loadGltf(const std::string& bytes, bool binary = true) {
  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  const auto size = static_cast<unsigned>(bytes.size());
  const bool loaded =
      binary
          ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                        reinterpret_cast<const unsigned char*>(bytes.data()), size)
          : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, "");
  EXPECT_TRUE(loaded) << error;
  EXPECT_EQ(warning, "");
  return model;
}

/// The values of an accessor, each of type T.
template <class T>
std::vector<T> valuesOf(const tinygltf::Model& model, int accessor) {
  const auto& a = model.accessors.at(static_cast<std::size_t>(accessor));
  const auto& view = model.bufferViews.at(static_cast<std::size_t>(a.bufferView));
  const int stride = a.ByteStride(view);
  EXPECT_GE(static_cast<std::size_t>(stride), sizeof(T));
  std::vector<T> values(a.count);
  for (std::size_t i = 0; i < a.count; ++i)
    std::memcpy(&values[i],
                model.buffers[0].data.data() + view.byteOffset + a.byteOffset +
                    i * static_cast<std::size_t>(stride),
                sizeof(T));
  return values;
}

inline std::vector<std::uint32_t> indicesOf(const tinygltf::Model& model, int accessor) {
  const int type = model.accessors.at(static_cast<std::size_t>(accessor)).componentType;
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) return valuesOf<std::uint32_t>(model, accessor);
  EXPECT_EQ(type, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
  const auto packed = valuesOf<std::uint16_t>(model, accessor);
  return {packed.begin(), packed.end()};
}

/// The corners of a face from its least on, in their order around it.
using Corners = std::array<convert::Float3, 3>;

inline Corners fromLeast(Corners corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// Faces with the number of their group.
using Faces = std::multiset<std::pair<int, Corners>>;

inline Faces facesOf(const convert::SurfaceMesh& surface) {
  Faces faces;
  for (std::size_t f = 0; f < surface.triangle.size(); ++f) {
    const convert::Triangle& t = surface.triangle[f];
    faces.insert(
        {static_cast<int>(surface.group[f]) + 1,
         fromLeast({surface.position[t[0]], surface.position[t[1]], surface.position[t[2]]})});
  }
  return faces;
}

inline void addFaces(const std::vector<convert::Float3>& position,
                     const std::vector<std::uint32_t>& index, int number, Faces& faces) {
  for (std::size_t i = 0; i + 2 < index.size(); i += 3)
    faces.insert({number, fromLeast({position.at(index[i]), position.at(index[i + 1]),
                                     position.at(index[i + 2])})});
}

inline int numberOf(const tinygltf::Primitive& primitive) {
  return primitive.extras.Get("number").GetNumberAsInt();
}

/// All faces of a mesh.
inline Faces facesOf(const tinygltf::Model& model, const tinygltf::Mesh& mesh) {
  Faces faces;
  for (const tinygltf::Primitive& primitive : mesh.primitives)
    addFaces(valuesOf<convert::Float3>(model, primitive.attributes.at("POSITION")),
             indicesOf(model, primitive.indices), numberOf(primitive), faces);
  return faces;
}

}  // namespace lumen::test
