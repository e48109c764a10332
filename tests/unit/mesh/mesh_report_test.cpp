// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/repair/mesh_report.h"

#include <numbers>

#include <gtest/gtest.h>

#include "converters/geometry/unit_guess.h"
#include "mesh_shapes.h"

namespace lumen::test {
namespace {

using namespace lumen::convert;

MeshReport diagnosed(const TriangleMesh& mesh) {
  return diagnoseMesh(mesh, Progress());
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Eigen::Vector3d& p : mesh.position) p *= factor;
  return mesh;
}

TEST(MeshReport, ATetrahedronIsClosedAndSound) {
  const MeshReport report = diagnosed(tetrahedron());
  EXPECT_TRUE(report.closed && report.manifold && report.oriented);
  EXPECT_NEAR(report.volume, 1.0 / 6, 1e-15);
  EXPECT_NEAR(report.area, 1.5 + std::sqrt(3.0) / 2, 1e-15);
  ASSERT_EQ(report.components.size(), 1U);
  EXPECT_EQ(report.components[0].genus, 0);
  EXPECT_EQ(report.selfIntersections, 0U);
}

TEST(MeshReport, GenusCountsHandles) {
  const MeshReport report = diagnosed(joined(torus(), tetrahedron(), {9, 0, 0}));
  ASSERT_EQ(report.components.size(), 2U);
  EXPECT_EQ(report.components[0].genus, 1);
  EXPECT_EQ(report.components[1].genus, 0);
}

TEST(MeshReport, AnOpenTubeHasTwoLoopsAndTheVolumeBetweenThem) {
  const MeshReport report = diagnosed(openTube(2, 10, 256, 4));
  EXPECT_FALSE(report.closed);
  ASSERT_EQ(report.boundaryLoops.size(), 2U);
  EXPECT_NEAR(report.boundaryLoops[0].centre.z(), 0, 1e-12);
  EXPECT_NEAR(report.boundaryLoops[1].centre.z(), 10, 1e-12);
  EXPECT_EQ(report.boundaryEdges, 512U);
  EXPECT_EQ(report.components[0].genus, 0);
  EXPECT_NEAR(report.volume, 40 * std::numbers::pi, 0.02);
  EXPECT_NEAR(report.area, 40 * std::numbers::pi, 0.02);
}

TEST(MeshReport, ASoupIsJudgedAsTheSurfaceThatItIs) {
  const MeshReport report = diagnosed(soup(torus()));
  EXPECT_TRUE(report.closed && report.manifold && report.oriented);
  EXPECT_EQ(report.components[0].genus, 1);
  EXPECT_EQ(report.duplicatePoints, soup(torus()).position.size() - torus().position.size());
}

TEST(MeshReport, EveryDefectIsCounted) {
  TriangleMesh mesh = torus();
  turn(mesh.triangle[20]);
  mesh.triangle.push_back(mesh.triangle[100]);
  mesh.triangle.push_back({3, 3, 4});
  mesh.position.emplace_back(0, 0, 0);
  const MeshReport report = diagnosed(mesh);
  EXPECT_FALSE(report.oriented);
  EXPECT_EQ(report.misorientedEdges, 3U);
  EXPECT_EQ(report.duplicateTriangles, 1U);
  EXPECT_EQ(report.nonManifoldEdges, 3U);
  EXPECT_EQ(report.degenerateTriangles, 1U);
  EXPECT_EQ(report.unusedPoints, 1U);
  EXPECT_FALSE(report.components[0].genus.has_value());
}

TEST(MeshReport, AMoebiusStripIsNotOriented) {
  const MeshReport report = diagnosed(moebius());
  EXPECT_TRUE(report.manifold);
  EXPECT_FALSE(report.oriented);
  EXPECT_EQ(report.boundaryLoops.size(), 1U);
}

TEST(MeshReport, TetrahedraThatShareAPointAreNotManifold) {
  TriangleMesh mesh = joined(tetrahedron(), scaled(tetrahedron(), -1));
  const MeshReport report = diagnosed(mesh);
  EXPECT_EQ(report.components.size(), 1U);
  EXPECT_EQ(report.nonManifoldVertices, 1U);
  EXPECT_EQ(report.nonManifoldEdges, 0U);
  EXPECT_TRUE(report.closed);
  EXPECT_FALSE(report.manifold);
}

TEST(MeshReport, HolesThatMeetInAPointAreOneLoop) {
  // squares, of which two are missing that share a corner: the sheets that touch there are apart
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y < 5; ++y)
    for (std::uint32_t x = 0; x < 5; ++x) mesh.position.emplace_back(x, y, 0);
  for (std::uint32_t y = 0; y < 4; ++y)
    for (std::uint32_t x = 0; x < 4; ++x) {
      const std::uint32_t i = 5 * y + x;
      if ((x == 1 && y == 1) || (x == 2 && y == 2)) continue;
      mesh.triangle.push_back({i, i + 1, i + 6});
      mesh.triangle.push_back({i, i + 6, i + 5});
    }
  const MeshReport report = diagnosed(mesh);
  EXPECT_EQ(report.nonManifoldVertices, 1U);
  EXPECT_EQ(report.boundaryEdges, 16U + 8U);
  ASSERT_EQ(report.boundaryLoops.size(), 2U);
  EXPECT_EQ(report.boundaryLoops[1].vertex.size(), 8U);
}

TEST(MeshReport, ThatTrianglesCutEachOtherIsSeen) {
  EXPECT_GT(diagnosed(joined(torus(), torus(), {0.5, 0, 0})).selfIntersections, 0U);
}

TEST(UnitGuess, AnAortaIsToldInMillimetresCentimetresAndMetres) {
  const TriangleMesh aorta = openTube(10, 300);
  EXPECT_EQ(guessUnit(vesselSize(aorta)).unit, "mm");
  EXPECT_EQ(guessUnit(vesselSize(aorta)).other, "");
  EXPECT_EQ(guessUnit(vesselSize(scaled(aorta, 0.001))).unit, "m");
  // vessels of 1.5 mm in cm: too thin for mm
  EXPECT_EQ(guessUnit(vesselSize(scaled(openTube(1.5, 90), 0.1))).unit, "cm");
  EXPECT_EQ(guessUnit(vesselSize(scaled(aorta, 1e3))).unit, "um");
  EXPECT_EQ(guessUnit(vesselSize(scaled(aorta, 1e6))).unit, "nm");
  EXPECT_FALSE(guessUnit(vesselSize(scaled(aorta, 1e10))).plausible);
}

TEST(UnitGuess, AModelOfSimVascularIsInCentimetresIfItHasTheSizeOfVesselsThen) {
  const VesselSize aorta = vesselSize(openTube(1.2, 25));
  const UnitGuess plain = guessUnit(aorta), model = guessUnit(aorta, true);
  EXPECT_EQ(plain.unit + plain.other, "mmcm");
  EXPECT_EQ(model.unit + model.other, "cmmm");
  EXPECT_EQ(guessUnit(vesselSize(openTube(10, 300)), true).unit, "mm");
}

TEST(UnitGuess, TheRadiusOfAnOpenTubeIsKnownWhereverItLies) {
  TriangleMesh tube = openTube(3, 100);
  for (Eigen::Vector3d& p : tube.position) p += Eigen::Vector3d(500, -300, 900);
  EXPECT_NEAR(vesselSize(tube).radius, 3, 0.1);
}

TEST(UnitGuess, AWarningNamesBothUnitsThatArePlausible) {
  const VesselSize aorta = vesselSize(openTube(1.2, 25));
  for (const bool isSimVascular : {false, true}) {
    const std::string warning = unitWarning(guessUnit(aorta, isSimVascular), aorta, isSimVascular);
    EXPECT_NE(warning.find("in mm"), std::string::npos) << warning;
    EXPECT_NE(warning.find("in cm"), std::string::npos) << warning;
    EXPECT_NE(warning.find("; unit states the unit"), std::string::npos) << warning;
  }
  const VesselSize whole = vesselSize(openTube(10, 300));
  EXPECT_EQ(unitWarning(guessUnit(whole), whole, false), "");
}

TEST(UnitGuess, ASizeThatNoVesselHasInTheStatedUnitGetsAWarningWithTheUnitThatFits) {
  const VesselSize aorta = vesselSize(openTube(10, 300));  // numbers of mm
  const auto warned = [&](double millimetres, UnitBy by) {
    return statedWarning(aorta, millimetres, by, {});
  };
  EXPECT_EQ(warned(1, UnitBy::File), "");
  EXPECT_EQ(warned(1e-3, UnitBy::File), "");  // a microscope's
  for (const double wrong : {10.0, 1000.0, 1e-6})
    EXPECT_NE(warned(wrong, UnitBy::File).find("implausible; in mm they would be vessels of 9."),
              std::string::npos)
        << warned(wrong, UnitBy::File);
  EXPECT_EQ(warned(1000, UnitBy::File).find("by the unit that it states it holds"), 0U);
  EXPECT_EQ(warned(1000, UnitBy::StandardOfGltf).find("by the standard of glTF it holds"), 0U);
  EXPECT_NE(warned(1e-3, UnitBy::StandardOfGltf), "");
}

}  // namespace
}  // namespace lumen::test
