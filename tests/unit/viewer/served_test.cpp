// SPDX-License-Identifier: Apache-2.0
// Requests of a page.
#include "served.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "converters/base/options/edit_steps.h"
#include "converters/base/run_program.h"
#include "viewer/session/packs/surface_pack.h"

namespace lumen::test {

using LookTest = ServedTest;
using WorkTest = ServedTest;
using FilesTest = ServedTest;

TEST_F(LookTest, ThePageAndItsFilesAreServed) {
  serve({});
  EXPECT_EQ(get("").body, "<!doctype html><title>page</title>");
  EXPECT_EQ(get("page.js").get_header_value("Content-Type"), "text/javascript; charset=utf-8");
  EXPECT_EQ(get("state").status, 200);
  EXPECT_EQ(get("case").status, 404);
  EXPECT_EQ(get("volume").status, 404);
  EXPECT_EQ(get("surface").status, 404);
}

TEST_F(LookTest, ThePackOfACaseHasItsTree) {
  const formats::Case value = twoVessels();
  writeCase("two.lumen", value);
  serve({"two.lumen"});
  const Json now = state();
  EXPECT_EQ(now["title"], "two.lumen");
  EXPECT_EQ(now["has_case"], true);
  EXPECT_EQ(now["save_as"], "two.lumen");
  EXPECT_EQ(now["unsaved"], false);
  const ReadPack pack(get("case").body);
  const auto centre = pack.array<float>("centre");
  ASSERT_EQ(centre.size(), 3 * value.tree.nodeCount());
  EXPECT_EQ(centre[3 * 7], value.tree.centre[7].x);
  EXPECT_EQ(pack.array<std::int32_t>("parent"), value.tree.parent);
  EXPECT_EQ(pack.json["branches"][1]["label"], "right");
  EXPECT_FLOAT_EQ(pack.array<float>("root_distance_mm").at(7), 7);  // seven steps of 1 mm
  EXPECT_EQ(pack.json["reachable"]["closed"].size(), 0U);
}

TEST_F(LookTest, ASurfaceComesAtOnceAndAFinerOneLater) {
  writeCase("two.lumen", twoVessels());
  serve({"two.lumen"});
  const ReadPack quick(get("surface?quick=1").body);
  EXPECT_EQ(quick.json["kind"], "quick");
  const auto nodes = quick.array<std::uint32_t>("node");
  EXPECT_LT(*std::max_element(nodes.begin(), nodes.end()), 14U);
  std::size_t triangles = 0;
  for (const Json& part : quick.json["parts"]) triangles += part["count"].get<std::size_t>();
  EXPECT_EQ(3 * triangles, quick.array<std::uint32_t>("triangle").size());
  ReadPack full(get("surface").body);
  while (full.json["kind"] != "closed" || full.json["level"] != 0)
    full = ReadPack(get("surface").body);
  EXPECT_GT(full.array<float>("radius_mm").size(), nodes.size());
  bool hasInlet = false;
  for (const Json& part : full.json["parts"])
    hasInlet = hasInlet || part["name"].get<std::string>().starts_with("inlet");
  EXPECT_TRUE(hasInlet);
}

TEST_F(LookTest, ASurfaceHasFewerTrianglesForMoving) {
  writeCase("two.lumen", twoVessels());
  serve({"two.lumen"});
  const ReadPack quick(get("surface?quick=1").body);
  const auto moving = quick.array<std::uint32_t>("moving");
  const auto position = quick.array<float>("position");
  ASSERT_FALSE(moving.empty());
  EXPECT_LE(moving.size(), quick.array<std::uint32_t>("triangle").size());
  std::size_t next = 0;
  for (const Json& part : quick.json["parts"]) {
    EXPECT_EQ(part["moving_first"], next);
    EXPECT_GT(part["moving_count"], 0);
    next += part["moving_count"].get<std::size_t>();
  }
  EXPECT_EQ(3 * next, moving.size());
  for (const std::uint32_t v : moving) ASSERT_LT(3 * v, position.size());
}

TEST(MovingSurface, ATubeKeepsItsWallWithFewTriangles) {
  constexpr std::uint32_t kRings = 60, kSides = 48;
  std::vector<convert::Float3> position;
  std::vector<convert::Triangle> triangle;
  for (std::uint32_t i = 0; i < kRings; ++i)
    for (std::uint32_t j = 0; j < kSides; ++j) {
      const double a = 2 * 3.141592653589793 * j / kSides;
      position.push_back({static_cast<float>(2 * std::cos(a)), static_cast<float>(2 * std::sin(a)),
                          static_cast<float>(i)});
      const std::uint32_t next = i * kSides + (j + 1) % kSides, here = i * kSides + j;
      if (i + 1 == kRings) continue;
      triangle.push_back({here, next, here + kSides});
      triangle.push_back({next, next + kSides, here + kSides});
    }
  const std::vector<float> radius(position.size(), 2);
  const std::vector<viewer::TriangleRun> runs = {{0, triangle.size() / 2},
                                                 {triangle.size() / 2, triangle.size() / 2}};
  const auto moving = viewer::movingSurface(position, radius, triangle, runs, 600);
  ASSERT_EQ(moving.run.size(), 2U);
  EXPECT_LT(moving.triangle.size(), 1200U);
  EXPECT_GT(moving.triangle.size(), 32U);
  for (const convert::Triangle& t : moving.triangle) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : t)
      middle += Eigen::Vector3d(position[v][0], position[v][1], 0) / 3;
    EXPECT_GT(middle.norm(), 1) << "a wall moves by less than half a radius";
  }
}

TEST_F(LookTest, AnUnchangedPartIsNotSentAgain) {
  writeCase("two.lumen", twoVessels());
  serve({"two.lumen"});
  const std::string tag = get("case").get_header_value("ETag");
  EXPECT_EQ(get("case", {{"If-None-Match", tag}}).status, 304);
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 0}, {"label", "other"}}).status, 200);
  EXPECT_EQ(get("case", {{"If-None-Match", tag}}).status, 200);
}

TEST_F(LookTest, TheVolumeComesWhole) {
  writeTube("tube.nrrd");
  serve({"tube.nrrd"});
  const ReadPack pack(get("volume").body);
  const auto sent = pack.array<std::uint16_t>("voxel");
  const auto volume = tubeVolume();
  const auto& voxels = std::get<std::vector<std::int16_t>>(volume.voxels);
  ASSERT_EQ(sent.size(), voxels.size());
  const double offset = pack.json["offset"];
  for (std::size_t i = 0; i < sent.size(); i += 97) ASSERT_EQ(sent[i] + offset, voxels[i]);
}

TEST_F(LookTest, TheCaseFileIsTheOneThatALibraryOpens) {
  const formats::Case value = twoVessels();
  writeCase("two.lumen", value);
  serve({"two.lumen"});
  const std::string bytes = get("case.lumen").body;
  const auto read = formats::decodeCase(std::as_bytes(std::span(bytes)));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->tree, value.tree);
}

TEST_F(LookTest, DistancesToTheTruthBelongToTheSurfacesVertices) {
  formats::Case truth = twoVessels();
  for (float& radius : truth.tree.radius) radius -= 0.25F;
  writeCase("two.lumen", twoVessels());
  writeCase("truth.lumen", truth);
  serve({"two.lumen"});
  EXPECT_EQ(get("distance").status, 404);
  Progress silent;
  session->open({path("truth.lumen"), "truth.lumen", viewer::OpenAs::Truth}, silent);
  const ReadPack surface(get("surface?quick=1").body), pack(get("distance?quick=1").body);
  const auto distance = pack.array<float>("distance_mm");
  ASSERT_EQ(3 * distance.size(), surface.array<float>("position").size());
  std::vector<float> sorted = distance;
  std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
  EXPECT_NEAR(sorted[sorted.size() / 2], 0.25, 0.05);
  performAll({{"op", "compare"}});
  EXPECT_GT(state()["figures"]["overlap"].get<double>(), 0.9);
}

TEST_F(WorkTest, AnOldRevisionIsAConflict) {
  writeCase("two.lumen", twoVessels());
  serve({"two.lumen"});
  const Json old = {
      {"op", "rename"}, {"branch", 0}, {"label", "a"}, {"revision", state()["revision"]}};
  ASSERT_EQ(post("do", old.dump()).status, 200);
  const auto second = post("do", old.dump());
  EXPECT_EQ(second.status, 409);
  EXPECT_EQ(Json::parse(second.body)["error"],
            "the document has changed meanwhile; look, and try again");
}

TEST_F(WorkTest, AnUnknownOperationIsCalledUnknownWithAndWithoutACase) {
  serve({});
  const auto sentence = [this](const char* op) {
    return Json::parse(perform({{"op", op}}).body)["error"].get<std::string>();
  };
  EXPECT_EQ(sentence("unheard"), "there is no operation \"unheard\"");
  EXPECT_EQ(sentence("seedUnheard"), "there is no operation \"seedUnheard\"");
  EXPECT_EQ(sentence("delete"), "there is no case to correct");
  writeCase("two.lumen", twoVessels());
  serve({"two.lumen"});
  EXPECT_EQ(sentence("unheard"), "there is no operation \"unheard\"");
}

TEST_F(WorkTest, EveryChangeIsUndoneAndDoneAgainToTheSameCaseUnderNewRevisions) {
  formats::Case two = twoVessels();
  two.models.reset();  // so that nothing has to be fitted
  two.points.emplace().offset.push_back(0);
  for (const formats::Vec3f& c : two.tree.centre) {
    two.points->position.push_back({c.x, c.y + 1, c.z});
    two.points->offset.push_back(two.points->offset.back() + 1);
  }
  writeCase("two.lumen", two);
  const auto last = two.tree.nodeCount() - 1;
  const std::vector<Json> changes = {
      {{"op", "delete"}, {"branch", 1}},
      {{"op", "delete"}, {"labels", {two.tree.branches[1].label}}},
      {{"op", "cut"}, {"node", 4}},
      {{"op", "join"}, {"branch", 1}, {"node", 4}},
      {{"op", "reverse"}, {"branch", 0}},
      {{"op", "rename"}, {"branch", 1}, {"label", "ica"}},
      {{"op", "kind"}, {"branch", 1}, {"kind", "aneurysm"}},
      {{"op", "move"}, {"node", last}, {"position", {5.5, 10, 0.5}}, {"radius_mm", 0.9}},
      {{"op", "widen"}, {"node", 3}, {"radius_mm", 1.4}, {"reach_mm", 2}},
      {{"op", "push"}, {"node", 3}, {"at", {3, 1, 0}}, {"by", {0, 0.4, 0}}, {"radius_mm", 0.8}},
      {{"op", "node_add"}, {"node", 3}},
      {{"op", "node_delete"}, {"node", 3}},
      {{"op", "seed_add"}, {"label", "a"}, {"points", {{{"position", {1, 2, 3}}}}}}};
  for (const Json& change : changes) {
    serve({"two.lumen"});
    const auto bytes = [this] { return get("case.lumen").body + state()["seeds"].dump(); };
    const auto revision = [this] { return state()["revision"].get<int>(); };
    const std::string before = bytes();
    const int first = revision();
    const auto answer = perform(change);
    ASSERT_EQ(answer.status, 200) << change << answer.body;
    waitForJob();
    const std::string after = bytes();
    EXPECT_NE(after, before) << change;
    EXPECT_EQ(revision(), first + 1) << change;
    ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
    EXPECT_EQ(bytes(), before) << change;
    EXPECT_EQ(revision(), first + 2) << change;
    EXPECT_EQ(state()["undo"], nullptr) << change;
    ASSERT_EQ(perform({{"op", "redo"}}).status, 200);
    EXPECT_EQ(bytes(), after) << change;
    EXPECT_EQ(revision(), first + 3) << change;
  }
}

TEST_F(WorkTest, SeveralVesselsAreDeletedAsOneChangeOfWhichTheCaseKeepsEach) {
  formats::Case three = twoVessels();
  three.models.reset();
  addVessel(three, "stays", straightPath({0, 20, 0}, {1, 0, 0}, 6), 0.8, 1.0);
  writeCase("three.lumen", three);
  serve({"three.lumen"});
  const auto status = [this](const Json& labels) {
    return perform({{"op", "delete"}, {"labels", labels}}).status;
  };
  EXPECT_EQ(status(Json::array()), 400);
  EXPECT_EQ(status({"left", "left"}), 400);
  EXPECT_EQ(status({"left", "none"}), 400);
  EXPECT_EQ(status({"left", "right", "stays"}), 400);
  EXPECT_EQ(perform({{"op", "delete"}, {"labels", {"left"}}, {"branch", 0}}).status, 400);
  ASSERT_EQ(status({"right", "left"}), 200);
  EXPECT_EQ(state()["undo"], "deleted 2 vessels");
  ASSERT_EQ(perform({{"op", "save"}}).status, 200);
  const formats::Case after = *formats::readCaseFile(path("three.lumen"));
  ASSERT_EQ(after.tree.branches.size(), 1U);
  EXPECT_EQ(after.tree.branches[0].label, "stays");
  const auto edits = recordedEdits(after.metadata);
  ASSERT_EQ(edits.size(), 2U);
  EXPECT_EQ(edits[0].sentence, "deleted \"right\"");
  EXPECT_EQ(edits[1].sentence, "deleted \"left\"");
  for (const auto& edit : edits) EXPECT_NE(edit.request.find("\"delete\""), std::string::npos);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(state()["undo"], nullptr);
}

TEST_F(WorkTest, ATruthThatIsClosedUndoneAndClosedAgainHasOtherDistances) {
  writeCase("two.lumen", twoVessels());
  serve({"two.lumen"});
  Progress silent;
  session->open({path("two.lumen"), "truth.lumen", viewer::OpenAs::Truth}, silent);
  const auto revisions = [this] {
    const Json now = state();
    return std::pair(now["revisions"]["truth"].get<int>(), get("distance?quick=1").status);
  };
  const auto [truth, status] = revisions();
  EXPECT_EQ(status, 200);
  const std::string tag = get("distance?quick=1").get_header_value("ETag");
  ASSERT_EQ(perform({{"op", "close_file"}, {"id", 2}}).status, 200);
  EXPECT_EQ(revisions(), std::pair(truth + 1, 404));
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(revisions(), std::pair(truth + 2, 200));
  EXPECT_NE(get("distance?quick=1").get_header_value("ETag"), tag);
  ASSERT_EQ(perform({{"op", "redo"}}).status, 200);
  EXPECT_EQ(revisions(), std::pair(truth + 3, 404));
}

TEST_F(WorkTest, RenameUndoRedoAndSaveLeaveExactlyThatInTheFile) {
  writeCase("two.lumen", twoVessels());
  const auto original = formats::readFileBytes(path("two.lumen"));
  serve({"two.lumen"});
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 1}, {"label", "ica"}}).status, 200);
  EXPECT_EQ(state()["unsaved"], true);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(state()["unsaved"], false);
  const std::string unchanged = get("save?format=lumen").body;
  EXPECT_EQ(unchanged.size(), original->size());
  EXPECT_EQ(std::memcmp(unchanged.data(), original->data(), unchanged.size()), 0);
  ASSERT_EQ(perform({{"op", "redo"}}).status, 200);
  ASSERT_EQ(perform({{"op", "save"}}).status, 200);
  EXPECT_EQ(state()["unsaved"], false);
  const auto saved = formats::readCaseFile(path("two.lumen"));
  ASSERT_TRUE(saved);
  EXPECT_EQ(saved->tree.branches[1].label, "ica");
}

TEST_F(WorkTest, AClickBecomesAFittedVesselAndCanBeUndone) {
  writeTube("tube.nrrd");
  serve({"tube.nrrd"});
  const Json seed = {{"op", "seed_add"}, {"points", {{{"position", {6.4, 6.4, 6.4}}}}}};
  ASSERT_EQ(perform(seed).status, 200);
  EXPECT_EQ(state()["seeds"][0]["tracked"], false);
  performAll({{"op", "track"}, {"labels", nullptr}});
  const Json now = state();
  EXPECT_EQ(now["has_case"], true);
  EXPECT_EQ(now["seeds"][0]["tracked"], true);
  EXPECT_EQ(now["unsaved"], true);
  const ReadPack pack(get("case").body);
  EXPECT_EQ(pack.json["has_models"], true);
  const auto radius = pack.array<float>("radius_mm");
  EXPECT_NEAR(radius[radius.size() / 2], 1.0, 0.1);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(state()["has_case"], false);
}

TEST_F(WorkTest, ACutIsFittedAtOnceAndUndoneToTheSameBytes) {
  writeTube("tube.nrrd");
  serve({"tube.nrrd"});
  ASSERT_EQ(perform({{"op", "seed_add"}, {"points", {{{"position", {6.4, 6.4, 6.4}}}}}}).status,
            200);
  performAll({{"op", "track"}});
  const std::string before = get("case.lumen").body;
  const auto nodes = ReadPack(get("case").body).array<float>("radius_mm").size();
  performAll({{"op", "cut"}, {"node", nodes / 2}});
  const ReadPack pack(get("case").body);
  EXPECT_EQ(pack.json["branches"].size(), 2U);
  EXPECT_EQ(pack.json["branches"][1]["parent_node"], -1);
  EXPECT_EQ(pack.json["reachable"]["closed"].size(), 0U);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(get("case.lumen").body, before);
}

TEST_F(WorkTest, AClickFindsTheAxisOfTheVessel) {
  writeTube("tube.nrrd");
  serve({"tube.nrrd"});
  const Json vessel = Json::parse(post("vessel_at_click", R"({"position": [6.8, 6.2, 7]})").body);
  EXPECT_EQ(vessel["found"], true);
  EXPECT_NEAR(vessel["position"][0].get<double>(), 6.4, 0.1);
  EXPECT_NEAR(vessel["position"][1].get<double>(), 6.4, 0.1);
  EXPECT_NEAR(vessel["radius_mm"].get<double>(), 1.0, 0.1);
  EXPECT_EQ(Json::parse(post("vessel_at_click", R"({"position": [-100, 0, 0]})").body)["found"],
            false);
}

TEST_F(WorkTest, SeedsAreMovedAndDeleted) {
  writeTube("tube.nrrd");
  serve({"tube.nrrd"});
  ASSERT_EQ(
      perform({{"op", "seed_add"}, {"label", "a"}, {"points", {{{"position", {1, 2, 3}}}}}}).status,
      200);
  EXPECT_EQ(
      perform({{"op", "seed_add"}, {"label", "a"}, {"points", {{{"position", {1, 2, 3}}}}}}).status,
      400);
  ASSERT_EQ(
      perform({{"op", "seed_move"}, {"label", "a"}, {"point", 0}, {"position", {4, 5, 6}}}).status,
      200);
  EXPECT_EQ(state()["seeds"][0]["points"][0]["position"], Json({4.0, 5.0, 6.0}));
  ASSERT_EQ(perform({{"op", "seed_delete"}, {"label", "a"}}).status, 200);
  EXPECT_EQ(state()["seeds"].size(), 0U);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(state()["seeds"].size(), 1U);
}

TEST_F(WorkTest, TheSeedOfATrackedVesselGoesWithIt) {
  writeTube("tube.nrrd");
  serve({"tube.nrrd"});
  ASSERT_EQ(
      perform({{"op", "seed_add"}, {"label", "a"}, {"points", {{{"position", {6.4, 6.4, 6.4}}}}}})
          .status,
      200);
  performAll({{"op", "track"}, {"labels", nullptr}});
  ASSERT_EQ(perform({{"op", "seed_add"},
                     {"label", "b"},
                     {"parent", "a"},
                     {"points", {{{"position", {1, 2, 3}}}}}})
                .status,
            200);
  EXPECT_EQ(perform({{"op", "rename"}, {"branch", 0}, {"label", "b"}}).status, 400);
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 0}, {"label", "ica"}}).status, 200);
  Json seeds = state()["seeds"];
  EXPECT_EQ(seeds[0]["label"], "ica");
  EXPECT_EQ(seeds[0]["tracked"], true);
  EXPECT_EQ(seeds[1]["parent"], "ica");
  EXPECT_EQ(seeds[1]["tracked"], false);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(state()["seeds"][0]["label"], "a");
  // cut in two, of which the first, with the seed's name, is deleted
  performAll({{"op", "cut"}, {"node", 10}});
  performAll({{"op", "delete"}, {"branch", 0}});
  seeds = state()["seeds"];
  ASSERT_EQ(seeds.size(), 1U);
  EXPECT_EQ(seeds[0]["label"], "b");
  EXPECT_EQ(seeds[0]["parent"], nullptr);
}

TEST_F(WorkTest, EveryFormatOfTheStateCanBeSaved) {
  writeTube("tube.nrrd");
  serve({"tube.nrrd"});
  ASSERT_EQ(perform({{"op", "seed_add"}, {"points", {{{"position", {6.4, 6.4, 6.4}}}}}}).status,
            200);
  performAll({{"op", "track"}});
  const Json formats = state()["formats"];
  for (const Json& format : formats) {
    if (format == "vtu" && !convert::installedProgram("lumen-netgen")) continue;
    const auto response = get("save?format=" + format.get<std::string>());
    EXPECT_EQ(response.status, 200) << format << response.body;
    EXPECT_GT(response.body.size(), 100U) << format;
    EXPECT_NE(response.get_header_value("Content-Disposition").find("attachment; filename=\"tube."),
              std::string::npos);
  }
}

TEST_F(WorkTest, ALongJobIsCancelledAndLeavesTheDocumentAsItWas) {
  writeTube("tube.nrrd");
  viewer::SessionOptions endless;
  endless.track.options.minTrials = endless.track.options.maxTrials = 1000000;
  endless.track.options.inlierRate = 1;
  session = std::make_unique<viewer::Session>(endless);
  Progress silent;
  session->open({path("tube.nrrd"), "tube.nrrd"}, silent);
  serveSession();
  const auto revision = session->now().revision;
  ASSERT_EQ(perform({{"op", "seed_add"}, {"points", {{{"position", {6.4, 6.4, 6.4}}}}}}).status,
            200);
  const Json job = Json::parse(perform({{"op", "track"}}).body);
  EXPECT_EQ(perform({{"op", "undo"}}).status, 409);
  EXPECT_TRUE(session->jobs.cancel(job["job"]));
  session->jobs.wait();
  EXPECT_EQ(session->now().revision, revision + 1);
  EXPECT_EQ(session->now().document.value, nullptr);
}

TEST_F(FilesTest, ADroppedFileAndADownloadNeedNoTemporaryFolder) {
  const NoTemporaryFolder none;
  serve({});
  ASSERT_EQ(post("file?name=a%20case.lumen&as=auto", bytesOf(twoVessels())).status, 200);
  waitForJob();
  EXPECT_EQ(state()["title"], "a case.lumen");
  EXPECT_EQ(state()["save_as"], nullptr);
  for (const char* const format : {"seeds", "lumen", "obj", "swc"})
    EXPECT_EQ(get(std::string("save?format=") + format).status, 200) << format;
  ASSERT_EQ(post("file?name=t.nrrd",
                 convert::encodeVolume(tubeVolume(), convert::VolumeFormat::Nrrd, true, "t.nrrd"))
                .status,
            200);
  waitForJob();
  EXPECT_TRUE(state()["has_volume"]);
}

TEST_F(FilesTest, AFileThatIsDroppedDuringAJobIsRefused) {
  writeTube("tube.nrrd");
  viewer::SessionOptions endless;
  endless.track.options.minTrials = endless.track.options.maxTrials = 1000000;
  endless.track.options.inlierRate = 1;
  session = std::make_unique<viewer::Session>(endless);
  Progress silent;
  session->open({path("tube.nrrd"), "tube.nrrd"}, silent);
  serveSession();
  ASSERT_EQ(perform({{"op", "seed_add"}, {"points", {{{"position", {6.4, 6.4, 6.4}}}}}}).status,
            200);
  ASSERT_EQ(perform({{"op", "track"}}).status, 200);
  EXPECT_EQ(post("file?name=a.obj", "v 0 0 0\n").status, 409);
}

TEST_F(FilesTest, ADroppedCaseIsNotSavedIntoTheFileOfTheOneItReplaces) {
  writeCase("one.lumen", twoVessels());
  serve({"one.lumen"});
  EXPECT_EQ(state()["save_as"], "one.lumen");
  const auto before = formats::readFileBytes(path("one.lumen"));
  const std::string body(reinterpret_cast<const char*>(before->data()), before->size());
  ASSERT_EQ(post("file?name=other.lumen&as=auto", body).status, 200);
  waitForJob();
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 1}, {"label", "mine"}}).status, 200);
  EXPECT_EQ(state()["save_as"], nullptr);
  EXPECT_EQ(perform({{"op", "save"}}).status, 400);
  EXPECT_EQ(*formats::readFileBytes(path("one.lumen")), *before);
  performAll({{"op", "undo"}});
  performAll({{"op", "undo"}});
  EXPECT_EQ(state()["save_as"], "one.lumen");
}

TEST_F(FilesTest, ABrokenFileIsRefusedByItsNameWithoutAPath) {
  serve({});
  const auto listener = session->events.listen();
  ASSERT_EQ(post("file?name=broken.lumen", "nothing of a case").status, 200);
  waitForJob();
  std::string text;
  while (const auto event = listener->wait(std::chrono::seconds(5)))
    if (event->name == "done") {
      const Json done = Json::parse(event->data);
      EXPECT_EQ(done["ok"], false);
      text = done["text"];
      break;
    }
  EXPECT_TRUE(text.starts_with("broken.lumen: ")) << text;
  EXPECT_EQ(text.find('/'), std::string::npos) << text;
  EXPECT_EQ(state()["has_case"], false);
}

TEST_F(FilesTest, AChangeOnDiskIsNoticedAndNotOverwritten) {
  writeCase("two.lumen", twoVessels());
  serve({"two.lumen"});
  session->lookAtFiles();
  EXPECT_EQ(state()["files"][0]["changed"], false);
  formats::Case other = twoVessels();
  other.tree.branches[0].label = "from elsewhere";
  writeCase("two.lumen", other);
  session->lookAtFiles();
  EXPECT_EQ(state()["files"][0]["changed"], true);
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 1}, {"label", "mine"}}).status, 200);
  EXPECT_EQ(perform({{"op", "save"}}).status, 409);
  EXPECT_EQ(formats::readCaseFile(path("two.lumen"))->tree.branches[0].label, "from elsewhere");
  EXPECT_EQ(perform({{"op", "save"}, {"force", true}}).status, 200);
  EXPECT_EQ(formats::readCaseFile(path("two.lumen"))->tree.branches[1].label, "mine");
  session->lookAtFiles();
  EXPECT_EQ(state()["files"][0]["changed"], false);
}

}  // namespace lumen::test
