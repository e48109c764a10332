// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/clutter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/base/error.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/phantom/phantom.h"
#include "formats/case/case_file.h"
#include "small_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

Phantom made(const std::string& clutter, const std::string& name = "tube") {
  PhantomOptions options;
  options.name = name;
  options.size = 64;
  options.noise = options.bias = 0;
  options.psf = 0;
  options.clutter = clutter;
  Progress progress;
  return makePhantom(options, progress);
}

/// Voxels that clutter makes brighter by more than a tenth of the contrast, and darker.
struct Change {
  std::size_t brighter = 0, darker = 0;
  double deepest = 0;   ///< mm: least distance of a brighter voxel from the wall; negative: within
  double farthest = 0;  ///< mm: greatest
  int brightest = 0;
  double sum = 0;  ///< of all differences
};

Change changeOf(const std::string& clutter) {
  const Phantom clean = made(""), phantom = made(clutter);
  const TubeTreeDistance wall(clean.truth.tree);
  Change change{0, 0, 1e9, -1e9, 0, 0};
  for (std::size_t i = 0; i < voxelsOf(clean).size(); ++i) {
    const int difference = voxelsOf(phantom)[i] - voxelsOf(clean)[i];
    change.sum += difference;
    change.darker += difference < -100 ? 1 : 0;
    if (difference <= 100) continue;
    ++change.brighter;
    const VolumeGeometry& grid = clean.volume.geometry;
    const double away = wall.nearest(grid.position(grid.cell(i))).distance;
    change.deepest = std::min(change.deepest, away);
    change.farthest = std::max(change.farthest, away);
    change.brightest = std::max(change.brightest, static_cast<int>(voxelsOf(phantom)[i]));
  }
  return change;
}

TEST(Clutter, LeavesTheTruthAndTheSeedsAsTheyWere) {
  const Phantom clean = made("", "bifurcation"),
                phantom = made("bone,vein,streaks,stent,void", "bifurcation");
  EXPECT_EQ(phantom.truth.tree, clean.truth.tree);
  ASSERT_EQ(phantom.seeds.size(), clean.seeds.size());
  EXPECT_EQ(phantom.seeds[1].points[0].position, clean.seeds[1].points[0].position);
  EXPECT_NE(voxelsOf(phantom), voxelsOf(clean));
  EXPECT_EQ(std::get<std::string>(phantom.truth.metadata.steps[0].parameters.at("clutter")),
            "bone,vein,streaks,stent,void");
  EXPECT_FALSE(clean.truth.metadata.steps[0].parameters.contains("clutter"));
}

TEST(Clutter, BoneIsBrighterThanVesselsAndReachesTheWall) {
  const Change bone = changeOf("bone");
  EXPECT_GT(bone.brighter, 1000U);
  EXPECT_EQ(bone.darker, 0U);
  EXPECT_EQ(bone.brightest, 100 + 1500);
  // a voxel is 0.2 mm, and the slab is at most half a radius (0.25 mm) off the wall
  EXPECT_LT(bone.deepest, 0.25 + 0.2);
}

TEST(Clutter, AVeinIsDimmerAndOffTheWall) {
  const Change vein = changeOf("vein");
  EXPECT_GT(vein.brighter, 1000U);
  EXPECT_EQ(vein.darker, 0U);
  EXPECT_EQ(vein.brightest, 100 + 600);
  // radii of 0.5 and 0.65 mm, axes 1.1 times their sum apart
  EXPECT_GT(vein.deepest, 0.1 * 1.15 - 0.2);
  EXPECT_LT(vein.farthest, 0.1 * 1.15 + 1.3 + 0.2);
}

TEST(Clutter, StreaksAreBrightAndDarkAroundMetal) {
  const Change streaks = changeOf("streaks");
  EXPECT_GT(streaks.brighter, 100U);
  EXPECT_GT(streaks.darker, 100U);
  EXPECT_GT(streaks.brightest, 100 + 2000);
}

TEST(Clutter, AStentLiesInTheWallAlone) {
  const Change stent = changeOf("stent");
  EXPECT_GT(stent.brighter, 50U);
  EXPECT_LT(stent.darker, stent.brighter / 10);
  // wires of 0.06 mm around the wall, in voxels of 0.2 mm
  EXPECT_LT(stent.farthest, 0.06 + 0.2);
  EXPECT_GT(stent.deepest, -0.06 - 0.2);
}

TEST(Clutter, AVoidLosesTheSignalOfAStretch) {
  const Change loss = changeOf("void");
  EXPECT_EQ(loss.brighter, 0U);
  // 95 % over three radii of 0.5 mm, half of it over one more on both sides together, 0.785 mm^2 wide
  EXPECT_NEAR(loss.sum * 0.2 * 0.2 * 0.2 / 1000, -0.785 * 0.95 * 4 * 0.5, 0.02 * 1.49);
}

TEST(Clutter, AKindIsEqualAloneAndWithOthers) {
  const Phantom clean = made(""), vein = made("vein"), both = made("vein,void");
  std::size_t compared = 0;
  for (std::size_t i = 0; i < voxelsOf(clean).size(); ++i)
    if (voxelsOf(clean)[i] == 100 && voxelsOf(vein)[i] != 100) {
      EXPECT_NEAR(voxelsOf(both)[i], voxelsOf(vein)[i], 1);  // as the sums are rounded otherwise
      ++compared;
    }
  EXPECT_GT(compared, 1000U);
}

TEST(Clutter, IsEqualOnAnyNumberOfThreads) {
  const auto all = "bone,vein,streaks,stent,void";
  const Phantom many = made(all);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(voxelsOf(many), voxelsOf(made(all)));
}

TEST(Clutter, RefusesUnknownKindsAndThoseNamedTwice) {
  for (const char* const list : {"bones", "bone,", "bone,bone", ","}) {
    try {
      (void)parseClutter(list);
      ADD_FAILURE() << list;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Usage) << list;
    }
  }
  EXPECT_EQ(parseClutter("void,bone").size(), 2U);
}

TEST(Willis, HasThreeInletsAndThreeLinks) {
  PhantomOptions options;
  options.name = "willis";
  options.size = 128;
  options.voxel = 0.4;
  Progress progress;
  const formats::CenterlineTree tree = makePhantom(options, progress).truth.tree;
  EXPECT_EQ(std::count(tree.parent.begin(), tree.parent.end(), formats::kNoParent), 3);
  ASSERT_EQ(tree.links.size(), 3U);
  for (const auto& [first, second] : tree.links) {
    EXPECT_LT(first, second);
    EXPECT_NE(tree.branch[first], tree.branch[second]);
    // the end lies on the other vessel's axis: nodes are 0.2 mm apart
    EXPECT_LT((toEigen(tree.centre[first]) - toEigen(tree.centre[second])).norm(), 0.11);
  }
}

std::vector<std::string> willisWithout(const std::set<std::string>& missing) {
  std::vector<std::string> labels;
  for (const formats::Branch& branch : designWillis({0.2, 51}, missing).tree.branches)
    labels.push_back(branch.label);
  std::sort(labels.begin(), labels.end());
  return labels;
}

TEST(Willis, ItsCommunicatingArteriesFeedWhatLiesBehindAMissingPart) {
  const std::vector<std::string> all{"Acom",   "BA",    "L-ACA", "L-ICA", "L-MCA", "L-PCA",
                                     "L-Pcom", "R-ACA", "R-ICA", "R-MCA", "R-PCA", "R-Pcom"};
  EXPECT_EQ(willisWithout({}), all);
  EXPECT_EQ(willisWithout({"L-P1"}), all);
  EXPECT_EQ(willisWithout({"R-A1"}), all);
  const Design design = designWillis({0.2, 51}, {"L-P1", "R-A1"});
  EXPECT_EQ(design.tree.links.size(), 1U);  // of the right posterior communicating artery
  for (const formats::Branch& branch : design.tree.branches) {
    if (branch.label != "L-PCA" && branch.label != "R-ACA") continue;
    const std::uint32_t before = design.tree.branch[static_cast<std::size_t>(branch.parentNode)];
    EXPECT_EQ(design.tree.branches[before].label, branch.label == "L-PCA" ? "L-Pcom" : "Acom");
  }
}

TEST(Willis, LacksWhatNothingFeeds) {
  for (const auto& [missing, absent] :
       {std::pair<std::set<std::string>, std::string>{{"L-P1", "L-Pcom"}, "L-PCA"},
        {{"R-A1", "Acom"}, "R-ACA"},
        {{"R-Pcom"}, "R-Pcom"},
        {{"L-A1", "R-A1"}, "Acom"}}) {
    const std::vector<std::string> labels = willisWithout(missing);
    EXPECT_EQ(std::count(labels.begin(), labels.end(), absent), 0) << absent;
    EXPECT_EQ(std::count(labels.begin(), labels.end(), "BA"), 1);
  }
}

TEST(Willis, HasTheCitedLengthsOfItsCommunicatingArteries) {
  const Design design = designWillis({0.2, 51}, {});
  for (const formats::Branch& branch : design.tree.branches) {
    const double length =
        static_cast<double>(design.tree.height[branch.firstNode]) * (branch.nodeCount - 1);
    if (branch.label == "Acom") {
      EXPECT_NEAR(length, 3, 0.3);
    }
    if (branch.label.ends_with("Pcom")) {
      EXPECT_NEAR(length, 15, 1.5);
    }
  }
}

}  // namespace
}  // namespace lumen::convert
