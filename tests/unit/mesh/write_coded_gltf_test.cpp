// SPDX-License-Identifier: Apache-2.0
// Draco's and meshoptimizer's decoders read what the writer of glTF gave to their encoders.
#include <cmath>
#include <map>
#include <memory>
#include <sstream>

#include <draco/compression/decode.h>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include "capped_tube.h"
#include "converters/base/error.h"
#include "gltf_reading.h"

namespace lumen::convert {
namespace {

using nlohmann::json;
using test::cappedTube;
using test::gltfOf;
using test::hostileLabels;
using test::loadGltf;

double distance(const Float3& a, const Float3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// The place nearest to `p` of a surface.
Float3 nearestVertex(const SurfaceMesh& surface, const Float3& p) {
  return *std::min_element(
      surface.position.begin(), surface.position.end(),
      [&](const Float3& a, const Float3& b) { return distance(a, p) < distance(b, p); });
}

/// `faces` with each corner moved to the nearest place of a surface, if that is within `bound`.
test::Faces snapped(const test::Faces& faces, const SurfaceMesh& surface, double bound) {
  test::Faces result;
  for (auto [number, corners] : faces) {
    for (Float3& corner : corners) {
      const Float3 near = nearestVertex(surface, corner);
      EXPECT_LT(distance(near, corner), bound);
      corner = near;
    }
    result.insert({number, test::fromLeast(corners)});
  }
  return result;
}

std::unique_ptr<draco::Mesh> decodeDraco(const tinygltf::Model& model,
                                         const tinygltf::Primitive& primitive) {
  const auto& extension = primitive.extensions.at("KHR_draco_mesh_compression");
  const auto& view =
      model.bufferViews[static_cast<std::size_t>(extension.Get("bufferView").GetNumberAsInt())];
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(model.buffers[0].data.data() + view.byteOffset),
              view.byteLength);
  return draco::Decoder().DecodeMeshFromBuffer(&buffer).value();
}

/// The values of an attribute as a viewer finds it, by the name that the primitive has for it.
template <class T, std::size_t n>
std::vector<std::array<T, n>> dracoValues(const draco::Mesh& mesh,
                                          const tinygltf::Primitive& primitive, const char* name) {
  const auto& ids = primitive.extensions.at("KHR_draco_mesh_compression").Get("attributes");
  const auto* attribute =
      mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(ids.Get(name).GetNumberAsInt()));
  EXPECT_EQ(attribute->num_components(), static_cast<int>(n)) << name;
  std::vector<std::array<T, n>> values(mesh.num_points());
  for (draco::PointIndex i(0); i < mesh.num_points(); ++i)
    attribute->GetMappedValue(i, values[i.value()].data());
  return values;
}

std::vector<std::uint32_t> dracoIndices(const draco::Mesh& mesh) {
  std::vector<std::uint32_t> index;
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
    for (const draco::PointIndex& v : mesh.face(f)) index.push_back(v.value());
  return index;
}

// The longest edge of the tube's box is 4 mm: a step of 16 bits is 4 / 65535 mm, and rounding moves
// by half on each axis.
constexpr double kDracoBound = 4.0 / 65535;

TEST(GltfDraco, DecodesToTheFacesTheValuesAndTheBoxes) {
  const SurfaceMesh surface = cappedTube(hostileLabels());
  const tinygltf::Model model =
      loadGltf(gltfOf(surface, {.color = ColorBy::Branch, .draco = true}));
  EXPECT_EQ(model.extensionsRequired, std::vector<std::string>{"KHR_draco_mesh_compression"});
  test::Faces faces;
  for (const tinygltf::Primitive& primitive : model.meshes.at(0).primitives) {
    const auto mesh = decodeDraco(model, primitive);
    const auto position = dracoValues<float, 3>(*mesh, primitive, "POSITION");
    const auto& accessor =
        model.accessors.at(static_cast<std::size_t>(primitive.attributes.at("POSITION")));
    EXPECT_EQ(accessor.count, position.size());
    test::addFaces(position, dracoIndices(*mesh), test::numberOf(primitive), faces);
    const auto radius = dracoValues<float, 1>(*mesh, primitive, "_RADIUS");
    const auto branch = dracoValues<std::uint16_t, 1>(*mesh, primitive, "_BRANCH");
    const auto confidence = dracoValues<float, 1>(*mesh, primitive, "_CONFIDENCE");
    EXPECT_EQ((dracoValues<std::uint16_t, 4>(*mesh, primitive, "COLOR_0").size()), position.size());
    for (std::size_t v = 0; v < position.size(); ++v) {
      EXPECT_NEAR(radius[v][0], 1 + 0.1F * position[v][2], 1e-3);
      EXPECT_NEAR(confidence[v][0], 1 - 0.2F * position[v][2], 1e-3);
      EXPECT_EQ(branch[v][0], position[v][2] < 1.9F ? 0U : hostileLabels().size() - 1);
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_GE(position[v][a], accessor.minValues[a]);
        EXPECT_LE(position[v][a], accessor.maxValues[a]);
      }
    }
  }
  EXPECT_EQ(snapped(faces, surface, kDracoBound), test::facesOf(surface));
}

TEST(GltfDraco, KeepsPartsTogetherWhereTheyMeet) {
  const SurfaceMesh surface = cappedTube({"a", "b"});
  const tinygltf::Model model = loadGltf(gltfOf(surface, {.per = MeshPer::Branch, .draco = true}));
  std::map<Float3, std::set<Float3>> decoded;  // by where a vertex was
  for (const tinygltf::Mesh& mesh : model.meshes)
    for (const tinygltf::Primitive& primitive : mesh.primitives)
      for (const Float3& p :
           dracoValues<float, 3>(*decodeDraco(model, primitive), primitive, "POSITION"))
        decoded[nearestVertex(surface, p)].insert(p);
  EXPECT_EQ(decoded.size(), surface.position.size());
  for (const auto& [place, points] : decoded) EXPECT_EQ(points.size(), 1U);
}

TEST(GltfDraco, RefusesBitsOutOfRange) {
  const SurfaceMesh surface = cappedTube({"a"});
  EXPECT_THROW(gltfOf(surface, {.draco = true, .dracoPositionBits = 31}), Error);
  EXPECT_THROW(gltfOf(surface, {.draco = true, .dracoNormalBits = 1}), Error);
}

TEST(GltfMeshopt, IsRefusedBesideDraco) {
  EXPECT_THROW(gltfOf(cappedTube({"a"}), {.meshopt = true, .draco = true}), Error);
}

/// A GLB of EXT_meshopt_compression as its specification says that it is read.
class MeshoptGlb {
public:
  explicit MeshoptGlb(const std::string& glb) {
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    m_json = json::parse(glb.substr(20, length));
    const std::string data = glb.substr(28 + length);
    for (const json& view : m_json["bufferViews"]) m_views.push_back(decoded(view, data));
  }

  [[nodiscard]] const json& content() const { return m_json; }

  template <class T>
  [[nodiscard]] std::vector<T> values(std::size_t index) const {
    const json& accessor = m_json["accessors"][index];
    const std::size_t view = accessor["bufferView"];
    const std::size_t stride = m_json["bufferViews"][view].value("byteStride", sizeof(T));
    std::vector<T> result(accessor["count"].template get<std::size_t>());
    for (std::size_t i = 0; i < result.size(); ++i)
      std::memcpy(&result[i],
                  m_views[view].data() + accessor["byteOffset"].get<std::size_t>() + i * stride,
                  sizeof(T));
    return result;
  }

private:
  static std::vector<unsigned char> decoded(const json& view, const std::string& data) {
    const json& coding = view["extensions"]["EXT_meshopt_compression"];
    const std::size_t count = coding["count"], stride = coding["byteStride"];
    EXPECT_EQ(coding["buffer"], 0);
    EXPECT_EQ(view["byteLength"], count * stride);
    const auto* first = reinterpret_cast<const unsigned char*>(data.data()) +
                        coding["byteOffset"].get<std::size_t>();
    const std::size_t size = coding["byteLength"];
    std::vector<unsigned char> bytes(count * stride);
    if (coding["mode"] == "TRIANGLES") {
      EXPECT_EQ(meshopt_decodeIndexBuffer(bytes.data(), count, stride, first, size), 0);
      return bytes;
    }
    EXPECT_EQ(coding["mode"], "ATTRIBUTES");
    EXPECT_EQ(meshopt_decodeVertexBuffer(bytes.data(), count, stride, first, size), 0);
    if (coding.value("filter", "NONE") == "EXPONENTIAL")
      meshopt_decodeFilterExp(bytes.data(), count, stride);
    return bytes;
  }

  json m_json;
  std::vector<std::vector<unsigned char>> m_views;
};

/// A micrometre, and what is lost of it.
constexpr double kMeshoptBound = 1e-3;

void expectMeshoptReads(const SurfaceMesh& surface) {
  const MeshoptGlb glb(gltfOf(surface, {.meshopt = true}));
  const json& content = glb.content();
  EXPECT_EQ(content["extensionsRequired"], json::array({"EXT_meshopt_compression"}));
  EXPECT_TRUE(content["buffers"][1]["extensions"]["EXT_meshopt_compression"]["fallback"]);
  test::Faces faces;
  for (const json& primitive : content["meshes"][0]["primitives"]) {
    const json& attributes = primitive["attributes"];
    const auto position = glb.values<Float3>(attributes["POSITION"]);
    const auto normal = glb.values<Float3>(attributes["NORMAL"]);
    const auto radius = glb.values<float>(attributes["_RADIUS"]);
    const auto branch = glb.values<std::uint16_t>(attributes["_BRANCH"]);
    const json& accessor = content["accessors"][attributes["POSITION"].get<std::size_t>()];
    for (std::size_t v = 0; v < position.size(); ++v) {
      EXPECT_NEAR(distance(normal[v], {}), 1, 5e-4);  // the validator's bound
      EXPECT_NEAR(radius[v], 1 + 0.1F * position[v][2], kMeshoptBound);
      EXPECT_EQ(branch[v], position[v][2] < 1.9F ? 0 : 1);
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_GE(position[v][a], accessor["min"][a].get<float>());
        EXPECT_LE(position[v][a], accessor["max"][a].get<float>());
      }
    }
    const bool isShort =
        content["accessors"][primitive["indices"].get<std::size_t>()]["componentType"] ==
        TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    std::vector<std::uint32_t> index;
    if (isShort) {
      const auto packed = glb.values<std::uint16_t>(primitive["indices"]);
      index.assign(packed.begin(), packed.end());
    } else {
      index = glb.values<std::uint32_t>(primitive["indices"]);
    }
    test::addFaces(position, index, primitive["extras"]["number"], faces);
  }
  EXPECT_EQ(snapped(faces, surface, kMeshoptBound), test::facesOf(surface));
}

TEST(GltfMeshopt, DecodesToTheFacesTheValuesAndTheBoxes) {
  expectMeshoptReads(cappedTube({"a", "b"}));
}

TEST(GltfMeshopt, RoundsMoreCoarselyOnlyWhereTwentyFourBitsDoNotSuffice) {
  SurfaceMesh surface = cappedTube({"a"});
  for (Float3& p : surface.position) p[0] += 20000;  // mm: steps of 2^-8
  const MeshoptGlb glb(gltfOf(surface, {.meshopt = true}));
  const std::size_t positions =
      glb.content()["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
  for (const Float3& p : glb.values<Float3>(positions))
    EXPECT_LT(distance(nearestVertex(surface, p), p), 1.0 / 256);
}

}  // namespace
/// The reasons why the writer does not go through tinygltf's (docs/architecture.md, "Own code, and why"). A release in which
/// one of these tests fails is a reason to look again.
json writtenByTinygltf(const tinygltf::Model& model) {
  std::ostringstream out;
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, false);
  return json::parse(out.str());
}

/// The buffer that meshopt's views decode to, which has a length and no bytes, and one of these views.
tinygltf::Model fallbackBuffer() {
  tinygltf::Model model;
  model.asset.version = "2.0";
  const tinygltf::Value extension(tinygltf::Value::Object{{"fallback", tinygltf::Value(true)}});
  model.buffers.resize(1);
  model.buffers[0].extensions["EXT_meshopt_compression"] = extension;
  model.bufferViews.resize(1);
  model.bufferViews[0].buffer = 0;
  model.bufferViews[0].byteLength = 12;
  model.bufferViews[0].extensions["EXT_meshopt_compression"] = extension;
  return model;
}

TEST(TinygltfWriter, DropsExtensionsOfBuffersAndBufferViews) {
  const json written = writtenByTinygltf(fallbackBuffer());
  EXPECT_FALSE(written["buffers"][0].contains("extensions"));
  EXPECT_FALSE(written["bufferViews"][0].contains("extensions"));
}

TEST(TinygltfWriter, GivesBytesToABufferThatHasNone) {
  const json buffer = writtenByTinygltf(fallbackBuffer())["buffers"][0];
  EXPECT_TRUE(buffer.contains("uri"));
  EXPECT_EQ(buffer["byteLength"], 0);  // glTF asks for 1 or more
}

TEST(TinygltfWriter, ThrowsForANameThatIsNotUtf8) {
  tinygltf::Model model = loadGltf(gltfOf(cappedTube({"a"})));
  model.nodes[0].name = "\xff";
  std::ostringstream out;
  EXPECT_ANY_THROW(tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true));
}

}  // namespace lumen::convert
