// SPDX-License-Identifier: Apache-2.0
#include "converters/inside/closed_mesh.h"

#include <gtest/gtest.h>

#include "tests/unit/inside/tube_mesh.h"

namespace lumen::convert {
namespace {

TEST(ClosedMesh, HasAnEndForEachOpening) {
  const ClosedMesh closed = closeMesh(test::tube(test::straight(20), 2, false));
  ASSERT_EQ(closed.ends.size(), 2U);
  EXPECT_TRUE(closed.ends[0].wasOpen);
  EXPECT_NEAR(closed.ends[0].radius, 2, 0.02);
  EXPECT_NEAR(closed.ends[0].normal.x() * closed.ends[1].normal.x(), -1, 1e-9);
  EXPECT_EQ(eulerCharacteristic(closed.mesh), 2);
}

TEST(ClosedMesh, FindsFlatCaps) {
  const ClosedMesh closed = closeMesh(test::tube(test::straight(20), 2, true));
  ASSERT_EQ(closed.ends.size(), 2U);
  EXPECT_FALSE(closed.ends[0].wasOpen);
  EXPECT_NEAR(closed.ends[0].centre.x() + closed.ends[1].centre.x(), 20, 1e-9);
}

TEST(ClosedMesh, TurnsWhatIsInsideOut) {
  TriangleMesh mesh = test::tube(test::straight(20), 2, true);
  for (Triangle& t : mesh.triangle) std::swap(t[0], t[1]);
  EXPECT_LT(enclosedVolume(mesh), 0);
  EXPECT_GT(enclosedVolume(closeMesh(mesh).mesh), 0);
}

TEST(ClosedMesh, SeesNoEndOnARing) {
  const ClosedMesh closed = closeMesh(test::ring(6, 2));
  EXPECT_TRUE(closed.ends.empty());
  EXPECT_EQ(eulerCharacteristic(closed.mesh), 0);
}

}  // namespace
}  // namespace lumen::convert
