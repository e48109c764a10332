// SPDX-License-Identifier: Apache-2.0
// Units, axes and roots of files of other programs: what these state, what a person states, and what
// the answer says of both.
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/cli/run_lumen.h"
#include "tests/unit/centerline/line_files.h"
#include "tests/unit/trees_from_surfaces/tube_mesh.h"

namespace lumen::test {

namespace {

using Json = nlohmann::ordered_json;

/// A tube of radius 2 and length 40 along x from `start`, as a glTF without buffers of its own.
std::string gltfOf(const convert::TriangleMesh& mesh) {
  std::string bytes;
  const auto add = [&](const auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  for (const auto& p : mesh.position)  // +y up, +z front
    for (const double x : {p.x(), p.z(), -p.y()}) add(static_cast<float>(x));
  const std::size_t positions = bytes.size();
  for (const auto& t : mesh.triangle)
    for (const std::uint32_t i : t) add(i);
  Json scene = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", Json::array({{{"nodes", {0}}}})},
      {"nodes", Json::array({{{"mesh", 0}}})},
      {"meshes",
       Json::array(
           {{{"primitives", Json::array({{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}})}}})},
      {"accessors", Json::array({{{"bufferView", 0},
                                  {"componentType", 5126},
                                  {"count", mesh.position.size()},
                                  {"type", "VEC3"}},
                                 {{"bufferView", 1},
                                  {"componentType", 5125},
                                  {"count", 3 * mesh.triangle.size()},
                                  {"type", "SCALAR"}}})},
      {"bufferViews",
       Json::array(
           {{{"buffer", 0}, {"byteLength", positions}},
            {{"buffer", 0}, {"byteOffset", positions}, {"byteLength", bytes.size() - positions}}})},
      {"buffers", Json::array({{{"byteLength", bytes.size()}, {"uri", "tube.bin"}}})}};
  return scene.dump() + "\n" + bytes;
}

}  // namespace

class StatedFactsTest : public CliTest {
protected:
  /// Writes tube.gltf, whose numbers are mm.
  void writeGltf(double scale) const {
    convert::TriangleMesh mesh = convert::test::tube(convert::test::straight(40), 2, false);
    for (auto& p : mesh.position) p *= scale;
    const std::string both = gltfOf(mesh);
    const std::size_t end = both.find('\n');
    write("tube.gltf", both.substr(0, end));
    write("tube.bin", both.substr(end + 1));
  }
  [[nodiscard]] std::string rootOf(const std::string& file) const {
    const Outcome done = lumen({"convert", file, "root.swc", "--quiet"});
    EXPECT_EQ(done.code, 0) << done.err;
    std::istringstream lines(readFile(path("root.swc")));
    std::string line;
    while (std::getline(lines, line))
      if (!line.starts_with("#")) return line;
    return {};
  }
};

TEST_F(StatedFactsTest, GltfIsInMetresByItsStandardAndAPersonOverridesIt) {
  writeGltf(1);
  const Outcome taken = lumen({"convert", "tube.gltf", "t.lumen"});
  ASSERT_EQ(taken.code, 0) << taken.err;
  EXPECT_TRUE(contains(taken.out, "unit m, by the standard of glTF")) << taken.out;
  EXPECT_TRUE(contains(taken.err, "implausible; in mm they would be vessels of")) << taken.err;
  EXPECT_TRUE(contains(taken.err, "--unit states the unit")) << taken.err;
  const Outcome stated = lumen({"convert", "tube.gltf", "t.lumen", "--unit", "mm"});
  ASSERT_EQ(stated.code, 0) << stated.err;
  EXPECT_TRUE(contains(stated.out, ", 38.0 mm\n")) << stated.out;  // up to its ends' radii
  EXPECT_FALSE(contains(stated.err, "implausible")) << stated.err;
  EXPECT_TRUE(
      contains(lumen({"info", "tube.gltf", "--unit", "mm"}).out, "unit          mm, as --unit"));
}

TEST_F(StatedFactsTest, GltfOfPlausibleSizeGetsNoWarningOfIt) {
  writeGltf(0.001);
  const Outcome done = lumen({"info", "tube.gltf", "--json"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_FALSE(contains(done.err, "implausible")) << done.err;
  const Json facts = Json::parse(done.out);
  EXPECT_EQ(facts["unit"], "m");
  EXPECT_EQ(facts["unit_from"], "standard");
  EXPECT_NEAR(facts["high_mm"][0].get<double>(), 40, 1e-3);
}

TEST_F(StatedFactsTest, ACenterlineHasARootThatAPersonStates) {
  const convert::test::LineFile fork = convert::test::fork();
  write("f.vtp", convert::test::vtpOf(fork));
  EXPECT_TRUE(rootOf("f.vtp").ends_with(" 0 0 0 2 -1")) << rootOf("f.vtp");
  const Outcome done = lumen({"convert", "f.vtp", "f.lumen", "--root=-9,0,32"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_TRUE(contains(rootOf("f.lumen"), " -9 0 32 1.2 -1")) << rootOf("f.lumen");
  EXPECT_EQ(lumen({"convert", "f.vtp", "f.lumen", "--root=500,0,0"}).code, 1);
}

TEST_F(StatedFactsTest, ARootIsStatedInTheCoordinatesOfAnInputFarFromZero) {
  convert::test::LineFile fork = convert::test::fork();
  for (auto& p : fork.points) p += Eigen::Vector3d(2'000'100, 0, -3e4);
  write("f.vtp", convert::test::vtpOf(fork));
  for (const char* root : {"--root=2000091,0,-29968", "--root=91,0,32"}) {
    const Outcome done = lumen({"convert", "f.vtp", "f.lumen", root});
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_TRUE(contains(rootOf("f.lumen"), " 91 0 32 1.2 -1")) << root << rootOf("f.lumen");
  }
}

TEST_F(StatedFactsTest, AStatedUnitThatNoVesselHasGetsAWarning) {
  convert::test::LineFile fork = convert::test::fork();
  const std::string field =
      R"(<FieldData><Array type="String" Name="Unit" NumberOfTuples="1" format="ascii">109 0</Array></FieldData>)";
  write("f.vtp", convert::test::vtpOf(fork, field));
  write("s.swc", "# units: m\n1 0 0 0 0 2 -1\n2 0 0 0 90 2 1\n");
  convert::TriangleMesh mesh = convert::test::tube(convert::test::straight(40), 2, false);
  std::ostringstream obj;
  obj << "# units: m\n";
  for (const auto& p : mesh.position) obj << "v " << p.x() << " " << p.y() << " " << p.z() << "\n";
  for (const auto& t : mesh.triangle)
    obj << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  write("t.obj", obj.str());
  for (const char* file : {"f.vtp", "s.swc", "t.obj"}) {
    const Outcome done = lumen({"info", file});
    EXPECT_EQ(done.code, 0) << done.err;
    EXPECT_TRUE(contains(done.out, "m, as the file states")) << done.out;
    EXPECT_TRUE(contains(done.err, ": by the unit that it states it holds vessels of "))
        << done.err;
    EXPECT_TRUE(contains(done.err, "implausible; in mm they would be")) << done.err;
    EXPECT_FALSE(contains(lumen({"info", file, "--unit", "mm"}).err, "implausible"));
  }
}

TEST_F(StatedFactsTest, LegacyLinesAreFoundByTheirContent) {
  const convert::test::LineFile fork = convert::test::fork();
  for (const bool isBinary : {false, true}) {
    write("f.vtk",
          convert::test::legacyOf(fork, isBinary, isBinary, "3D Slicer output. SPACE=RAS"));
    const Outcome done = lumen({"convert", "f.vtk", "f.lumen"});
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_TRUE(contains(done.err, "x and y were negated")) << done.err;
    EXPECT_TRUE(contains(rootOf("f.lumen"), " 0 0 0 2 -1")) << rootOf("f.lumen");
    EXPECT_TRUE(
        contains(lumen({"info", "f.vtk"}).out, "unit        mm, by its size\naxes        LPS"));
  }
}

TEST_F(StatedFactsTest, AxesOfSurfacesAndCenterlinesMayBeStated) {
  std::ostringstream obj;
  const convert::TriangleMesh mesh = convert::test::tube(convert::test::straight(40), 2, false);
  for (const auto& p : mesh.position) obj << "v " << p.x() << " " << p.y() << " " << p.z() << "\n";
  for (const auto& t : mesh.triangle)
    obj << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  write("t.obj", obj.str());
  const auto highX = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"info", "t.obj", "--json"});
    const Outcome done = lumen(more);
    EXPECT_EQ(done.code, 0) << done.err;
    return Json::parse(done.out)["high_mm"][0].get<double>();
  };
  EXPECT_NEAR(highX({}), 40, 1e-3);
  EXPECT_NEAR(highX({"--frame", "lps"}), 40, 1e-3);
  EXPECT_NEAR(highX({"--frame", "ras"}), 0, 1e-3);
  const Outcome done = lumen({"convert", "t.obj", "t.lumen", "--frame", "ras"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_TRUE(contains(done.out, "axes LPS")) << done.out;
}

TEST_F(StatedFactsTest, TheAnswerStatesUnitAndAxesOfACenterline) {
  write("t.swc", "# units: um\n1 0 0 0 0 200 -1\n2 0 0 0 9000 200 1\n");
  const Outcome done = lumen({"convert", "t.swc", "t.lumen", "--json"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(Json::parse(done.out)["centerline"],
            Json({{"unit", "um"}, {"unit_from", "file"}, {"frame_stated", false}}));
  const Outcome text = lumen({"convert", "t.swc", "t.lumen"});
  EXPECT_TRUE(contains(text.out, "centerline read    unit um, as the file states; axes not stated"))
      << text.out;
}

// Files that came out wrong for users; the folder is beside the repository, and not part of it.
TEST_F(StatedFactsTest, FilesOfUsersHaveTheLengthsOfTheirTrees) {
  const std::filesystem::path folder = std::filesystem::path(LUMEN_SHARED_DATA) / "../hostile/4";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is missing";
  struct Known {
    const char* file;
    double least, most;
  };
  for (const auto& [file, least, most] :
       {Known{"2-two-point-lines/one-turned.vtp", 65, 67},
        Known{"2-two-point-lines/triangle.vtp", 65, 67},
        Known{"2-two-point-lines/all-turned.vtp", 65, 67},
        Known{"2-two-point-lines/unshared.vtp", 65, 67},
        Known{"8-tree-falls-apart/mixed.vtp", 65, 67},
        Known{"9-inlet-of-a-network/network.vtp", 65, 67},
        Known{"11-legacy-vtk-lines/lines.vtk", 65, 67},
        Known{"3-centerline-in-cm/lines.vtp", 390, 400},
        Known{"7-swc-states-its-unit/micrometres.swc", 0.74, 0.76},
        Known{"7-swc-states-its-unit/nanometres.swc", 74, 77}}) {
    const Outcome done = lumen({"info", (folder / file).string(), "--json"});
    ASSERT_EQ(done.code, 0) << done.err;
    const Json facts = Json::parse(done.out);
    EXPECT_EQ(facts["trees"], 1) << file;
    EXPECT_GE(facts["length_mm"].get<double>(), least) << file;
    EXPECT_LE(facts["length_mm"].get<double>(), most) << file;
  }
}

}  // namespace lumen::test
