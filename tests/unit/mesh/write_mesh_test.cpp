// SPDX-License-Identifier: Apache-2.0
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <draco/compression/decode.h>
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include "converters/common/error.h"
#include "converters/mesh/write_gltf.h"
#include "converters/mesh/write_plain.h"
#include "converters/surface/polygonise.h"
#include "open_mesh.h"
#include "synthetic.h"

namespace lumen::convert {
namespace {

using test::TriMesh;

// Two vessels, and a branch without triangles between them.
std::vector<BranchMesh> sample() {
  formats::Case source = test::tubeCase(3);
  test::addVessel(source, "side a", test::straightPath({20, 30, 40}, {0, 1, 0}, 3), 0.8, 1.6);
  test::addModels(source);
  Progress progress;
  auto meshes = polygonise(source, {}, progress);
  meshes.insert(meshes.begin() + 1, BranchMesh{"empty", {}, {}, {}});
  return meshes;
}

std::size_t verticesOf(const std::vector<BranchMesh>& meshes) {
  std::size_t count = 0;
  for (const BranchMesh& m : meshes) count += m.position.size();
  return count;
}

std::size_t facesOf(const std::vector<BranchMesh>& meshes) {
  std::size_t count = 0;
  for (const BranchMesh& m : meshes) count += m.triangle.size();
  return count;
}

tinygltf::Model loadGltf(const std::string& bytes, bool binary) {
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

const float* floatsOf(const tinygltf::Model& model, int accessor) {
  const auto& a = model.accessors[static_cast<std::size_t>(accessor)];
  const auto& view = model.bufferViews[static_cast<std::size_t>(a.bufferView)];
  return reinterpret_cast<const float*>(model.buffers[0].data.data() + view.byteOffset +
                                        a.byteOffset);
}

class Gltf : public testing::TestWithParam<bool> {};

TEST_P(Gltf, ReadsBackWithOneNamedMeshPerBranch) {
  const auto meshes = sample();
  const tinygltf::Model model = loadGltf(encodeGltf(meshes, GetParam(), {}), GetParam());
  ASSERT_EQ(model.meshes.size(), 2U);
  ASSERT_EQ(model.nodes.size(), 3U);
  EXPECT_EQ(model.nodes[0].children, (std::vector<int>{1, 2}));
  EXPECT_EQ(model.nodes[1].name, "tube");
  EXPECT_EQ(model.nodes[2].name, "side a");
  EXPECT_EQ(model.asset.generator, "lumen " LUMEN_VERSION);
  for (std::size_t b = 0; b < 2; ++b) {
    const BranchMesh& mesh = meshes[2 * b];
    const tinygltf::Primitive& primitive = model.meshes[b].primitives.at(0);
    const int position = primitive.attributes.at("POSITION"),
              normal = primitive.attributes.at("NORMAL");
    EXPECT_EQ(model.accessors[static_cast<std::size_t>(position)].count, mesh.position.size());
    EXPECT_EQ(model.accessors[static_cast<std::size_t>(primitive.indices)].count,
              3 * mesh.triangle.size());
    const std::size_t at = 3 * (mesh.position.size() - 1);
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_EQ(floatsOf(model, position)[at + a], mesh.position.back()[a]);
      EXPECT_EQ(floatsOf(model, normal)[at + a], mesh.normal.back()[a]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, Gltf, testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Binary" : "Json"; });

TEST(GltfFrame, TakesLpsMillimetresToMetresWithSuperiorUp) {
  const auto at = [](std::size_t row, const std::array<double, 3>& p) {
    return kGltfFromLps[row] * p[0] + kGltfFromLps[4 + row] * p[1] + kGltfFromLps[8 + row] * p[2] +
           kGltfFromLps[12 + row];
  };
  const std::array<double, 3> lps{1, 2, 3};  // 1 mm left, 2 mm posterior, 3 mm superior
  EXPECT_DOUBLE_EQ(at(0, lps), 0.001);       // left
  EXPECT_DOUBLE_EQ(at(1, lps), 0.003);       // up
  EXPECT_DOUBLE_EQ(at(2, lps), -0.002);      // anterior is +Z, so posterior is -Z
  const tinygltf::Model model = loadGltf(encodeGltf(sample(), true, {}), true);
  EXPECT_EQ(model.nodes[0].matrix, std::vector<double>(kGltfFromLps.begin(), kGltfFromLps.end()));
  EXPECT_EQ(model.nodes[0].name, "LPS_mm_to_glTF_m");
}

TEST(GltfIndices, AreShortWhereTheyFit) {
  const tinygltf::Model model = loadGltf(encodeGltf(sample(), true, {}), true);
  const int indices = model.meshes[0].primitives[0].indices;
  EXPECT_EQ(model.accessors[static_cast<std::size_t>(indices)].componentType,
            TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

std::unique_ptr<draco::Mesh> decodeDraco(const tinygltf::Model& model, std::size_t mesh) {
  const auto& extension =
      model.meshes[mesh].primitives[0].extensions.at("KHR_draco_mesh_compression");
  const auto& view =
      model.bufferViews[static_cast<std::size_t>(extension.Get("bufferView").GetNumberAsInt())];
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(model.buffers[0].data.data() + view.byteOffset),
              view.byteLength);
  return draco::Decoder().DecodeMeshFromBuffer(&buffer).value();
}

TEST(GltfDraco, DecodesToTheCountsAndTheBoxOfItsAccessors) {
  const auto meshes = sample();
  const tinygltf::Model model = loadGltf(encodeGltf(meshes, true, {.draco = true}), true);
  EXPECT_EQ(model.extensionsRequired, std::vector<std::string>{"KHR_draco_mesh_compression"});
  for (std::size_t b = 0; b < 2; ++b) {
    const tinygltf::Primitive& primitive = model.meshes[b].primitives[0];
    const auto& accessor =
        model.accessors[static_cast<std::size_t>(primitive.attributes.at("POSITION"))];
    const auto decoded = decodeDraco(model, b);
    EXPECT_EQ(decoded->num_faces(), meshes[2 * b].triangle.size());
    EXPECT_EQ(decoded->num_points(), meshes[2 * b].position.size());
    EXPECT_EQ(accessor.count, decoded->num_points());
    const auto& ids = primitive.extensions.at("KHR_draco_mesh_compression").Get("attributes");
    const auto* position = decoded->GetAttributeByUniqueId(
        static_cast<std::uint32_t>(ids.Get("POSITION").GetNumberAsInt()));
    for (draco::PointIndex i(0); i < decoded->num_points(); ++i) {
      std::array<float, 3> p;
      position->GetMappedValue(i, p.data());
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_GE(p[a], accessor.minValues[a]);
        EXPECT_LE(p[a], accessor.maxValues[a]);
      }
    }
  }
}

TEST(GltfDraco, MovesNoVertexFartherThanItsQuantisation) {
  const auto meshes = sample();
  const tinygltf::Model model = loadGltf(encodeGltf(meshes, true, {.draco = true}), true);
  const auto decoded = decodeDraco(model, 0);
  const auto* position = decoded->GetNamedAttribute(draco::GeometryAttribute::POSITION);
  // The tube is 4.4 mm long: a step of 14 bits is 4.4 / 16383 mm, and rounding moves by half on
  // each axis.
  const double bound = 0.5 * std::sqrt(3.0) * 4.4 / 16383 + 1e-6;
  for (draco::PointIndex i(0); i < decoded->num_points(); ++i) {
    Eigen::Vector3f p;
    position->GetMappedValue(i, p.data());
    float nearest = 1e9F;
    for (const Float3& q : meshes[0].position)
      nearest = std::min(nearest, (Eigen::Vector3f(q.data()) - p).norm());
    EXPECT_LT(nearest, bound);
  }
}

TEST(GltfDraco, RefusesBitsOutOfRange) {
  const auto meshes = sample();
  EXPECT_THROW(encodeGltf(meshes, true, {.draco = true, .dracoPositionBits = 31}), Error);
  EXPECT_THROW(encodeGltf(meshes, true, {.draco = true, .dracoNormalBits = 1}), Error);
}

// OpenMesh's readers take a stream; the extension chooses the format.
TriMesh readBack(const std::string& bytes, const char* extension) {
  TriMesh mesh;
  std::istringstream stream(bytes);
  OpenMesh::IO::Options options(OpenMesh::IO::Options::VertexNormal);
  if (std::string(extension) != ".OBJ") options += OpenMesh::IO::Options::Binary;
  EXPECT_TRUE(OpenMesh::IO::read_mesh(mesh, stream, extension, options));
  return mesh;
}

TEST(Obj, ReadsBackWithItsNormals) {
  const auto meshes = sample();
  const TriMesh mesh = readBack(encodeObj(meshes), ".OBJ");
  EXPECT_EQ(mesh.n_vertices(), verticesOf(meshes));
  EXPECT_EQ(mesh.n_faces(), facesOf(meshes));
  const TriMesh::VertexHandle first(0);
  EXPECT_EQ(mesh.point(first), TriMesh::Point(meshes[0].position[0].data()));
  EXPECT_EQ(mesh.normal(first), TriMesh::Normal(meshes[0].normal[0].data()));
}

TEST(Obj, NamesItsBranchesWithoutSpacesAndOnlyOnce) {
  auto meshes = sample();
  meshes[0].label = "side_a";
  const std::string text = encodeObj(meshes);
  EXPECT_NE(text.find("\no side_a\n"), std::string::npos);
  EXPECT_NE(text.find("\no side_a_2\n"), std::string::npos);
  EXPECT_EQ(text.find("empty"), std::string::npos);
  EXPECT_NE(text.find("millimetres, LPS"), std::string::npos);
}

TEST(Ply, ReadsBackWithItsNormals) {
  const auto meshes = sample();
  const std::string bytes = encodePly(meshes);
  EXPECT_NE(bytes.find("comment branch 2 side_a\n"), std::string::npos);
  const TriMesh mesh = readBack(bytes, ".PLY");
  EXPECT_EQ(mesh.n_vertices(), verticesOf(meshes));
  EXPECT_EQ(mesh.n_faces(), facesOf(meshes));
  const TriMesh::VertexHandle first(0);
  EXPECT_EQ(mesh.point(first), TriMesh::Point(meshes[0].position[0].data()));
  EXPECT_EQ(mesh.normal(first), TriMesh::Normal(meshes[0].normal[0].data()));
}

TEST(Stl, HasFiftyBytesPerTriangleAndUnitNormals) {
  const auto meshes = sample();
  const std::string bytes = encodeStl(meshes);
  const std::size_t faces = facesOf(meshes);
  ASSERT_EQ(bytes.size(), 84 + 50 * faces);
  EXPECT_NE(bytes.substr(0, 80).find("mm, LPS"), std::string::npos);
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  EXPECT_EQ(count, faces);
  std::array<float, 12> facet{};
  std::memcpy(facet.data(), bytes.data() + 84, sizeof facet);
  EXPECT_NEAR(std::hypot(facet[0], facet[1], facet[2]), 1, 1e-6);
  EXPECT_EQ(readBack(bytes, ".STL").n_faces(), faces);
}

TEST(WriteMesh, GivesTheSameBytesEachTime) {
  const auto meshes = sample();
  EXPECT_EQ(encodeGltf(meshes, true, {.draco = true}), encodeGltf(meshes, true, {.draco = true}));
  EXPECT_EQ(encodeGltf(meshes, false, {}), encodeGltf(meshes, false, {}));
}

}  // namespace
}  // namespace lumen::convert
