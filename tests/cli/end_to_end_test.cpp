// SPDX-License-Identifier: Apache-2.0
// From a synthetic tube to a case, a mesh and a score.
#include <nlohmann/json.hpp>

#include "converters/base/run_program.h"
#include "converters/engine/file_format.h"
#include "formats/case/case_file.h"
#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

using Names = std::vector<std::string>;

const Names kQuantiles = {"median", "p90", "max"};

}  // namespace

TEST_F(FittedTubeTest, ATubeIsFoundAndAnswersHaveTheirStableNames) {
  const Outcome compared = lumen({"compare", "tube.lumen", "truth.lumen", "--json"});
  ASSERT_EQ(compared.code, 0) << compared.err;
  const Json score = Json::parse(compared.out);
  EXPECT_GE(score["overlap"].get<double>(), 0.95);
  const Names scores = {"overlap",           "overlap_until_first_error",
                        "average_inside_mm", "assd_mm",
                        "assd_limited_mm",   "radius_bias_mm",
                        "radius_rms_mm",     "missed_mm",
                        "false_mm",          "wall_distance_mm"};
  Names whole = scores, branch = {"label"};
  whole.emplace_back("branches");
  branch.insert(branch.end(), scores.begin(), scores.end());
  EXPECT_EQ(keys(score), whole);
  EXPECT_EQ(keys(score["wall_distance_mm"]), kQuantiles);
  ASSERT_EQ(score["branches"].size(), 1U);
  EXPECT_EQ(keys(score["branches"][0]), branch);

  const Outcome told = lumen({"info", "tube.lumen", "--json"});
  ASSERT_EQ(told.code, 0) << told.err;
  const Json info = Json::parse(told.out);
  EXPECT_EQ(keys(info), (Names{"branches",
                               "nodes",
                               "links",
                               "trees",
                               "networks",
                               "points",
                               "blobs",
                               "blobs_per_node",
                               "length_mm",
                               "reachable",
                               "radius_mm",
                               "least_shown_radius_mm",
                               "error_of_fit_mm",
                               "provenance",
                               "note",
                               "node_arrays",
                               "motion",
                               "seeds",
                               "inlets",
                               "surface",
                               "surface_warnings",
                               "surface_findings",
                               "contacts_accepted",
                               "next"}));
  EXPECT_EQ(keys(info["radius_mm"]), (Names{"min", "max"}));
  EXPECT_EQ(keys(info["error_of_fit_mm"]), kQuantiles);
  EXPECT_EQ(keys(info["provenance"]),
            (Names{"voxel_size_mm", "source", "parent_sha256", "point_step_mm", "steps"}));
  ASSERT_EQ(info["branches"].size(), 1U);
  EXPECT_GT(info["blobs"].get<int>(), info["nodes"].get<int>());
}

TEST_F(TubeTest, AVolumeIsConvertedWithoutSeeds) {
  const Outcome done = lumen({"convert", "tube.nrrd", "found.lumen", "--json"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(Json::parse(done.out)["branches"], 1);
  const Outcome compared = lumen({"compare", "found.lumen", "truth.lumen", "--json"});
  EXPECT_GE(Json::parse(compared.out)["overlap"].get<double>(), 0.98) << compared.out;
}

TEST_F(TubeTest, RepeatedRunsHaveOtherNoise) {
  const Outcome done = lumen({"convert", "tube.nrrd", "found.lumen", "--repeat", "2", "--json"});
  ASSERT_EQ(done.code, 0) << done.err;
  const Json repeats = Json::parse(done.out)["repeats"];
  const double least = repeats["least_length_mm"].get<double>();
  EXPECT_LT(least, repeats["greatest_length_mm"].get<double>());
  EXPECT_GT(least, 0.95 * Json::parse(done.out)["length_mm"].get<double>());
}

TEST_F(TubeTest, ProposalsOfSeedsAreSeedsInBothFormats) {
  for (const char* const file : {"found.json", "found.mrk.json"}) {
    const Outcome proposed = lumen({"seeds", "tube.nrrd", file, "--json"});
    ASSERT_EQ(proposed.code, 0) << proposed.err;
    EXPECT_EQ(Json::parse(proposed.out)["seeds"], 1);
    EXPECT_EQ(Json::parse(read(file)).contains("markups"), std::string(file) == "found.mrk.json");
    ASSERT_EQ(lumen({"convert", "tube.nrrd", "again.lumen", "--seeds", file}).code, 0) << file;
    const Outcome compared = lumen({"compare", "again.lumen", "truth.lumen", "--json"});
    EXPECT_GE(Json::parse(compared.out)["overlap"].get<double>(), 0.98) << file;
  }
}

TEST_F(TubeTest, TheSeedsOfATrackStayInTheCaseAndComeOutAgain) {
  Json seeds = Json::parse(read("seeds.json"));
  Json stray = seeds["branches"][0];
  stray["label"] = "stray";
  stray["points"] = {{0.2, 0.2, 0.2}};
  seeds["branches"].push_back(stray);
  write("two.json", seeds.dump());
  const Outcome made = lumen({"convert", "tube.nrrd", "kept.lumen", "--seeds", "two.json",
                              "--seeds-only", "--inlier-rate", "0.9"});
  ASSERT_EQ(made.code, 0) << made.err;
  const auto seedsOf = [this](const std::string& file) {
    return Json::parse(lumen({"info", file, "--json"}).out)["seeds"];
  };
  EXPECT_EQ(seedsOf("kept.lumen"), Json({{"tracked", 1}, {"waiting", 1}}));
  ASSERT_EQ(lumen({"convert", "kept.lumen", "kept.lumen.json"}).code, 0);
  EXPECT_EQ(seedsOf("kept.lumen.json"), Json({{"tracked", 1}, {"waiting", 1}}));
  ASSERT_EQ(lumen({"convert", "kept.lumen.json", "again.lumen"}).code, 0);
  EXPECT_EQ(read("again.lumen"), read("kept.lumen"));
  ASSERT_EQ(lumen({"seeds", "kept.lumen", "out.mrk.json"}).code, 0);
  const Outcome again = lumen({"convert", "tube.nrrd", "from.lumen", "--seeds", "out.mrk.json",
                               "--seeds-only", "--inlier-rate", "0.9"});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(seedsOf("from.lumen"), Json({{"tracked", 1}, {"waiting", 1}}));
}

TEST_F(TubeTest, ACaseWithoutSeedsHasNoneToWrite) {
  const Outcome none = lumen({"seeds", "truth.lumen", "out.json"});
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.err.find("truth.lumen: it holds no seeds"), std::string::npos) << none.err;
}

/// A fork with its truth and clicks, and the clicks on its trunk alone.
class ForkTest : public CliTest {
protected:
  void SetUp() override {
    fillOnce("fork", [this] {
      make({"phantom", "bifurcation", "fork.nrrd", "--size", "64", "--truth", "truth.lumen",
            "--seeds", "seeds.json"});
    });
    Json seeds = Json::parse(read("seeds.json"));
    seeds["branches"].erase(seeds["branches"].begin() + 1, seeds["branches"].end());
    seeds["branches"][0]["label"] = "trunk";
    write("trunk.json", seeds.dump());
  }
  Json converted(const std::vector<std::string>& options) const {
    std::vector<std::string> line = {"convert", "fork.nrrd", "fork.lumen", "--json"};
    line.insert(line.end(), options.begin(), options.end());
    const Outcome done = lumen(line);
    EXPECT_EQ(done.code, 0) << done.err;
    return Json::parse(done.out);
  }
  [[nodiscard]] formats::CenterlineTree tree() const {
    return (*formats::readCaseFile(path("fork.lumen"))).tree;
  }
};

TEST_F(ForkTest, SeedsAreHintsUnlessTheyStandAlone) {
  const Json free = converted({}), hinted = converted({"--seeds", "trunk.json"});
  EXPECT_EQ(hinted["length_mm"], free["length_mm"]);
  EXPECT_EQ(tree().branches[0].label, "trunk");
  EXPECT_GT(tree().branches.size(), 1U);
  EXPECT_EQ(converted({"--seeds", "trunk.json", "--seeds-only"})["branches"], 1);
}

TEST_F(ForkTest, OnlyConnectedKeepsTheTreesOfSeedsAndOfHints) {
  EXPECT_EQ(converted({"--seeds", "trunk.json", "--seeds-only", "--only-connected"})["branches"],
            1);
  EXPECT_EQ(converted({"--seeds", "seeds.json", "--only-connected"})["branches"], 2);
}

TEST_F(ForkTest, HintsGiveTheTrueForks) {
  ASSERT_EQ(converted({"--seeds", "seeds.json"})["branches"], 2);
  const Outcome compared = lumen({"compare", "fork.lumen", "truth.lumen", "--json"});
  EXPECT_GE(Json::parse(compared.out)["overlap"].get<double>(), 0.98);
}

TEST_F(ForkTest, ARootTurnsTheTree) {
  converted({});
  const formats::CenterlineTree before = tree();
  const formats::Branch& child = before.branches.back();
  const formats::Vec3f& tip = before.centre[child.firstNode + child.nodeCount - 1];
  const std::string place =
      std::to_string(tip.x) + "," + std::to_string(tip.y) + "," + std::to_string(tip.z);
  converted({"--root", place, "--only-connected"});
  EXPECT_EQ(tree().branches.front().parentNode, formats::kNoParent);
  EXPECT_EQ(tree().centre[0], tip);
  EXPECT_EQ(tree().nodeCount(), before.nodeCount());
}

TEST_F(ForkTest, ARootOutsideOfVesselsIsAFailure) {
  const Outcome done = lumen({"convert", "fork.nrrd", "out.lumen", "--root", "1,1,1"});
  EXPECT_EQ(done.code, 1);
  EXPECT_NE(done.err.find("--root 1,1,1 lies in no vessel"), std::string::npos) << done.err;
  EXPECT_FALSE(exists("out.lumen"));
}

TEST_F(CliTest, AVolumeWithoutVesselsIsAFailureThatNamesSeeds) {
  ASSERT_EQ(lumen({"phantom", "tube", "tube.nrrd", "--size", "32"}).code, 0);
  const Outcome dark = lumen({"convert", "tube.nrrd", "tube.lumen", "--dark"});
  EXPECT_EQ(dark.code, 1);
  EXPECT_NE(dark.err.find("no vessels are found"), std::string::npos) << dark.err;
  EXPECT_NE(dark.err.find("--seeds"), std::string::npos) << dark.err;
  EXPECT_FALSE(exists("tube.lumen"));
}

TEST_F(TubeTest, TheTrueTreeComparedToItselfIsPerfectAndHasNoWall) {
  const Outcome compared = lumen({"compare", "truth.lumen", "truth.lumen", "--json"});
  ASSERT_EQ(compared.code, 0) << compared.err;
  const Json score = Json::parse(compared.out);
  EXPECT_EQ(score["overlap"], 1.0);
  EXPECT_NEAR(score["assd_mm"].get<double>(), 0, 1e-6);
  EXPECT_NEAR(score["missed_mm"].get<double>(), 0, 1e-6);
  EXPECT_TRUE(score["wall_distance_mm"].is_null());
}

TEST_F(TubeTest, WhatACaseDoesNotHaveIsNull) {
  const Json info = Json::parse(lumen({"info", "truth.lumen", "--json"}).out);
  EXPECT_EQ(info["points"], 0);
  EXPECT_EQ(info["blobs"], 0);
  EXPECT_TRUE(info["blobs_per_node"].is_null());
  EXPECT_TRUE(info["error_of_fit_mm"].is_null());
}

TEST_F(TubeTest, InfoOfAVolumeGivesItsHeader) {
  const Json info = Json::parse(lumen({"info", "tube.nrrd", "--json"}).out);
  EXPECT_EQ(keys(info),
            (Names{"size", "spacing_mm", "origin_mm", "direction", "placed_by", "resampled",
                   "stored_type", "encoding", "voxel_bytes", "stored_bytes", "next"}));
  EXPECT_TRUE(info["placed_by"].is_null());
  EXPECT_EQ(info["stored_type"], "int16");
  EXPECT_EQ(info["encoding"], "gzip");
  EXPECT_EQ(info["voxel_bytes"], 64 * 64 * 64 * 2);
  EXPECT_EQ(info["stored_bytes"], read("tube.nrrd").size());
}

TEST_F(TubeTest, InfoDoesNotReadVoxelsUnlessAsked) {
  write("cut.nrrd", read("tube.nrrd").substr(0, 20000));
  const Outcome header = lumen({"info", "cut.nrrd"});
  EXPECT_EQ(header.code, 0) << header.err;
  EXPECT_NE(header.out.find("not read; --voxels"), std::string::npos) << header.out;
  EXPECT_EQ(lumen({"info", "cut.nrrd", "--voxels"}).code, 3);
}

TEST_F(TubeTest, InfoOfAVolumeGivesItsGeometryAndDigest) {
  const Json info = Json::parse(lumen({"info", "tube.nrrd", "--json", "--voxels"}).out);
  EXPECT_EQ(keys(info), (Names{"size", "spacing_mm", "origin_mm", "direction", "sha256",
                               "pixel_type", "min", "max", "labels", "placed_by", "resampled",
                               "stored_type", "encoding", "voxel_bytes", "stored_bytes", "next"}));
  EXPECT_EQ(info["labels"], Json::array());
  EXPECT_EQ(info["size"], Json::array({64, 64, 64}));
  EXPECT_EQ(info["pixel_type"], "int16");
  EXPECT_EQ(info["sha256"].get<std::string>().size(), 64U);
}

TEST_F(TubeTest, CropKeepsTheBoxWithItsEnds) {
  const Outcome told = lumen({"info", "tube.nrrd", "--json", "--crop", "0,63,10,49,20,39"});
  ASSERT_EQ(told.code, 0) << told.err;
  EXPECT_EQ(Json::parse(told.out)["size"], Json::array({64, 40, 20}));
}

TEST_F(TubeTest, TrackThenFitGivesConvertsCaseAndNamesItsParentForAnyNumberOfThreads) {
  ASSERT_EQ(
      lumen({"convert", "tube.nrrd", "one.lumen", "--seeds", "seeds.json", "--threads", "1"}).code,
      0);
  ASSERT_EQ(
      lumen({"track", "tube.nrrd", "two.lumen", "--seeds", "seeds.json", "--threads", "2"}).code,
      0);
  ASSERT_EQ(lumen({"fit", "two.lumen", "two.lumen", "--threads", "2"}).code, 0);
  auto one = formats::readCaseFile(path("one.lumen"));
  auto two = formats::readCaseFile(path("two.lumen"));
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->metadata.parentSha256, "");
  EXPECT_EQ(two->metadata.parentSha256.size(), 64U);
  two->metadata.parentSha256.clear();
  EXPECT_TRUE(formats::encodeBinary(*one) == formats::encodeBinary(*two));
}

TEST_F(FittedTubeTest, ACaseBecomesEveryOtherFormatAndBothEncodingsHoldTheSame) {
  for (const auto& format : engine::fileFormats()) {
    if (!engine::canWrite(format)) continue;
    if (engine::canWriteVolumeMesh(format) && !convert::installedProgram("lumen-netgen")) continue;
    const std::string name = std::string("a").append(format.endings.front());
    const Outcome made = lumen({"convert", "tube.lumen", name});
    EXPECT_EQ(made.code, 0) << name << ": " << made.err;
    EXPECT_FALSE(read(name).empty()) << name;
  }
  ASSERT_EQ(lumen({"convert", "a.lumen.json", "back.lumen"}).code, 0);
  EXPECT_TRUE(read("tube.lumen") == read("back.lumen"));
}

TEST_F(TubeTest, EveryVolumeFormatThatIsWrittenReadsBackTheSame) {
  const Json info = Json::parse(lumen({"info", "tube.nrrd", "--json", "--voxels"}).out);
  for (const auto& format : engine::fileFormats()) {
    if (!engine::canWriteVolume(format)) continue;
    const std::string name = std::string("other").append(format.endings.front());
    ASSERT_EQ(lumen({"phantom", "tube", name, "--size", "64"}).code, 0) << name;
    EXPECT_EQ(Json::parse(lumen({"info", name, "--json", "--voxels"}).out)["sha256"],
              info["sha256"])
        << name;
  }
}

TEST_F(TubeTest, ATreeAloneHasNoSurfaceToMakeAMeshOf) {
  const Outcome refused = lumen({"convert", "truth.lumen", "truth.glb"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_NE(refused.err.find("truth.lumen"), std::string::npos) << refused.err;
  EXPECT_FALSE(exists("truth.glb"));
}

TEST_F(TubeTest, ToChoosesTheFormatWhateverTheName) {
  ASSERT_EQ(lumen({"convert", "truth.lumen", "a.txt", "--to", "lumen.json"}).code, 0);
  EXPECT_EQ(read("a.txt").front(), '{');
}

TEST_F(TubeTest, FromChoosesTheFormatWhateverTheName) {
  std::filesystem::copy(path("tube.nrrd"), path("tube.scan"));
  EXPECT_EQ(lumen({"info", "tube.scan"}).code, 4);
  const Outcome told = lumen({"info", "tube.scan", "--from", "nrrd"});
  EXPECT_EQ(told.code, 0) << told.err;
}

TEST_F(TubeTest, QuietPrintsNothingOnStandardError) {
  const Outcome made =
      lumen({"convert", "tube.nrrd", "tube.glb", "--seeds", "seeds.json", "--quiet"});
  EXPECT_EQ(made.code, 0);
  EXPECT_EQ(made.err, "");
  EXPECT_EQ(made.out, "");
}

TEST_F(TubeTest, ProgressAwayFromATerminalIsPlainLinesOnStandardError) {
  const Outcome made = lumen({"track", "tube.nrrd", "tube.lumen", "--seeds", "seeds.json"});
  ASSERT_EQ(made.code, 0);
  EXPECT_NE(made.err.find("done in"), std::string::npos) << made.err;
  EXPECT_EQ(made.err.find_first_of("\r\x1b"), std::string::npos) << made.err;
}

TEST_F(TubeTest, ASeedThatStartsNoTrackFailsOnlyWhenStrict) {
  ASSERT_EQ(
      lumen({"phantom", "tube", "clean.nrrd", "--size", "64", "--noise", "0", "--bias", "0"}).code,
      0);
  // the corner of the volume is flat background
  Json seeds = Json::parse(read("seeds.json"));
  Json stray = seeds["branches"][0];
  stray["label"] = "stray";
  stray["points"] = Json::array({{{"position", {0.8, 0.8, 0.8}}, {"radius", 0.5}}});
  seeds["branches"].push_back(stray);
  write("two.json", seeds.dump());

  const Outcome lenient =
      lumen({"track", "clean.nrrd", "a.lumen", "--seeds", "two.json", "--inlier-rate", "0.9"});
  EXPECT_EQ(lenient.code, 0) << lenient.err;
  EXPECT_NE(lenient.err.find("stray"), std::string::npos) << lenient.err;
  EXPECT_TRUE(exists("a.lumen"));
  const Outcome strict = lumen({"track", "clean.nrrd", "b.lumen", "--seeds", "two.json",
                                "--inlier-rate", "0.9", "--strict"});
  EXPECT_EQ(strict.code, 3) << strict.err;
  EXPECT_NE(strict.err.find("lumen: error: "), std::string::npos) << strict.err;
  EXPECT_NE(strict.err.find("stray"), std::string::npos) << strict.err;
  EXPECT_FALSE(exists("b.lumen"));

  seeds["branches"].erase(0);
  write("stray.json", seeds.dump());
  EXPECT_EQ(
      lumen({"track", "clean.nrrd", "b.lumen", "--seeds", "stray.json", "--inlier-rate", "0.9"})
          .code,
      1);
  EXPECT_FALSE(exists("b.lumen"));
}

TEST_F(TubeTest, AFailureLeavesTheExistingOutputAlone) {
  write("tube.lumen", "precious");
  write("bad.json", "{\"branches\": 7}");
  EXPECT_EQ(lumen({"track", "tube.nrrd", "tube.lumen", "--seeds", "bad.json"}).code, 3);
  EXPECT_EQ(lumen({"fit", "truth.lumen", "tube.lumen"}).code, 3);
  EXPECT_EQ(read("tube.lumen"), "precious");
  EXPECT_EQ(entries(), (Names{"bad.json", "seeds.json", "truth.lumen", "tube.lumen", "tube.nrrd"}));
}

}  // namespace lumen::test
