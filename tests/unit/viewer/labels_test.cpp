// SPDX-License-Identifier: Apache-2.0
// A label map beside the volume: it is listed and sent, its roles change, and the vessels that are found follow them.
#include "formats/case/vessel_system.h"
#include "served.h"
#include "viewer/session/packs/volume_pack.h"

namespace lumen::test {

namespace {

/// Two tubes along z, apart from each other, and so thin that their voxels are no labels.
convert::Volume twoTubes() {
  return convert::drawVolume(64, 0.2, [](const Eigen::Vector3d& p) {
    return std::min(convert::capsule(p, {3.6, 6.4, 0.4}, {3.6, 6.4, 12.2}, 0.6),
                    convert::capsule(p, {9.2, 6.4, 0.4}, {9.2, 6.4, 12.2}, 0.6));
  });
}

/// Labels 2 and 9 where the tubes are, as coarse as half of the volume, and 300 in a corner.
convert::Volume labelsOfTubes() {
  convert::Volume map;
  map.geometry.size = {32, 32, 32};
  map.geometry.spacing = {0.4, 0.4, 0.4};
  map.geometry.origin = {0.1, 0.1, 0.1};
  std::vector<std::int16_t> voxels;
  map.geometry.cells().forEach([&](const convert::Cell& cell) {
    const Eigen::Vector3d p = map.geometry.position(cell);
    const auto isIn = [&](double x) { return std::hypot(p.x() - x, p.y() - 6.4) < 0.9; };
    const bool isCorner = cell[0] < 3 && cell[1] < 3;
    voxels.push_back(isIn(3.6) ? 2 : isIn(9.2) ? 9 : isCorner ? 300 : 0);
  });
  map.voxels = std::move(voxels);
  return map;
}

}  // namespace

class LabelsTest : public ServedTest {
protected:
  void SetUp() override {
    writeVolume("tubes.nrrd", twoTubes());
    std::string file =
        convert::encodeVolume(labelsOfTubes(), convert::VolumeFormat::Nrrd, false, "labels");
    file.insert(file.find("\n\n") + 1,
                "Segment0_LabelValue:=2\nSegment0_Name:=renal artery\n"
                "Segment1_LabelValue:=9\nSegment1_Name:=twig\n"
                "Segment2_LabelValue:=300\nSegment2_Name:=spleen\n"
                "Segment3_LabelValue:=4\nSegment3_Name:=liver\n");
    write("labels.seg.nrrd", file);
    serve({"tubes.nrrd"});
  }
  void openMap(const std::string& name) const {
    Progress silent;
    session->open({path(name), name, viewer::OpenAs::Labels}, silent);
  }
  /// Finds vessels, and expects that some are proposed.
  void find() const {
    const auto listener = session->events.listen();
    performAll({{"op", "find"}});
    std::string outcome;
    while (const auto event = listener->wait(std::chrono::seconds(1)))
      if (event->name == "done") outcome = event->data;
    EXPECT_NE(outcome.find("proposed"), std::string::npos) << outcome;
  }
  [[nodiscard]] Json label(std::size_t i) const { return state()["labels"]["list"][i]; }
  [[nodiscard]] httplib::Response setRole(int label, const std::string& role) const {
    return perform({{"op", "role"}, {"label", label}, {"role", role}});
  }
  /// "NAME: SYSTEM" of each vessel in a pack.
  [[nodiscard]] std::set<std::string> systemsIn(const std::string& pack) const {
    const ReadPack read(get(pack).body);
    std::set<std::string> found;
    for (const Json& branch : read.json["branches"])
      found.insert(branch["label"].get<std::string>() + ": " + branch["system"].get<std::string>());
    return found;
  }
};

TEST_F(LabelsTest, AreListedWithTheirRolesAndSentAsPlacesInTheList) {
  EXPECT_EQ(state()["labels"], nullptr);
  EXPECT_EQ(get("labels").status, 404);
  openMap("labels.seg.nrrd");
  const Json labels = state()["labels"];
  EXPECT_EQ(labels["name"], "labels.seg.nrrd");
  EXPECT_EQ(labels["roles"][2], "artery");
  ASSERT_EQ(labels["list"].size(), 3U) << labels;  // no voxel is liver
  EXPECT_EQ(label(0)["name"], "renal artery");
  EXPECT_EQ(label(0)["role"], "artery");
  EXPECT_EQ(label(0)["from"], "its header, its name");
  EXPECT_EQ(label(1)["role"], "unknown");
  EXPECT_EQ(label(2)["value"], 300);
  EXPECT_EQ(label(2)["role"], "organ");
  EXPECT_EQ(label(2)["voxels"], 288);
  const ReadPack pack(get("labels").body);
  EXPECT_EQ(pack.json["spacing_mm"], Json({0.4, 0.4, 0.4}));
  const auto places = pack.array<std::uint8_t>("voxel");
  const auto voxels = std::get<std::vector<std::int16_t>>(labelsOfTubes().voxels);
  ASSERT_EQ(places.size(), voxels.size());
  for (std::size_t i = 0; i < voxels.size(); ++i)
    ASSERT_EQ(places[i], voxels[i] == 2 ? 1 : voxels[i] == 9 ? 2 : voxels[i] == 300 ? 3 : 0);
}

TEST_F(LabelsTest, AnotherRoleIsUndoneAndLeavesTheVoxels) {
  EXPECT_NE(setRole(2, "vein").body.find("no label map"), std::string::npos);
  openMap("labels.seg.nrrd");
  const Json before = state();
  ASSERT_EQ(setRole(9, "false-lumen").status, 200);
  EXPECT_EQ(label(1)["role"], "false-lumen");
  EXPECT_EQ(label(1)["from"], "its header, the page");
  EXPECT_EQ(state()["undo"], "role of twig: false-lumen");
  EXPECT_EQ(state()["revisions"]["labels"], before["revisions"]["labels"]);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(state()["labels"], before["labels"]);
  EXPECT_NE(setRole(4, "bone").body.find("no voxel"), std::string::npos);
  const std::string refusal = setRole(9, "tendon").body;
  EXPECT_NE(refusal.find("tendon; expected unknown, vessel, artery"), std::string::npos) << refusal;
}

TEST_F(LabelsTest, WhatIsFoundHasTheNamesAndSystemsOfTheRoles) {
  openMap("labels.seg.nrrd");
  ASSERT_EQ(setRole(9, "vein").status, 200);
  find();
  const std::set<std::string> both = {"renal artery: artery", "twig: vein"};
  EXPECT_EQ(systemsIn("proposals"), both);
  EXPECT_EQ(state()["proposals"][0]["system"], "artery");
  performAll({{"op", "accept"}, {"labels", {"twig"}}});
  performAll({{"op", "accept"}});
  EXPECT_EQ(systemsIn("case"), both);
  std::size_t maps = 0;
  for (const formats::Step& step : session->now().document.value->metadata.steps)
    maps += step.name == "label-map" ? 1 : 0;
  EXPECT_EQ(maps, 1U) << "the case states the map that it was made with";
}

TEST_F(LabelsTest, ALabelOfNoVesselIsNoneAndTheOthersAreFoundBesideTheCase) {
  openMap("labels.seg.nrrd");
  ASSERT_EQ(setRole(9, "bone").status, 200);
  find();
  performAll({{"op", "accept"}});
  EXPECT_EQ(systemsIn("case"), std::set<std::string>{"renal artery: artery"});
  ASSERT_EQ(setRole(9, "vein").status, 200);
  find();
  EXPECT_EQ(systemsIn("proposals"), std::set<std::string>{"twig: vein"});
  performAll({{"op", "accept"}});
  EXPECT_EQ(systemsIn("case"), (std::set<std::string>{"renal artery: artery", "twig: vein"}));
}

TEST_F(LabelsTest, OnlyLabelsOfTheVolumeAreTakenAndGoWithIt) {
  convert::Volume far = labelsOfTubes();
  far.geometry.origin.x() += 40;
  writeVolume("far.nrrd", far);
  for (const auto& [file, fault] : {std::pair{"far.nrrd", "none of its labels lies within"},
                                    std::pair{"tubes.nrrd", "its voxels are no labels"}})
    try {
      openMap(file);
      ADD_FAILURE() << file << " is taken";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(fault), std::string::npos) << error.what();
    }
  EXPECT_EQ(state()["labels"], nullptr);
  openMap("labels.seg.nrrd");
  ASSERT_EQ(perform({{"op", "close_file"}, {"id", state()["files"][0]["id"]}}).status, 200);
  EXPECT_EQ(state()["labels"], nullptr);
  EXPECT_EQ(state()["files"].size(), 0U);
  Progress silent;
  EXPECT_THROW(session->open({path("labels.seg.nrrd"), "l", viewer::OpenAs::Labels}, silent),
               Error);
}

TEST(VolumePack, LabelsAreNotAveraged) {
  auto volume = std::make_shared<convert::Volume>();
  volume->geometry.size = {4, 2, 1};
  volume->voxels = std::vector<std::uint8_t>{1, 9, 1, 9, 3, 7, 3, 7};
  viewer::VolumeSending sending;
  sending.mostVoxels = 4;
  sending.isLabels = true;
  const viewer::VolumePack sent(volume, "labels", sending);
  const ReadPack pack(sent.bytes(0, sent.size()) + sent.bytes(sent.size() - 4, 4));
  EXPECT_EQ(pack.json["size"], Json({2, 2, 1}));
  EXPECT_EQ(pack.array<std::uint8_t>("voxel"), (std::vector<std::uint8_t>{9, 9, 7, 7}));
}

}  // namespace lumen::test
