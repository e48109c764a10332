// SPDX-License-Identifier: Apache-2.0
// Vessels that are found in a volume, wait as proposals, and are accepted or rejected.
#include "viewer/session/proposals.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "formats/case/vessel_system.h"
#include "served.h"
#include "viewer/session/proposal_joints.h"

namespace lumen::test {

namespace fs = std::filesystem;

namespace {

/// A trunk along z, a branch of it, a branch of that branch, and a tube apart from them.
convert::Volume treeVolume() {
  return convert::drawVolume(72, 0.2, [](const Eigen::Vector3d& p) {
    return std::min({convert::capsule(p, {4, 6, 0.4}, {4, 6, 14}, 0.9),
                     convert::capsule(p, {4, 6, 5}, {12, 6, 9}, 0.6),
                     convert::capsule(p, {9, 6, 7.5}, {9, 12.5, 9}, 0.5),
                     convert::capsule(p, {12, 12, 0.4}, {12, 12, 5}, 0.7)});
  });
}

std::set<std::string> labelsIn(const Json& list) {
  std::set<std::string> labels;
  for (const Json& item : list) labels.insert(item["label"]);
  return labels;
}

}  // namespace

class ProposalsTest : public ServedTest {
protected:
  void SetUp() override {
    writeVolume("tree.nrrd", treeVolume());
    serve({"tree.nrrd"});
  }
  void find() const { performAll({{"op", "find"}}); }
  [[nodiscard]] Json proposals() const { return state()["proposals"]; }
  [[nodiscard]] Json proposal(const std::string& label) const {
    for (const Json& each : proposals())
      if (each["label"] == label) return each;
    return nullptr;
  }
  /// A proposal on a proposal that itself hangs on one.
  [[nodiscard]] std::string grandchild() const {
    for (const Json& each : proposals())
      if (each["parent_waits"] == true &&
          proposal(each["parent"].get<std::string>())["parent_waits"] == true)
        return each["label"];
    return {};
  }
  [[nodiscard]] Json branches() const { return ReadPack(get("case").body).json["branches"]; }
  /// The last sentence of a job that is started now.
  [[nodiscard]] std::string outcome(const Json& request) const {
    const auto listener = session->events.listen();
    performAll(request);
    for (;;) {
      const auto event = listener->wait(std::chrono::seconds(10));
      if (!event) return "no outcome";
      if (event->name == "done") return Json::parse(event->data)["text"];
    }
  }
};

TEST_F(ProposalsTest, WhatIsFoundWaitsAndIsNoPartOfTheCase) {
  find();
  const Json now = state();
  EXPECT_EQ(now["proposals"].size(), 4U) << now["proposals"];
  EXPECT_EQ(now["has_case"], false);
  EXPECT_EQ(now["unsaved"], false);
  EXPECT_EQ(now["undo"], "find vessels");
  EXPECT_FALSE(grandchild().empty()) << now["proposals"];
  const ReadPack pack(get("proposals").body);
  EXPECT_EQ(labelsIn(pack.json["branches"]), labelsIn(now["proposals"]));
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(proposals().size(), 0U);
  EXPECT_EQ(get("proposals").status, 404);
}

TEST_F(ProposalsTest, ConfidenceIsTheMeanOfTheNodesInlierRatesAndRadiusTheirMedian) {
  find();
  const ReadPack pack(get("proposals").body);
  const auto rate = pack.array<float>("inlier_rate"), radius = pack.array<float>("radius_mm");
  const Json list = proposals();
  for (std::size_t b = 0; b < list.size(); ++b) {
    const std::ptrdiff_t first = pack.json["branches"][b]["first_node"],
                         count = pack.json["branches"][b]["node_count"];
    const double sum = std::accumulate(rate.begin() + first, rate.begin() + first + count, 0.0);
    EXPECT_NEAR(list[b]["confidence"].get<double>(), sum / static_cast<double>(count), 1e-5);
    const double width =
        std::accumulate(radius.begin() + first, radius.begin() + first + count, 0.0);
    EXPECT_NEAR(list[b]["radius_mm"].get<double>(), width / static_cast<double>(count), 1e-5);
  }
}

TEST_F(ProposalsTest, AcceptingABranchAcceptsItsParentsInOneStepThatIsUndone) {
  find();
  const Json all = proposals();
  const std::string label = grandchild();
  performAll({{"op", "accept"}, {"labels", {label}}});
  ASSERT_EQ(branches().size(), 3U);
  EXPECT_EQ(ReadPack(get("case").body).json["has_models"], true);
  EXPECT_EQ(proposals().size(), 1U);
  EXPECT_EQ(state()["undo"], "accept 3 vessels");
  EXPECT_EQ(state()["unsaved"], true);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(state()["has_case"], false);
  EXPECT_EQ(proposals(), all);
  ASSERT_EQ(perform({{"op", "redo"}}).status, 200);
  EXPECT_EQ(branches().size(), 3U);
}

TEST_F(ProposalsTest, AcceptedOneByOneTheyHangAsTheyWereFound) {
  find();
  const std::string label = grandchild(), parent = proposal(label)["parent"],
                    trunk = proposal(parent)["parent"];
  performAll({{"op", "accept"}, {"labels", {trunk}}});
  EXPECT_EQ(proposal(parent)["parent"], trunk);
  EXPECT_EQ(proposal(parent)["parent_waits"], false);
  const auto before = ReadPack(get("case").body).array<float>("centre");
  // an edit in between numbers the vessels anew
  ASSERT_EQ(perform({{"op", "rename"}, {"branch", 0}, {"label", "renamed"}}).status, 200);
  EXPECT_EQ(proposal(parent)["parent"], "renamed");
  performAll({{"op", "accept"}, {"labels", {parent}}});
  performAll({{"op", "accept"}, {"labels", {label}}});
  const ReadPack pack(get("case").body);
  const Json list = pack.json["branches"];
  ASSERT_EQ(list.size(), 3U);
  const auto branch = pack.array<std::uint32_t>("branch");
  EXPECT_EQ(list[1]["label"], parent);
  EXPECT_EQ(branch[list[1]["parent_node"].get<std::size_t>()], 0U);
  EXPECT_EQ(branch[list[2]["parent_node"].get<std::size_t>()], 1U);
  auto centre = pack.array<float>("centre");
  centre.resize(before.size());
  EXPECT_EQ(centre, before) << "vessels that were there stay as they are";
  EXPECT_EQ(pack.json["reachable"]["closed"].size(), 0U);
  EXPECT_EQ(state()["undo"], "accept " + label);
}

TEST_F(ProposalsTest, OnAVesselThatIsGoneAProposalIsATreeOfItsOwn) {
  find();
  const std::string parent = proposal(grandchild())["parent"], trunk = proposal(parent)["parent"];
  Json apart;
  for (const Json& each : proposals())
    if (each["parent"].is_null() && each["label"] != trunk) apart = each["label"];
  performAll({{"op", "accept"}, {"labels", {trunk, apart}}});
  const Json list = branches();
  performAll({{"op", "delete"}, {"branch", list[0]["label"] == trunk ? 0 : 1}});
  EXPECT_EQ(proposal(parent)["parent"], nullptr);
  performAll({{"op", "accept"}, {"labels", {parent}}});
  EXPECT_EQ(branches()[1]["parent_node"], -1);
}

TEST_F(ProposalsTest, RejectedOnesGoAndWhatHungOnThemWaits) {
  find();
  const std::string label = grandchild(), parent = proposal(label)["parent"];
  const Json all = proposals();
  ASSERT_EQ(perform({{"op", "reject"}, {"labels", {parent}}}).status, 200);
  EXPECT_EQ(proposals().size(), 3U);
  EXPECT_EQ(proposal(label)["parent"], nullptr);
  EXPECT_EQ(state()["undo"], "reject " + parent);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(proposals(), all);
  ASSERT_EQ(perform({{"op", "reject"}}).status, 200);
  EXPECT_EQ(proposals().size(), 0U);
  EXPECT_EQ(state()["undo"], "reject 4 vessels");
}

TEST_F(ProposalsTest, OnlyVesselsThatTheCaseLacksAreProposed) {
  const Json seed = {
      {"op", "seed_add"}, {"label", "mine"}, {"points", {{{"position", {4, 6, 10}}}}}};
  ASSERT_EQ(perform(seed).status, 200);
  performAll({{"op", "track"}});
  const std::string before = get("case.lumen").body;
  find();
  EXPECT_EQ(get("case.lumen").body, before);
  EXPECT_EQ(proposals().size(), 3U) << proposals();
  const Json list = proposals();
  EXPECT_TRUE(std::any_of(list.begin(), list.end(), [](const Json& each) {
    return each["parent"] == "mine" && each["parent_waits"] == false;
  })) << list;
  performAll({{"op", "accept"}});
  EXPECT_EQ(branches().size(), 4U);
  EXPECT_EQ(outcome({{"op", "find"}}), "no vessel is found that the case lacks");
  EXPECT_EQ(proposals().size(), 0U);
}

TEST_F(ProposalsTest, AProposalThatASeedHasTrackedMeanwhileIsDropped) {
  find();
  const Json seed = {
      {"op", "seed_add"}, {"label", "mine"}, {"points", {{{"position", {4, 6, 12}}}}}};
  ASSERT_EQ(perform(seed).status, 200);
  performAll({{"op", "track"}});
  EXPECT_EQ(proposals().size(), 3U);
  const Json list = proposals();
  EXPECT_TRUE(std::any_of(list.begin(), list.end(), [](const Json& each) {
    return each["parent"] == "mine";
  })) << list;
}

TEST_F(ProposalsTest, NamesOfSeedsThatWaitAreNotTakenTwice) {
  const auto seed = [](const char* label) -> Json {
    return {{"op", "seed_add"}, {"label", label}, {"points", {{{"position", {1, 1, 1}}}}}};
  };
  ASSERT_EQ(perform(seed("A.0")).status, 200);
  find();
  EXPECT_FALSE(labelsIn(proposals()).contains("A.0"));
  const std::string first = proposals()[0]["label"];
  EXPECT_EQ(perform(seed(first.c_str())).status, 400);
}

TEST_F(ProposalsTest, AnAcceptedTreeIsSavedWithoutTracesOfProposals) {
  session->saving.saveTo(path("tree.lumen"));
  find();
  performAll({{"op", "accept"}});
  ASSERT_EQ(perform({{"op", "save"}}).status, 200);
  const auto saved = formats::readCaseFile(path("tree.lumen"));
  ASSERT_TRUE(saved);
  EXPECT_EQ(saved->tree.branches.size(), 4U);
  EXPECT_TRUE(saved->models && saved->points);
  EXPECT_EQ(std::count(saved->metadata.extensionsUsed.begin(), saved->metadata.extensionsUsed.end(),
                       "LUMEN_proposal"),
            0);
  const auto& steps = saved->metadata.steps;
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(steps[1].name, "edit");
  EXPECT_EQ(std::get<std::string>(steps[1].parameters.begin()->second),
            "accepted 4 vessels that were found without seeds");
}

TEST_F(ProposalsTest, OnesThatWaitAreKeptBesideTheFileAndTakenAgain) {
  find();
  const std::string trunk = proposal(proposal(grandchild())["parent"])["parent"];
  performAll({{"op", "accept"}, {"labels", {trunk}}});
  const Json waiting = proposals();
  ASSERT_EQ(session->keepUnsaved(), (std::vector{path("tree.unsaved.lumen").string(),
                                                 path("tree.unsaved.proposals.lumen").string()}));
  serve({"tree.nrrd"});
  ASSERT_EQ(session->findUnsaved().size(), 2U);
  performAll({{"op", "recover"}, {"name", "tree.unsaved.lumen"}});
  performAll({{"op", "recover"}, {"name", "tree.unsaved.proposals.lumen"}});
  EXPECT_EQ(branches().size(), 1U);
  EXPECT_EQ(proposals(), waiting);
  performAll({{"op", "accept"}});
  EXPECT_EQ(branches().size(), 4U);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  ASSERT_EQ(perform({{"op", "reject"}}).status, 200);
  session->keepUnsaved();
  EXPECT_EQ(perform({{"op", "forget"}, {"name", "tree.unsaved.proposals.lumen"}}).status, 200);
  EXPECT_FALSE(fs::exists(path("tree.unsaved.proposals.lumen")));
}

TEST_F(ProposalsTest, GoWithTheVolumeThatTheyWereFoundIn) {
  find();
  ASSERT_EQ(perform({{"op", "close_file"}, {"id", 1}}).status, 200);
  EXPECT_EQ(proposals().size(), 0U);
}

TEST_F(ProposalsTest, RequestsThatDoNotFitAreRefusedInASentence) {
  const auto sentence = [this](const Json& request) {
    const auto answer = perform(request);
    EXPECT_EQ(answer.status, 400);
    return Json::parse(answer.body)["error"].get<std::string>();
  };
  EXPECT_EQ(sentence({{"op", "accept"}}), "no vessel is proposed; find vessels first");
  EXPECT_EQ(sentence({{"op", "reject"}}), "no vessel is proposed; find vessels first");
  find();
  EXPECT_EQ(sentence({{"op", "accept"}, {"labels", {"nobody"}}}),
            "no proposal has the name \"nobody\"");
  serve({});
  EXPECT_EQ(sentence({{"op", "find"}}), "there is no volume to find vessels in");
}

TEST_F(ProposalsTest, AMaskIsRefusedInASentence) {
  convert::Volume mask = convert::drawVolume(40, 0.2, [](const Eigen::Vector3d& p) {
    return convert::capsule(p, {4, 4, 0.4}, {4, 4, 7}, 1);
  });
  for (std::int16_t& voxel : std::get<std::vector<std::int16_t>>(mask.voxels))
    voxel = voxel > 500 ? 1 : 0;
  writeVolume("mask.nrrd", mask);
  serve({"mask.nrrd"});
  EXPECT_EQ(outcome({{"op", "find"}}),
            "mask.nrrd: its voxels are labels, as of a mask; expected the intensities of an "
            "angiogram. `lumen convert` makes a case of a mask");
}

TEST_F(ProposalsTest, AVolumeWithoutVesselsIsReported) {
  convert::Volume noise = convert::drawVolume(32, 0.2, [](const Eigen::Vector3d&) { return 1; });
  std::uint32_t random = 1;
  for (std::int16_t& voxel : std::get<std::vector<std::int16_t>>(noise.voxels))
    voxel = static_cast<std::int16_t>((random = random * 1664525U + 1013904223U) >> 24);
  writeVolume("noise.nrrd", noise);
  serve({"noise.nrrd"});
  const std::string text = outcome({{"op", "find"}});
  EXPECT_TRUE(text.starts_with("no vessels are found in noise.nrrd, as ")) << text;
  EXPECT_EQ(state()["undo"], nullptr);
}

TEST_F(ProposalsTest, CancelledFindingLeavesTheDocumentAsItWas) {
  const auto answer = perform({{"op", "find"}});
  ASSERT_EQ(answer.status, 200);
  ASSERT_TRUE(session->jobs.cancel(Json::parse(answer.body)["job"]));
  waitForJob();
  EXPECT_EQ(proposals().size(), 0U);
  EXPECT_EQ(state()["undo"], nullptr);
}

TEST(Proposals, ALinkOutlivesAcceptanceOneByOne) {
  formats::Case found = twoVessels();
  found.models.reset();
  const std::uint32_t last = 7, other = 8;  // the end of the first, the second node of the second
  found.tree.links = {{last, other + 1}};
  viewer::Document document;
  document.proposals = viewer::proposalsBehind(found, 0);
  const viewer::Acceptance first = viewer::accepted(document, {true, false});
  EXPECT_TRUE(first.value->tree.links.empty());
  EXPECT_TRUE(first.value->nodeArrays.empty());
  const viewer::Acceptance second = viewer::accepted(first.document, {true});
  ASSERT_EQ(second.value->tree.links.size(), 1U);
  EXPECT_EQ(second.value->tree.links[0], (std::array<std::uint32_t, 2>{last, other + 1}));
  EXPECT_EQ(second.firstNewNode, 8U);
  EXPECT_EQ(second.document.proposals, nullptr);
}

TEST(Proposals, SystemsOfTheCaseStayAndThoseOfAcceptedVesselsAreUnknown) {
  using formats::VesselSystem;
  formats::Case known = twoVessels(), found;
  known.models.reset();
  formats::setNodeSystems(known, std::vector(known.tree.nodeCount(), VesselSystem::Vein));
  addVessel(found, "found", straightPath({40, 0, 0}, {1, 0, 0}, 10), 0.5, 1.0);
  viewer::Document document;
  document.value = std::make_shared<const formats::Case>(known);
  document.proposals = viewer::proposalsBehind(found, 0);
  const viewer::Acceptance accepted = viewer::accepted(document, {true});
  EXPECT_TRUE(accepted.droppedArrays.empty());
  EXPECT_EQ(formats::readBranchSystems(*accepted.value),
            (std::vector{VesselSystem::Vein, VesselSystem::Vein, VesselSystem::Unknown}));
}

TEST(Proposals, HalfOfTheNodesInAVesselOfTheCaseAreNotTooMany) {
  const auto proposed = [](double share) {
    formats::Case found;
    addVessel(found, "found", straightPath({0, 0, 0}, {1, 0, 0}, 10), 0.5, 1.0);
    formats::Case known;
    addVessel(known, "known", straightPath({-1, 0, 0}, {share, 0, 0}, 2), 1.0, 1.0);
    viewer::Document document;
    document.value = std::make_shared<const formats::Case>(known);
    return viewer::proposalsFor(document, viewer::proposalsBehind(found, 0)) != nullptr;
  };
  EXPECT_TRUE(proposed(4.5));   // ends at 3.5 with a round end to 4.5: nodes 0 to 4
  EXPECT_FALSE(proposed(6.5));  // nodes 0 to 6
}

}  // namespace lumen::test
