// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/open_edges.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "formats/case/case_field.h"
#include "formats/case/reachability.h"
#include "shapes.h"
#include "tests/unit/formats/beads.h"

namespace lumen::convert {
namespace {

using formats::Case;
using formats::test::addBeads;
using formats::test::alongX;

/// Two rows of eleven beads of radius 1 along x, half a radius apart, and a gap of 2.4 mm from x = 5
/// between them: 0.4 mm of it is closed.
Case closedTube(float y = 0) {
  Case value = formats::test::noBeads();
  auto places = alongX(0, 0.5F, 11, y);
  for (const auto& place : alongX(7.4F, 0.5F, 11, y)) places.push_back(place);
  addBeads(value, "a", places, 1);
  return value;
}

double missing(const Case& value) {
  const auto found = formats::measureReachability(value.tree, formats::caseField(value));
  return found.total - found.reachable;
}

/// The blobs of a node.
TEST(OpenEdges, OpensAnEdgeThatIsClosed) {
  Case value = closedTube();
  ASSERT_GT(missing(value), 5);
  openEdges(value);
  EXPECT_EQ(missing(value), 0);
}

TEST(OpenEdges, LeavesOpenTreesAsTheyAre) {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 11), 1);
  const Case before = value;
  openEdges(value);
  EXPECT_EQ(value, before);
}

TEST(OpenEdges, AddsToTheNodesOfTheEdgeAndChangesNothingElse) {
  const Case before = closedTube();
  Case value = before;
  openEdges(value);
  EXPECT_EQ(value.tree, before.tree);
  for (std::uint32_t node = 0; node < before.tree.nodeCount(); ++node) {
    auto blobs = test::blobsOf(value, node);
    if (node == 10 || node == 11) {
      ASSERT_GE(blobs.size(), 2U);
      blobs.resize(1);
    }
    EXPECT_EQ(blobs, test::blobsOf(before, node)) << node;
  }
}

TEST(OpenEdges, StaysWithinTheTube) {
  Case value = closedTube();
  openEdges(value);
  const field::BlendedField field = formats::caseField(value);
  for (double x = 5; x <= 7.4; x += 0.05)
    for (int i = 0; i < 16; ++i) {
      const double angle = 0.3926991 * i;
      const field::Vec wall{x, 1.02 * std::cos(angle), 1.02 * std::sin(angle)};
      EXPECT_LT(field.blended(wall, field.follow(wall, x < 6.2 ? 10 : 11)).value, field.level())
          << x;
    }
}

TEST(OpenEdges, MakesNoBulgeOfAThinVessel) {
  // of radius 0.2 and T = 0.1 mm, closed by a gap of a tenth of the radius
  Case value = formats::test::noBeads();
  auto places = alongX(0, 0.1F, 11);
  for (const auto& place : alongX(1.42F, 0.1F, 11)) places.push_back(place);
  addBeads(value, "a", places, 0.2F);
  ASSERT_GT(missing(value), 1);
  openEdges(value);
  EXPECT_EQ(missing(value), 0);
  const field::BlendedField field = formats::caseField(value);
  for (double x = 1; x <= 1.42; x += 0.02) {
    const field::Vec wall{x, 0.21, 0};
    EXPECT_LT(field.blended(wall, field.follow(wall, x < 1.21 ? 10 : 11)).value, field.level())
        << x;
  }
}

TEST(OpenEdges, OpensAVesselThatBeginsAlongAnotherOneHoweverLongTheStretchIs) {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 81), 1);
  std::vector<formats::Vec3f> places = alongX(0.5F, 0.4F, 70, 0.4F);
  for (std::size_t k = 0; k < places.size(); ++k) places[k].y += 0.025F * static_cast<float>(k);
  addBeads(value, "b", places, 0.5F, 0);
  ASSERT_GT(missing(value), 5);
  openEdges(value);
  EXPECT_EQ(missing(value), 0);
}

TEST(OpenEdges, OpensARootsOwnCentre) {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 5), 1);
  value.models->centre[0].y = 1.1F;
  ASSERT_EQ(missing(value), 2);
  openEdges(value);
  EXPECT_EQ(missing(value), 0);
}

TEST(OpenEdges, KeepsVesselsThatTouchApart) {
  Case value = closedTube();
  const std::uint32_t other = addBeads(value, "b", alongX(0, 0.5F, 40, 2), 1);
  openEdges(value);
  EXPECT_EQ(missing(value), 0);
  const field::BlendedField field = formats::caseField(value);
  // across the place where they touch, beside the opening, from either side
  for (const bool upwards : {true, false}) {
    std::uint32_t cursor = upwards ? 10 : other + 12;
    bool left = false;
    for (double y = upwards ? 0 : 2; upwards ? y <= 2 : y >= 0; y += upwards ? 0.05 : -0.05) {
      const field::Vec point{6.2, y, 0};
      cursor = field.follow(point, cursor);
      left = left || field.blended(point, cursor).value <= field.level();
    }
    EXPECT_TRUE(left);
    EXPECT_EQ(cursor < other, upwards);
  }
}

}  // namespace
}  // namespace lumen::convert
