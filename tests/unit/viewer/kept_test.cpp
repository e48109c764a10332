// SPDX-License-Identifier: Apache-2.0
// A library's cases, files that are read again, and work that is not saved.
#include "converters/base/error.h"
#include "converters/library/index/library_file.h"
#include "served.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/operations.h"

namespace lumen::test {

namespace fs = std::filesystem;

using ReloadTest = ServedTest;
using UnsavedTest = ServedTest;

namespace {

formats::Case named(const std::string& label) {
  formats::Case value = twoVessels();
  value.tree.branches[0].label = label;
  return value;
}

}  // namespace

class OpenLibraryTest : public ServedTest {
protected:
  void SetUp() override {
    fs::create_directories(path("deep/deeper"));
    fs::create_directories(path(".hidden"));
    writeCase("a.lumen", named("in a"));
    writeCase("deep/b.lumen", named("in b"));
    write("broken.lumen", "nothing of a case");
    writeCase("a.unsaved.lumen", named("no case of its own"));
    writeCase("deep/deeper/c.lumen", named("too deep"));
    writeCase(".hidden/d.lumen", named("hidden"));
    session = std::make_unique<viewer::Session>(viewer::SessionOptions{});
    session->openLibrary(viewer::casesIn(folder));
    serveSession();
  }
  [[nodiscard]] Json libraryRead() const {
    while (state()["revisions"]["library"] != 4)  // three and one
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return Json::parse(get("library").body);
  }
};

TEST_F(OpenLibraryTest, ListsItsCasesWithFiguresAndSaysWhichCannotBeRead) {
  const Json library = libraryRead();
  EXPECT_EQ(library["name"], folder.filename().string());
  ASSERT_EQ(library["cases"].size(), 3U);
  EXPECT_EQ(library["cases"][0]["name"], "a.lumen");
  EXPECT_EQ(library["cases"][0]["branches"], 2);
  EXPECT_NEAR(library["cases"][0]["length_mm"].get<double>(), 12, 1e-5);
  EXPECT_EQ(library["cases"][1]["name"], "broken.lumen");
  EXPECT_EQ(library["cases"][1]["branches"], nullptr);
  EXPECT_FALSE(library["cases"][1]["error"].get<std::string>().empty());
  EXPECT_EQ(library["cases"][2]["name"], "deep/b.lumen");
}

TEST_F(OpenLibraryTest, OpensTheCaseOfANumberAndSavesIntoItsFile) {
  performAll({{"op", "open_case"}, {"index", 2}});
  EXPECT_EQ(state()["open_case"], 2);
  EXPECT_EQ(state()["save_as"], "b.lumen");
  EXPECT_EQ(state()["unsaved"], false);
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 1}, {"label", "mine"}}).status, 200);
  ASSERT_EQ(perform({{"op", "save"}}).status, 200);
  EXPECT_EQ(formats::readCaseFile(path("deep/b.lumen"))->tree.branches[1].label, "mine");
  EXPECT_EQ(formats::readCaseFile(path("a.lumen"))->tree.branches[1].label, "right");
}

class PublishedLibraryTest : public ServedTest {
protected:
  void SetUp() override {
    fs::create_directories(path("lib/data/fork-1"));
    writeCase("lib/data/fork-1/case.lumen", twoVessels());
    writeCase("lib/data/unlisted.lumen", twoVessels());
    convert::LibraryFile library;
    library.id = "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4";
    library.title = "Forks";
    library.date = "2026-11-22";
    library.generator = "lumen 0.1.0";
    convert::LibraryEntry entry;
    entry.id = "fork-1";
    entry.title = "A fork";
    entry.recordSha256 = std::string(64, '0');
    library.cases = {entry};
    write("lib/library.json", convert::libraryText(library));
    session = std::make_unique<viewer::Session>(viewer::SessionOptions{});
    session->openLibrary(viewer::casesIn(path("lib")));
    serveSession();
    performAll({{"op", "open_case"}, {"index", 0}});
  }
};

TEST_F(PublishedLibraryTest, HasTheCasesThatItListsUnderTheirTitles) {
  const Json library = Json::parse(get("library").body);
  EXPECT_EQ(library["name"], "Forks");
  ASSERT_EQ(library["cases"].size(), 1U);
  EXPECT_EQ(library["cases"][0]["name"], "A fork (fork-1)");
}

TEST_F(PublishedLibraryTest, IsNeverWrittenInto) {
  EXPECT_EQ(state()["save_as"], nullptr);
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 1}, {"label", "mine"}}).status, 200);
  EXPECT_EQ(perform({{"op", "save"}}).status, 400);
  const std::vector<std::string> kept = session->keepUnsaved();
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept.front(), path("fork-1.unsaved.lumen").string());
  EXPECT_EQ(formats::readCaseFile(path("lib/data/fork-1/case.lumen"))->tree.branches[1].label,
            "right");
  EXPECT_EQ(std::distance(fs::directory_iterator(path("lib/data/fork-1")), {}), 1);
}

TEST_F(OpenLibraryTest, NoPathOpensAFileNorANumberBeyondTheList) {
  EXPECT_EQ(perform({{"op", "open_case"}, {"index", 3}}).status, 400);
  EXPECT_EQ(perform({{"op", "open_case"}, {"index", -1}}).status, 400);
  EXPECT_EQ(perform({{"op", "open_case"}, {"index", "deep/deeper/c.lumen"}}).status, 400);
  EXPECT_EQ(perform({{"op", "open_case"}, {"path", path("a.lumen").string()}}).status, 400);
  EXPECT_EQ(state()["has_case"], false);
}

TEST_F(OpenLibraryTest, ChangesThatAreNotSavedAreAskedAboutAndKept) {
  performAll({{"op", "open_case"}, {"index", 0}});
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 1}, {"label", "mine"}}).status, 200);
  EXPECT_EQ(perform({{"op", "open_case"}, {"index", 2}}).status, 409);
  performAll({{"op", "open_case"}, {"index", 2}, {"force", true}});
  EXPECT_EQ(state()["open_case"], 2);
  EXPECT_EQ(state()["undo"], nullptr);  // it would save one case into the file of another
  // the name was taken by another file, which is as it was
  EXPECT_EQ(formats::readCaseFile(path("a.unsaved.2.lumen"))->tree.branches[1].label, "mine");
  EXPECT_EQ(formats::readCaseFile(path("a.unsaved.lumen"))->tree.branches[0].label,
            "no case of its own");
}

TEST_F(OpenLibraryTest, ABrokenCaseLeavesWhatIsOpen) {
  performAll({{"op", "open_case"}, {"index", 0}});
  performAll({{"op", "open_case"}, {"index", 1}});
  EXPECT_EQ(state()["open_case"], 0);
  EXPECT_EQ(state()["title"], "a.lumen");
}

TEST_F(ReloadTest, AFileThatHasChangedIsReadAgainAndThatCanBeUndone) {
  writeCase("two.lumen", twoVessels());
  serve({"two.lumen"});
  writeCase("two.lumen", named("from elsewhere"));
  session->lookAtFiles();
  const Json file = state()["files"][0];
  EXPECT_EQ(file["changed"], true);
  performAll({{"op", "reload"}, {"id", file["id"]}});
  EXPECT_EQ(ReadPack(get("case").body).json["branches"][0]["label"], "from elsewhere");
  EXPECT_EQ(state()["files"][0]["changed"], false);
  EXPECT_EQ(state()["unsaved"], false);
  EXPECT_EQ(perform({{"op", "save"}}).status, 200);  // nobody else's work is overwritten
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(ReadPack(get("case").body).json["branches"][0]["label"], "left");
  EXPECT_EQ(state()["unsaved"], true);
}

TEST_F(ReloadTest, AMeshTakesItsOwnPlace) {
  write("wall.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  serve({"wall.obj"});
  write("wall.obj", "v 0 0 0\nv 1 0 0\nv 0 7 0\nf 1 2 3\n");
  performAll({{"op", "reload"}, {"id", state()["files"][0]["id"]}});
  const Json now = state();
  ASSERT_EQ(now["meshes"].size(), 1U);
  EXPECT_EQ(
      ReadPack(get("mesh?id=" + now["meshes"][0]["id"].dump()).body).array<float>("position")[7],
      7);
}

TEST_F(ReloadTest, WhatHasBecomeAnotherKindOfFileIsNotTakenForTheOldOne) {
  writeCase("two.lumen", twoVessels());
  serve({"two.lumen"});
  write("two.lumen", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  performAll({{"op", "reload"}, {"id", state()["files"][0]["id"]}});
  EXPECT_EQ(ReadPack(get("case").body).json["branches"][0]["label"], "left");
  EXPECT_EQ(perform({{"op", "reload"}, {"id", 77}}).status, 400);
}

/// A session with an open case, without a server.
class SavingTest : public ServedTest {
protected:
  void SetUp() override {
    writeCase("two.lumen", twoVessels());
    open("two.lumen");
    own.saving.saveTo(path("two.lumen"));
  }
  void open(const std::string& name) {
    Progress silent;
    own.open({path(name), name}, silent);
  }
  /// The work that `reload` of the first open file does for a page that saw `seen`.
  void reload(const viewer::Moment& seen) {
    const Json request = {{"op", "reload"}, {"id", seen.document.files[0].id}};
    const formats::JsonDocument parsed = viewer::parseRequest(request.dump(), 1000);
    viewer::reload(own, viewer::Arguments(parsed.root()), seen);
    own.jobs.wait();
  }
  fs::path save(const viewer::Moment& seen) {
    viewer::Document document = seen.document;
    return own.saving.save(document, false);
  }

  viewer::Session own{viewer::SessionOptions{}};
};

TEST_F(SavingTest, AReloadThatComesTooLateChangesNothingOfWhatIsSaved) {
  const viewer::Moment seen = own.history.now();
  write("wall.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  open("wall.obj");
  writeCase("two.lumen", named("from elsewhere"));
  reload(seen);
  EXPECT_FALSE(own.hasUnsaved()) << "the case is that of its file as it was read";
  EXPECT_THROW(save(own.history.now()), viewer::Conflict) << "which has changed since";
}

TEST_F(SavingTest, ADocumentThatAnotherHasReplacedIsNotSavedIntoTheFileOfThat) {
  writeCase("other.lumen", named("other"));
  const viewer::Moment seen = own.history.now();
  open("other.lumen");
  own.saving.saveTo(path("other.lumen"));
  const Json request = {{"op", "save"}};
  const formats::JsonDocument parsed = viewer::parseRequest(request.dump(), 1000);
  EXPECT_THROW(viewer::save(own, viewer::Arguments(parsed.root()), seen), viewer::Conflict);
  EXPECT_EQ(formats::readCaseFile(path("other.lumen"))->tree.branches[0].label, "other");
}

TEST_F(SavingTest, ATargetThatComesWhileAnotherIsWrittenKeepsItsOwnStamp) {
  writeCase("other.lumen", twoVessels());
  const viewer::Moment now = own.history.now();
  for (int k = 0; k < 100; ++k) {
    own.saving.saveTo(path("two.lumen"));
    std::thread other([this, k] {
      std::this_thread::sleep_for(std::chrono::microseconds(20 * k));
      own.saving.saveTo(path("other.lumen"));
    });
    save(now);
    other.join();
    ASSERT_NO_THROW(save(now)) << "after " << 20 * k << " us";
  }
}

TEST_F(UnsavedTest, IsWrittenBesideTheFileAndRemovedWhenItIsSaved) {
  writeCase("two.lumen", twoVessels());
  serve({"two.lumen"});
  EXPECT_TRUE(session->keepUnsaved().empty());
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 1}, {"label", "mine"}}).status, 200);
  ASSERT_EQ(session->keepUnsaved(), std::vector{path("two.unsaved.lumen").string()});
  EXPECT_EQ(formats::readCaseFile(path("two.unsaved.lumen"))->tree.branches[1].label, "mine");
  ASSERT_EQ(perform({{"op", "save"}}).status, 200);
  EXPECT_FALSE(fs::exists(path("two.unsaved.lumen")));
}

TEST_F(UnsavedTest, IsRemovedWhenItIsUndone) {
  writeCase("two.lumen", twoVessels());
  serve({"two.lumen"});
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 1}, {"label", "mine"}}).status, 200);
  session->keepUnsaved();
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_TRUE(session->keepUnsaved().empty());
  EXPECT_FALSE(fs::exists(path("two.unsaved.lumen")));
}

TEST_F(UnsavedTest, OfAnEarlierProgramIsOfferedAndNeverOverwritten) {
  writeCase("two.lumen", twoVessels());
  writeCase("two.unsaved.lumen", named("before the end"));
  writeCase("twofold.unsaved.lumen", named("of another file"));
  serve({"two.lumen"});
  EXPECT_EQ(session->findUnsaved(), std::vector{path("two.unsaved.lumen").string()});
  const Json before = state()["unsaved_before"];
  ASSERT_EQ(before.size(), 1U);
  EXPECT_EQ(before[0]["name"], "two.unsaved.lumen");
  EXPECT_EQ(before[0]["newer"], true);
  const auto now = std::chrono::duration_cast<std::chrono::milliseconds>(
                       std::chrono::system_clock::now().time_since_epoch())
                       .count();
  EXPECT_NEAR(static_cast<double>(now - before[0]["written_ms"].get<std::int64_t>()), 0, 60000);
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 1}, {"label", "mine"}}).status, 200);
  EXPECT_EQ(session->keepUnsaved(), std::vector{path("two.unsaved.2.lumen").string()});
  performAll({{"op", "recover"}, {"name", "two.unsaved.lumen"}});
  EXPECT_EQ(ReadPack(get("case").body).json["branches"][0]["label"], "before the end");
  EXPECT_EQ(state()["save_as"], "two.lumen");
  EXPECT_EQ(state()["unsaved"], true);
  ASSERT_EQ(perform({{"op", "save"}}).status, 200);
  EXPECT_EQ(formats::readCaseFile(path("two.lumen"))->tree.branches[0].label, "before the end");
  ASSERT_EQ(perform({{"op", "forget"}, {"name", "two.unsaved.lumen"}}).status, 200);
  EXPECT_FALSE(fs::exists(path("two.unsaved.lumen")));
}

TEST_F(UnsavedTest, NoOtherCopyIsTakenForOneThatAnotherPageHasDeleted) {
  writeCase("two.lumen", twoVessels());
  writeCase("two.unsaved.lumen", named("first"));
  writeCase("two.unsaved.2.lumen", named("second"));
  serve({"two.lumen"});
  session->findUnsaved();
  ASSERT_EQ(perform({{"op", "forget"}, {"name", "two.unsaved.2.lumen"}}).status, 200);
  EXPECT_EQ(perform({{"op", "forget"}, {"name", "two.unsaved.2.lumen"}}).status, 409);
  EXPECT_EQ(perform({{"op", "recover"}, {"name", "two.unsaved.2.lumen"}}).status, 409);
  EXPECT_EQ(perform({{"op", "forget"}, {"name", "two.lumen"}}).status, 409);
  EXPECT_TRUE(fs::exists(path("two.unsaved.lumen")));
  EXPECT_TRUE(fs::exists(path("two.lumen")));
}

TEST_F(UnsavedTest, OfADocumentWithoutAFileIsKeptAtThePlaceForIt) {
  viewer::SessionOptions options;
  options.unnamed = path("state/lumen/lumen");
  session = std::make_unique<viewer::Session>(options);
  serveSession();
  EXPECT_TRUE(session->findUnsaved().empty());
  const auto dropped = std::make_shared<viewer::DroppedFiles>();
  dropped->add("two.lumen", bytesOf(twoVessels()));
  Progress silent;
  session->open({dropped->first(), "two.lumen", viewer::OpenAs::Auto, {}, dropped}, silent);
  const fs::path kept = path("state/lumen/lumen.unsaved.lumen");
  EXPECT_TRUE(session->keepUnsaved().empty());
  EXPECT_FALSE(fs::exists(path("state"))) << "what is saved leaves no folder";
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 1}, {"label", "mine"}}).status, 200);
  ASSERT_EQ(session->keepUnsaved(), std::vector{kept.string()});
  EXPECT_EQ(fs::status(kept.parent_path()).permissions(), fs::perms::owner_all);
  server.reset();
  session = std::make_unique<viewer::Session>(options);
  serveSession();
  ASSERT_EQ(session->findUnsaved(), std::vector{kept.string()});
  performAll({{"op", "recover"}, {"name", "lumen.unsaved.lumen"}});
  EXPECT_EQ(ReadPack(get("case").body).json["branches"][1]["label"], "mine");
}

TEST_F(UnsavedTest, HasANameOfItsOwnForEachVersionOfACase) {
  writeCase("head.v1.lumen", twoVessels());
  writeCase("head.v2.lumen", twoVessels());
  serve({"head.v1.lumen"});
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 1}, {"label", "mine"}}).status, 200);
  EXPECT_EQ(session->keepUnsaved(), std::vector{path("head.v1.unsaved.lumen").string()});
  serve({"head.v2.lumen"});
  EXPECT_TRUE(session->findUnsaved().empty());
  serve({"head.v1.lumen"});
  EXPECT_EQ(session->findUnsaved().size(), 1U);
}

TEST_F(UnsavedTest, IsNotWrittenThroughALinkThatLeadsNowhere) {
  writeCase("two.lumen", twoVessels());
  fs::create_symlink("elsewhere.lumen", path("two.unsaved.lumen"));
  serve({"two.lumen"});
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 1}, {"label", "mine"}}).status, 200);
  EXPECT_EQ(session->keepUnsaved(), std::vector{path("two.unsaved.2.lumen").string()});
  EXPECT_FALSE(fs::exists(path("elsewhere.lumen")));
}

TEST_F(UnsavedTest, SeedsAreKeptBesideTheirVolume) {
  writeTube("tube.nrrd");
  serve({"tube.nrrd"});
  ASSERT_EQ(
      perform({{"op", "seed_add"}, {"label", "a"}, {"points", {{{"position", {1, 2, 3}}}}}}).status,
      200);
  ASSERT_EQ(session->keepUnsaved(), std::vector{path("tube.unsaved.seeds.json").string()});
  serve({"tube.nrrd"});
  ASSERT_EQ(session->findUnsaved().size(), 1U);
  performAll({{"op", "recover"}, {"name", "tube.unsaved.seeds.json"}});
  EXPECT_EQ(state()["seeds"][0]["label"], "a");
}

/// A case and its volume, in which the seed "waits" is placed.
class WaitingSeedTest : public UnsavedTest {
protected:
  void SetUp() override {
    UnsavedTest::SetUp();
    writeTube("tube.nrrd");
    writeCase("two.lumen", twoVessels());
    serve({"tube.nrrd", "two.lumen"});
    ASSERT_EQ(
        perform({{"op", "seed_add"},
                 {"label", "waits"},
                 {"points", Json::array({{{"position", {6.4, 6.4, 6.4}}, {"radius_mm", 1.5}}})}})
            .status,
        200);
  }
  void expectItWaits() {
    ASSERT_EQ(state()["seeds"].size(), 1U);
    EXPECT_EQ(state()["seeds"][0]["label"], "waits");
    EXPECT_EQ(state()["seeds"][0]["tracked"], false);
    EXPECT_EQ(state()["seeds"][0]["points"][0]["radius_mm"], 1.5);
  }
  const std::vector<std::string> m_kept{path("two.unsaved.lumen").string()};
};

TEST_F(WaitingSeedTest, IsSavedWithTheCaseAndWaitsWhenThatIsOpenedAgain) {
  EXPECT_EQ(state()["unsaved"], true);
  ASSERT_EQ(perform({{"op", "save"}}).status, 200);
  EXPECT_EQ(state()["unsaved"], false);
  EXPECT_TRUE(session->keepUnsaved().empty());
  serve({"tube.nrrd", "two.lumen"});
  EXPECT_EQ(state()["unsaved"], false);
  expectItWaits();
}

TEST_F(WaitingSeedTest, IsKeptWithUnsavedWorkAndRecovered) {
  EXPECT_EQ(session->keepUnsaved(), m_kept);
  const auto written = fs::last_write_time(m_kept.front());
  EXPECT_EQ(session->keepUnsaved(), m_kept);
  EXPECT_EQ(fs::last_write_time(m_kept.front()), written);  // nothing has changed since
  serve({"tube.nrrd", "two.lumen"});
  EXPECT_EQ(state()["seeds"].size(), 0U);
  ASSERT_EQ(session->findUnsaved(), m_kept);
  performAll({{"op", "recover"}, {"name", "two.unsaved.lumen"}});
  expectItWaits();
  EXPECT_EQ(state()["unsaved"], true);
}

TEST_F(WaitingSeedTest, IsProvenanceOnceItIsTracked) {
  performAll({{"op", "track"}});
  ASSERT_EQ(perform({{"op", "save"}}).status, 200);
  EXPECT_EQ(state()["unsaved"], false);
  serve({"tube.nrrd", "two.lumen"});
  ASSERT_EQ(state()["seeds"].size(), 1U);
  EXPECT_EQ(state()["seeds"][0]["tracked"], true);
  const auto again = perform({{"op", "track"}});
  EXPECT_EQ(again.status, 400);  // nothing waits
}

TEST_F(WaitingSeedTest, IsInADownloadedCaseAndBesideAnotherCaseThatIsOpened) {
  write("copy.lumen", get("save?format=lumen").body);
  serve({"tube.nrrd", "copy.lumen"});
  expectItWaits();
  EXPECT_EQ(state()["unsaved"], false);
  ASSERT_EQ(perform({{"op", "seed_add"},
                     {"label", "more"},
                     {"points", Json::array({{{"position", {6.4, 6.4, 8.0}}}})}})
                .status,
            200);
  std::ifstream stream(path("two.lumen"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_EQ(post("file?name=two.lumen&as=auto", bytes).status, 200);
  waitForJob();
  EXPECT_EQ(state()["seeds"].size(), 2U);
  EXPECT_EQ(state()["unsaved"], true);
}

}  // namespace lumen::test
