// SPDX-License-Identifier: Apache-2.0
// The list of what a check leaves to be done.
#include "viewer/session/work_list.h"

#include "served.h"

namespace lumen::test {

namespace {

/// Kinds of the places that are left, in their order.
std::vector<std::string> kindsIn(const Json& work) {
  std::vector<std::string> kinds;
  for (const Json& item : work["items"]) kinds.push_back(item["kind"]);
  return kinds;
}

std::size_t countOf(const Json& work, const std::string& kind) {
  const auto kinds = kindsIn(work);
  return static_cast<std::size_t>(std::count(kinds.begin(), kinds.end(), kind));
}

const Json& firstOf(const Json& work, const std::string& kind) {
  const auto& items = work["items"];
  return *std::find_if(items.begin(), items.end(),
                       [&](const Json& item) { return item["kind"] == kind; });
}

/// Half of the tube of tubeVolume(), and a piece of 1.2 mm that hangs in the dark beside it, thinner than a
/// voxel.
formats::Case halfOfTube() {
  formats::Case value;
  value.metadata.voxelSize = 0.2;
  addVessel(value, "tube", straightPath({6.4, 6.4, 1.4}, {0, 0, 1}, 6), 1.0, 1.0);
  addVessel(value, "loose", straightPath({3, 3, 5}, {0, 0, 0.2}, 7), 0.09, 1.0);
  addModels(value);
  value.metadata.source = convert::describeSource(tubeVolume());
  return value;
}

}  // namespace

class WorkListTest : public ServedTest {
protected:
  void SetUp() override {
    ServedTest::SetUp();
    writeTube("tube.nrrd");
    writeCase("half.lumen", halfOfTube());
    serve({"tube.nrrd", "half.lumen"});
    EXPECT_EQ(state()["work"], nullptr);
    performAll({{"op", "check"}});
  }
  Json work() { return state()["work"]; }
};

TEST_F(WorkListTest, HasEveryKindOfPlaceThatTheCheckKnows) {
  const Json list = work();
  EXPECT_EQ(list["found"], list["items"].size());
  EXPECT_EQ(list["ignored"], Json::array());
  EXPECT_EQ(countOf(list, "loose"), 1U) << list;
  EXPECT_EQ(countOf(list, "thin"), 1U) << list;
  EXPECT_GE(countOf(list, "early-end"), 1U) << list;
  const Json& thin = firstOf(list, "thin");
  EXPECT_EQ(thin["branch"], 1);
  EXPECT_NE(thin["about"].get<std::string>().find("loose has a mean radius of 0.09 mm"),
            std::string::npos)
      << thin;
  const Json& end = firstOf(list, "early-end");
  EXPECT_EQ(end["branch"], 0);
  ASSERT_TRUE(end["missing"].is_number()) << end;
  for (const Json& item : list["items"])
    EXPECT_TRUE(item["kind"] != "missing" || item["missing"] != end["missing"])
        << "what goes on beyond an end is one place: " << list;
  EXPECT_TRUE(
      state()["check"]["missing_vessels"][end["missing"].get<std::size_t>()].contains("clicks"));
}

TEST_F(WorkListTest, APlaceWhoseVesselIsDeletedIsDone) {
  const Json before = work();
  ASSERT_EQ(perform({{"op", "delete"}, {"branch", 1}}).status, 200);
  const Json after = work();
  EXPECT_EQ(after["found"], before["found"]);
  EXPECT_EQ(countOf(after, "loose"), 0U) << after;
  EXPECT_EQ(countOf(after, "thin"), 0U) << after;
  EXPECT_EQ(countOf(after, "early-end"), countOf(before, "early-end"));
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(work(), before);
}

TEST_F(WorkListTest, AnEndIsTrackedOnFromItsPlaceAsOneChange) {
  const Json all = state();
  const Json& end = firstOf(all["work"], "early-end");
  const Json& clicks = all["check"]["missing_vessels"][end["missing"].get<std::size_t>()]["clicks"];
  Json points = Json::array();
  for (const Json& point : clicks["points"]) points.push_back({{"position", point}});
  performAll({{"op", "track_from"}, {"points", points}});
  EXPECT_LT(countOf(work(), "early-end"), countOf(all["work"], "early-end")) << work();
  EXPECT_EQ(state()["seeds"].size(), 1U);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(work(), all["work"]);
  EXPECT_EQ(state()["seeds"].size(), 0U);
}

TEST_F(WorkListTest, ANumberOfAnEarlierCheckNamesNoPlaceOfALaterOne) {
  const Json seen = work()["items"][0]["id"];
  performAll({{"op", "check"}});
  EXPECT_EQ(perform({{"op", "ignore"}, {"item", seen}, {"reason", "a vein"}}).status, 409);
  EXPECT_EQ(work()["ignored"], Json::array());
}

TEST_F(WorkListTest, AnIgnoredPlaceIsInTheCaseWithItsReason) {
  const Json before = work();
  const Json loose = firstOf(before, "loose");
  EXPECT_EQ(perform({{"op", "ignore"}, {"item", loose["id"]}, {"reason", " "}}).status, 400);
  EXPECT_EQ(perform({{"op", "ignore"}, {"item", 999}, {"reason", "none"}}).status, 400);
  ASSERT_EQ(perform({{"op", "ignore"}, {"item", loose["id"]}, {"reason", "a vein, seen: \"v. 2\""}})
                .status,
            200);
  const Json after = work();
  EXPECT_EQ(countOf(after, "loose"), 0U);
  ASSERT_EQ(after["ignored"].size(), 1U);
  EXPECT_EQ(after["ignored"][0]["kind"], "loose");
  EXPECT_EQ(after["ignored"][0]["reason"], "a vein, seen: \"v. 2\"");
  ASSERT_EQ(perform({{"op", "save"}}).status, 200);

  // the file keeps it: a new check of it leaves the place out, until it is no longer ignored
  serve({"tube.nrrd", "half.lumen"});
  performAll({{"op", "check"}});
  EXPECT_EQ(work()["items"].size(), after["items"].size());
  EXPECT_EQ(work()["found"], before["found"]);
  EXPECT_EQ(perform({{"op", "unignore"}, {"ignored", 1}}).status, 400);
  ASSERT_EQ(perform({{"op", "unignore"}, {"ignored", 0}}).status, 200);
  EXPECT_EQ(countOf(work(), "loose"), 1U);
  EXPECT_EQ(work()["ignored"], Json::array());
}

}  // namespace lumen::test
