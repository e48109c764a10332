// SPDX-License-Identifier: Apache-2.0
// The one length of vessels, and radii that the volume does not show.
#include "converters/judge/measure/vessel_length.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "converters/base/progress.h"
#include "converters/judge/facts/case_info.h"
#include "converters/judge/measure/measure_tables.h"
#include "converters/judge/measure/shown_radius.h"
#include "formats/case/topology.h"
#include "tests/unit/measure/shapes.h"

namespace lumen::convert::test {
namespace {

/// A helix of two turns with a straight child that leaves it at 20 mm.
formats::Case helixWithChild(double spacing) {
  const Tube helix = helixTube(8, 5, 2, 1);
  const Eigen::Vector3d from = helix.position(20);
  Tube child = straightTube(from, Eigen::Vector3d(from.x(), from.y(), 0), 25, 0.6);
  child.label = "child";
  child.parent = 0;
  child.parentAlong = 20;
  return treeOf({helix, child}, spacing);
}

void shake(formats::CenterlineTree& tree, double sd) {
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, static_cast<float>(sd));
  for (formats::Vec3f& centre : tree.centre) {
    centre.x += noise(random);
    centre.y += noise(random);
    centre.z += noise(random);
  }
}

TEST(VesselLengths, AreThoseOfTheCurveBelowTheNoiseOfTheNodes) {
  formats::Case value = helixWithChild(0.5);
  const double clean = formats::branchLength(value.tree, value.tree.branches[0]);
  shake(value.tree, 0.1);
  EXPECT_GT(formats::branchLength(value.tree, value.tree.branches[0]), 1.03 * clean);
  EXPECT_NEAR(vesselLengths(value.tree).branch[0], clean, 0.01 * clean);
}

TEST(VesselLengths, BeginAtTheWallOfTheParent) {
  const formats::Case value = helixWithChild(0.25);
  EXPECT_NEAR(vesselLengths(value.tree).branch[1], 24, 0.1);  // the parent's radius is 1 mm
}

TEST(VesselLengths, DoNotDependOnTheDistanceOfTheNodes) {
  const VesselLengths coarse = vesselLengths(helixWithChild(0.5).tree);
  const VesselLengths fine = vesselLengths(helixWithChild(0.005).tree);
  EXPECT_NEAR(fine.branch[0], coarse.branch[0], 0.002 * coarse.branch[0]);
  EXPECT_NEAR(fine.branch[1], coarse.branch[1], 0.1);
}

TEST(VesselLengths, AreSumsOfTheEdges) {
  const formats::CenterlineTree tree = helixWithChild(0.5).tree;
  const VesselLengths lengths = vesselLengths(tree);
  std::vector<double> sums(tree.branches.size());
  for (std::size_t n = 0; n < lengths.edge.size(); ++n) {
    EXPECT_GE(lengths.edge[n], 0);
    sums[tree.branch[n]] += lengths.edge[n];
  }
  for (std::size_t b = 0; b < sums.size(); ++b) EXPECT_NEAR(sums[b], lengths.branch[b], 1e-9);
  EXPECT_NEAR(lengths.total, sums[0] + sums[1], 1e-9);
}

TEST(VesselLengths, OfInfoAndOfMeasuresAreEqual) {
  formats::Case value = helixWithChild(0.5);
  shake(value.tree, 0.1);
  Progress progress;
  const CaseInfo info = describeCase(value, progress);
  const CaseMeasures measures = measuresOf(value);
  double total = 0;
  for (std::size_t b = 0; b < info.branches.size(); ++b) {
    EXPECT_NEAR(info.branches[b].length, measures.vessels[b].length.value, 1e-9);
    total += info.branches[b].length;
  }
  EXPECT_NEAR(info.length, total, 1e-9);
}

TEST(VesselLengths, OfAnAneurysmAreItsEdges) {
  formats::Case value = helixWithChild(0.5);
  shake(value.tree, 0.1);
  value.tree.branches[1].kind = formats::BranchKind::Aneurysm;
  EXPECT_NEAR(vesselLengths(value.tree).branch[1],
              formats::branchLength(value.tree, value.tree.branches[1]), 1e-9);
}

TEST(ListTrees, TheLongestStandsFirstWithAllItsBranches) {
  const Tube first = straightTube({0, 0, 0}, {0, 0, 1}, 10, 1);
  const Tube second = straightTube({30, 0, 0}, {0, 0, 1}, 20, 1);
  Tube child = straightTube({30, 0, 10}, {1, 0, 0}, 6, 0.5);
  child.parent = 1;
  child.parentAlong = 10;
  const formats::CenterlineTree tree = treeOf({first, second, child}, 0.5).tree;
  const std::vector<TreeExtent> trees = listTrees(tree, vesselLengths(tree));
  ASSERT_EQ(trees.size(), 2U);
  EXPECT_EQ(trees[0].root, 1U);
  EXPECT_EQ(trees[0].branches, 2U);
  EXPECT_NEAR(trees[0].length, 25, 0.1);
  EXPECT_NEAR(trees[1].length, 10, 1e-6);
}

/// A vessel that narrows from 1 to 0.2 mm over 40 mm, of a volume of 0.5 x 0.5 x 0.8 mm.
formats::Case taperingCase(double blur) {
  Tube tube = straightTube({0, 0, 0}, {0, 0, 1}, 40, 1);
  tube.radius = [](double along) { return 1 - 0.02 * along; };
  formats::Case value = caseOf({tube}, 0.25);
  formats::SourceVolume& source = value.metadata.source.emplace();
  source.size = {64, 64, 64};
  source.spacing = {0.5, 0.5, 0.8};
  if (blur > 0) {
    formats::Step& step = value.metadata.steps.emplace_back();
    step.name = "track";
    step.parameters["point-spread"] = blur;
  }
  return value;
}

TEST(ShownRadius, IsTheHalfLevelOfALineBehindTheBlur) {
  EXPECT_NEAR(leastShownRadius(taperingCase(0.4).metadata).value(), 0.47096, 1e-5);
  EXPECT_DOUBLE_EQ(leastShownRadius(taperingCase(0).metadata).value(), 0.4);
  EXPECT_FALSE(leastShownRadius(formats::Metadata{}));
}

TEST(ShownRadius, BoundsWhatIsFittedBelowIt) {
  const CaseMeasures m = measuresOf(taperingCase(0.4));
  EXPECT_NEAR(m.vessels[0].smallestRadius.atMost, 0.47096, 1e-5);
  EXPECT_LT(m.vessels[0].smallestRadius.value, 0.3);  // the number stays
  EXPECT_TRUE(std::isnan(m.vessels[0].meanRadius.atMost));
  EXPECT_NEAR(m.paths[0].catheter.atMost, 6 * 0.47096, 1e-4);  // French: a third of a mm each
  for (const StationMeasures& station : m.stations) {
    EXPECT_EQ(std::isnan(station.radius.atMost), station.radius.value >= 0.47096);
    EXPECT_TRUE(std::isnan(station.area.atMost));
  }
  EXPECT_TRUE(std::isnan(measuresOf(caseOf({straightTube({0, 0, 0}, {0, 0, 1}, 20, 0.1)}, 0.1))
                             .vessels[0]
                             .smallestRadius.atMost));  // no volume, no bound
}

TEST(ShownRadius, IsWrittenAsABound) {
  EXPECT_EQ(shownRadius(0.21, 0.4, 2), "<= 0.40");
  EXPECT_EQ(shownRadius(0.41, 0.4, 2), "0.41");
  EXPECT_EQ(shownRadius(0.21, std::nullopt, 2), "0.21");
  const formats::Case value = taperingCase(0.4);
  const auto tables = measureTables(value, measuresOf(value));
  EXPECT_EQ(measuresJson(tables)["vessels"][0]["smallest_radius_mm"]["at_most"], 0.470964);
  const std::vector<MeasuredCase> cases = {{"a", tables}};
  EXPECT_NE(measuresCsv(cases, 1).find("smallest_radius_mm: at most 0.470964"), std::string::npos);
}

}  // namespace
}  // namespace lumen::convert::test
