// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 with KHR_draco_mesh_compression, EXT_meshopt_compression and MSFT_lod.
#include "converters/io/mesh/write_gltf.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/io/mesh/draco_mesh.h"
#include "converters/io/mesh/gltf_document.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/meshopt_codec.h"
#include "converters/io/mesh/vertex_streams.h"
#include "converters/io/mesh/write_options.h"

namespace lumen::convert {

using nlohmann::json;

namespace {

constexpr const char* kLod = "MSFT_lod";
// Index 65535 is the primitive restart value of 16-bit indices, which glTF forbids.
constexpr std::size_t kMaxShortVertices = 65535;
// Each level serves half the height on the screen of the previous level; the last serves all
// smaller heights.
constexpr double kLodCoverage = 0.5;

// One level while it is written.
struct Level {
  const SurfaceMesh& surface;
  std::vector<MeshPart> parts;
  std::vector<VertexStream> streams;
};

json rootNode() {
  return {
      {"name", "LPS_mm_to_glTF_m"},
      {"matrix", kGltfFromLps},
      {"extras",
       {{"frame", "LPS: +x left, +y posterior, +z superior"},
        {"unit", "mm"},
        {"matrix",
         "to glTF: metres, +x left, +y superior, +z anterior; apply its inverse to come back to "
         "LPS mm"}}}};
}

// Linear light, as glTF's factors are.
json systemFactor(formats::VesselSystem system) {
  SurfaceMesh one;
  one.branch = {0};
  one.systems = {system};
  const Color color = vertexColors(one, {ColorBy::System, 0, 1}).front();
  return {color[0] / 65535.0, color[1] / 65535.0, color[2] / 65535.0, 1.0};
}

// The wall is arterial red, or has the colour of its system if it states one, and the lumen at an
// open end is darker; white if vertices have colours.
json makeMaterial(FaceKind kind, const std::optional<formats::VesselSystem>& system, bool isOpen,
                  bool isColored) {
  const bool isWall = kind == FaceKind::Wall;
  const json color = isColored          ? json{1.0, 1.0, 1.0, 1.0}
                     : isWall && system ? systemFactor(*system)
                     : isWall           ? json{0.5, 0.05, 0.05, 1.0}
                                        : json{0.2, 0.01, 0.02, 1.0};
  std::string name = isWall ? "vessel wall" : faceKindName(kind);
  if (system) name += ", " + systemName(*system);
  json material = {{"name", name},
                   {"pbrMetallicRoughness",
                    {{"baseColorFactor", color},
                     {"metallicFactor", 0.0},
                     {"roughnessFactor", isWall ? 0.45 : 0.7}}}};
  if (isOpen) material["doubleSided"] = true;  // the inside of the wall shows
  return material;
}

json meshExtras(const SurfaceMesh& surface, const std::vector<VertexStream>& streams,
                const ColorScale& scale, bool isSkinned) {
  const std::map<std::string, const char*> meanings = {
      {"POSITION", isSkinned ? "m, as glTF" : "mm, LPS"},
      {"_RADIUS", "mm"},
      {"_BRANCH", "index into branches"},
      {"_CONFIDENCE", "0 to 1"}};
  json extras = {{"branches", surface.labels}};
  if (!surface.systems.empty()) extras["systems"] = systemNames(surface);
  for (const VertexStream& stream : streams)
    if (const auto found = meanings.find(stream.name); found != meanings.end())
      extras["attributes"][stream.name] = found->second;
  if (scale.by == ColorBy::None) return extras;
  json color = {{"map", colorMapName(scale.by)}};
  if (scale.by == ColorBy::Branch) color["by"] = "branch";
  if (scale.by == ColorBy::Radius)
    color.update({{"by", "radius"}, {"unit", "mm"}, {"scale", "logarithmic"}});
  if (scale.by == ColorBy::Confidence) color["by"] = "confidence";
  if (scale.by == ColorBy::System) color["by"] = "system";
  if (hasRange(scale.by)) color["range"] = {scale.low, scale.high};
  extras["color"] = std::move(color);
  return extras;
}

json makeAccessor(const VertexStream& stream, std::size_t count) {
  json accessor = {{"componentType", stream.componentType},
                   {"count", count},
                   {"type", stream.components == 1   ? "SCALAR"
                            : stream.components == 3 ? "VEC3"
                                                     : "VEC4"}};
  if (stream.isNormalized) accessor["normalized"] = true;
  return accessor;
}

void setBounds(json& accessor, const Float3& low, const Float3& high) {
  accessor["min"] = low;
  accessor["max"] = high;
}

Float3 positionAt(const VertexStream& positions, std::size_t vertex) {
  Float3 p;
  std::memcpy(p.data(), positions.bytes.data() + vertex * positions.stride, sizeof p);
  return p;
}

json indexAccessor(std::size_t count, bool isShort) {
  return {{"componentType", isShort ? kUnsignedShort : kUnsignedInt},
          {"count", count},
          {"type", "SCALAR"}};
}

// Offsets of a part's vertices and indices in the buffer views of its level.
struct Place {
  std::size_t vertex = 0, index = 0;
};

// The accessor of a part's share of a stream, which has a buffer view of its own.
json sharedAccessor(const VertexStream& stream, const MeshPart& part, std::size_t first, int view) {
  json accessor = makeAccessor(stream, part.vertex.size());
  accessor["bufferView"] = view;
  accessor["byteOffset"] = first * stream.stride;
  if (stream.name != "POSITION") return accessor;
  Float3 low = positionAt(stream, first), high = low;
  for (std::size_t v = 0; v < part.vertex.size(); ++v)
    extendBox(positionAt(stream, first + v), low, high);
  setBounds(accessor, low, high);
  return accessor;
}

// The primitives of a level's parts, which share a buffer view for each attribute.
std::vector<json> plainPrimitives(GltfDocument& document, Level& level) {
  std::vector<std::uint32_t> index;
  std::size_t most = 0;
  for (const MeshPart& part : level.parts) {
    for (const Triangle& t : part.triangle) index.insert(index.end(), t.begin(), t.end());
    most = std::max(most, part.vertex.size());
  }
  const bool isShort = most <= kMaxShortVertices;
  std::vector<int> views;
  for (VertexStream& stream : level.streams) views.push_back(document.addVertices(stream));
  const int indexView = document.addIndices(index, most, isShort);
  std::vector<json> primitives;
  Place place;
  for (const MeshPart& part : level.parts) {
    json primitive;
    for (std::size_t s = 0; s < views.size(); ++s)
      primitive["attributes"][level.streams[s].name] =
          document.add("accessors", sharedAccessor(level.streams[s], part, place.vertex, views[s]));
    json indices = indexAccessor(3 * part.triangle.size(), isShort);
    indices["bufferView"] = indexView;
    indices["byteOffset"] = place.index * (isShort ? 2 : 4);
    primitive["indices"] = document.add("accessors", std::move(indices));
    place.vertex += part.vertex.size();
    place.index += 3 * part.triangle.size();
    primitives.push_back(std::move(primitive));
  }
  return primitives;
}

// The cube around all levels.
DracoGrid makeDracoGrid(std::span<const SurfaceMesh> levels) {
  Float3 low = levels.front().position.empty() ? Float3{} : levels.front().position.front();
  Float3 high = low;
  for (const SurfaceMesh& level : levels)
    for (const Float3& p : level.position) extendBox(p, low, high);
  DracoGrid grid{low, 0};
  for (std::size_t a = 0; a < 3; ++a) grid.range = std::max(grid.range, high[a] - low[a]);
  if (!(grid.range > 0)) grid.range = 1;
  return grid;
}

std::vector<json> dracoPrimitives(GltfDocument& document, const Level& level, const DracoGrid& grid,
                                  const WriteMeshOptions& options) {
  std::vector<json> primitives;
  std::size_t first = 0;
  for (const MeshPart& part : level.parts) {
    const DracoMesh coded =
        encodeDraco({level.streams, first, part.vertex.size(), part.triangle}, grid, options);
    json primitive, extension;
    for (std::size_t s = 0; s < level.streams.size(); ++s) {
      const VertexStream& stream = level.streams[s];
      json accessor = makeAccessor(stream, coded.vertices);
      if (stream.name == "POSITION") setBounds(accessor, coded.low, coded.high);
      primitive["attributes"][stream.name] = document.add("accessors", std::move(accessor));
      extension["attributes"][stream.name] = coded.id[s];
    }
    primitive["indices"] = document.add(
        "accessors", indexAccessor(3 * coded.triangles, coded.vertices <= kMaxShortVertices));
    extension["bufferView"] = document.addBytes(coded.bytes);
    primitive["extensions"][kDracoExtension] = std::move(extension);
    primitives.push_back(std::move(primitive));
    first += part.vertex.size();
  }
  if (!level.parts.empty()) document.useExtension(kDracoExtension, true);
  return primitives;
}

// The shortest rotation of z to the direction, as a quaternion x, y, z, w.
json turnFromZ(const std::array<double, 3>& d) {
  if (d[2] < -1 + 1e-12) return json::array({1.0, 0.0, 0.0, 0.0});
  const double length = std::sqrt(d[1] * d[1] + d[0] * d[0] + (1 + d[2]) * (1 + d[2]));
  return json::array({-d[1] / length, d[0] / length, 0.0, (1 + d[2]) / length});
}

// Writes the levels of one surface; holds their common data.
class GltfWriter {
public:
  GltfWriter(std::span<const SurfaceMesh> levels, const WriteMeshOptions& options,
             const GltfScene* layout = nullptr, const MeshSkin* skin = nullptr)
      : m_document(options.meshopt),
        m_options(options),
        m_layout(layout),
        m_skin(skin),
        m_first(levels.front()),
        m_scale(measureColorScale(m_first, options.color)),
        m_grid(makeDracoGrid(levels)),
        m_isOpen(!isClosed(m_first)) {
    m_document.content["asset"] = {{"version", "2.0"}, {"generator", "lumen " LUMEN_VERSION}};
    m_document.content["scene"] = 0;
    m_document.add("scenes", {{"nodes", json::array({0})}});
    m_document.add("nodes", layout ? json{{"name", "vessels"}} : rootNode());
    if (skin) m_skinIndex = addSkin(*skin, m_document);
    for (const SurfaceMesh& level : levels) addLevel(level);
    for (const auto& [branch, nodes] : m_nodes) link(nodes);
    if (layout)
      for (const GltfPlace& place : layout->places) addPlace(place);
  }

  std::string write(bool binary) { return m_document.write(binary); }

private:
  // A skinned mesh is a root, as it has no transform of its own.
  void addChild(int node) {
    json& siblings = m_skin ? m_document.content["scenes"][0]["nodes"]
                            : m_document.content["nodes"][0]["children"];
    siblings.push_back(node);
  }

  void addPlace(const GltfPlace& place) {
    addChild(m_document.add("nodes", {{"name", place.name},
                                      {"translation", place.position},
                                      {"rotation", turnFromZ(place.direction)}}));
  }

  void addLevel(const SurfaceMesh& surface) {
    const bool bySystem = m_layout && !surface.systems.empty();
    Level level{surface, splitMesh(surface, m_options.per, bySystem), {}};
    if (!m_options.draco)
      for (MeshPart& part : level.parts) orderForDrawing(part);
    level.streams = vertexStreams(surface, level.parts, m_scale);
    if (m_layout)
      std::erase_if(level.streams, [](const VertexStream& stream) {
        return stream.name != "POSITION" && stream.name != "NORMAL";
      });
    if (m_skin) addSkinStreams(m_skin->levels[m_levels++], level.parts, level.streams);
    if (level.parts.empty()) return;
    const std::vector<json> primitives = m_options.draco
                                             ? dracoPrimitives(m_document, level, m_grid, m_options)
                                             : plainPrimitives(m_document, level);
    for (std::size_t i = 0; i < primitives.size();) {
      const std::uint32_t branch = level.parts[i].branch;
      const std::string name = m_layout ? m_layout->nodes[m_nodes[branch].size()] : nameOf(branch);
      json mesh = {{"name", name}};
      if (!m_layout)
        mesh["extras"] = meshExtras(surface, level.streams, m_scale, m_skin != nullptr);
      for (; i < primitives.size() && level.parts[i].branch == branch; ++i)
        mesh["primitives"].push_back(finished(primitives[i], level.parts[i], bySystem));
      json node = {{"name", name}, {"mesh", m_document.add("meshes", std::move(mesh))}};
      if (m_skin) node["skin"] = m_skinIndex;
      m_nodes[branch].push_back(m_document.add("nodes", std::move(node)));
    }
  }

  std::string nameOf(std::uint32_t branch) const {
    return m_options.per == MeshPer::Branch ? m_first.labels[branch] : "vessels";
  }

  json finished(json primitive, const MeshPart& part, bool bySystem) {
    const FaceGroup& group = m_first.groups[part.group];
    primitive["mode"] = 4;
    primitive["material"] =
        materialFor(group.kind, bySystem ? std::optional(part.system) : std::nullopt);
    primitive["extras"] = {
        {"name", group.name}, {"number", part.group + 1}, {"kind", faceKindName(group.kind)}};
    if (bySystem) primitive["extras"]["system"] = systemName(part.system);
    return primitive;
  }

  int materialFor(FaceKind kind, const std::optional<formats::VesselSystem>& system) {
    const auto [found, isNew] = m_materials.try_emplace({kind, system}, 0);
    if (isNew)
      found->second = m_document.add(
          "materials", makeMaterial(kind, system, m_isOpen, m_options.color != ColorBy::None));
    return found->second;
  }

  // Adds the nodes of one mesh in all levels.
  void link(const std::vector<int>& nodes) {
    addChild(nodes.front());
    if (m_layout && !m_layout->lod) {
      for (std::size_t i = 1; i < nodes.size(); ++i) addChild(nodes[i]);
      return;
    }
    if (nodes.size() == 1) return;
    m_document.useExtension(kLod, false);
    json& first = m_document.content["nodes"][static_cast<std::size_t>(nodes.front())];
    first["extensions"][kLod]["ids"] = std::vector<int>(nodes.begin() + 1, nodes.end());
    json coverage;
    for (std::size_t i = 1; i < nodes.size(); ++i)
      coverage.push_back(std::pow(kLodCoverage, static_cast<double>(i)));
    coverage.push_back(0.0);
    first["extras"]["MSFT_screencoverage"] = std::move(coverage);
  }

  GltfDocument m_document;
  const WriteMeshOptions& m_options;
  const GltfScene* m_layout;
  const MeshSkin* m_skin;
  int m_skinIndex = 0;
  std::size_t m_levels = 0;  // those that are written
  const SurfaceMesh& m_first;
  ColorScale m_scale;
  DracoGrid m_grid;
  bool m_isOpen;
  std::map<std::pair<FaceKind, std::optional<formats::VesselSystem>>, int> m_materials;
  std::map<std::uint32_t, std::vector<int>> m_nodes;  // nodes of each mesh, in the order of levels
};

}  // namespace

std::string encodeGltf(std::span<const SurfaceMesh> levels, bool binary,
                       const WriteMeshOptions& options, const MeshSkin* skin) {
  if (options.draco && options.meshopt)
    throw Error(ErrorKind::Usage, options.word("draco") + " and " + options.word("meshopt") +
                                      ": found both, expected one of them");
  if (!skin) return GltfWriter(levels, options).write(binary);
  const std::vector<SurfaceMesh> placed = inGltfFrame(levels);
  return GltfWriter(placed, options, nullptr, skin).write(binary);
}

std::string encodeGlbScene(std::span<const SurfaceMesh> levels, const GltfScene& scene) {
  return GltfWriter(levels, WriteMeshOptions{}, &scene).write(true);
}

}  // namespace lumen::convert
