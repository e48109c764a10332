// SPDX-License-Identifier: Apache-2.0
// Reports of the commands about a case whose surface closes the path, and about the origin of its nodes.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "formats/case/case_file.h"
#include "formats/case/node_origin.h"
#include "formats/case/vessel_system.h"
#include "tests/cli/run_lumen.h"
#include "tests/unit/formats/beads.h"

namespace lumen::test {

namespace {

using Json = nlohmann::ordered_json;
using formats::test::addBeads;
using formats::test::alongX;

/// A vessel of radius 1 and 13 mm length with a wall 6 mm from its root, node 11 being the first beyond
/// it, and one of 2 mm that leaves it 2 mm from the root, behind a wall of its own, from node 22 on.
formats::Case closedCase() {
  formats::Case value = formats::test::noBeads();
  auto places = alongX(0, 0.5F, 11);
  for (const auto& place : alongX(8, 0.5F, 11)) places.push_back(place);
  addBeads(value, "trunk", places, 1);
  addBeads(value, "arm", {{2, 2.5F, 0}, {2, 3, 0}}, 1, 4);
  return value;
}

}  // namespace

class ReachableTest : public CliTest {
protected:
  void SetUp() override { put("closed.lumen", closedCase()); }
  void put(const std::string& name, const formats::Case& value) const {
    ASSERT_TRUE(formats::writeCaseFile(value, path(name)));
  }
};

TEST_F(ReachableTest, ValidateWarnsOfEveryClosedWayWorstFirst) {
  const Outcome told = lumen({"validate", "closed.lumen"});
  EXPECT_EQ(told.code, 0) << told.err;
  const std::size_t trunk = told.out.find(
      "closed.lumen: warning CLOSED_EDGE at /tree/parent/11: branch trunk is closed "
      "before node 11 at (6.0, 0.0, 0.0): 8.0 mm beyond cannot be reached; lumen fit may open "
      "it\n");
  const std::size_t arm = told.out.find(
      "closed.lumen: warning CLOSED_EDGE at /tree/parent/22: branch arm is closed "
      "before node 22 at (2.0, 1.0, 0.0): 2.0 mm beyond cannot be reached; lumen fit may open "
      "it\n");
  ASSERT_NE(trunk, std::string::npos) << told.out;
  ASSERT_NE(arm, std::string::npos) << told.out;
  EXPECT_LT(trunk, arm);
}

TEST_F(ReachableTest, AClosedWayIsAnErrorWhenStrict) {
  const Outcome told = lumen({"validate", "closed.lumen", "--strict"});
  EXPECT_EQ(told.code, 3);
  EXPECT_TRUE(contains(told.out, "not valid, as --strict makes warnings errors")) << told.out;
}

TEST_F(ReachableTest, ValidateCountsClosedWaysThatItDoesNotList) {
  const Outcome told = lumen({"validate", "closed.lumen", "--json", "--max-issues", "1"});
  const Json file = Json::parse(told.out)["files"][0];
  EXPECT_EQ(file["valid"], true);
  EXPECT_EQ(file["warnings"], 2);
  EXPECT_EQ(file["complete"], false);
  ASSERT_EQ(file["issues"].size(), 1U);
  EXPECT_EQ(file["issues"][0]["code"], "CLOSED_EDGE");
  EXPECT_EQ(file["issues"][0]["number"], 651);
  EXPECT_EQ(file["issues"][0]["severity"], "warning");
  EXPECT_EQ(file["issues"][0]["pointer"], "/tree/parent/11");
  EXPECT_EQ(file["issues"][0]["arguments"]["found"], "8.0");
}

TEST_F(ReachableTest, ValidateReportsTheSurfacesWarningsWhenAskedFor) {
  const char* const opened = "of the tree had no lumen and were opened in the mesh";
  const Outcome plain = lumen({"validate", "closed.lumen"});
  EXPECT_FALSE(contains(plain.out, "SURFACE")) << plain.out;
  const Outcome asked = lumen({"validate", "closed.lumen", "--surface"});
  EXPECT_EQ(asked.code, 0) << asked.err;
  EXPECT_TRUE(contains(asked.out, "closed.lumen: warning SURFACE at file: ")) << asked.out;
  EXPECT_TRUE(contains(asked.out, opened)) << asked.out;
  const Outcome strict = lumen({"validate", "closed.lumen", "--surface", "--json", "--strict"});
  EXPECT_EQ(strict.code, 3);
  const Json issues = Json::parse(strict.out)["files"][0]["issues"];
  const auto isSurface = [](const Json& issue) { return issue["number"] == 652; };
  EXPECT_TRUE(std::any_of(issues.begin(), issues.end(), isSurface)) << issues;
}

TEST_F(ReachableTest, InfoReportsTheSurfaceAndItsWarningsWhenAskedFor) {
  const char* const opened = "of the tree had no lumen and were opened in the mesh";
  const Json plain = Json::parse(lumen({"info", "closed.lumen", "--json"}).out);
  EXPECT_TRUE(plain["surface"].is_null());
  EXPECT_TRUE(plain["surface_warnings"].empty());
  const Outcome asked = lumen({"info", "closed.lumen", "--surface"});
  EXPECT_TRUE(contains(asked.out, opened)) << asked.out;
  const Json made = Json::parse(lumen({"convert", "closed.lumen", "closed.vtp", "--json"}).out);
  const Json found = Json::parse(lumen({"info", "closed.lumen", "--surface", "--json"}).out);
  EXPECT_EQ(found["surface"], made["surface"]);
  EXPECT_GT(found["surface"]["triangles"], 0);
  const Json sentences = found["surface_warnings"];
  EXPECT_TRUE(std::any_of(sentences.begin(), sentences.end(), [&](const Json& sentence) {
    return contains(sentence.get<std::string>(), opened);
  })) << sentences;
}

TEST_F(ReachableTest, TheReportListsTheWarningsOfTheSurfaceThatConvertMakes) {
  const Outcome converted = lumen({"convert", "closed.lumen", "closed.stl"});
  ASSERT_EQ(converted.code, 0) << converted.err;
  const char* const opened = "of the tree had no lumen and were opened in the mesh";
  ASSERT_TRUE(contains(converted.err, opened)) << converted.err;
  ASSERT_EQ(lumen({"report", "closed.lumen", "closed.html"}).code, 0);
  const std::string page = read("closed.html");
  EXPECT_TRUE(contains(page, "the surface that lumen convert makes: "));
  EXPECT_TRUE(contains(page, opened));
}

TEST_F(ReachableTest, AClosedWayInAFileThatIsNotValidIsNotLookedFor) {
  formats::Case value = closedCase();
  std::string text = formats::encodeJson(value);
  text.replace(text.find("\"mm\""), 4, "\"cm\"");
  write("bad.lumen.json", text);
  const Outcome told = lumen({"validate", "bad.lumen.json"});
  EXPECT_EQ(told.code, 3);
  EXPECT_FALSE(contains(told.out, "CLOSED_EDGE")) << told.out;
}

TEST_F(ReachableTest, InfoTellsWhatCanBeReachedAndWhereTheWayEnds) {
  const Outcome told = lumen({"info", "closed.lumen"});
  ASSERT_EQ(told.code, 0) << told.err;
  EXPECT_TRUE(contains(told.out, "5.0 of 15.0 mm")) << told.out;
  EXPECT_TRUE(contains(told.out, "branch trunk is closed before node 11")) << told.out;
  const Json info = Json::parse(lumen({"info", "closed.lumen", "--json"}).out)["reachable"];
  EXPECT_NEAR(info["length_mm"].get<double>(), 5, 1e-6);
  EXPECT_NEAR(info["of_mm"].get<double>(), 15, 1e-6);
  EXPECT_EQ(info["trees"], 1);
  EXPECT_NEAR(info["longest_tree_mm"].get<double>(), 15, 1e-6);
  ASSERT_EQ(info["closed"].size(), 2U);
  EXPECT_EQ(info["closed"][0]["branch"], "trunk");
  EXPECT_EQ(info["closed"][0]["node"], 11);
  EXPECT_NEAR(info["closed"][0]["position"][0].get<double>(), 6, 0.13);
  EXPECT_NEAR(info["closed"][0]["beyond_mm"].get<double>(), 8, 1e-6);
}

TEST_F(ReachableTest, InfoListsTenPlacesAndHowManyMoreThereAre) {
  formats::Case value = closedCase();
  for (int i = 0; i < 12; ++i)
    addBeads(value, "more-" + std::to_string(i), {{2, 0, 2.5F}, {2, 0, 3}}, 1, 4);
  put("many.lumen", value);
  const std::string text = lumen({"info", "many.lumen"}).out;
  EXPECT_TRUE(contains(text, "closed at 4 places more; lumen info --json lists all")) << text;
  EXPECT_EQ(Json::parse(lumen({"info", "many.lumen", "--json"}).out)["reachable"]["closed"].size(),
            14U);
}

TEST_F(ReachableTest, IsNotKnownOfACaseWithoutModels) {
  formats::Case value = closedCase();
  value.models.reset();
  put("tree.lumen", value);
  const Outcome told = lumen({"info", "tree.lumen"});
  EXPECT_TRUE(contains(told.out, "not known, as there are no models")) << told.out;
  EXPECT_TRUE(Json::parse(lumen({"info", "tree.lumen", "--json"}).out)["reachable"].is_null());
  EXPECT_EQ(lumen({"validate", "tree.lumen", "--strict"}).code, 0);
}

TEST_F(ReachableTest, ConvertWarnsAndWritesNothingWhenStrict) {
  const Outcome made = lumen({"convert", "closed.lumen", "again.lumen"});
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(contains(made.err, "branch trunk is closed before node 11")) << made.err;
  EXPECT_TRUE(contains(made.out, "reachable: 5.0 of 15.0 mm\n")) << made.out;
  EXPECT_EQ(lumen({"convert", "closed.lumen", "strict.lumen", "--strict"}).code, 3);
  EXPECT_FALSE(exists("strict.lumen"));
}

TEST_F(ReachableTest, TheOriginsOfNodesSurviveBothEncodingsAndAFit) {
  formats::Case value = closedCase();
  std::vector<formats::NodeOrigin> origins(value.tree.nodeCount(), formats::NodeOrigin::Measured);
  origins[11] = formats::NodeOrigin::Bridged;
  origins[22] = formats::NodeOrigin::Given;
  setNodeOrigins(value, origins);
  formats::PointSets points;
  for (const formats::Vec3f& c : value.tree.centre) {
    points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
    for (const float y : {-1.0F, 1.0F}) points.position.push_back({c.x, c.y + y, c.z});
    for (const float z : {-1.0F, 1.0F}) points.position.push_back({c.x, c.y, c.z + z});
  }
  points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
  value.points = std::move(points);
  value.metadata.voxelSize = 0.5;
  put("origins.lumen", value);
  ASSERT_EQ(lumen({"convert", "origins.lumen", "text.lumen.json"}).code, 0);
  ASSERT_EQ(lumen({"convert", "text.lumen.json", "back.lumen"}).code, 0);
  EXPECT_EQ(read("back.lumen"), read("origins.lumen"));
  const Outcome fitted = lumen({"fit", "origins.lumen", "fitted.lumen"});
  ASSERT_EQ(fitted.code, 0) << fitted.err;
  for (const char* file : {"back.lumen", "fitted.lumen"}) {
    const auto found = formats::readCaseFile(path(file));
    ASSERT_TRUE(found) << file;
    EXPECT_EQ(formats::readNodeOrigins(*found), origins) << file;
  }
}

TEST_F(ReachableTest, SystemsAreShownWhereACaseStatesThemAndSurviveATrim) {
  formats::Case value = closedCase();
  put("plain.lumen", value);
  EXPECT_FALSE(contains(lumen({"info", "plain.lumen"}).out, "system"));
  EXPECT_FALSE(contains(lumen({"info", "plain.lumen", "--json"}).out, "\"system\""));
  setNodeSystems(value, std::vector<formats::VesselSystem>(value.tree.nodeCount(),
                                                           formats::VesselSystem::FalseLumen));
  put("stated.lumen", value);
  const Outcome told = lumen({"info", "stated.lumen"});
  EXPECT_TRUE(contains(told.out, "false-lumen")) << told.out;
  EXPECT_TRUE(
      contains(lumen({"info", "stated.lumen", "--json"}).out, "\"system\": \"false-lumen\""));
  ASSERT_EQ(lumen({"trim", "stated.lumen", "trimmed.lumen", "--min-length", "0.1"}).code, 0);
  EXPECT_TRUE(contains(lumen({"info", "trimmed.lumen"}).out, "false-lumen"));
}

TEST_F(ReachableTest, AFitOpensWhatItClosed) {
  formats::Case value = closedCase();
  value.points = formats::PointSets{std::vector<std::uint32_t>(value.tree.nodeCount() + 1, 0), {}};
  value.metadata.voxelSize = 0.5;
  std::vector<formats::NodeOrigin> origins(value.tree.nodeCount(), formats::NodeOrigin::Given);
  setNodeOrigins(value, origins);
  put("given.lumen", value);
  const Outcome fitted = lumen({"fit", "given.lumen", "fitted.lumen"});
  ASSERT_EQ(fitted.code, 0) << fitted.err;
  EXPECT_TRUE(contains(fitted.out, "reachable: 15.0 of 15.0 mm\n")) << fitted.out;
  EXPECT_EQ(lumen({"validate", "fitted.lumen", "--strict"}).code, 0);
}

}  // namespace lumen::test
