// SPDX-License-Identifier: Apache-2.0
// A glTF 2.0 document under construction: its JSON, and its buffer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vertex_streams.h"
#include "converters/io/mesh/write_options.h"

namespace lumen::convert {

// Words of glTF 2.0 that reading and writing share.

/// The first word of a GLB, and the types of its chunks: "glTF", "JSON", "BIN" and 0.
inline constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a,
                               kBinaryChunk = 0x004e4942;

inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

/// Arrays and objects are added to `content`; buffers are added by write(). Functions that add
/// bytes throw Error(Unsupported) beyond 2 GiB.
class GltfDocument {
public:
  explicit GltfDocument(bool meshopt) : m_meshopt(meshopt) {}

  /// The JSON without `buffers`.
  nlohmann::json content;

  /// Appends `item` to the array `content[list]`; returns its index.
  int add(const char* list, nlohmann::json item);

  /// A buffer view of vertices. With meshopt `stream` receives the values that a reader decodes.
  int addVertices(VertexStream& stream);
  /// A buffer view of triangles: 16-bit indices if `isShort`.
  int addIndices(const std::vector<std::uint32_t>& index, std::size_t vertices, bool isShort);
  /// A buffer view of bytes that only an extension reads.
  int addBytes(const std::vector<char>& bytes);

  /// Lists an extension that the file uses; `required`: the file cannot be read without it.
  void useExtension(const char* name, bool required);

  /// The document as a GLB, or as JSON with its buffer in a data URI.
  std::string write(bool binary);

private:
  int addView(std::span<const unsigned char> bytes, nlohmann::json view);
  /// A view of `size` bytes, which `coded` holds encoded.
  int addCodedView(std::span<const unsigned char> coded, std::size_t size, nlohmann::json view,
                   nlohmann::json coding);

  bool m_meshopt;
  std::vector<unsigned char> m_bytes;
  std::size_t m_decodedSize = 0;  ///< size of the buffer that meshopt's views decode to
};

// Skins and animations of glTF.

/// The surfaces in glTF's frame, metres with +y up: programs leave the transforms of a skinned mesh
/// out, so that vertices lie where joints at rest leave them.
std::vector<SurfaceMesh> inGltfFrame(std::span<const SurfaceMesh> levels);

/// Appends JOINTS_0 and WEIGHTS_0 of the vertices of parts.
void addSkinStreams(const MeshSkin::Vertices& vertices, std::span<const MeshPart> parts,
                    std::vector<VertexStream>& streams);

/// Adds the joints as children of node 0, whose matrix is kGltfFromLps, the skin, and an animation
/// with linear samplers, unless there is one time only; returns the index of the skin. The joints
/// stand in their poses at rest.
int addSkin(const MeshSkin& skin, GltfDocument& document);

}  // namespace lumen::convert
