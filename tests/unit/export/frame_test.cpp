// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/frame.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace lumen::convert {

namespace {

const Eigen::Vector3d kPlace(10, 20, 30);  // left, posterior, superior

}  // namespace

TEST(ExportFrame, KeepsMillimetresAndLpsWithoutAChoice) {
  EXPECT_EQ(ExportFrame{}.position(kPlace), kPlace);
}

TEST(ExportFrame, TurnsToTheAxesThatItNames) {
  const ExportFrame ras{LengthUnit::Millimetre, Axes::Ras}, lsa{LengthUnit::Metre, Axes::Lsa};
  EXPECT_EQ(ras.position(kPlace), Eigen::Vector3d(-10, -20, 30));
  EXPECT_TRUE(lsa.position(kPlace).isApprox(Eigen::Vector3d(0.010, 0.030, -0.020)));
  EXPECT_EQ(lsa.direction(Eigen::Vector3d::UnitZ()), Eigen::Vector3d::UnitY());
  EXPECT_DOUBLE_EQ((ExportFrame{LengthUnit::Centimetre, Axes::Lps}.length(25)), 2.5);
}

TEST(ExportFrame, MirrorsNothing) {
  for (const Axes axes : {Axes::Lps, Axes::Ras, Axes::Lsa})
    EXPECT_NEAR((ExportFrame{LengthUnit::Metre, axes}.rotation().determinant()), 1, 1e-15);
}

TEST(ExportFrame, ItsMatrixIsWhatItDoesToAPosition) {
  const ExportFrame frame{LengthUnit::Metre, Axes::Lsa};
  const Eigen::Vector4d moved = frame.matrix() * kPlace.homogeneous();
  EXPECT_TRUE(moved.head<3>().isApprox(frame.position(kPlace)));
}

TEST(ExportFrame, TakesASurfaceWithItsRadiiAndNormals) {
  SurfaceMesh mesh;
  mesh.position = {{10, 20, 30}};
  mesh.normal = {{0, 0, 1}};
  mesh.radius = {2};
  mesh.triangle = {{0, 1, 2}};
  const SurfaceMesh moved = ExportFrame{LengthUnit::Centimetre, Axes::Lsa}.of(mesh);
  EXPECT_EQ(moved.position[0], (Float3{1, 3, -2}));
  EXPECT_EQ(moved.normal[0], (Float3{0, 1, 0}));
  EXPECT_FLOAT_EQ(moved.radius[0], 0.2F);
  const SurfaceMesh over = turnedOver(mesh);
  EXPECT_EQ(over.normal[0][2], -1);
  EXPECT_EQ(over.triangle[0], (Triangle{0, 2, 1}));
}

}  // namespace lumen::convert
