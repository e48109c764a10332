// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/sofa/scene.h"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/export/shared/insertion.h"
#include "converters/export/targets/sofa/scene_tree.h"
#include "tests/unit/export/made_tree.h"

namespace lumen::convert {

namespace {

SceneInput input(InstrumentKind kind, double pathLength = 60) {
  SceneInput result;
  result.insertion.position = {1, 2, 3};
  result.insertion.direction = {0, 0, 1};
  result.insertion.pathLength = pathLength;
  result.branch = "a \"--\" <b>";
  result.instruments = makeInstruments(kind, pathLength + 20, 4);
  result.box = {{0, 0, 0}, {10, 10, 10}};
  return result;
}

void each(const SceneItem& item, const std::function<void(const SceneItem&)>& visit) {
  visit(item);
  for (const SceneItem& child : item.children) each(child, visit);
}

std::size_t count(const SceneItem& root, const std::string& type) {
  std::size_t found = 0;
  each(root, [&](const SceneItem& item) { found += item.type == type ? 1 : 0; });
  return found;
}

std::string valueOf(const SceneItem& root, const std::string& type, const std::string& name) {
  std::string value;
  each(root, [&](const SceneItem& item) {
    if (item.type == type) value = item.value(name);
  });
  return value;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

TEST(Scene, HasARestShapeAndForcesForEachInstrument) {
  for (const auto& [kind, instruments] :
       {std::pair{InstrumentKind::Guidewire, 2U}, std::pair{InstrumentKind::Catheter, 1U},
        std::pair{InstrumentKind::Coil, 1U}}) {
    const SceneItem scene = makeScene(input(kind), {.instrument = kind});
    EXPECT_EQ(count(scene, "WireRestShape"), instruments);
    EXPECT_EQ(count(scene, "AdaptiveBeamForceFieldAndMass"), instruments);
    // frames for all beams of all instruments
    int beams = 0;
    for (const Instrument& instrument : makeInstruments(kind, 80, 4)) beams += instrument.beams();
    EXPECT_EQ(valueOf(scene, "RegularGridTopology", "nx"), std::to_string(beams + 1));
  }
}

TEST(Scene, OnlyTheFirstSectionOfAnInstrumentIsStraight) {
  // SOFA v25.06 puts a straight section that is not the first in the wrong place
  for (const auto kind :
       {InstrumentKind::Guidewire, InstrumentKind::Catheter, InstrumentKind::Coil})
    for (const Instrument& instrument : makeInstruments(kind, 80, 4)) {
      ASSERT_EQ(instrument.sections.size(), 2U);
      EXPECT_EQ(instrument.sections[0].curlDiameter, 0);
      EXPECT_GT(instrument.sections[1].curlDiameter, 0);
    }
}

TEST(Scene, NeitherPushesAnInstrumentOutOfItsHandleNorBeyondTheWay) {
  for (const auto kind :
       {InstrumentKind::Guidewire, InstrumentKind::Catheter, InstrumentKind::Coil}) {
    const SceneInput in = input(kind);
    const SceneItem scene = makeScene(in, {.instrument = kind, .step = 0.5});
    std::vector<double> tips(in.instruments.size(), 0);
    std::size_t active = tips.size() - 1;
    const std::string actions = valueOf(scene, "BeamAdapterActionController", "actions");
    for (const char c : actions) {
      if (c == '1') tips[active] += 0.5;
      if (c == '8' || c == '9') active = static_cast<std::size_t>(c - '8');
    }
    EXPECT_NEAR(tips.back(), std::min(60.0, in.instruments.back().length() - 1), 1.0);
    for (std::size_t k = 0; k < tips.size(); ++k) EXPECT_LT(tips[k], in.instruments[k].length());
    if (tips.size() == 2) {
      EXPECT_NEAR(tips[0], 30, 1.0);
    }
    EXPECT_EQ(stepCount(in, {.instrument = kind, .step = 0.5}),
              static_cast<int>(std::count(actions.begin(), actions.end(), ' ')) + 1);
  }
}

TEST(Scene, IsTheSameInXmlAndInPython) {
  for (const auto wall : {WallKind::Mesh, WallKind::Implicit})
    for (const auto dialect : {SofaDialect::Current, SofaDialect::V23_06}) {
      const SofaOptions options{.wall = wall, .dialect = dialect};
      SceneInput plain = input(options.instrument);
      plain.branch = "ica";
      const SceneItem scene = makeScene(plain, options);
      const std::string xml = printXml(scene, {}), python = printPython(scene, {});
      std::size_t components = 0, nodes = 0;
      each(scene, [&](const SceneItem& item) {
        (item.isNode() ? nodes : components) += 1;
        if (item.isNode()) return;
        EXPECT_NE(python.find("addObject(\"" + item.type + "\""), std::string::npos) << item.type;
        for (const SceneDatum& datum : item.data)
          EXPECT_NE(xml.find(datum.name + "=\"" + datum.value + "\""), std::string::npos)
              << datum.name;
      });
      EXPECT_EQ(occurrences(python, ".addObject("), components);
      EXPECT_EQ(occurrences(python, ".addChild("), nodes - 1);
      EXPECT_EQ(occurrences(xml, "<Node"), nodes);
    }
}

TEST(Scene, EscapesWhatALabelMayHold) {
  const SceneInput in = input(InstrumentKind::Catheter);
  const SofaOptions options{.instrument = InstrumentKind::Catheter, .wall = WallKind::Implicit};
  const std::string xml = printXml(makeScene(in, options), aboutScene(in, options));
  EXPECT_NE(xml.find("branch=\"a &quot;--&quot; &lt;b&gt;\""), std::string::npos);
  // a comment ends at the first two hyphens
  EXPECT_EQ(occurrences(xml, "<!--"), occurrences(xml, "-->"));
  const std::string python = printPython(makeScene(in, options), aboutScene(in, options));
  EXPECT_NE(python.find("branch=\"a \\\"--\\\" <b>\""), std::string::npos);
}

TEST(Scene, HasNoCharacterOfALabelThatXmlForbids) {
  SceneInput in = input(InstrumentKind::Catheter);
  in.branch = "x\xef\xbf\xbe\xef\xbf\xbf";
  const SofaOptions options{.wall = WallKind::Implicit};
  const std::string xml = printXml(makeScene(in, options), aboutScene(in, options));
  EXPECT_NE(xml.find("branch=\"x__\""), std::string::npos);
  EXPECT_EQ(xml.find("\xef\xbf"), std::string::npos);
}

/// A straight vessel along x, of nodes a millimetre apart and a radius of 1.5 mm.
formats::CenterlineTree straightVessel(int nodes) {
  formats::CenterlineTree tree;
  for (int i = 0; i < nodes; ++i) {
    tree.centre.push_back({static_cast<float>(i), 0, 0});
    tree.radius.push_back(1.5F);
  }
  return tree;
}

TEST(Scene, AVesselThatGivesWayHasFramesAlongThePathAndTissueForAllOfIt) {
  const formats::CenterlineTree tree = straightVessel(10);
  SceneInput in = input(InstrumentKind::Catheter);
  in.frames = framesAlong(tree, {1, 2, 3, 4, 5, 6, 7, 8, 9});
  ASSERT_EQ(in.frames.size(), 5U);  // 1.95 mm apart at least: at 1, 3, 5, 7 and 9
  const SceneItem scene =
      makeScene(in, {.instrument = InstrumentKind::Catheter, .wall = WallKind::Soft});
  EXPECT_EQ(valueOf(scene, "BlobPose", "nodes"), "1 3 5 7 9");
  EXPECT_EQ(valueOf(scene, "MeshTopology", "edges"), "0 1 1 2 2 3 3 4");
  // 10 mN / mm for each of 8 mm, half of an edge at the ends; times 1.5^2 against turns
  SceneItem tissue;
  each(scene, [&](const SceneItem& item) {
    if (item.value("name") == "tissue") tissue = item;
  });
  EXPECT_EQ(tissue.value("stiffness"), "10 20 20 20 10");
  EXPECT_EQ(tissue.value("angularStiffness"), "22.5 45 45 45 22.5");
  EXPECT_EQ(valueOf(scene, "BeamInterpolation", "innerRadius"), "1.5 1.5 1.5 1.5");
  EXPECT_EQ(valueOf(scene, "BeamInterpolation", "radius"), "1.875 1.875 1.875 1.875");
  EXPECT_EQ(count(scene, "BeamBlobContact"), 1U);
  EXPECT_EQ(count(makeScene(in, {.wall = WallKind::Implicit}), "BlobPose"), 0U);
}

TEST(Scene, AVesselThatMovesHasTheMotionAndASurfaceThatGoesAlong) {
  SceneInput in = input(InstrumentKind::Catheter);
  in.moves = true;
  const SofaOptions options{.instrument = InstrumentKind::Catheter, .wall = WallKind::Implicit};
  const SceneItem scene = makeScene(in, options);
  EXPECT_EQ(valueOf(scene, "BlobMotion", "field"), "@wall");
  EXPECT_EQ(valueOf(scene, "BlobField", "domain"), "blended");
  EXPECT_EQ(valueOf(scene, "BlobMotion", "points"), "@points");
  EXPECT_EQ(valueOf(scene, "IdentityMapping", "output"), "@surface");
  EXPECT_EQ(valueOf(scene, "InterventionalRadiologyController", "startingPos"),
            "@/vessel/motion.carriedPlace");
  EXPECT_EQ(valueOf(scene, "BlobMotion", "place").substr(0, 6), "1 2 3 ");
  EXPECT_NE(aboutScene(in, options).back().find("moves as the motion"), std::string::npos);
  in.moves = false;
  EXPECT_EQ(count(makeScene(in, options), "BlobMotion"), 0U);
}

// Contacts see the wall as planes, so it goes at most a fiftieth of the least radius in a step.
TEST(Scene, AVesselThatMovesFastHasShorterSteps) {
  formats::CenterlineTree tree;
  addBranch(tree, "a", -1, {0, 0, 0}, {0, 0, 2}, 3, 1);
  tree.radius[0] = 0.5f;
  formats::Motion motion{{0, 1}, 0, {2}, {{{0, 0, 4}}, {{0, 4.5f, 4}}}};  // 4.5 mm/s
  const std::vector<std::uint32_t> wide{1, 2}, all{0, 1, 2};
  EXPECT_EQ(stepsPerPush(tree, motion, wide), 3);  // 0.045 mm from push to push, 0.02 in a step
  EXPECT_EQ(stepsPerPush(tree, motion, all), 5);   // 0.01 mm in a step
  motion.pose.back().centre.y = 40;
  EXPECT_EQ(stepsPerPush(tree, motion, all), 10);
  motion.pose.back().centre.y = 0;
  EXPECT_EQ(stepsPerPush(tree, motion, all), 1);
  SceneInput in = input(InstrumentKind::Catheter);
  const SofaOptions options{.wall = WallKind::Implicit};
  const int pushes = stepCount(in, options);
  in.stepsPerPush = 4;
  EXPECT_EQ(stepCount(in, options), 4 * pushes);
  const SceneItem scene = makeScene(in, options);
  EXPECT_EQ(scene.value("dt"), "0.0025");
  EXPECT_EQ(valueOf(scene, "BeamAdapterActionController", "timeSteps").substr(0, 14),
            "0 0.005 0.015 ");
  EXPECT_EQ(valueOf(scene, "WriteState", "period"), "0.1");
}

TEST(Scene, NamesThePluginsOfItsComponents) {
  const SceneItem mesh = makeScene(input(InstrumentKind::Guidewire), {});
  const SceneItem implicit =
      makeScene(input(InstrumentKind::Guidewire), {.wall = WallKind::Implicit});
  const auto requires_ = [](const SceneItem& scene, const std::string& plugin) {
    return printXml(scene, {}).find("pluginName=\"" + plugin + "\"") != std::string::npos;
  };
  EXPECT_TRUE(requires_(mesh, "BeamAdapter"));
  EXPECT_FALSE(requires_(mesh, "LumenSofa"));
  EXPECT_TRUE(requires_(implicit, "LumenSofa"));
  EXPECT_FALSE(requires_(implicit, "Sofa.Component.Collision.Detection.Algorithm"));
}

TEST(Scene, HasTheNamesOfItsDialect) {
  const SceneItem scene =
      makeScene(input(InstrumentKind::Guidewire), {.dialect = SofaDialect::V23_06});
  for (const char* const newer :
       {"CollisionPipeline", "CollisionResponse", "FixedProjectiveConstraint", "RodStraightSection",
        "RodSpireSection"})
    EXPECT_EQ(count(scene, newer), 0U) << newer;
  for (const char* const old : {"DefaultPipeline", "DefaultContactManager", "FixedConstraint"})
    EXPECT_EQ(count(scene, old), 1U) << old;
  EXPECT_EQ(printXml(scene, {}).find("nbBeams"), std::string::npos);
  // the guidewire, which is the last: 60 mm of shaft, 20 of tip
  EXPECT_EQ(valueOf(scene, "WireRestShape", "straightLength"), "60");
  EXPECT_EQ(valueOf(scene, "WireRestShape", "length"), "80");
  EXPECT_EQ(valueOf(scene, "WireRestShape", "keyPoints"), "0 60 80");
  EXPECT_EQ(valueOf(scene, "WireRestShape", "densityOfBeams"), "30 20");
}

using formats::BranchKind;
using formats::CenterlineTree;

/// A trunk along z of 20 mm that goes on in a wide branch of 9 mm; a thin one and a sac hang on it.
CenterlineTree fork() {
  CenterlineTree tree;
  addBranch(tree, "trunk", -1, {0, 0, 0}, {0, 0, 1}, 21, 2);
  addBranch(tree, "thin", 20, {1, 0, 20}, {1, 0, 0}, 30, 0.3F);
  addBranch(tree, "wide", 20, {0, 0, 21}, {0, 0, 1}, 9, 1.5F);
  addBranch(tree, "sac", 20, {0, 5, 20}, {0, 1, 0}, 3, 5, BranchKind::Aneurysm);
  return tree;
}

TEST(Insertion, LiesAsFarInsideTheRootAsItNeedsAndFollowsTheWidestVessel) {
  const Insertion in = findInsertion(fork(), "", 1.5);
  EXPECT_EQ(in.branch, 0U);
  EXPECT_EQ(in.position, Eigen::Vector3d(0, 0, 2));
  EXPECT_EQ(in.direction, Eigen::Vector3d::UnitZ());
  EXPECT_DOUBLE_EQ(in.radius, 2);
  // to the last node, at z = 29, less its radius
  EXPECT_DOUBLE_EQ(in.pathLength, 29 - 1.5 - 2);
}

TEST(Insertion, IsAtTheBranchThatIsNamed) {
  const Insertion in = findInsertion(fork(), "sac", 0.5);
  EXPECT_EQ(in.branch, 3U);
  EXPECT_EQ(in.position, Eigen::Vector3d(0, 6, 20));
}

TEST(Insertion, RefusesALabelThatNoBranchHasAndTellsThose) {
  try {
    findInsertion(fork(), "trunc", 0.5);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    EXPECT_NE(std::string(error.what()).find("trunk, thin, wide, sac"), std::string::npos);
  }
}

TEST(Insertion, RefusesAVesselThatIsTooNarrow) {
  try {
    findInsertion(fork(), "thin", 0.5);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
  }
}

TEST(Insertion, TurnsTheXAxisIntoAnyDirection) {
  for (const Eigen::Vector3d& to :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0.6, 0, -0.8)})
    EXPECT_LT((turnTo(to) * Eigen::Vector3d::UnitX() - to).norm(), 1e-12);
}

}  // namespace

}  // namespace lumen::convert
