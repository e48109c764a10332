// SPDX-License-Identifier: Apache-2.0
// A session with one thread, and routes without a transport, as the worker of a page has them.
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "served.h"
#include "viewer/routes/routes.h"

namespace lumen::viewer {
namespace {

class OneThreadTest : public ::testing::Test {
protected:
  OneThreadTest() {
    session.events.forward([this](const Event& event) { heard.push_back(event.name); });
  }

  SessionOptions options() {
    SessionOptions made;
    made.oneThread =
        OneThread{[this] { return isJobStopped; }, [this] { return isSurfaceStopped; }};
    return made;
  }

  PageAnswer ask(bool isPost, const std::string& name, const std::string& body = "",
                 std::multimap<std::string, std::string> query = {}) {
    PageRequest request{isPost, name, std::move(query)};
    request.bodySize = body.size();
    request.readBody = [&body](std::uint64_t) { return body; };
    request.whileWanted = [](const std::function<void(Progress&)>& work) {
      Progress silent;
      work(silent);
    };
    return routes.answer(request);
  }
  Json state() { return Json::parse(std::string(ask(false, "state").piece(0, 1 << 20))); }
  PageAnswer perform(Json operation) {
    operation["revision"] = state()["revision"];
    return ask(true, "do", operation.dump());
  }
  void drop(const std::string& name, const std::string& bytes,
            std::multimap<std::string, std::string> query = {}) {
    query.emplace("name", name);
    ASSERT_EQ(ask(true, "file", bytes, std::move(query)).status, 200);
  }

  bool isJobStopped = false, isSurfaceStopped = false;
  std::vector<std::string> heard;
  Session session{options()};
  PageFiles page;
  Routes routes{session, page, 1 << 30};
};

TEST_F(OneThreadTest, JobWaitsForTheOwnerOfTheSession) {
  drop("two.lumen", test::bytesOf(test::twoVessels()));
  EXPECT_FALSE(state()["job"].is_null());
  EXPECT_FALSE(state()["has_case"].get<bool>());
  EXPECT_EQ(perform({{"op", "undo"}}).status, 409);
  EXPECT_TRUE(session.work());
  EXPECT_TRUE(state()["job"].is_null());
  EXPECT_TRUE(state()["has_case"].get<bool>());
  EXPECT_EQ(state()["undo"], "open two.lumen");
  EXPECT_NE(std::find(heard.begin(), heard.end(), "done"), heard.end());
  EXPECT_NE(std::find(heard.begin(), heard.end(), "state"), heard.end());
}

TEST_F(OneThreadTest, FileThatAPageBeginsWithCannotBeUndone) {
  drop("two.lumen", test::bytesOf(test::twoVessels()), {{"first", "1"}});
  ASSERT_TRUE(session.work());
  EXPECT_TRUE(state()["has_case"].get<bool>());
  EXPECT_TRUE(state()["undo"].is_null());
  EXPECT_FALSE(state()["unsaved"].get<bool>());
}

TEST_F(OneThreadTest, JobThatIsStoppedChangesNothing) {
  drop("tube.nrrd",
       convert::encodeVolume(test::tubeVolume(), convert::VolumeFormat::Nrrd, false, "tube.nrrd"));
  ASSERT_TRUE(session.work());
  const Json before = state();
  isJobStopped = true;
  ASSERT_EQ(perform({{"op", "find"}}).status, 200);
  EXPECT_TRUE(session.work());
  EXPECT_TRUE(state()["job"].is_null());
  EXPECT_EQ(state()["revision"], before["revision"]);
  isJobStopped = false;
  ASSERT_EQ(perform({{"op", "find"}}).status, 200);
  EXPECT_TRUE(session.work());
  EXPECT_FALSE(state()["proposals"].empty());
}

TEST_F(OneThreadTest, SurfaceIsLeftForARequestAndMadeLater) {
  drop("two.lumen", test::bytesOf(test::twoVessels()));
  ASSERT_TRUE(session.work());
  ASSERT_EQ(ask(false, "surface", "", {{"level", "1"}}).status, 200);
  const Json preview = state()["revisions"]["surface"];
  isSurfaceStopped = true;
  EXPECT_TRUE(session.work());
  EXPECT_EQ(state()["revisions"]["surface"], preview);
  isSurfaceStopped = false;
  while (session.work()) continue;
  EXPECT_NE(state()["revisions"]["surface"], preview);
}

TEST_F(OneThreadTest, SurfaceThatAnAnswerNeedsIsMadeWhoeverWaits) {
  drop("two.lumen", test::bytesOf(test::twoVessels()));
  ASSERT_TRUE(session.work());
  isSurfaceStopped = true;
  Progress silent;
  ASSERT_TRUE(session.finishedSurface(1, silent).bytes);
}

TEST_F(OneThreadTest, FolderOfATargetIsAZip) {
  drop("two.lumen", test::bytesOf(test::twoVessels()));
  ASSERT_TRUE(session.work());
  const PageAnswer answer = ask(false, "save", "", {{"format", "sofa.zip"}});
  ASSERT_EQ(answer.status, 200);
  EXPECT_EQ(answer.fileName, "two.sofa.zip");
  const std::string zip(answer.piece(0, answer.size));
  EXPECT_EQ(zip.substr(0, 4), "PK\x03\x04");
  for (const char* const name : {"sofa/README.md", "sofa/lumen-export.json", "sofa/scene.py"})
    EXPECT_NE(zip.find(name), zip.npos) << name;
  EXPECT_EQ(ask(false, "save", "", {{"format", "tin.zip"}}).status, 400);
}

TEST_F(OneThreadTest, OtherNamesAreNoRequests) {
  EXPECT_EQ(ask(false, "do").status, 404);
  EXPECT_EQ(ask(true, "state").status, 404);
  EXPECT_FALSE(ask(false, "nothing").piece);
}

}  // namespace
}  // namespace lumen::viewer
