// SPDX-License-Identifier: Apache-2.0
// A volume of one patient and a case of another are not mixed without an answer.
#include "served.h"

namespace lumen::test {

namespace {

/// A case of the tube, whose source is its volume with that many voxels changed.
formats::Case caseOfTubeWith(std::size_t changed) {
  convert::Volume volume = tubeVolume();
  formats::Case value = twoVessels();
  std::visit(
      [&](auto& voxels) {
        for (std::size_t i = 0; i < changed; ++i) voxels[i] += 1;
      },
      volume.voxels);
  value.metadata.source = convert::describeSource(volume);
  return value;
}

}  // namespace

class SourceMatchTest : public ServedTest {
protected:
  /// One seed on the tube's axis, which waits.
  void addSeed() {
    ASSERT_EQ(perform({{"op", "seed_add"},
                       {"label", "tube"},
                       {"points", Json::array({{{"position", {6.4, 6.4, 6.4}}}})}})
                  .status,
              200);
  }
};

TEST_F(SourceMatchTest, ACaseOfThisVolumeAsksNothing) {
  writeTube("tube.nrrd");
  writeCase("own.lumen", caseOfTubeWith(0));
  serve({"tube.nrrd", "own.lumen"});
  EXPECT_EQ(state()["other_source"], nullptr);
  addSeed();
  performAll({{"op", "track"}});
  EXPECT_EQ(perform({{"op", "accept_volume"}}).status, 400);
}

TEST_F(SourceMatchTest, ACaseWithoutAVolumeOfItsOwnAsksNothing) {
  writeTube("tube.nrrd");
  writeCase("free.lumen", twoVessels());
  serve({"tube.nrrd", "free.lumen"});
  EXPECT_EQ(state()["other_source"], nullptr);
}

TEST_F(SourceMatchTest, NothingIsTrackedIntoACaseOfAnotherVolume) {
  writeTube("tube.nrrd");
  writeCase("other.lumen", caseOfTubeWith(1));
  for (const auto& names : {std::vector<std::string>{"tube.nrrd", "other.lumen"},
                            std::vector<std::string>{"other.lumen", "tube.nrrd"}}) {
    serve(names);
    const Json said = state()["other_source"];
    ASSERT_TRUE(said.is_string());
    EXPECT_NE(said.get<std::string>().find("other.lumen was made from another volume"),
              std::string::npos)
        << said;
    EXPECT_NE(said.get<std::string>().find("voxels"), std::string::npos) << said;
    addSeed();
    for (const char* op : {"track", "find", "accept"}) {
      const auto answer = perform({{"op", op}});
      EXPECT_EQ(answer.status, 400) << op;
      EXPECT_NE(answer.body.find("belong to one patient"), std::string::npos) << answer.body;
    }
    EXPECT_EQ(perform({{"op", "rename"}, {"branch", 1}, {"label", "mine"}}).status, 200);
  }
}

TEST_F(SourceMatchTest, TheAnswerIsKeptInTheCaseAndCanBeUndone) {
  writeTube("tube.nrrd");
  writeCase("other.lumen", caseOfTubeWith(1));
  serve({"tube.nrrd", "other.lumen"});
  ASSERT_EQ(perform({{"op", "accept_volume"}}).status, 200);
  EXPECT_EQ(state()["other_source"], nullptr);
  EXPECT_EQ(state()["undo"], "accept tube.nrrd");
  addSeed();
  performAll({{"op", "track"}});
  ASSERT_EQ(perform({{"op", "save"}}).status, 200);
  const auto kept = formats::readCaseFile(path("other.lumen"));
  ASSERT_TRUE(kept);
  const auto& steps = kept->metadata.steps;
  const auto step = std::find_if(steps.begin(), steps.end(),
                                 [](const auto& each) { return each.name == "accept-volume"; });
  ASSERT_NE(step, steps.end());
  EXPECT_EQ(std::get<std::string>(step->parameters.at("sha256")),
            convert::describeSource(tubeVolume()).sha256);

  serve({"tube.nrrd", "other.lumen"});  // once is enough
  EXPECT_EQ(state()["other_source"], nullptr);

  writeCase("other.lumen", caseOfTubeWith(1));
  serve({"tube.nrrd", "other.lumen"});
  ASSERT_EQ(perform({{"op", "accept_volume"}}).status, 200);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_TRUE(state()["other_source"].is_string());
}

TEST_F(SourceMatchTest, AVolumeThatIsClosedAsksNothing) {
  writeTube("tube.nrrd");
  writeCase("other.lumen", caseOfTubeWith(1));
  serve({"tube.nrrd", "other.lumen"});
  ASSERT_EQ(perform({{"op", "close_file"}, {"id", state()["files"][0]["id"]}}).status, 200);
  EXPECT_EQ(state()["other_source"], nullptr);
}

TEST_F(SourceMatchTest, WhatIsNotCertainAboutTheVolumeStays) {
  writeTube("tube.nrrd");
  serve({"tube.nrrd"});
  EXPECT_EQ(state()["assumptions"], Json::array());
  write("bare.nrrd",
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nspacings: 1 1 1\nencoding: "
        "raw\n\nabcdefgh");
  serve({"bare.nrrd"});
  EXPECT_EQ(state()["assumptions"].size(), 1U) << state()["assumptions"];
}

}  // namespace lumen::test
