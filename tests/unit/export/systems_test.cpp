// SPDX-License-Identifier: Apache-2.0
// Arteries and veins in exported folders: as colour and as name.
#include <cstddef>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "converters/base/progress.h"
#include "converters/export/export_case.h"
#include "converters/io/mesh/mesh_parts.h"
#include "formats/case/vessel_system.h"
#include "kissing.h"

namespace lumen::test {

using namespace convert;
using formats::VesselSystem;

namespace {

// Vermilion and blue of M. Okabe and K. Ito, sRGB.
constexpr const char *kArtery = "#D55E00", *kVein = "#0072B2";

/// An artery and a vein, 1 mm apart.
formats::Case arteryAndVein() {
  formats::Case value = kissingCase(1);
  std::vector<VesselSystem> systems(value.tree.nodeCount(), VesselSystem::Artery);
  std::fill(systems.begin() + value.tree.branches[1].firstNode, systems.end(), VesselSystem::Vein);
  formats::setNodeSystems(value, systems);
  return value;
}

ExportResult exported(const std::string& target, const formats::Case& value) {
  Progress silent;
  for (const ExportTarget& one : exportTargets())
    if (one.name == target) return exportCase(one, value, {}, {}, silent);
  ADD_FAILURE() << "there is no target " << target;
  return {};
}

std::string fileOf(const ExportResult& result, const std::string& name) {
  for (const ExportFile& file : result.files)
    if (file.name == name) return file.bytes;
  return "";
}

/// The part of a text from a mark up to the end of its line.
std::string lineWith(const std::string& text, const std::string& mark) {
  const std::size_t at = text.find(mark);
  return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST(Systems, EveryFolderNamesThemWithTheirColours) {
  const formats::Case value = arteryAndVein();
  for (const char* target : {"sofa", "steve", "mujoco", "cathsim", "isaac", "grid", "openfoam",
                             "simvascular", "svzerod", "oned", "godot", "slicer", "print"}) {
    const ExportResult result = exported(target, value);
    const auto systems = nlohmann::json::parse(fileOf(result, "lumen-export.json"))["systems"];
    ASSERT_EQ(systems.size(), 2U) << target;
    EXPECT_EQ(systems[0],
              (nlohmann::json{{"name", "artery"}, {"color", kArtery}, {"branches", {"wide"}}}));
    EXPECT_EQ(systems[1],
              (nlohmann::json{{"name", "vein"}, {"color", kVein}, {"branches", {"narrow"}}}));
    EXPECT_TRUE(holds(fileOf(result, "README.md"), "| vein | `#0072B2` | 1 |")) << target;
  }
  const ExportResult plain = exported("svzerod", kissingCase(1));
  EXPECT_FALSE(holds(fileOf(plain, "lumen-export.json"), "systems"));
  EXPECT_FALSE(holds(fileOf(plain, "README.md"), "Systems of vessels"));
}

TEST(Systems, ASceneOfSofaShowsEachByASurfaceOfItsColour) {
  const ExportResult result = exported("sofa", arteryAndVein());
  const std::string scene = fileOf(result, "scene.scn");
  for (const std::string name : {"artery", "vein"}) {
    EXPECT_TRUE(holds(scene, "<Node name=\"view_" + name + "\"")) << name;
    EXPECT_TRUE(holds(scene, "filename=\"vessel-" + name + ".obj\"")) << name;
    EXPECT_TRUE(holds(fileOf(result, "vessel-" + name + ".obj"), "\nf ")) << name;
  }
  EXPECT_TRUE(holds(scene, "color=\"0.835294118 0.368627451 0 0.25\""))
      << lineWith(scene, "color=");
  EXPECT_TRUE(holds(scene, "color=\"0 0.447058824 0.698039216 0.25\""));
  EXPECT_FALSE(holds(scene, "view_vessel"));
  EXPECT_TRUE(holds(fileOf(exported("sofa", kissingCase(1)), "scene.scn"), "view_vessel"));
}

TEST(Systems, NodesOfSofaAreVariablesInPython) {
  formats::Case value = arteryAndVein();
  formats::setNodeSystems(
      value, std::vector<VesselSystem>(value.tree.nodeCount(), VesselSystem::TrueLumen));
  const std::string script = fileOf(exported("sofa", value), "scene.py");
  EXPECT_TRUE(holds(script, "    view_true_lumen = vessel.addChild(\"view_true_lumen\")"));
  EXPECT_TRUE(holds(script, "vessel-true-lumen.obj"));
}

TEST(Systems, EachOtherProgramGetsThemInItsOwnWords) {
  const formats::Case value = arteryAndVein();
  EXPECT_TRUE(holds(fileOf(exported("steve", value), "vessels.py"), "\"narrow\": \"vein\""));
  const auto model = nlohmann::json::parse(fileOf(exported("svzerod", value), "model.json"));
  EXPECT_EQ(model["vessels"][0]["_system"], "artery");
  const std::string scene = fileOf(exported("slicer", value), "scene.mrml");
  EXPECT_TRUE(holds(scene, "name=\"vein\"")) << scene;
  EXPECT_TRUE(holds(scene, "color=\"0 0.447 0.698\" opacity=\"0.5\" visibility=\"true\""));
  const std::string stage = fileOf(exported("isaac", value), "vessel.usda");
  EXPECT_TRUE(holds(stage, "lumen:systems = [\"artery\", \"vein\"]"));
  // 0x72 of sRGB is 0.1683 in linear light, 0xB2 0.4452
  EXPECT_TRUE(holds(stage, "(0, 0.1683, 0.4452)")) << lineWith(stage, "displayColor");
  const std::string glb = fileOf(exported("blender", value), "vessels.glb");
  EXPECT_TRUE(holds(glb, "\"vessel wall, vein\""));
  EXPECT_TRUE(holds(glb, "\"system\":\"artery\""));
  const std::string phantom = fileOf(exported("cathsim", value), "phantom_assets/vessel.xml");
  EXPECT_TRUE(holds(phantom, "rgba=\"0.835 0.369 0 1\"")) << lineWith(phantom, "rgba");
  EXPECT_TRUE(holds(phantom, "rgba=\"0 0.447 0.698 1\""));
  EXPECT_TRUE(holds(fileOf(exported("mujoco", value), "scene.xml"), "rgba=\"0.835 0.369 0 0.3\""));
}

TEST(Systems, ASurfaceIsCutIntoTheTrianglesOfEach) {
  SurfaceMesh surface;
  surface.position.resize(6);
  surface.normal.resize(6);
  surface.branch = {0, 0, 1, 1, 1, 1};
  surface.triangle = {{0, 1, 2}, {1, 2, 3}, {3, 4, 5}};
  surface.group = {0, 0, 0};
  surface.groups = {{"wall", FaceKind::Wall}};
  surface.labels = {"a", "b"};
  EXPECT_TRUE(splitBySystem(surface).empty());
  surface.systems = {VesselSystem::Vein, VesselSystem::Artery};
  const auto parts = splitBySystem(surface);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].name(), "artery");
  EXPECT_EQ(parts[0].surface.triangle.size(), 2U);
  EXPECT_EQ(parts[1].surface.triangle, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(parts[1].surface.position.size(), 6U);
  EXPECT_EQ(mainSystem(surface), VesselSystem::Artery);
}

}  // namespace lumen::test
