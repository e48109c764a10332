// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "closed_cases.h"
#include "converters/stages/surface/reported_places.h"

namespace lumen::convert {
namespace {

TEST(BareStretches, AWholeSurfaceHasNone) {
  const test::ClosedCase closed(test::forkCase());
  EXPECT_TRUE(stretchesWithoutWall(closed.surface, closed.source.tree).empty());
}

TEST(BareStretches, NamesTheBranchWhoseSurfaceIsNotThere) {
  test::ClosedCase closed(test::forkCase());
  CaseSurface& surface = closed.surface;
  // vertices of the side's last nodes alone are what the function looks at
  CaseSurface without = surface;
  without.mesh.position.clear();
  without.node.clear();
  for (std::size_t v = 0; v < surface.node.size(); ++v) {
    if (surface.mesh.position[v].y() > 3) continue;
    without.mesh.position.push_back(surface.mesh.position[v]);
    without.node.push_back(surface.node[v]);
  }
  const auto told = stretchesWithoutWall(without, closed.source.tree);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NE(told[0].find("branch side"), std::string::npos) << told[0];
}

}  // namespace
}  // namespace lumen::convert
