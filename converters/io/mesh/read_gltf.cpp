// SPDX-License-Identifier: Apache-2.0
// Declared in mesh_readers.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/io/mesh/gltf_content.h"
#include "converters/io/mesh/gltf_document.h"
#include "converters/io/mesh/mesh_builder.h"
#include "converters/io/mesh/read_mesh.h"

namespace lumen::convert {
namespace {

using Json = GltfContent::Json;

constexpr std::uint64_t kNoIndex = ~std::uint64_t{0};
enum Mode : std::uint64_t { kTriangles = 4, kStrip = 5, kFan = 6 };

/// Transform from glTF's metres, +x left, +y up, +z front, to LPS mm.
Eigen::Matrix4d lpsFromGltf() {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = 1000;
  m(1, 2) = -1000;
  m(2, 1) = 1000;
  m(3, 3) = 1;
  return m;
}

/// Numbers of an accessor.
class Accessor {
public:
  Accessor(const GltfContent& content, std::uint64_t index, const char* type) : m_content(content) {
    Json json = content.item("accessors", index);
    m_where = "/accessors/" + std::to_string(index);
    if (GltfContent::text(json, "type") != type)
      content.refuse(m_where + "/type is " + quotedText(GltfContent::text(json, "type")) +
                     "; expected " + type);
    m_components = std::string_view(type) == "VEC3" ? 3 : 1;
    m_count = content.whole(json, "count", 0);
    m_type = content.whole(json, "componentType", 0);
    const auto normalized = json.find("normalized");
    m_normalized = normalized && normalized->boolean().value_or(false);
    if (json.find("sparse"))
      throw unsupported(
          content.name() + ": " + m_where +
          " is sparse, which lumen does not read; write it without sparse accessors, such as by "
          "Blender's export");
    if (json.find("bufferView")) locate(json);
  }

  [[nodiscard]] std::uint64_t count() const { return m_count; }
  [[nodiscard]] bool hasData() const { return m_bytes.data() != nullptr; }

  /// Number `component` of element `i`.
  [[nodiscard]] double at(std::uint64_t i, std::size_t component) const {
    const char* from = m_bytes.data() + static_cast<std::size_t>(i) * m_stride + component * m_size;
    switch (m_type) {
      case 5120:
        return scaled(loadNumber<std::int8_t>(from, Endian::Little), 127);
      case 5121:
        return scaled(loadNumber<std::uint8_t>(from, Endian::Little), 255);
      case 5122:
        return scaled(loadNumber<std::int16_t>(from, Endian::Little), 32767);
      case 5123:
        return scaled(loadNumber<std::uint16_t>(from, Endian::Little), 65535);
      case 5125:
        return loadNumber<std::uint32_t>(from, Endian::Little);
      default:
        return static_cast<double>(loadNumber<float>(from, Endian::Little));
    }
  }
  [[nodiscard]] bool isWhole() const { return m_type != 5126; }

private:
  [[nodiscard]] double scaled(double value, double most) const {
    return m_normalized ? std::max(value / most, -1.0) : value;
  }

  void locate(Json json) {
    const std::uint64_t view = m_content.whole(json, "bufferView", kNoIndex);
    const std::uint64_t offset = m_content.whole(json, "byteOffset", 0);
    const std::map<std::uint64_t, std::size_t> sizes = {{5120, 1}, {5121, 1}, {5122, 2},
                                                        {5123, 2}, {5125, 4}, {5126, 4}};
    const auto size = sizes.find(m_type);
    if (size == sizes.end())
      m_content.refuse(m_where + "/componentType is " + std::to_string(m_type) +
                       "; expected 5120 to 5126");
    m_size = size->second;
    const std::string_view bytes = m_content.view(view);
    const std::uint64_t stride =
        m_content.whole(m_content.item("bufferViews", view), "byteStride", 0);
    const std::size_t element = m_size * m_components;
    if (stride > 252 || (stride != 0 && stride < element))
      m_content.refuse("/bufferViews/" + std::to_string(view) + "/byteStride is " +
                       std::to_string(stride) + "; expected " + std::to_string(element) +
                       " to 252");
    m_stride = stride == 0 ? element : static_cast<std::size_t>(stride);
    const std::uint64_t room = offset + element > offset && offset + element <= bytes.size()
                                   ? (bytes.size() - offset - element) / m_stride + 1
                                   : 0;
    if (m_count > room)
      m_content.refuse(m_where + "/count is " + std::to_string(m_count) + "; expected at most " +
                       std::to_string(room) + ", for which there are bytes");
    m_bytes = bytes.substr(std::min<std::size_t>(static_cast<std::size_t>(offset), bytes.size()));
  }

  const GltfContent& m_content;
  std::string m_where;
  std::size_t m_components = 1, m_size = 4, m_stride = 4;
  std::uint64_t m_count = 0, m_type = 0;
  bool m_normalized = false;
  std::string_view m_bytes;
};

class GltfReader {
public:
  GltfReader(std::string_view bytes, const InputFile& file)
      : m_content(bytes, file), m_builder(m_content.name()) {}

  MeshFile read() {
    checkExtensions();
    m_seen.assign(static_cast<std::size_t>(m_content.size("nodes")), false);
    for (const std::uint64_t root : roots()) m_open.emplace_back(root, lpsFromGltf());
    while (!m_open.empty()) {
      const auto [node, matrix] = m_open.back();
      m_open.pop_back();
      visit(node, matrix);
    }
    m_builder.file.unitMm = 1;
    m_builder.file.frameStated = true;
    if (!m_isOurs) m_builder.file.standardMm = 1000;
    if (!m_isOurs && m_hasSkin)
      m_builder.file.notes.emplace_back(
          "its skins are not applied: meshes lie where their nodes are, whatever their joints do");
    if (!m_isOurs)
      m_builder.file.notes.emplace_back("taken as metres with +Y up, by the standard of glTF");
    return m_builder.finish();
  }

private:
  void checkExtensions() const {
    const auto required = m_content.root().find("extensionsRequired");
    if (!required) return;
    for (const Json& name : required->entries()) {
      const std::string text = name.text() == nullptr ? std::string() : *name.text();
      // appearance has no part in the surface
      const bool isLook = text.starts_with("KHR_materials") || text.starts_with("KHR_texture") ||
                          text.starts_with("EXT_texture") || text == "KHR_lights_punctual" ||
                          text == "MSFT_lod";
      if (!isLook && text != kDracoExtension && text != "KHR_mesh_quantization")
        throw unsupported(
            m_content.name() + ": it requires the extension " + quotedText(text) +
            ", which lumen does not read; KHR_draco_mesh_compression and "
            "KHR_mesh_quantization are read, and files of Blender's export have no other");
    }
  }

  /// Indices of nodes; the array `key` of `object`.
  std::vector<std::uint64_t> numbers(Json object, const char* key) const {
    std::vector<std::uint64_t> found;
    const auto list = object.find(key);
    if (!list) return found;
    if (!list->isArray()) m_content.refuse(std::string(key) + " is no array; expected one");
    for (const Json& entry : list->entries()) {
      const auto number = entry.number();
      const auto value = number ? number->asInteger<std::uint64_t>() : std::nullopt;
      if (!value)
        m_content.refuse(std::string(key) + " holds what is no whole number; expected nodes");
      found.push_back(*value);
    }
    return found;
  }

  /// The roots of the file's scene; without scenes, the nodes without a parent.
  std::vector<std::uint64_t> roots() const {
    if (m_content.size("scenes") > 0)
      return numbers(m_content.item("scenes", m_content.whole(m_content.root(), "scene", 0)),
                     "nodes");
    std::vector<bool> isChild(static_cast<std::size_t>(m_content.size("nodes")), false);
    for (std::uint64_t n = 0; n < isChild.size(); ++n)
      for (const std::uint64_t child : numbers(m_content.item("nodes", n), "children"))
        if (child < isChild.size()) isChild[static_cast<std::size_t>(child)] = true;
    std::vector<std::uint64_t> found;
    for (std::uint64_t n = 0; n < isChild.size(); ++n)
      if (!isChild[static_cast<std::size_t>(n)]) found.push_back(n);
    return found;
  }

  template <std::size_t N>
  bool reals(Json object, const char* key, std::array<double, N>& values) const {
    const auto list = object.find(key);
    if (!list) return false;
    if (!list->isArray() || list->arraySize() != N)
      m_content.refuse(std::string("/nodes: ") + key + " is no array of " + std::to_string(N) +
                       " numbers; expected one");
    for (std::size_t i = 0; i < N; ++i) {
      const auto number = (*list)[i].number();
      const auto value = number ? number->asDouble() : std::nullopt;
      if (!value)
        m_content.refuse(
            std::string("/nodes: ") + key + " holds " +
            (number ? number->shown() + ", which no double holds" : "what is no number"));
      values[i] = *value;
    }
    return true;
  }

  Eigen::Matrix4d matrixOf(Json node) const {
    std::array<double, 16> m{};
    if (reals(node, "matrix", m)) return Eigen::Map<const Eigen::Matrix4d>(m.data());
    std::array<double, 3> t{}, s{1, 1, 1};
    std::array<double, 4> r{0, 0, 0, 1};
    reals(node, "translation", t);
    reals(node, "rotation", r);
    reals(node, "scale", s);
    const Eigen::Matrix3d turn =
        Eigen::Quaterniond(r[3], r[0], r[1], r[2]).normalized().toRotationMatrix();
    Eigen::Matrix4d placed = Eigen::Matrix4d::Identity();
    placed.topLeftCorner<3, 3>() = turn * Eigen::Vector3d(s.data()).asDiagonal();
    placed.topRightCorner<3, 1>() = Eigen::Vector3d(t.data());
    return placed;
  }

  void visit(std::uint64_t index, const Eigen::Matrix4d& above) {
    Json node = m_content.item("nodes", index);
    if (m_seen[static_cast<std::size_t>(index)])
      m_content.refuse("/nodes/" + std::to_string(index) +
                       " has two parents; expected one, as in a tree");
    m_seen[static_cast<std::size_t>(index)] = true;
    if (GltfContent::text(node, "name") == "LPS_mm_to_glTF_m") m_isOurs = true;
    const Eigen::Matrix4d matrix = above * matrixOf(node);
    const std::vector<std::uint64_t> children = numbers(node, "children");
    for (auto child = children.rbegin(); child != children.rend(); ++child)
      m_open.emplace_back(*child, matrix);
    m_hasSkin = m_hasSkin || (node.find("mesh") && node.find("skin"));
    if (node.find("mesh")) addMesh(m_content.whole(node, "mesh", kNoIndex), matrix);
  }

  void addMesh(std::uint64_t index, const Eigen::Matrix4d& matrix) {
    Json mesh = m_content.item("meshes", index);
    const auto primitives = mesh.find("primitives");
    if (!primitives || !primitives->isArray())
      m_content.refuse("/meshes/" + std::to_string(index) + " has no primitives; expected some");
    std::map<std::uint64_t, std::uint32_t> placed;  // first point of each accessor of positions
    for (const Json& primitive : primitives->entries()) {
      if (!primitive.isObject()) m_content.refuse("/meshes: a primitive is no object");
      const auto extras = primitive.find("extras");
      const std::string name = extras ? GltfContent::text(*extras, "name") : std::string();
      m_builder.beginGroup(name.empty() ? GltfContent::text(mesh, "name") : name);
      addPrimitive(primitive, matrix, placed);
    }
  }

  void addPrimitive(Json primitive, const Eigen::Matrix4d& matrix,
                    std::map<std::uint64_t, std::uint32_t>& placed) {
    const std::uint64_t mode = m_content.whole(primitive, "mode", kTriangles);
    if (mode < kTriangles || mode > kFan) {
      if (!std::exchange(m_hasLines, true))
        m_builder.file.notes.emplace_back("its lines and points were passed over");
      return;
    }
    const auto attributes = primitive.find("attributes");
    if (!attributes || !attributes->find("POSITION"))
      m_content.refuse("/meshes: a primitive has no attribute POSITION; expected one");
    const std::uint64_t accessor = m_content.whole(*attributes, "POSITION", kNoIndex);
    const Accessor positions(m_content, accessor, "VEC3");
    const auto extensions = primitive.find("extensions");
    if (const auto draco = extensions ? extensions->find(kDracoExtension) : std::nullopt)
      return addDraco(*draco, primitive, positions, matrix);
    if (!positions.hasData() || positions.count() == 0)
      m_content.refuse("/accessors/" + std::to_string(accessor) +
                       " has no data; expected positions");
    const auto known = placed.find(accessor);
    const auto first =
        known != placed.end() ? known->second : static_cast<std::uint32_t>(m_builder.points());
    if (known == placed.end()) {
      requireRoom(positions.count());
      for (std::uint64_t i = 0; i < positions.count(); ++i)
        addPoint({positions.at(i, 0), positions.at(i, 1), positions.at(i, 2)}, matrix);
      placed[accessor] = first;
    }
    const std::vector<std::uint32_t> indices = readIndices(primitive, positions.count());
    requireRoom(indices.size() / 3);
    addFaces(indices, mode, first, isMirrored(matrix));
  }

  /// Nodes may show one mesh many times; the bound keeps the result within the file's own size.
  void requireRoom(std::uint64_t count) {
    m_placed += count;
    if (m_placed > m_content.totalBytes())
      m_content.refuse(
          "its nodes repeat meshes until there are more points and triangles than the "
          "file has bytes; expected fewer");
  }

  void addPoint(const Eigen::Vector3d& p, const Eigen::Matrix4d& matrix) {
    const Eigen::Vector3d at =
        matrix.topLeftCorner<3, 3>() * p + Eigen::Vector3d(matrix.topRightCorner<3, 1>());
    m_builder.addPoint(at, [&] { return "point " + std::to_string(m_builder.points()); });
  }

  static bool isMirrored(const Eigen::Matrix4d& matrix) {
    const Eigen::Matrix3d m = matrix.topLeftCorner<3, 3>();
    return m.determinant() < 0;
  }

  std::vector<std::uint32_t> readIndices(Json primitive, std::uint64_t points) const {
    std::vector<std::uint32_t> indices;
    if (!primitive.find("indices")) {
      for (std::uint64_t i = 0; i < points; ++i) indices.push_back(static_cast<std::uint32_t>(i));
      return indices;
    }
    const std::uint64_t accessor = m_content.whole(primitive, "indices", kNoIndex);
    const Accessor stored(m_content, accessor, "SCALAR");
    if (!stored.hasData() || !stored.isWhole())
      m_content.refuse("/accessors/" + std::to_string(accessor) +
                       " has no whole numbers; expected indices");
    indices.reserve(static_cast<std::size_t>(stored.count()));
    for (std::uint64_t i = 0; i < stored.count(); ++i) {
      const double index = stored.at(i, 0);
      if (!(index >= 0 && index < static_cast<double>(points)))
        m_content.refuse("/accessors/" + std::to_string(accessor) + ": index " + std::to_string(i) +
                         " is " + std::to_string(static_cast<std::int64_t>(index)) +
                         "; expected less than " + std::to_string(points) +
                         ", the number of points");
      indices.push_back(static_cast<std::uint32_t>(index));
    }
    return indices;
  }

  void addFaces(const std::vector<std::uint32_t>& index, std::uint64_t mode, std::uint32_t first,
                bool mirrored) {
    const std::size_t step = mode == kTriangles ? 3 : 1;
    for (std::size_t i = 0; i + 2 < index.size(); i += step) {
      Triangle t = {first + index[mode == kFan ? 0 : i], first + index[i + 1],
                    first + index[i + 2]};
      // every other triangle of a strip has the opposite orientation
      if (mirrored != (mode == kStrip && i % 2 == 1)) std::swap(t[1], t[2]);
      m_builder.addTriangle(t);
    }
  }

  void addDraco(Json extension, Json primitive, const Accessor& positions,
                const Eigen::Matrix4d& matrix) {
    if (!extension.isObject() || !primitive.find("indices"))
      m_content.refuse(std::string("/meshes: ") + kDracoExtension +
                       " is incomplete; expected indices too");
    const auto ids = extension.find("attributes");
    if (!ids || !ids->isObject())
      m_content.refuse(std::string("/meshes: ") + kDracoExtension + " has no attributes");
    const Accessor indices(m_content, m_content.whole(primitive, "indices", kNoIndex), "SCALAR");
    const std::uint64_t id = m_content.whole(*ids, "POSITION", kNoIndex);
    const std::uint64_t view = m_content.whole(extension, "bufferView", kNoIndex);
    const std::string_view bytes = m_content.view(view);
    const DecodedDraco mesh = decodeDracoMesh(
        bytes, static_cast<std::uint32_t>(std::min<std::uint64_t>(id, 0xFFFFFFFF)),
        static_cast<std::size_t>(positions.count()), static_cast<std::size_t>(indices.count() / 3));
    m_dracoBytes += bytes.size();
    if (m_dracoBytes > m_content.totalBytes())
      m_content.refuse(
          "its nodes repeat packed meshes beyond the size of the file; expected fewer");
    if (mesh.triangle.empty())
      m_content.refuse("/bufferViews/" + std::to_string(view) + " is no Draco mesh of " +
                       std::to_string(positions.count()) + " points and " +
                       std::to_string(indices.count() / 3) +
                       " triangles, which its accessors announce; expected one");
    const auto first = static_cast<std::uint32_t>(m_builder.points());
    for (const auto& p : mesh.position)
      addPoint({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])},
               matrix);
    std::vector<std::uint32_t> corners;
    for (const Triangle& t : mesh.triangle)
      for (const std::uint32_t v : t) {
        if (v >= mesh.position.size())
          m_content.refuse("/bufferViews/" + std::to_string(view) +
                           ": a Draco mesh has a corner beyond its points");
        corners.push_back(v);
      }
    addFaces(corners, kTriangles, first, isMirrored(matrix));
  }

  GltfContent m_content;
  MeshBuilder m_builder;
  std::vector<bool> m_seen;
  std::vector<std::pair<std::uint64_t, Eigen::Matrix4d>> m_open;
  std::uint64_t m_placed = 0, m_dracoBytes = 0;
  bool m_isOurs = false, m_hasLines = false, m_hasSkin = false;
};

}  // namespace

MeshFile parseGltf(std::string_view bytes, const InputFile& file) {
  return GltfReader(bytes, file).read();
}

}  // namespace lumen::convert
