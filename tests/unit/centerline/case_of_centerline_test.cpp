// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/case_of_centerline.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/io/centerline/centerline_readers.h"
#include "formats/case/node_origin.h"
#include "formats/case/validate.h"

namespace lumen::convert {
namespace {

formats::Case caseOf(const std::string& swc) {
  CenterlineFile file = parseSwc(swc, "t.swc");
  toPatientSpace(file, {1.0, CenterlineAxes::Lps});
  formats::Case value = caseOfCenterline(file, "t.swc");
  EXPECT_TRUE(formats::validate(value)) << formats::validate(value).error().text();
  return value;
}

double edge(const formats::CenterlineTree& tree, std::size_t node) {
  return (toEigen(tree.centre[node]) - toEigen(tree.centre[std::size_t(tree.parent[node])])).norm();
}

TEST(CaseOfCenterline, LongSegmentsGetNodesAndAllAreGiven) {
  const formats::Case value = caseOf("1 0 0 0 0 1 -1\n2 0 0 0 30 2 1\n");
  EXPECT_EQ(value.tree.nodeCount(), 51U);  // 30 / (0.6 * 1)
  for (std::size_t n = 1; n < value.tree.nodeCount(); ++n) {
    EXPECT_NEAR(edge(value.tree, n), 0.6, 1e-5);
    EXPECT_NEAR(value.tree.radius[n], 1 + value.tree.centre[n].z / 30, 1e-6);
    EXPECT_NEAR(value.tree.direction[n].z, 1, 1e-6);
  }
  for (const auto origin : formats::readNodeOrigins(value))
    EXPECT_EQ(origin, formats::NodeOrigin::Given);
}

TEST(CaseOfCenterline, PointsAtASensibleDistanceAreTheNodes) {
  const formats::Case value = caseOf("1 0 0 0 0 1 -1\n2 0 0 0 0.7 1 1\n3 0 0 0.1 1.5 1 2\n");
  ASSERT_EQ(value.tree.nodeCount(), 3U);
  EXPECT_EQ(value.tree.centre[2], (formats::Vec3f{0, 0.1F, 1.5F}));
}

TEST(CaseOfCenterline, DensePointsAreThinnedToHalfARadius) {
  std::string swc;
  for (int i = 0; i <= 200; ++i)
    swc += std::to_string(i + 1) + " 0 0 0 " + std::to_string(i * 0.1) + " 2 " +
           std::to_string(i == 0 ? -1 : i) + "\n";
  const formats::Case value = caseOf(swc);
  EXPECT_EQ(value.tree.nodeCount(), 21U);
  EXPECT_EQ(value.tree.centre.back(), (formats::Vec3f{0, 0, 20}));
}

TEST(CaseOfCenterline, AChildKeepsItsRadiusUpToItsParentsAxis) {
  const formats::Case value =
      caseOf("1 0 0 0 0 2 -1\n2 0 0 0 1 2 1\n3 0 0 0 2 2 2\n4 0 4 0 1 0.5 2\n");
  ASSERT_EQ(value.tree.branches.size(), 2U);
  const formats::Branch& child = value.tree.branches[1];
  EXPECT_EQ(child.parentNode, 1);
  EXPECT_EQ(value.tree.branches[0].label, "b000");
  EXPECT_EQ(child.label, "b001");
  for (std::uint32_t n = child.firstNode; n < child.firstNode + child.nodeCount; ++n)
    EXPECT_EQ(value.tree.radius[n], 0.5F);
}

// At 10 degrees a child of radius 0.5 runs for 10 mm within its parent of radius 2.
TEST(CaseOfCenterline, AChildThatRunsWithinItsParentHangsWhereItLeaves) {
  std::string swc;
  for (int i = 0; i <= 30; ++i)
    swc += std::to_string(i + 1) + " 0 0 0 " + std::to_string(i) + " 2 " +
           std::to_string(i == 0 ? -1 : i) + "\n";
  swc += "40 0 3.4730 0 24.6962 0.5 6\n";  // from z = 5, 20 mm on
  const formats::Case value = caseOf(swc);
  ASSERT_EQ(value.tree.branches.size(), 2U);
  const formats::Branch& child = value.tree.branches[1];
  EXPECT_GT(child.parentNode, 8);
  EXPECT_LT(child.parentNode, 13);
  EXPECT_LT(edge(value.tree, child.firstNode), 2);
}

TEST(CaseOfCenterline, VesselsThatAreTooLongForTheirRadiiAreRefused) {
  CenterlineFile file = parseSwc("1 0 0 0 0 1e-9 -1\n2 0 0 0 1e9 1e-9 1\n", "t.swc");
  try {
    caseOfCenterline(file, "t.swc");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    EXPECT_NE(std::string(error.what()).find("so long for their radii"), std::string::npos);
  }
}

TEST(PatientSpace, UnitsAreGuessedWhereMillimetresAreNoVessels) {
  const auto unitOf = [](const std::string& swc) {
    CenterlineFile file = parseSwc(swc, "t.swc");
    const double unit = toPatientSpace(file, {}).unit;
    EXPECT_EQ(file.remarks.size(), unit == 1 ? 0U : 1U);
    return unit;
  };
  EXPECT_EQ(unitOf("1 0 0 0 0 0.01 -1\n2 0 0 0 0.3 0.008 1\n"), 1000);
  EXPECT_EQ(unitOf("1 0 0 0 0 100 -1\n2 0 0 0 1000 80 1\n"), 1e-3);
  EXPECT_EQ(unitOf("1 0 0 0 0 1 -1\n2 0 0 0 100 0.5 1\n"), 1);
}

TEST(PatientSpace, RasIsTurnedIntoLps) {
  CenterlineFile file = parseSwc("1 0 1 2 3 4 -1\n", "t.swc");
  toPatientSpace(file, {1.0, CenterlineAxes::Ras});
  EXPECT_EQ(file.points[0].position, Eigen::Vector3d(-1, -2, 3));
}

TEST(PatientSpace, NeuroMorphoIsInMicrometresAndItsSomaOnePoint) {
  CenterlineFile file = parseSwc(
      "# Original file edited by NeuroMorpho.Org\n1 1 0 0 0 5 -1\n2 1 0 5 0 5 1\n3 1 0 -5 0 5 "
      "1\n4 3 9 0 0 1 1\n5 3 19 0 0 0 4\n",
      "t.swc");
  EXPECT_EQ(file.points.size(), 3U);
  EXPECT_EQ(file.remarks.size(), 3U);  // the unit, the soma, the radius that is missing
  EXPECT_EQ(file.points[2].radius, 1);
  EXPECT_EQ(toPatientSpace(file, {}).unit, 1e-3);
  EXPECT_NEAR(file.points[2].position.x(), 0.019, 1e-12);
}

const std::filesystem::path kShared = LUMEN_SHARED_DATA;

TEST(RealCenterlines, SlicersCurvesOfAFolderAreOneTreeWithTheirLoops) {
  const auto folder = kShared / "neurovascular/centerlines";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is missing";
  const CenterlineFile file = readCurves(folder);
  std::size_t roots = 0;
  for (const CenterlinePoint& point : file.points) roots += point.parent == kNoPoint ? 1 : 0;
  EXPECT_EQ(roots, 1U);
  EXPECT_EQ(centerlineChains(file).size(), 25U);
  EXPECT_EQ(file.links.size(), 1U);  // both vertebral arteries end in the basilar artery
  EXPECT_TRUE(formats::validate(caseOfCenterline(file, "curves")));
}

TEST(RealCenterlines, VmtksLinesOfTheAortaAreOneTreeWhetherSplitOrNot) {
  for (const char* name : {"aorta/aorta-centerline.vtp", "aorta/aorta-centerline-branches.vtp"}) {
    if (!std::filesystem::exists(kShared / name)) GTEST_SKIP() << name << " is missing";
    const CenterlineFile file = readVtpCenterline(kShared / name);
    EXPECT_EQ(centerlineChains(file).size(), 2U) << name;
    EXPECT_NEAR(measureExtent(file).most, 7.578, 1e-3) << name;
  }
}

}  // namespace
}  // namespace lumen::convert
