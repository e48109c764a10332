// SPDX-License-Identifier: Apache-2.0
// Declared in gltf_document.h.
#include <algorithm>
#include <cstring>
#include <string>

#include "converters/io/mesh/gltf_document.h"
#include "converters/io/mesh/write_gltf.h"

namespace lumen::convert {

using nlohmann::json;

namespace {

constexpr double kMetre = 1e-3;  // mm
// Positions in metres: rounded to 2^-20 m, a micrometre.
constexpr int kMetreExponent = -20;

Float3 turned(const Float3& v) {
  return {v[0], v[2], -v[1]};
}

Float3 placed(const Float3& p) {
  const auto metres = [](float mm) { return static_cast<float>(kMetre * double{mm}); };
  return turned({metres(p[0]), metres(p[1]), metres(p[2])});
}

VertexStream fourStream(const char* name, bool isNormalized, std::span<const MeshPart> parts,
                        const std::vector<MeshSkin::Four>& values) {
  VertexStream stream{name, kUnsignedShort, 4, isNormalized, 8, 0};
  for (const MeshPart& part : parts)
    for (const std::uint32_t vertex : part.vertex) {
      const std::size_t at = stream.bytes.size();
      stream.bytes.resize(at + stream.stride);
      std::memcpy(stream.bytes.data() + at, values[vertex].data(), stream.stride);
    }
  return stream;
}

// Arrays of floats, each an accessor of one buffer view.
class FloatArrays {
public:
  explicit FloatArrays(GltfDocument& document) : m_document(document) {}

  int add(const char* type, std::size_t components, const std::vector<float>& values,
          bool hasBounds = false) {
    json accessor = {{"componentType", kFloat},
                     {"count", values.size() / components},
                     {"type", type},
                     {"byteOffset", m_bytes.size()}};
    if (hasBounds) {
      accessor["min"] = {values.front()};
      accessor["max"] = {values.back()};
    }
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    m_bytes.insert(m_bytes.end(), bytes, bytes + sizeof(float) * values.size());
    m_accessors.push_back(m_document.add("accessors", std::move(accessor)));
    return m_accessors.back();
  }

  // Writes the view, after which nothing may be added.
  void finish() {
    const int view = m_document.addBytes(m_bytes);
    for (const int accessor : m_accessors)
      m_document.content["accessors"][static_cast<std::size_t>(accessor)]["bufferView"] = view;
  }

private:
  GltfDocument& m_document;
  std::vector<char> m_bytes;
  std::vector<int> m_accessors;
};

// The inverse of a joint's transform at rest, column by column: from metres to the joint's frame.
std::vector<float> inverseBindMatrices(const MeshSkin& skin) {
  std::vector<float> all;
  for (const Float3& o : skin.rest)
    all.insert(all.end(), {1000, 0, 0, 0, 0, 0, 1000, 0, 0, -1000, 0, 0, 0.0F - o[0], 0.0F - o[1],
                           0.0F - o[2], 1});
  return all;
}

template <class Row>
std::vector<float> flat(const std::vector<Row>& rows) {
  std::vector<float> values;
  for (const Row& row : rows) values.insert(values.end(), row.begin(), row.end());
  return values;
}

// One animation of all joints that move.
class Animation {
public:
  Animation(const MeshSkin& skin, FloatArrays& arrays)
      : m_arrays(arrays), m_input(arrays.add("SCALAR", 1, skin.time, true)) {}

  void addJoint(const MeshSkin& skin, std::size_t joint, int node) {
    add(node, "translation", m_arrays.add("VEC3", 3, flat(skin.translation[joint])));
    add(node, "rotation", m_arrays.add("VEC4", 4, flat(skin.rotation[joint])));
    const std::vector<float>& scale = skin.scale[joint];
    if (std::all_of(scale.begin(), scale.end(), [](float s) { return s == 1; })) return;
    std::vector<float> scales;
    for (const float s : scale) scales.insert(scales.end(), 3, s);
    add(node, "scale", m_arrays.add("VEC3", 3, scales));
  }

  [[nodiscard]] json content(double startTime) const {
    json animation = {{"name", "motion"}, {"samplers", m_samplers}, {"channels", m_channels}};
    if (startTime != 0) animation["extras"] = {{"start_s", startTime}};
    return animation;
  }

private:
  void add(int node, const char* path, int output) {
    m_channels.push_back(
        {{"sampler", m_samplers.size()}, {"target", {{"node", node}, {"path", path}}}});
    m_samplers.push_back({{"input", m_input}, {"output", output}, {"interpolation", "LINEAR"}});
  }

  FloatArrays& m_arrays;
  int m_input;
  std::vector<json> m_samplers, m_channels;
};

int addJointNode(const MeshSkin& skin, std::size_t joint, GltfDocument& document) {
  const int node =
      document.add("nodes", {{"name", skin.name[joint]}, {"translation", skin.rest[joint]}});
  document.content["nodes"][0]["children"].push_back(node);
  return node;
}

}  // namespace

std::vector<SurfaceMesh> inGltfFrame(std::span<const SurfaceMesh> levels) {
  std::vector<SurfaceMesh> out(levels.begin(), levels.end());
  for (SurfaceMesh& level : out) {
    std::transform(level.position.begin(), level.position.end(), level.position.begin(), placed);
    std::transform(level.normal.begin(), level.normal.end(), level.normal.begin(), turned);
  }
  return out;
}

void addSkinStreams(const MeshSkin::Vertices& vertices, std::span<const MeshPart> parts,
                    std::vector<VertexStream>& streams) {
  for (VertexStream& stream : streams)
    if (stream.name == "POSITION") stream.exponent = kMetreExponent;
  streams.push_back(fourStream("JOINTS_0", false, parts, vertices.joint));
  streams.push_back(fourStream("WEIGHTS_0", true, parts, vertices.weight));
}

int addSkin(const MeshSkin& skin, GltfDocument& document) {
  std::vector<int> nodes;
  for (std::size_t j = 0; j < skin.rest.size(); ++j)
    nodes.push_back(addJointNode(skin, j, document));
  // the standard gives matrices a view of their own
  FloatArrays binding(document);
  const int matrices = binding.add("MAT4", 16, inverseBindMatrices(skin));
  binding.finish();
  const bool isMoving = std::any_of(skin.translation.begin(), skin.translation.end(),
                                    [](const auto& places) { return !places.empty(); });
  if (isMoving && skin.time.size() > 1) {
    FloatArrays arrays(document);
    Animation animation(skin, arrays);
    for (std::size_t j = 0; j < nodes.size(); ++j)
      if (!skin.translation[j].empty()) animation.addJoint(skin, j, nodes[j]);
    document.add("animations", animation.content(skin.startTime));
    arrays.finish();
  }
  return document.add("skins",
                      {{"inverseBindMatrices", matrices}, {"joints", nodes}, {"skeleton", 0}});
}

}  // namespace lumen::convert
