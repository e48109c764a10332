// SPDX-License-Identifier: Apache-2.0
// Surfaces, labels and scenes of other programs become cases.
#include <filesystem>
#include <sstream>

#include <nlohmann/json.hpp>

#include "formats/case/case_file.h"
#include "tests/cli/run_lumen.h"
#include "tests/unit/trees_from_surfaces/tube_mesh.h"

namespace lumen::test {

namespace {

using Json = nlohmann::ordered_json;

std::string objOf(const convert::TriangleMesh& mesh) {
  std::ostringstream text;
  for (const auto& p : mesh.position) text << "v " << p.x() << " " << p.y() << " " << p.z() << "\n";
  for (const auto& t : mesh.triangle)
    text << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  return text.str();
}

/// A tube along x, 40 mm long, of 2 mm radius, open at both ends.
std::string tubeObj() {
  return objOf(convert::test::tube(convert::test::straight(40), 2, false));
}

/// Loads tube.obj, turned about z to lie along y, three times as large.
const char* const kScene = R"(<?xml version="1.0"?>
<Node name="root">
  <Node name="Vessels">
    <MeshOBJLoader name="mesh" filename="parts/tube.obj" rotation="0 0 90" scale="3"/>
    <TriangleCollisionModel moving="0"/>
  </Node>
  <Node name="Tool"><MeshOBJLoader name="tip" filename="tip.obj"/></Node>
</Node>)";

}  // namespace

class SurfacesInTest : public CliTest {
protected:
  [[nodiscard]] Json info(const std::string& file) const {
    const Outcome told = lumen({"info", file, "--json"});
    EXPECT_EQ(told.code, 0) << told.err;
    return told.code == 0 ? Json::parse(told.out) : Json();
  }
  void writeScene(const std::string& mesh) const {
    std::filesystem::create_directory(path("scene"));
    std::filesystem::create_directory(path("scene/parts"));
    write("scene/vessels.scn", kScene);
    if (!mesh.empty()) write(mesh, tubeObj());
  }
};

TEST_F(SurfacesInTest, ConvertStatesTheUnitAndTheAxesOfAMesh) {
  write("tube.obj", tubeObj());
  const Outcome guessed = lumen({"convert", "tube.obj", "tube.lumen"});
  ASSERT_EQ(guessed.code, 0) << guessed.err;
  EXPECT_TRUE(contains(guessed.out, "unit mm, by its size; axes not stated; taken as LPS\n"))
      << guessed.out;
  const Outcome stated = lumen({"convert", "tube.obj", "tube.lumen", "--unit", "cm", "--json"});
  ASSERT_EQ(stated.code, 0) << stated.err;
  EXPECT_EQ(Json::parse(stated.out)["mesh"],
            Json({{"unit", "cm"}, {"unit_from", "option"}, {"frame_stated", false}}));
  const Outcome other = lumen({"convert", "tube.lumen", "copy.lumen", "--json"});
  EXPECT_TRUE(Json::parse(other.out)["mesh"].is_null()) << other.out;
}

TEST_F(SurfacesInTest, AMeshBecomesACase) {
  write("tube.obj", tubeObj());
  const Outcome done = lumen({"convert", "tube.obj", "tube.lumen"});
  ASSERT_EQ(done.code, 0) << done.err;
  const Json told = info("tube.lumen");
  EXPECT_EQ(told["branches"].size(), 1U);
  EXPECT_NEAR(told["radius_mm"]["max"].get<double>(), 2, 0.05);
  EXPECT_GT(told["blobs"].get<int>(), 0);
}

TEST_F(SurfacesInTest, ACenterlineIsFollowedOrRefused) {
  write("tube.obj", tubeObj());
  std::ostringstream inside, outside;
  for (int i = 1; i <= 39; ++i) {
    inside << i << " 0 " << i << " 0 0 2 " << (i == 1 ? -1 : i - 1) << "\n";
    outside << i << " 0 " << -i << " 0 0 2 " << (i == 1 ? -1 : i - 1) << "\n";
  }
  write("line.swc", inside.str());
  write("far.swc", outside.str());
  const Outcome done = lumen({"convert", "tube.obj", "tube.lumen", "--centerline", "line.swc"});
  ASSERT_EQ(done.code, 0) << done.err;
  const Outcome refused = lumen({"convert", "tube.obj", "no.lumen", "--centerline", "far.swc"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_TRUE(contains(refused.err, "0 of its 39 points lie inside")) << refused.err;
  EXPECT_FALSE(exists("no.lumen"));
}

TEST_F(SurfacesInTest, ASceneGivesItsVesselsWhereItPlacesThem) {
  writeScene("scene/parts/tube.obj");
  const Outcome done = lumen({"convert", "scene/vessels.scn", "tube.lumen"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NEAR(info("tube.lumen")["radius_mm"]["max"].get<double>(), 6, 0.15);
  const auto value = formats::readCaseFile(path("tube.lumen"));
  ASSERT_TRUE(value);
  for (const formats::Vec3f& c : value->tree.centre) {
    EXPECT_NEAR(c.x, 0, 0.1);
    EXPECT_GT(c.y, 0);
  }
}

TEST_F(SurfacesInTest, ASceneTakesNoMeshFromElsewhere) {
  writeScene("");
  write("tube.obj", tubeObj());
  std::filesystem::create_symlink("../../tube.obj", path("scene/parts/tube.obj"));
  const Outcome refused = lumen({"convert", "scene/vessels.scn", "tube.lumen"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_TRUE(contains(refused.err, "--allow-detached")) << refused.err;
  EXPECT_EQ(lumen({"convert", "scene/vessels.scn", "tube.lumen", "--allow-detached", "."}).code, 0);
}

TEST_F(SurfacesInTest, AMeshOfASceneIsChosenByItsName) {
  writeScene("scene/parts/tube.obj");
  const Outcome refused = lumen({"convert", "scene/vessels.scn", "tube.lumen", "--mesh", "tip"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_TRUE(contains(refused.err, "tip.obj, which cannot be read")) << refused.err;
}

class LabelsInTest : public TubeTest {};

TEST_F(LabelsInTest, LabelsBecomeTheVesselThatTheyCameFrom) {
  ASSERT_EQ(lumen({"convert", "tube.nrrd", "tracked.lumen", "--seeds", "seeds.json"}).code, 0);
  ASSERT_EQ(lumen({"check", "tube.nrrd", "tracked.lumen", "--mask", "labels.nrrd"}).code, 0);
  const Outcome done = lumen({"convert", "labels.nrrd", "again.lumen", "--mask"});
  ASSERT_EQ(done.code, 0) << done.err;
  const Outcome compared = lumen({"compare", "again.lumen", "truth.lumen", "--json"});
  ASSERT_EQ(compared.code, 0) << compared.err;
  const Json score = Json::parse(compared.out);
  EXPECT_GE(score["overlap"].get<double>(), 0.9) << compared.out;
  // labels are recognised by their voxels
  ASSERT_EQ(lumen({"convert", "labels.nrrd", "bare.lumen"}).code, 0);
  EXPECT_EQ(read("bare.lumen"), read("again.lumen"));
  ASSERT_EQ(lumen({"convert", "labels.nrrd", "named.lumen", "--labels", "1=ica"}).code, 0);
  const auto named = formats::readCaseFile(path("named.lumen"));
  ASSERT_TRUE(named);
  EXPECT_EQ(named->tree.branches[0].label, "ica");
}

TEST_F(LabelsInTest, LabelsWhoseFileLeavesLeftAndRightOpenSayIt) {
  ASSERT_EQ(lumen({"convert", "tube.nrrd", "tracked.lumen", "--seeds", "seeds.json"}).code, 0);
  ASSERT_EQ(lumen({"check", "tube.nrrd", "tracked.lumen", "--mask", "labels.nrrd"}).code, 0);
  std::string text = read("labels.nrrd");
  const std::string space = "left-posterior-superior";
  text.replace(text.find(space), space.size(), "3D-right-handed");
  write("open.nrrd", text);
  ASSERT_EQ(lumen({"convert", "open.nrrd", "open.lumen", "--mask"}).code, 0);
  const Outcome info = lumen({"info", "open.lumen"});
  EXPECT_NE(info.out.find("assumption-1 its space is \"3D-right-handed\""), std::string::npos)
      << info.out;
}

TEST_F(LabelsInTest, ALabelMapNamesWhatIsFoundBesideIt) {
  ASSERT_EQ(lumen({"convert", "tube.nrrd", "tracked.lumen", "--seeds", "seeds.json"}).code, 0);
  ASSERT_EQ(lumen({"check", "tube.nrrd", "tracked.lumen", "--mask", "labels.nrrd"}).code, 0);
  write("table.csv", "value,name\n1,ica\n");
  const auto nameBy = [&](std::vector<std::string> line) {
    const Outcome done = lumen(std::move(line));
    EXPECT_EQ(done.code, 0) << done.err;
    const auto named = formats::readCaseFile(path("named.lumen"));
    return named ? named->tree.branches[0].label + " of " + named->metadata.steps[1].name : "";
  };
  EXPECT_EQ(nameBy({"track", "tube.nrrd", "named.lumen", "--label-map", "labels.nrrd"}),
            "label-1 of label-map");
  EXPECT_EQ(nameBy({"track", "tube.nrrd", "named.lumen", "--label-map", "labels.nrrd",
                    "--label-table", "table.csv"}),
            "ica of label-map");
  EXPECT_EQ(nameBy({"convert", "tube.nrrd", "named.lumen", "--label-map", "labels.nrrd",
                    "--label-table", "topcow"}),
            "BA of label-map");
  EXPECT_EQ(nameBy({"convert", "labels.nrrd", "named.lumen", "--label-table", "table.csv"}),
            "ica of fit");
}

TEST_F(LabelsInTest, AnswersStateTheRolesOfLabelsAndTheirSources) {
  ASSERT_EQ(lumen({"convert", "tube.nrrd", "tracked.lumen", "--seeds", "seeds.json"}).code, 0);
  ASSERT_EQ(lumen({"check", "tube.nrrd", "tracked.lumen", "--mask", "labels.nrrd"}).code, 0);
  write("dataset.json", R"({"labels": {"background": 0, "basilar artery": 1}})");
  const auto labelOf = [&](std::vector<std::string> line) {
    line.emplace_back("--json");
    const Outcome done = lumen(std::move(line));
    EXPECT_EQ(done.code, 0) << done.err;
    const Json answer = Json::parse(done.out);
    const Json& label =
        answer.contains("labels") ? answer["labels"][0] : answer["label_maps"][0]["labels"][0];
    EXPECT_EQ(label["value"], 1);
    EXPECT_GT(label["voxels"].get<int>(), 100);
    return label["name"].get<std::string>() + ": " + label["role"].get<std::string>() + " (" +
           label["from"].get<std::string>() + ")";
  };
  const auto branch = [&] {
    return formats::readCaseFile(path("named.lumen"))->tree.branches[0].label;
  };
  EXPECT_EQ(labelOf({"track", "tube.nrrd", "named.lumen", "--label-map", "labels.nrrd"}),
            "basilar artery: artery (dataset.json, its name)");
  EXPECT_EQ(branch(), "basilar artery");
  EXPECT_EQ(labelOf({"info", "labels.nrrd", "--voxels", "--label-table", "topcow"}),
            "BA: artery (TopCoW)");
  // a folder is one map, and the first map names
  std::filesystem::create_directory(path("maps"));
  write("maps/rib_left_1.nrrd", read("labels.nrrd"));
  EXPECT_EQ(labelOf({"info", "maps"}), "rib_left_1: bone (its file, TotalSegmentator total)");
  const Json cut = Json::parse(lumen({"info", "maps", "--crop", "8,55,8,55,8,55", "--json"}).out);
  EXPECT_EQ(cut["size"], Json::array({48, 48, 48}));
  for (const std::vector<std::string>& line :
       {std::vector<std::string>{"info", "maps", "--voxels", "--label-table", "topcow"},
        {"track", "tube.nrrd", "no.lumen", "--label-map", "maps", "--label-table", "topcow"}}) {
    const Outcome refused = lumen(line);
    EXPECT_EQ(refused.code, 2);
    EXPECT_TRUE(contains(refused.err, "--label-table does nothing for a folder")) << refused.err;
  }
  const std::vector<std::string> both = {"track", "tube.nrrd",   "named.lumen", "--label-map",
                                         "maps",  "--label-map", "labels.nrrd"};
  EXPECT_EQ(labelOf(both), "rib_left_1: bone (its file, TotalSegmentator total)");
  EXPECT_EQ(branch(), "basilar artery");
  std::vector<std::string> stated = both;
  stated.insert(stated.end(), {"--role", "rib_left_1=vein"});
  EXPECT_EQ(labelOf(stated), "rib_left_1: vein (its file, the option)");
  EXPECT_EQ(branch(), "rib_left_1");
}

TEST_F(LabelsInTest, TheAnswerIsAnInventoryOfLabels) {
  ASSERT_EQ(lumen({"convert", "tube.nrrd", "tracked.lumen", "--seeds", "seeds.json"}).code, 0);
  ASSERT_EQ(lumen({"check", "tube.nrrd", "tracked.lumen", "--mask", "labels.nrrd"}).code, 0);
  write("table.csv", "value,name,role\n1,ica,artery\n");
  std::vector<std::string> line = {"convert",     "tube.nrrd",      "named.lumen",
                                   "--label-map", "labels.nrrd",    "--label-table",
                                   "table.csv",   "--only-labelled"};
  const Outcome text = lumen(line);
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_TRUE(contains(text.out, "label 1     ica: artery (table.csv), ")) << text.out;
  EXPECT_TRUE(contains(text.out, " mm) mm") || contains(text.out, ") mm, 9") ||
              contains(text.out, ") mm, 100"))
      << text.out;
  EXPECT_FALSE(contains(text.out, "no label")) << text.out;
  line.emplace_back("--json");
  const Json answer = Json::parse(lumen(line).out);
  const Json& label = answer["label_maps"][0]["labels"][0];
  EXPECT_EQ(label["branches"], Json::array({"ica"}));
  EXPECT_GT(label["held_share"], 0.9);
  EXPECT_GT(label["length_mm"], 5);
  EXPECT_LE(label["least_radius_mm"], label["greatest_radius_mm"]);
  EXPECT_EQ(answer["unlabelled"]["branches"], Json::array());
  // a label of no vessel takes the vessel away, and says how much
  line.insert(line.end(), {"--role", "1=bone"});
  const Outcome none = lumen(line);
  EXPECT_EQ(none.code, 1) << none.err;
}

TEST_F(LabelsInTest, SeedsGetTheNamesAndThePriorOfMaps) {
  ASSERT_EQ(lumen({"convert", "tube.nrrd", "tracked.lumen", "--seeds", "seeds.json"}).code, 0);
  ASSERT_EQ(lumen({"check", "tube.nrrd", "tracked.lumen", "--mask", "labels.nrrd"}).code, 0);
  write("table.csv", "value,name,role\n1,ica,artery\n");
  for (const bool isOnly : {false, true}) {
    std::vector<std::string> line = {"convert",     "tube.nrrd",     "named.lumen",
                                     "--seeds",     "seeds.json",    "--label-map",
                                     "labels.nrrd", "--label-table", "table.csv"};
    if (isOnly) line.emplace_back("--seeds-only");
    const Outcome done = lumen(line);
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(formats::readCaseFile(path("named.lumen"))->tree.branches[0].label, "ica");
    line.insert(line.end(), {"--role", "1=bone"});
    const Outcome refused = lumen(line);
    EXPECT_EQ(refused.code, 1) << refused.err;
    EXPECT_TRUE(contains(refused.err, "a label map states that it lies in no vessel"))
        << refused.err;
  }
}

TEST_F(LabelsInTest, LabelMapsThatCannotBeAreMistakes) {
  ASSERT_EQ(lumen({"convert", "tube.nrrd", "tracked.lumen", "--seeds", "seeds.json"}).code, 0);
  ASSERT_EQ(lumen({"check", "tube.nrrd", "tracked.lumen", "--mask", "labels.nrrd"}).code, 0);
  write("twice.csv", "1,ica\n1,mca\n");
  const auto refusal = [&](std::vector<std::string> line, int code) {
    line.insert(line.begin(), {"track", "tube.nrrd", "x.lumen"});
    const Outcome done = lumen(std::move(line));
    EXPECT_EQ(done.code, code) << done.err;
    EXPECT_FALSE(exists("x.lumen"));
    return done.err;
  };
  EXPECT_TRUE(contains(refusal({"--label-map", "labels.nrrd", "--label-table", "twice.csv"}, 3),
                       "twice.csv: line 2: names the label 1 twice"));
  EXPECT_TRUE(contains(refusal({"--label-table", "topcow"}, 2),
                       "--label-table does nothing without --label-map"));
  EXPECT_TRUE(contains(refusal({"--label-map", "truth.lumen"}, 3), "expected a volume of labels"));
  // the labels of another place
  std::string text = read("labels.nrrd");
  const std::size_t at = text.find("space origin: (");
  ASSERT_NE(at, text.npos);
  text.insert(at + 15, "9");
  write("far.nrrd", text);
  EXPECT_TRUE(contains(refusal({"--label-map", "far.nrrd"}, 3), "none of its labels lies within"));
}

TEST_F(LabelsInTest, LabelsThatCannotBeAreMistakes) {
  for (const std::vector<std::string>& line : std::vector<std::vector<std::string>>{
           {"convert", "tube.nrrd", "x.lumen", "--labels", "ica"},
           {"convert", "tube.nrrd", "x.lumen", "--labels", "1=a,1=b"},
           {"convert", "tube.nrrd", "x.lumen", "--labels", "1=a;2=b"},
           {"convert", "tube.nrrd", "x.lumen", "--labels", "0=a"},
           {"convert", "tube.nrrd", "x.lumen", "--mask", "--label", "1"},
           {"convert", "tube.nrrd", "x.lumen", "--mask", "--seeds", "seeds.json"},
           {"convert", "truth.lumen", "x.lumen", "--mask"}}) {
    const Outcome refused = lumen(line);
    EXPECT_EQ(refused.code, 2) << line[3] << " " << refused.err;
  }
  const Outcome separator = lumen({"convert", "tube.nrrd", "x.lumen", "--labels", "1=a;2=b"});
  EXPECT_TRUE(contains(separator.err, "a comma between them")) << separator.err;
  const Outcome image = lumen({"convert", "tube.nrrd", "x.lumen", "--mask"});
  EXPECT_EQ(image.code, 3) << image.err;
  EXPECT_TRUE(contains(image.err, "expected labels")) << image.err;
  EXPECT_FALSE(exists("x.lumen"));
}

}  // namespace lumen::test
