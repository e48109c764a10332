// SPDX-License-Identifier: Apache-2.0
// Options of meshes, from outside.
#include <sstream>

#include <nlohmann/json.hpp>

#include "formats/case/case_file.h"
#include "run_lumen.h"

namespace lumen::test {
namespace {

/// good.lumen: two nodes with models, one branch "tube"; the tree states no inlier rates.
class MeshOptionsTest : public CliTest {
protected:
  void SetUp() override {
    formats::Case value;
    auto& tree = value.tree;
    tree.centre = {{0, 0, 0}, {0, 0, 1}};
    tree.direction = {{0, 0, 1}, {0, 0, 1}};
    tree.radius = {1, 1};
    tree.height = {1, 1};
    tree.parent = {-1, 0};
    tree.branch = {0, 0};
    formats::Branch branch;
    branch.label = "tube";
    branch.nodeCount = 2;
    tree.branches = {branch};
    value.models = formats::BlobbyModels{formats::Kernel::Cauchy, 0.2,         0.1, {0, 1, 2},
                                         {{0, 0, 0}, {0, 0, 1}},  {0.5f, 0.5f}};
    value.metadata.voxelSize = 0.1;
    ASSERT_TRUE(formats::writeCaseFile(value, path("good.lumen")));
  }

  [[nodiscard]] nlohmann::json gltf(const std::vector<std::string>& options) const {
    std::vector<std::string> command{"convert", "good.lumen", "a.gltf"};
    command.insert(command.end(), options.begin(), options.end());
    const Outcome made = lumen(command);
    EXPECT_EQ(made.code, 0) << made.err;
    return nlohmann::json::parse(read("a.gltf"));
  }
};

TEST_F(MeshOptionsTest, CompressionsAreThoseThatWereAskedFor) {
  EXPECT_FALSE(gltf({}).contains("extensionsRequired"));
  EXPECT_EQ(gltf({"--draco"})["extensionsRequired"][0], "KHR_draco_mesh_compression");
  EXPECT_EQ(gltf({"--meshopt"})["extensionsRequired"][0], "EXT_meshopt_compression");
  const Outcome both = lumen({"convert", "good.lumen", "b.glb", "--draco", "--meshopt"});
  EXPECT_EQ(both.code, 2) << both.err;
  EXPECT_FALSE(exists("b.glb"));
}

TEST_F(MeshOptionsTest, LevelsHaveFewerFacesEach) {
  const nlohmann::json content = gltf({"--lod", "3", "--patches"});
  EXPECT_EQ(content["meshes"].size(), 3U);
  const auto indices = [&](std::size_t mesh) -> std::size_t {
    std::size_t count = 0;
    for (const auto& primitive : content["meshes"][mesh]["primitives"])
      count +=
          content["accessors"][primitive["indices"].get<std::size_t>()]["count"].get<std::size_t>();
    return count;
  };
  EXPECT_LT(indices(1), indices(0));
  EXPECT_LT(indices(2), indices(1));
}

TEST_F(MeshOptionsTest, MeshesAreNamedByTheirBranchesOnRequest) {
  EXPECT_EQ(gltf({})["meshes"][0]["name"], "vessels");
  EXPECT_EQ(gltf({"--mesh-per", "branch"})["meshes"][0]["name"], "tube");
}

TEST_F(MeshOptionsTest, ColorsSayWhatTheyShow) {
  EXPECT_FALSE(gltf({})["meshes"][0]["extras"].contains("color"));
  EXPECT_EQ(gltf({"--color", "radius"})["meshes"][0]["extras"]["color"]["by"], "radius");
  const Outcome unknown = lumen({"convert", "good.lumen", "b.glb", "--color", "confidence"});
  EXPECT_EQ(unknown.code, 3);
  EXPECT_NE(unknown.err.find("color confidence"), std::string::npos) << unknown.err;
  EXPECT_FALSE(exists("b.glb"));
}

TEST_F(MeshOptionsTest, StlIsTextWithSolidsOnRequest) {
  EXPECT_EQ(lumen({"convert", "good.lumen", "a.stl"}).code, 0);
  EXPECT_FALSE(read("a.stl").starts_with("solid"));
  EXPECT_EQ(lumen({"convert", "good.lumen", "b.stl", "--stl-solids"}).code, 0);
  EXPECT_TRUE(read("b.stl").starts_with("solid "));
}

}  // namespace
}  // namespace lumen::test
