// SPDX-License-Identifier: Apache-2.0
// History, jobs, events and packs, without a server.
#include <atomic>
#include <functional>

#include "converters/base/error.h"
#include "served.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/history.h"
#include "viewer/session/job_runner.h"
#include "viewer/session/opening.h"
#include "viewer/session/packs/pack.h"
#include "viewer/session/packs/volume_pack.h"

namespace lumen::test {

using viewer::Document;
using viewer::History;

namespace {

Document withNodes(std::size_t nodes) {
  auto value = std::make_shared<formats::Case>();
  value->tree.centre.resize(nodes);
  Document document;
  document.value = value;
  return document;
}

}  // namespace

using OpeningTest = ServedTest;

TEST_F(OpeningTest, TheUnitAndTheFoldersOfTheCommandLineCountForMeshes) {
  std::filesystem::create_directory(path("scene"));
  write("a.obj", "v 0 0 0\nv 3 0 0\nv 0 1 0\nf 1 2 3\n");
  write("scene/a.scn", "<Node name=\"root\"><MeshOBJLoader filename=\"../a.obj\"/></Node>\n");
  viewer::SessionOptions options;
  engine::VolumeArguments& arguments = options.volume;
  Progress silent;
  const auto opened = [&](const std::string& name) {
    const Document document = viewer::withFile({}, {path(name), name}, 1, options, silent);
    return document.meshes.front().mesh->mesh.position[1].x();
  };
  EXPECT_EQ(opened("a.obj"), 3);
  EXPECT_THROW(opened("scene/a.scn"), Error);
  arguments.unit = "cm";
  arguments.allowDetached = {folder.string()};
  EXPECT_EQ(opened("a.obj"), 30);
  EXPECT_EQ(opened("scene/a.scn"), 30);
}

TEST(History, UndoAndRedoBringBackTheSameParts) {
  History history;
  const Document first = withNodes(1), second = withNodes(2);
  ASSERT_TRUE(history.commit("one", 1, first));
  ASSERT_TRUE(history.commit("two", 2, second));
  EXPECT_EQ(history.undoName(), "two");
  EXPECT_EQ(history.undo(), "two");
  EXPECT_EQ(history.now().document.value, first.value);
  EXPECT_EQ(history.redoName(), "two");
  EXPECT_EQ(history.redo(), "two");
  EXPECT_EQ(history.now().document.value, second.value);
  EXPECT_EQ(history.redo(), std::nullopt);
}

TEST(History, AChangeOfWhatHasChangedMeanwhileIsRefused) {
  History history;
  ASSERT_TRUE(history.commit("one", 1, withNodes(1)));
  EXPECT_EQ(history.commit("late", 1, withNodes(2)), std::nullopt);
  EXPECT_EQ(history.now().document.value->tree.nodeCount(), 1U);
}

TEST(History, OnlyRevisionsOfPartsThatChangedChange) {
  History history;
  Document document = history.now().document;
  document.value = withNodes(1).value;
  ASSERT_TRUE(history.commit("one", 1, document));
  const auto now = history.now();
  EXPECT_EQ(now.parts.value, 2U);
  EXPECT_EQ(now.parts.seeds, 1U);
  EXPECT_EQ(now.parts.volume, 1U);
}

TEST(History, EveryChangeOfAPartCountsItsOwnRevisionAlsoWhenItIsUndoneAndDoneAgain) {
  using Count = std::uint64_t viewer::PartRevisions::*;
  const std::vector<std::pair<Count, std::function<void(Document&)>>> parts = {
      {&viewer::PartRevisions::value,
       [](Document& d) { d.value = std::make_shared<formats::Case>(); }},
      {&viewer::PartRevisions::truth,
       [](Document& d) { d.truth = std::make_shared<formats::Case>(); }},
      {&viewer::PartRevisions::volume,
       [](Document& d) { d.volume = std::make_shared<convert::Volume>(); }},
      {&viewer::PartRevisions::proposals,
       [](Document& d) { d.proposals = std::make_shared<formats::Case>(); }},
      {&viewer::PartRevisions::seeds,
       [](Document& d) { d.seeds = std::make_shared<viewer::Seeds>(); }},
      {&viewer::PartRevisions::meshes, [](Document& d) {
         d.meshes.push_back({1, "m", std::make_shared<convert::MeshFile>()});
       }}};
  for (const auto& [changed, change] : parts) {
    History history;
    Document document = history.now().document;
    change(document);
    ASSERT_TRUE(history.commit("one", 1, document));
    const auto expect = [&history, &parts, changed = changed](std::uint64_t revision) {
      for (const auto& part : parts)
        EXPECT_EQ(history.now().parts.*part.first, part.first == changed ? revision : 1U);
      EXPECT_EQ(history.now().revision, revision);
    };
    expect(2);
    ASSERT_TRUE(history.undo());
    expect(3);
    ASSERT_TRUE(history.redo());
    expect(4);
  }
}

TEST(History, WhatCanBeUndoneIsForgottenFromTheOldestOnBeyondItsBytes) {
  History history(100 * sizeof(formats::Vec3f) + 3 * sizeof(formats::Case));
  for (std::uint64_t i = 1; i <= 5; ++i) ASSERT_TRUE(history.commit("c", i, withNodes(40)));
  int steps = 0;
  while (history.undo()) ++steps;
  EXPECT_EQ(steps, 2);
}

TEST(Jobs, OneRunsAtATimeAndCanBeCancelled) {
  viewer::EventHub events;
  const auto listener = events.listen();
  viewer::JobRunner jobs(events, [] {});
  const int job = jobs.start("waiting", true, [](Progress& progress) -> std::string {
    for (;;) {
      progress.check();
      std::this_thread::yield();
    }
  });
  EXPECT_THROW(jobs.start("other", false, [](Progress&) { return std::string(); }),
               viewer::Conflict);
  EXPECT_FALSE(jobs.cancel(job + 1));
  while (!jobs.cancel(job)) std::this_thread::yield();
  jobs.wait();
  EXPECT_FALSE(jobs.running());
  const auto event = listener->wait(std::chrono::seconds(10));
  ASSERT_TRUE(event);
  EXPECT_EQ(event->name, "done");
  const Json done = Json::parse(event->data);
  EXPECT_EQ(done["job"], job);
  EXPECT_EQ(done["ok"], false);
  EXPECT_EQ(done["cancelled"], true);
}

TEST(Jobs, OnlyAJobThatChangesTheDocumentKeepsOthersFromChangingIt) {
  viewer::EventHub events;
  viewer::JobRunner jobs(events, [] {});
  const auto untilCancelled = [](Progress& progress) -> std::string {
    for (;;) {
      progress.check();
      std::this_thread::yield();
    }
  };
  jobs.start("tracking", true, untilCancelled);
  EXPECT_THROW(jobs.requireNoChange(), viewer::Conflict);
  jobs.cancelAll();
  jobs.wait();
  EXPECT_NO_THROW(jobs.requireNoChange());
  jobs.start("checking", false, untilCancelled);
  EXPECT_NO_THROW(jobs.requireNoChange());
  jobs.cancelAll();
  jobs.wait();
}

TEST(Jobs, OneOfManyThreadsStartsItsJobWithItsOwnKind) {
  viewer::EventHub events;
  viewer::JobRunner jobs(events, [] {});
  std::atomic<int> begun{0}, wrong{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&jobs, &begun, &wrong, changes = t % 2 == 0] {
      for (int i = 0; i < 200; ++i) try {
          jobs.start(changes ? "changes" : "reads", changes, [&jobs, &wrong, changes](Progress&) {
            const auto running = jobs.running();
            wrong += !running || running->changes != changes ||
                     running->name != (changes ? "changes" : "reads");
            return std::string();
          });
          ++begun;
        } catch (const viewer::Conflict&) {
          std::this_thread::yield();
        }
    });
  for (std::thread& thread : threads) thread.join();
  jobs.wait();
  EXPECT_GT(begun, 0);
  EXPECT_EQ(wrong, 0);
}

TEST(Jobs, AnExceptionBeforeOrAfterTheWorkLeavesTheRunnerFree) {
  viewer::EventHub events;
  std::atomic<int> calls{0};
  viewer::JobRunner jobs(events, [&calls] {
    if (++calls <= 1 || calls == 3) throw std::bad_alloc();
  });
  const auto nothing = [](Progress&) { return std::string(); };
  EXPECT_THROW(jobs.start("first", true, nothing), std::bad_alloc);
  EXPECT_FALSE(jobs.running());
  jobs.start("second", true, nothing);  // whose end cannot be announced
  jobs.wait();
  EXPECT_NO_THROW(jobs.start("third", true, nothing));
  jobs.wait();
}

TEST(Jobs, AConflictEndsAJobWithItsOwnSentence) {
  viewer::EventHub events;
  const auto listener = events.listen();
  viewer::JobRunner jobs(events, [] {});
  jobs.start("late", true, [](Progress&) -> std::string { throw viewer::Conflict("too late"); });
  jobs.wait();
  EXPECT_EQ(Json::parse(listener->wait(std::chrono::seconds(10))->data)["text"], "too late");
}

TEST(Jobs, AnErrorEndsAJobWithItsSentence) {
  viewer::EventHub events;
  const auto listener = events.listen();
  viewer::JobRunner jobs(events, [] {});
  jobs.start("failing", false, [](Progress& progress) -> std::string {
    progress.warn("careful");
    throw failed("it broke");
  });
  jobs.wait();
  EXPECT_EQ(Json::parse(listener->wait(std::chrono::seconds(10))->data)["text"], "careful");
  EXPECT_EQ(Json::parse(listener->wait(std::chrono::seconds(10))->data)["text"], "it broke");
}

TEST(Events, APageThatDoesNotReadKeepsTheNewestState) {
  viewer::EventHub events;
  const auto listener = events.listen();
  for (int i = 0; i < 10000; ++i) {
    events.send("state", {{"revision", i}});
    events.send("message", {{"text", i}});
  }
  bool hasNewest = false;
  int count = 0;
  while (const auto event = listener->wait(std::chrono::milliseconds(0))) {
    ++count;
    hasNewest = hasNewest || event->data == R"({"revision":9999})";
  }
  EXPECT_TRUE(hasNewest);
  EXPECT_LE(count, 256);
}

TEST(Pack, ArraysLieOnMultiplesOfEightBytesBehindTheJson) {
  viewer::PackWriter pack;
  pack.set("name", "x");
  pack.add("a", std::vector<std::uint8_t>{1, 2, 3});
  pack.add("b", std::vector<float>{4, 5});
  const ReadPack read(pack.bytes());
  EXPECT_EQ(read.base % 8, 0U);
  EXPECT_EQ(read.json["name"], "x");
  EXPECT_EQ(read.array<std::uint8_t>("a"), (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_EQ(read.array<float>("b"), (std::vector<float>{4, 5}));
}

namespace {

/// A volume of 4 x 2 x 2 voxels that count upwards from -3.
std::shared_ptr<const convert::Volume> countedVolume() {
  convert::Volume volume;
  volume.geometry.size = {4, 2, 2};
  volume.geometry.spacing = {1, 2, 2};
  volume.geometry.origin = {10, 20, 30};
  std::vector<std::int16_t> voxels;
  for (std::int16_t i = -3; i < 13; ++i) voxels.push_back(i);
  volume.voxels = voxels;
  return std::make_shared<const convert::Volume>(std::move(volume));
}

std::vector<double> intensities(const ReadPack& pack) {
  std::vector<double> values;
  const double scale = pack.json["scale"], offset = pack.json["offset"];
  if (pack.json["arrays"]["voxel"]["type"] == "u8")
    for (const auto v : pack.array<std::uint8_t>("voxel")) values.push_back(scale * v + offset);
  else
    for (const auto v : pack.array<std::uint16_t>("voxel")) values.push_back(scale * v + offset);
  return values;
}

std::string wholeOf(const viewer::VolumePack& pack, std::size_t step) {
  std::string bytes;
  while (bytes.size() < pack.size()) bytes += pack.bytes(bytes.size(), step);
  return bytes;
}

}  // namespace

TEST(VolumePack, GivesTheIntensitiesOfSignedVoxelsExactly) {
  const ReadPack pack(wholeOf(viewer::VolumePack(countedVolume(), "v"), 1 << 20));
  std::vector<double> expected;
  for (int i = -3; i < 13; ++i) expected.push_back(i);
  EXPECT_EQ(intensities(pack), expected);
  EXPECT_EQ(pack.json["size"], Json({4, 2, 2}));
  EXPECT_EQ(pack.json["arrays"]["voxel"]["shape"], Json({2, 2, 4}));
  EXPECT_EQ(pack.json["origin"], Json({10.0, 20.0, 30.0}));
}

TEST(VolumePack, IsTheSameInPiecesOfAnySize) {
  const viewer::VolumePack pack(countedVolume(), "v");
  const std::string whole = wholeOf(pack, 1 << 20);
  for (const std::size_t step : {1U, 3U, 17U}) EXPECT_EQ(wholeOf(pack, step), whole);
}

TEST(VolumePack, TooManyVoxelsAreAveragedAlongTheFinestAxisFirst) {
  const ReadPack pack(wholeOf(viewer::VolumePack(countedVolume(), "v", {.mostVoxels = 8}), 64));
  EXPECT_EQ(pack.json["reduction"], Json({2, 1, 1}));
  EXPECT_EQ(pack.json["size"], Json({2, 2, 2}));
  EXPECT_EQ(pack.json["spacing_mm"], Json({2.0, 2.0, 2.0}));
  EXPECT_EQ(pack.json["origin"], Json({10.5, 20.0, 30.0}));  // the middle of the first two voxels
  EXPECT_EQ(pack.json["source_size"], Json({4, 2, 2}));
  const auto values = intensities(pack);
  ASSERT_EQ(values.size(), 8U);
  EXPECT_NEAR(values[0], -2.5, 0.51);  // of -3 and -2, in whole steps
  EXPECT_NEAR(values[7], 11.5, 0.51);
}

TEST(VolumePack, ACropInEightBitsKeepsItsPlaceAndIsWithinAStep) {
  viewer::VolumeSending sending;
  sending.eightBits = sending.cropped = true;
  sending.crop = convert::CellBox::between({1, 0, 1}, {2, 1, 1});
  const ReadPack pack(wholeOf(viewer::VolumePack(countedVolume(), "v", sending), 64));
  EXPECT_EQ(pack.json["size"], Json({2, 2, 1}));
  EXPECT_EQ(pack.json["origin"], Json({11.0, 20.0, 32.0}));
  const std::vector<double> expected = {6, 7, 10, 11};
  const auto values = intensities(pack);
  ASSERT_EQ(values.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(values[i], expected[i], 15.0 / 255);
}

namespace {

// The measures of the open case.
formats::Case straightVessel() {
  formats::Case value;
  value.metadata.voxelSize = 0.2;
  addVessel(value, "tube", straightPath({6.4, 6.4, 1.4}, {0, 0, 1}, 11), 1.0, 1.0);
  addModels(value);
  return value;
}

}  // namespace

class MeasuresTest : public ServedTest {
protected:
  void SetUp() override {
    ServedTest::SetUp();
    writeCase("tube.lumen", straightVessel());
    serve({"tube.lumen"});
  }
};

TEST_F(MeasuresTest, AreThoseOfTheCaseUntilItChanges) {
  EXPECT_EQ(state()["revisions"]["measures"], 0);
  EXPECT_EQ(get("measures").status, 404);
  performAll({{"op", "measure"}});
  EXPECT_EQ(state()["revisions"]["measures"], 1);
  EXPECT_EQ(state()["measures_are_old"], false);
  const Json tables = Json::parse(get("measures").body);
  ASSERT_EQ(tables["vessels"].size(), 1U);
  EXPECT_EQ(tables["vessels"][0]["vessel"], "tube");
  EXPECT_NEAR(tables["vessels"][0]["length_mm"]["value"].get<double>(), 10, 0.01);
  performAll({{"op", "rename"}, {"branch", 0}, {"label", "carotid"}});
  EXPECT_EQ(state()["measures_are_old"], true);
}

TEST_F(MeasuresTest, AreTablesOfCommaSeparatedValuesToo) {
  performAll({{"op", "measure"}});
  const std::string table = get("measures?kind=vessels").body;
  EXPECT_EQ(table.substr(0, 12), "case,vessel,") << table;
  EXPECT_NE(table.find("\ntube.lumen,tube,"), std::string::npos) << table;
  EXPECT_EQ(get("measures?kind=none").status, 404);
}

}  // namespace lumen::test
