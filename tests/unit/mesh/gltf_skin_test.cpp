// SPDX-License-Identifier: Apache-2.0
// Skins and animations of glTF, as tinygltf and Draco's decoder read them.
#include <cmath>
#include <memory>
#include <set>

#include <Eigen/Geometry>
#include <draco/compression/decode.h>

#include "capped_tube.h"
#include "gltf_reading.h"

namespace lumen::convert {
namespace {

using test::cappedTube;
using test::loadGltf;
using test::valuesOf;

// Joint 0 rests, joint 1 moves from (0, 0, 2) mm by 3 mm along x, turns and grows.
MeshSkin skinOfTube(const SurfaceMesh& surface) {
  MeshSkin skin;
  skin.name = {"rest", "node-1"};
  skin.rest = {{0, 0, 0}, {0, 0, 2}};
  MeshSkin::Vertices& vertices = skin.levels.emplace_back();
  for (const Float3& p : surface.position) {
    const auto share = static_cast<std::uint16_t>(65535 * std::min(p[2] / 4, 1.0F));
    vertices.joint.push_back({0, 1, 0, 0});
    vertices.weight.push_back({static_cast<std::uint16_t>(65535 - share), share, 0, 0});
  }
  skin.time = {0, 0.5F};
  skin.translation = {{}, {{0, 0, 2}, {3, 0, 2}}};
  skin.rotation = {{}, {{0, 0, 0, 1}, {0, 0, 0.6F, 0.8F}}};
  skin.scale = {{}, {1, 1.25F}};
  return skin;
}

std::string skinned(const WriteMeshOptions& options = {}) {
  const SurfaceMesh surface = cappedTube({"a", "b", "c"});
  const MeshSkin skin = skinOfTube(surface);
  return encodeGltf(std::span(&surface, 1), true, options, &skin);
}

Eigen::Matrix4d matrixOf(const std::vector<double>& columns) {
  return Eigen::Map<const Eigen::Matrix4d>(columns.data());
}

TEST(GltfSkin, LeavesVerticesWhereTheyAreAtRest) {
  const tinygltf::Model model = loadGltf(skinned());
  ASSERT_EQ(model.skins.size(), 1U);
  const tinygltf::Skin& skin = model.skins[0];
  const auto inverse = valuesOf<std::array<float, 16>>(model, skin.inverseBindMatrices);
  const Eigen::Matrix4d root = matrixOf(model.nodes[0].matrix);
  ASSERT_EQ(inverse.size(), skin.joints.size());
  for (std::size_t j = 0; j < inverse.size(); ++j) {
    const auto& node = model.nodes[static_cast<std::size_t>(skin.joints[j])];
    Eigen::Matrix4d joint = Eigen::Matrix4d::Identity();
    for (int i = 0; i < 3; ++i)
      joint(i, 3) = node.translation.empty() ? 0 : node.translation[static_cast<std::size_t>(i)];
    const Eigen::Matrix4d bound =
        Eigen::Map<const Eigen::Matrix4f>(inverse[j].data()).cast<double>();
    EXPECT_TRUE((root * joint * bound).isIdentity(1e-9)) << j;
  }
}

TEST(GltfSkin, HasMeshesAsRootsInMetres) {
  const SurfaceMesh surface = cappedTube({"a", "b", "c"});
  const tinygltf::Model model = loadGltf(skinned());
  ASSERT_EQ(model.scenes[0].nodes.size(), 2U);
  const auto& node = model.nodes[static_cast<std::size_t>(model.scenes[0].nodes[1])];
  EXPECT_EQ(node.skin, 0);
  EXPECT_TRUE(node.matrix.empty() && node.translation.empty());
  std::set<Float3> wanted;
  for (const Float3& p : surface.position) wanted.insert({p[0] / 1000, p[2] / 1000, -p[1] / 1000});
  for (const tinygltf::Primitive& primitive : model.meshes[0].primitives)
    for (const Float3& p : valuesOf<Float3>(model, primitive.attributes.at("POSITION"))) {
      const bool isThere = std::any_of(wanted.begin(), wanted.end(), [&](const Float3& w) {
        return std::hypot(w[0] - p[0], w[1] - p[1], w[2] - p[2]) < 1e-9;
      });
      EXPECT_TRUE(isThere);
    }
}

TEST(GltfSkin, GivesEveryVertexWeightsThatAddUpToOne) {
  const tinygltf::Model model = loadGltf(skinned());
  for (const tinygltf::Primitive& primitive : model.meshes[0].primitives) {
    const auto joints = valuesOf<MeshSkin::Four>(model, primitive.attributes.at("JOINTS_0"));
    const auto weights = valuesOf<MeshSkin::Four>(model, primitive.attributes.at("WEIGHTS_0"));
    const auto positions = valuesOf<Float3>(model, primitive.attributes.at("POSITION"));
    ASSERT_EQ(weights.size(), joints.size());
    for (std::size_t v = 0; v < weights.size(); ++v) {
      EXPECT_EQ(weights[v][0] + weights[v][1], 65535);
      EXPECT_NEAR(weights[v][1], 65535 * std::min(250 * positions[v][1], 1.0F), 1.01);
    }
  }
}

TEST(GltfSkin, AnimatesWithLinearSamplers) {
  const tinygltf::Model model = loadGltf(skinned());
  ASSERT_EQ(model.animations.size(), 1U);
  const tinygltf::Animation& animation = model.animations[0];
  ASSERT_EQ(animation.channels.size(), 3U);  // of the joint that moves
  for (const tinygltf::AnimationSampler& sampler : animation.samplers)
    EXPECT_EQ(sampler.interpolation, "LINEAR");
  const auto outputOf = [&](const char* path) {
    for (const tinygltf::AnimationChannel& channel : animation.channels)
      if (channel.target_path == path)
        return animation.samplers[static_cast<std::size_t>(channel.sampler)].output;
    return -1;
  };
  EXPECT_EQ(valuesOf<float>(model, animation.samplers[0].input), (std::vector<float>{0, 0.5F}));
  EXPECT_EQ(valuesOf<Float3>(model, outputOf("translation"))[1], (Float3{3, 0, 2}));
  EXPECT_EQ((valuesOf<std::array<float, 4>>(model, outputOf("rotation"))[1]),
            (std::array<float, 4>{0, 0, 0.6F, 0.8F}));
  EXPECT_EQ(valuesOf<Float3>(model, outputOf("scale"))[1], (Float3{1.25F, 1.25F, 1.25F}));
}

TEST(GltfSkin, SurvivesDracoBitForBit) {
  WriteMeshOptions options;
  options.draco = true;
  const tinygltf::Model model = loadGltf(skinned(options));
  for (const tinygltf::Primitive& primitive : model.meshes[0].primitives) {
    const auto& extension = primitive.extensions.at("KHR_draco_mesh_compression");
    const auto& view =
        model.bufferViews[static_cast<std::size_t>(extension.Get("bufferView").GetNumberAsInt())];
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(model.buffers[0].data.data() + view.byteOffset),
                view.byteLength);
    const std::unique_ptr<draco::Mesh> mesh =
        draco::Decoder().DecodeMeshFromBuffer(&buffer).value();
    const auto attributeOf = [&](const char* name) {
      return mesh->GetAttributeByUniqueId(
          static_cast<std::uint32_t>(extension.Get("attributes").Get(name).GetNumberAsInt()));
    };
    const auto* weight = attributeOf("WEIGHTS_0");
    const auto* joint = attributeOf("JOINTS_0");
    const auto* position = attributeOf("POSITION");
    for (draco::PointIndex i(0); i < mesh->num_points(); ++i) {
      MeshSkin::Four joints{}, weights{};
      Float3 p{};
      joint->GetMappedValue(i, joints.data());
      weight->GetMappedValue(i, weights.data());
      position->GetMappedValue(i, p.data());
      EXPECT_EQ(joints, (MeshSkin::Four{0, 1, 0, 0}));
      EXPECT_EQ(weights[0] + weights[1], 65535);
      EXPECT_NEAR(weights[1], 65535 * std::min(250 * p[1], 1.0F), 4);  // positions are rounded
    }
  }
}

}  // namespace
}  // namespace lumen::convert
