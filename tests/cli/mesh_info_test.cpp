// SPDX-License-Identifier: Apache-2.0
// lumen info of meshes: of those that lumen wrote, and of others.
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/cli/run_lumen.h"

namespace lumen::test {

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
