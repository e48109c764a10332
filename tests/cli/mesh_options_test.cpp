// SPDX-License-Identifier: Apache-2.0
// Options of meshes, from outside.
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "formats/case/case_file.h"
#include "run_lumen.h"
#include "tests/cli/run_lumen.h"

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

// lumen info of meshes: of those that lumen wrote, and of others.
using Json = nlohmann::ordered_json;

class MeshInfoTest : public FittedTubeTest {
protected:
  Json info(const std::vector<std::string>& arguments) {
    std::vector<std::string> line = {"info"};
    line.insert(line.end(), arguments.begin(), arguments.end());
    line.emplace_back("--json");
    const Outcome outcome = lumen(line);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Json::parse(outcome.out, nullptr, false);
  }
};

TEST_F(MeshInfoTest, WhatLumenWritesComesBackInMillimetresAndLps) {
  ASSERT_EQ(lumen({"convert", "tube.lumen", "a.obj"}).code, 0);
  const Json obj = info({"a.obj"});
  for (const char* name : {"a.glb", "a.gltf", "a.ply", "a.stl"}) {
    ASSERT_EQ(lumen({"convert", "tube.lumen", name}).code, 0) << name;
    const Json other = info({name});
    EXPECT_EQ(other["unit"], "mm") << name;
    EXPECT_EQ(other["unit_from"], "file") << name;
    EXPECT_EQ(other["frame_stated"], true) << name;
    EXPECT_EQ(other["triangles"], obj["triangles"]) << name;
    // texts of floats are read as doubles
    for (const char* corner : {"low_mm", "high_mm"})
      for (std::size_t a = 0; a < 3; ++a)
        EXPECT_EQ(other[corner][a].get<float>(), obj[corner][a].get<float>()) << name;
    EXPECT_NEAR(other["area_mm2"].get<double>(), obj["area_mm2"].get<double>(), 1e-6) << name;
  }
  ASSERT_EQ(lumen({"convert", "tube.lumen", "draco.glb", "--draco"}).code, 0);
  const Json draco = info({"draco.glb"});
  EXPECT_NEAR(draco["area_mm2"].get<double>(), obj["area_mm2"].get<double>(),
              0.01 * obj["area_mm2"].get<double>());
}

TEST_F(MeshInfoTest, TheUnitIsGuessedAndAnnounced) {
  // a box of 0.1 x 0.01 x 0.01: a vessel in metres
  write(
      "box.obj",
      "v 0 0 0\nv .1 0 0\nv .1 .01 0\nv 0 .01 0\nv 0 0 .01\nv .1 0 .01\nv .1 .01 .01\nv 0 .01 .01\n"
      "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const Outcome guessed = lumen({"info", "box.obj"});
  EXPECT_EQ(guessed.code, 0);
  EXPECT_NE(guessed.err.find("taken to be in m: vessels of 4.76 mm radius"), std::string::npos)
      << guessed.err;
  EXPECT_NEAR(info({"box.obj"})["volume_mm3"].get<double>(), 1e4, 1e-6);
  const Outcome stated = lumen({"info", "box.obj", "--unit", "cm"});
  EXPECT_EQ(stated.err.find("warning"), std::string::npos) << stated.err;
  EXPECT_NEAR(info({"box.obj", "--unit", "cm"})["volume_mm3"].get<double>(), 0.01, 1e-9);
}

}  // namespace lumen::test
