// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/vectors.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/judge/measure/measures.h"
#include "converters/judge/measure/neck_plane.h"
#include "converters/judge/measure/sac_shape.h"
#include "converters/judge/measure/sac_tree.h"
#include "converters/judge/measure/wall.h"
#include "tests/unit/measure/exact_design.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

const Frame kFrame{0.2, 25.4};

double truth(const Design& design, const std::string& measure) {
  return std::get<double>(design.notes.at("true.sac." + measure));
}

std::vector<SacMeasures> measureSacsOf(const formats::Case& source) {
  const WallNoise noise(source, Wall(source));
  return measureSacs(source, &noise, Progress());
}

// The wall of a design, exactly.
SacShape shapeOfDesign(const Design& design) {
  const TubeTreeDistance wall(design.tree);
  const SacTree sac = findSacs(design.tree).front();
  BoxedField field;
  for (const std::uint32_t n : sac.nodes)
    field.box.add(toEigen(design.tree.centre[n]), static_cast<double>(design.tree.radius[n]) + 2);
  field.value = [&](const Vector3d& p) { return -wall.nearest(p).distance; };
  const auto attachment = static_cast<std::size_t>(sac.attachment);
  const NeckPlace place{toEigen(design.tree.centre[attachment]), sac.middle, {}};
  const Progress progress;
  const auto shape =
      findSacShape(field, place, toEigen(design.tree.centre[sac.widest]), sac.radius, 0, progress);
  return shape.value();
}

// A tenth of what docs/measures.md promises of indices and volumes of a fitted case.
void expectTruth(const Design& design) {
  const DomeShape shape = shapeOfDesign(design).shape;
  EXPECT_NEAR(shape.volume / truth(design, "dome_volume_mm3"), 1, 0.002);
  EXPECT_NEAR(shape.area / truth(design, "dome_area_mm2"), 1, 0.002);
  EXPECT_NEAR(shape.width / truth(design, "width_mm"), 1, 0.003);
  EXPECT_NEAR(shape.height / truth(design, "height_mm"), 1, 0.003);
  EXPECT_NEAR(shape.reach / truth(design, "height_mm"), 1, 0.003);
  // the plane that touches a vessel does so up to a fiftieth of a triangle's edge
  EXPECT_NEAR(shape.neckDiameter / truth(design, "neck_diameter_mm"), 1, 0.004);
  EXPECT_NEAR(shape.neckArea / truth(design, "neck_area_mm2"), 1, 0.008);
  EXPECT_NEAR(1 - shape.volume / shape.hullVolume, 0, 0.003);
}

TEST(SacShape, OfABallOnATubeIsItsClosedForm) {
  expectTruth(designSacSphere(kFrame));
}

TEST(SacShape, OfAnEllipsoidOnATubeIsItsClosedForm) {
  expectTruth(designSacEllipsoid(kFrame));
}

TEST(SacShape, OfABallInAForkIsItsClosedForm) {
  expectTruth(designSacFork(kFrame));
}

// Wall points without noise: errors left are those of the fit.
TEST(SacMeasures, OfAFittedBallAreNearItsClosedForm) {
  const Design design = designSacSphere(kFrame);
  const auto sacs = measureSacsOf(test::caseOfDesign(design, 0.5, 0.2));
  ASSERT_EQ(sacs.size(), 1U);
  const SacMeasures& sac = sacs[0];
  EXPECT_EQ(sac.position, "side-wall");
  EXPECT_NEAR(sac.volume.value / truth(design, "dome_volume_mm3"), 1, 0.02);
  EXPECT_NEAR(sac.width.value / truth(design, "width_mm"), 1, 0.02);
  EXPECT_NEAR(sac.inflowAngle.value, 90, 2);
  EXPECT_GT(sac.volume.plusMinus, 0);
}

TEST(SacMeasures, AreEmptyWithAReasonWithoutModels) {
  formats::Case source;
  source.tree = designSacSphere(kFrame).tree;
  const auto sacs = measureSacs(source, nullptr, Progress());
  ASSERT_EQ(sacs.size(), 1U);
  EXPECT_TRUE(std::isnan(sacs[0].volume.value));
  EXPECT_EQ(sacs[0].volume.absent, "the case has no models: fit it first");
}

TEST(SacMeasures, AreEmptyWithAReasonForASacWithoutAVessel) {
  const Design design = designSacSphere(kFrame);
  formats::Case source = test::caseOfDesign(design, 0.5, 0.1);
  source.tree.branches[1].parentNode = formats::kNoParent;
  source.tree.parent[source.tree.branches[1].firstNode] = formats::kNoParent;
  const auto sacs = measureSacsOf(source);
  ASSERT_EQ(sacs.size(), 1U);
  EXPECT_EQ(sacs[0].neckDiameter.absent, "the aneurysm hangs on no vessel");
}

TEST(SacTree, LobesBelongToTheSacThatTheyHangOn) {
  const Design design = designSacLobes(kFrame);
  const std::vector<SacTree> sacs = findSacs(design.tree);
  ASSERT_EQ(sacs.size(), 1U);
  EXPECT_EQ(sacs[0].branches.size(), 3U);
  EXPECT_EQ(design.tree.branch[static_cast<std::size_t>(sacs[0].attachment)], 0U);
}

TEST(SacTree, TheVesselTowardsTheRootComesFirst) {
  const Design design = designSacFork(kFrame);
  const SacTree sac = findSacs(design.tree).front();
  const std::vector<SacVessel> vessels = vesselsAtNeck(design.tree, sac, 2);
  ASSERT_EQ(vessels.size(), 3U);
  EXPECT_LT(vessels[0].node, static_cast<std::uint32_t>(sac.attachment));
  for (const SacVessel& v : vessels) EXPECT_NEAR(v.diameter, 2.6, 1e-4);
}

// The part of a ball beyond a plane: area of the section and volume of the cap.
TEST(PlaneCutter, CutsACapOffABall) {
  BoxedField field;
  field.box.add(Vector3d::Zero(), 3.5);
  field.value = [](const Vector3d& p) { return 3 - p.norm(); };
  const Progress progress;
  const SampledField samples(field, 0.1, nullptr, progress);
  const LocalSurface surface = samples.surface(Vector3d::Zero());
  const Vector3d along = Vector3d(1, 2, 3).normalized();
  PlaneCutter cutter(surface, {-2.9 * along, Vector3d::Zero(), {}});
  const auto cut = cutter.cut({along, 1});
  ASSERT_TRUE(cut);
  constexpr double kPi = 3.141592653589793;
  EXPECT_NEAR(cut->area / (kPi * 8), 1, 0.002);
  EXPECT_NEAR(cut->volume / (kPi * 4 * 7 / 3), 1, 0.002);
  // a plane below the vessel's axis separates nothing
  EXPECT_FALSE(cutter.cut({along, -2.95}));
}

// Samples near the wall alone give the surface that all samples give.
TEST(SampledField, SkipsOnlySamplesAwayFromTheWall) {
  BoxedField field;
  field.box.add(Vector3d(0.3, -0.2, 0.1), 3.5);
  field.value = [](const Vector3d& p) { return 3 - (p - Vector3d(0.3, -0.2, 0.1)).norm(); };
  const Progress progress;
  const SampledField coarse(field, 0.4, nullptr, progress);
  std::atomic<int> calls = 0;
  const BoxedField counted{field.box, [&](const Vector3d& p) {
                             ++calls;
                             return field.value(p);
                           }};
  const SampledField fewer(counted, 0.2, &coarse, progress);
  const int some = calls.exchange(0);
  const SampledField all(counted, 0.2, nullptr, progress);
  EXPECT_LT(some, 0.6 * calls);
  const LocalSurface a = fewer.surface(Vector3d::Zero()), b = all.surface(Vector3d::Zero());
  EXPECT_EQ(a.mesh.triangle, b.mesh.triangle);
  EXPECT_EQ(a.mesh.position, b.mesh.position);
}

}  // namespace
}  // namespace lumen::convert
