// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/write_gltf.h"

#include "capped_tube.h"
#include "converters/base/error.h"
#include "gltf_reading.h"

namespace lumen::convert {
namespace {

using test::cappedTube;
using test::gltfOf;
using test::hostileLabels;
using test::loadGltf;
using test::valuesOf;

class Gltf : public testing::TestWithParam<bool> {};

TEST_P(Gltf, ReadsBackWithItsFacesInNamedAndNumberedGroups) {
  const SurfaceMesh surface = cappedTube(hostileLabels());
  const tinygltf::Model model = loadGltf(gltfOf(surface, {}, GetParam()), GetParam());
  ASSERT_EQ(model.meshes.size(), 1U);
  const tinygltf::Mesh& mesh = model.meshes[0];
  EXPECT_EQ(test::facesOf(model, mesh), test::facesOf(surface));
  ASSERT_EQ(mesh.primitives.size(), 3U);
  const std::array<std::string, 3> kinds{"wall", "inlet", "outlet"};
  for (std::size_t g = 0; g < 3; ++g) {
    const auto& extras = mesh.primitives[g].extras;
    EXPECT_EQ(extras.Get("name").Get<std::string>(), surface.groups[g].name);
    EXPECT_EQ(extras.Get("number").GetNumberAsInt(), static_cast<int>(g) + 1);
    EXPECT_EQ(extras.Get("kind").Get<std::string>(), kinds[g]);
  }
  const auto& labels = mesh.extras.Get("branches");
  ASSERT_EQ(labels.ArrayLen(), surface.labels.size());
  for (int i = 0; i < static_cast<int>(labels.ArrayLen()); ++i)
    EXPECT_EQ(labels.Get(i).Get<std::string>(), surface.labels[static_cast<std::size_t>(i)]);
}

TEST_P(Gltf, VerticesKeepTheirValuesAndFlatEndsHaveNormalsOfTheirOwn) {
  const SurfaceMesh surface = cappedTube({"low", "middle", "high"});
  const tinygltf::Model model = loadGltf(gltfOf(surface, {}, GetParam()), GetParam());
  const std::array<Float3, 3> flat{Float3{}, Float3{0, 0, -1}, Float3{0, 0, 1}};
  for (const tinygltf::Primitive& primitive : model.meshes.at(0).primitives) {
    const auto position = valuesOf<Float3>(model, primitive.attributes.at("POSITION"));
    const auto normal = valuesOf<Float3>(model, primitive.attributes.at("NORMAL"));
    const auto radius = valuesOf<float>(model, primitive.attributes.at("_RADIUS"));
    const auto confidence = valuesOf<float>(model, primitive.attributes.at("_CONFIDENCE"));
    const auto branch = valuesOf<std::uint16_t>(model, primitive.attributes.at("_BRANCH"));
    for (std::size_t v = 0; v < position.size(); ++v) {
      const Float3& p = position[v];
      EXPECT_EQ(radius[v], 1 + 0.1F * p[2]);
      EXPECT_EQ(confidence[v], 1 - 0.2F * p[2]);
      EXPECT_EQ(branch[v], p[2] < 2 ? 0 : 2);
      const auto group = static_cast<std::size_t>(test::numberOf(primitive) - 1);
      EXPECT_EQ(normal[v], group == 0 ? (Float3{p[0], p[1], 0}) : flat.at(group));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, Gltf, testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Binary" : "Json"; });

TEST(GltfVertices, HaveNoConfidenceWhereItIsUnknown) {
  SurfaceMesh surface = cappedTube({"a"});
  surface.confidence.clear();
  const tinygltf::Model model = loadGltf(gltfOf(surface));
  EXPECT_FALSE(model.meshes.at(0).primitives.at(0).attributes.contains("_CONFIDENCE"));
  EXPECT_THROW(gltfOf(surface, {.color = ColorBy::Confidence}), Error);
}

TEST(GltfVertices, HaveNoBranchWhereSixteenBitsCannotCountThem) {
  const auto has = [](std::size_t branches) {
    std::vector<std::string> labels;
    for (std::size_t b = 0; b < branches; ++b) labels.push_back(std::to_string(b));
    const tinygltf::Model model = loadGltf(gltfOf(cappedTube(labels)));
    return model.meshes.at(0).primitives.at(0).attributes.contains("_BRANCH");
  };
  EXPECT_TRUE(has(65536));
  EXPECT_FALSE(has(65537));
}

TEST(GltfMeshes, AreOneForEachBranchOnRequest) {
  const SurfaceMesh surface = cappedTube({"low", "none of it", "high"});
  const tinygltf::Model model = loadGltf(gltfOf(surface, {.per = MeshPer::Branch}));
  ASSERT_EQ(model.meshes.size(), 2U);
  EXPECT_EQ(model.meshes[0].name, "low");
  EXPECT_EQ(model.meshes[1].name, "high");
  EXPECT_EQ(model.nodes.at(0).children, (std::vector<int>{1, 2}));
  EXPECT_EQ(model.nodes.at(1).name, "low");
  EXPECT_EQ(model.nodes.at(2).name, "high");
  test::Faces all = test::facesOf(model, model.meshes[0]);
  all.merge(test::facesOf(model, model.meshes[1]));
  EXPECT_EQ(all, test::facesOf(surface));
}

TEST(GltfFrame, TakesLpsMillimetresToMetresWithSuperiorUp) {
  const auto at = [](std::size_t row, const std::array<double, 3>& p) {
    return kGltfFromLps[row] * p[0] + kGltfFromLps[4 + row] * p[1] + kGltfFromLps[8 + row] * p[2] +
           kGltfFromLps[12 + row];
  };
  const std::array<double, 3> lps{1, 2, 3};  // 1 mm left, 2 mm posterior, 3 mm superior
  EXPECT_DOUBLE_EQ(at(0, lps), 0.001);       // left
  EXPECT_DOUBLE_EQ(at(1, lps), 0.003);       // up
  EXPECT_DOUBLE_EQ(at(2, lps), -0.002);      // anterior is +Z, so posterior is -Z
  const tinygltf::Model model = loadGltf(gltfOf(cappedTube({"a"})));
  EXPECT_EQ(model.nodes[0].matrix, std::vector<double>(kGltfFromLps.begin(), kGltfFromLps.end()));
  EXPECT_EQ(model.nodes[0].name, "LPS_mm_to_glTF_m");
  EXPECT_EQ(model.nodes[0].extras.Get("unit").Get<std::string>(), "mm");
  EXPECT_EQ(model.asset.generator, "lumen " LUMEN_VERSION);
}

TEST(GltfIndices, AreShortWhereTheyFit) {
  const auto typeFor = [](int around) {
    const tinygltf::Model model = loadGltf(gltfOf(cappedTube({"a"}, around, 6)));
    const int indices = model.meshes.at(0).primitives.at(0).indices;
    return model.accessors.at(static_cast<std::size_t>(indices)).componentType;
  };
  // seven rings: the wall has 65534 and 65541 vertices, and 65535 is the most
  EXPECT_EQ(typeFor(9362), TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
  EXPECT_EQ(typeFor(9363), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
}

TEST(GltfMaterials, AreOneForEachKindAndShowTheInsideOnlyOfAnOpenSurface) {
  const tinygltf::Model closed = loadGltf(gltfOf(cappedTube({"a"})));
  ASSERT_EQ(closed.materials.size(), 3U);
  EXPECT_EQ(closed.materials[0].name, "vessel wall");
  EXPECT_EQ(closed.materials[1].name, "inlet");
  for (const tinygltf::Material& material : closed.materials) EXPECT_FALSE(material.doubleSided);
  const tinygltf::Model open = loadGltf(gltfOf(test::openTube({"a"})));
  ASSERT_EQ(open.materials.size(), 1U);
  EXPECT_TRUE(open.materials[0].doubleSided);
}

TEST(GltfColors, ShowTheRadiusWithItsRange) {
  const tinygltf::Model model = loadGltf(gltfOf(cappedTube({"a"}), {.color = ColorBy::Radius}));
  const auto& color = model.meshes.at(0).extras.Get("color");
  EXPECT_EQ(color.Get("by").Get<std::string>(), "radius");
  EXPECT_EQ(color.Get("unit").Get<std::string>(), "mm");
  EXPECT_FLOAT_EQ(static_cast<float>(color.Get("range").Get(0).GetNumberAsDouble()), 1.0F);
  EXPECT_FLOAT_EQ(static_cast<float>(color.Get("range").Get(1).GetNumberAsDouble()), 1.4F);
  using Rgba = std::array<std::uint16_t, 4>;
  const auto& primitive = model.meshes.at(0).primitives.at(0);
  const auto position = valuesOf<Float3>(model, primitive.attributes.at("POSITION"));
  const auto colors = valuesOf<Rgba>(model, primitive.attributes.at("COLOR_0"));
  for (std::size_t v = 0; v < position.size(); ++v) {
    // viridis ends in sRGB 68, 1, 84 and 253, 231, 37; as linear light by IEC 61966-2-1
    if (position[v][2] == 0) {
      EXPECT_EQ(colors[v], (Rgba{3788, 20, 5810, 65535}));
    }
    if (position[v][2] == 4) {
      EXPECT_EQ(colors[v], (Rgba{64372, 52369, 1212, 65535}));
    }
  }
  EXPECT_EQ(model.materials.at(0).pbrMetallicRoughness.baseColorFactor,
            (std::vector<double>{1, 1, 1, 1}));
}

TEST(GltfLevels, AreNodesOutsideOfTheSceneThatTheFirstNames) {
  const std::array levels{cappedTube({"a", "b"}, 24), cappedTube({"a", "b"}, 12),
                          cappedTube({"a", "b"}, 6)};
  const tinygltf::Model model = loadGltf(encodeGltf(levels, true, {}));
  ASSERT_EQ(model.nodes.size(), 4U);
  EXPECT_EQ(model.scenes.at(0).nodes, std::vector<int>{0});
  EXPECT_EQ(model.nodes[0].children, std::vector<int>{1});
  EXPECT_EQ(model.extensionsUsed, std::vector<std::string>{"MSFT_lod"});
  EXPECT_TRUE(model.extensionsRequired.empty());
  const auto& ids = model.nodes[1].extensions.at("MSFT_lod").Get("ids");
  ASSERT_EQ(ids.ArrayLen(), 2U);
  EXPECT_EQ(model.nodes[1].extras.Get("MSFT_screencoverage").ArrayLen(), 3U);
  for (std::size_t level = 0; level < 3; ++level) {
    const int node = level == 0 ? 1 : ids.Get(static_cast<int>(level) - 1).GetNumberAsInt();
    const int mesh = model.nodes.at(static_cast<std::size_t>(node)).mesh;
    EXPECT_EQ(test::facesOf(model, model.meshes.at(static_cast<std::size_t>(mesh))),
              test::facesOf(levels[level]));
  }
}

TEST(GltfLevels, AreThoseOfEachBranchWhereBranchesAreMeshes) {
  const std::array levels{cappedTube({"a", "b"}, 12), cappedTube({"a", "b"}, 6)};
  const tinygltf::Model model = loadGltf(encodeGltf(levels, true, {.per = MeshPer::Branch}));
  ASSERT_EQ(model.nodes.at(0).children.size(), 2U);
  for (const int child : model.nodes[0].children) {
    const tinygltf::Node& node = model.nodes.at(static_cast<std::size_t>(child));
    const int other = node.extensions.at("MSFT_lod").Get("ids").Get(0).GetNumberAsInt();
    EXPECT_EQ(model.nodes.at(static_cast<std::size_t>(other)).name, node.name);
  }
}

TEST(GltfScene, OfNothingIsARootNode) {
  const tinygltf::Model model = loadGltf(gltfOf({}));
  EXPECT_TRUE(model.meshes.empty());
  EXPECT_EQ(model.nodes.size(), 1U);
}

TEST(GltfBytes, AreTheSameEachTime) {
  const SurfaceMesh surface = cappedTube(hostileLabels());
  for (const WriteMeshOptions& options :
       {WriteMeshOptions{}, WriteMeshOptions{.meshopt = true}, WriteMeshOptions{.draco = true}})
    EXPECT_EQ(gltfOf(surface, options), gltfOf(surface, options));
}

}  // namespace
}  // namespace lumen::convert
