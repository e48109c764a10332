// SPDX-License-Identifier: Apache-2.0
#include "formats/case/reachability.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "formats/case/case_field.h"
#include "formats/case/validate.h"
#include "tests/unit/formats/beads.h"

namespace lumen::formats {
namespace {

using test::addBeads;
using test::alongX;
using test::noBeads;

Reachability reach(const Case& value) {
  EXPECT_TRUE(validate(value));
  return measureReachability(value.tree, caseField(value));
}

/// Eleven beads of radius 1 along x, half a radius apart, and as many beyond a gap of that length.
Case beadsWithGap(float gap) {
  Case value = noBeads();
  std::vector<Vec3f> places = alongX(0, 0.5F, 11);
  for (const Vec3f& place : alongX(5 + gap, 0.5F, 11)) places.push_back(place);
  addBeads(value, "a", places, 1);
  return value;
}

TEST(Reachability, OfAnOpenTubeIsAllOfIt) {
  Case value = noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 21), 1);
  const Reachability found = reach(value);
  EXPECT_NEAR(found.total, 10, 1e-6);
  EXPECT_NEAR(found.reachable, 10, 1e-6);
  EXPECT_TRUE(found.barriers.empty());
}

TEST(Reachability, EndsWhereTheWayLeavesTheLumenFirst) {
  // balls of radius 1 at x = 5 and x = 8: the way leaves the lumen at x = 6
  const Reachability found = reach(beadsWithGap(3));
  EXPECT_NEAR(found.total, 13, 1e-6);
  EXPECT_NEAR(found.reachable, 5, 1e-6);
  ASSERT_EQ(found.barriers.size(), 1U);
  EXPECT_EQ(found.barriers[0].node, 11U);
  EXPECT_GE(found.barriers[0].place.x, 6);
  EXPECT_LE(found.barriers[0].place.x, 6 + 1.0 / 32 + 1e-6);
  EXPECT_NEAR(found.barriers[0].beyond, 3 + 5, 1e-6);
}

TEST(Reachability, MissesNoWallOfAFifthOfTheRadius) {
  EXPECT_EQ(reach(beadsWithGap(2.2F)).barriers.size(), 1U);
  EXPECT_TRUE(reach(beadsWithGap(1.9F)).barriers.empty());
}

TEST(Reachability, StepsByAThirtySecondOfTheThinnerNode) {
  // beads of radius 2 and 1 with a way of 8 outside of both: each step there is reported
  Case value = noBeads();
  addBeads(value, "wide", {{0, 0, 0}, {0.5F, 0, 0}}, 2);
  addBeads(value, "thin", {{11.5F, 0, 0}, {12, 0, 0}}, 1, 1);
  ASSERT_TRUE(validate(value));
  std::size_t steps = 0;
  findClosedPlaces(value.tree, caseField(value), [&](const ClosedPlace& place) {
    EXPECT_EQ(place.node, 2U);
    ++steps;
    return true;
  });
  EXPECT_NEAR(static_cast<double>(steps), 8 * 32, 8);
}

TEST(Reachability, NamesTheFirstBarrierOfEachWayOnly) {
  Case value = beadsWithGap(3);
  addBeads(value, "open", {{2, 1.5F, 0}, {2, 2, 0}}, 1, 4);
  addBeads(value, "closed", {{2, -4, 0}, {2, -4.5F, 0}}, 1, 4);
  addBeads(value, "beyond", {{10, -4, 0}, {10, -4.5F, 0}}, 1, 15);
  const Reachability found = reach(value);
  ASSERT_EQ(found.barriers.size(), 2U);
  EXPECT_EQ(found.barriers[0].node, 11U);
  EXPECT_EQ(found.barriers[1].node, value.tree.branches[2].firstNode);
  // of a branch's first edge what lies outside of the parent's ball counts
  EXPECT_NEAR(found.barriers[0].beyond, 8 + 3 + 0.5, 1e-6);
  EXPECT_NEAR(found.barriers[1].beyond, 3 + 0.5, 1e-6);
  EXPECT_NEAR(found.reachable, 5 + 0.5 + 0.5, 1e-6);
  EXPECT_NEAR(found.reachable + found.barriers[0].beyond + found.barriers[1].beyond, found.total,
              1e-6);
}

TEST(Reachability, AddsUpWhatIsReachedFromAllRoots) {
  Case value = beadsWithGap(3);
  const std::uint32_t other = addBeads(value, "b", alongX(0, 0.5F, 5, 10), 1);
  const Reachability found = reach(value);
  EXPECT_NEAR(found.reachable, 5 + 2, 1e-6);
  ASSERT_EQ(found.barriers.size(), 1U);
  EXPECT_LT(found.barriers[0].node, other);
}

TEST(Reachability, OfATreeWhoseRootIsOutsideIsNothing) {
  Case value = noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 5), 1);
  value.models->centre[0].y = 1.5F;
  const Reachability found = reach(value);
  EXPECT_EQ(found.reachable, 0);
  ASSERT_EQ(found.barriers.size(), 1U);
  EXPECT_EQ(found.barriers[0].node, 0U);
  EXPECT_EQ(found.barriers[0].place.x, 0);
  EXPECT_NEAR(found.barriers[0].beyond, 2, 1e-6);
}

TEST(Reachability, OfATreeWithoutAnyBlobIsNothing) {
  Case value = noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 5), 1);
  value.models = BlobbyModels{Kernel::Cauchy, 0.2, 0.1, std::vector<std::uint32_t>(6, 0), {}, {}};
  EXPECT_EQ(reach(value).reachable, 0);
}

/// A hairpin along x in one branch, whose legs are 0.8 mm apart and so in one another's lumen. The
/// second leg has a gap of 3 mm, 8 mm from its turn.
Case hairpinWithGap() {
  std::vector<Vec3f> places = alongX(0, 0.5F, 41);
  places.push_back({20.2F, 0.4F, 0});
  for (const Vec3f& place : alongX(20, -0.5F, 17, 0.8F)) places.push_back(place);
  for (const Vec3f& place : alongX(9, -0.5F, 19, 0.8F)) places.push_back(place);
  Case value = noBeads();
  addBeads(value, "a", places, 1);
  return value;
}

TEST(Reachability, IsNotOpenedByAnotherStretchOfTheTree) {
  const Case value = hairpinWithGap();
  const field::BlendedField field = caseField(value);
  const Reachability found = measureReachability(value.tree, field);
  ASSERT_EQ(found.barriers.size(), 1U);
  const Barrier& barrier = found.barriers[0];
  EXPECT_EQ(barrier.node, 41U + 1 + 17);
  // whoever asks without having followed is told of the leg beside it
  EXPECT_GT(field.blended(barrier.place, field.locate(barrier.place)).value, field.level());
}

TEST(ClosedPlaces, HaveTheCursorThatFollowedFromTheRoot) {
  const Case value = hairpinWithGap();
  std::vector<ClosedPlace> closed;
  findClosedPlaces(value.tree, caseField(value), [&](const ClosedPlace& place) {
    closed.push_back(place);
    return true;
  });
  ASSERT_FALSE(closed.empty());
  for (const ClosedPlace& place : closed) {
    EXPECT_EQ(place.node, 59U);
    EXPECT_GE(place.cursor, 57U);  // on its own leg
    EXPECT_NEAR(place.place.x, 10.5, 0.5 + 1e-6);
  }
  EXPECT_GE(closed.size(), 7U);  // 1 mm in steps of an eighth
}

TEST(ClosedPlaces, AreBoundedOnAnEdgeThatIsLongBeyondReason) {
  Case value = noBeads();
  addBeads(value, "a", {{0, 0, 0}, {3e38F, 0, 0}}, 1e-30F);
  std::size_t told = 0, checked = 0;
  findClosedPlaces(
      value.tree, caseField(value),
      [&](const ClosedPlace&) {
        ++told;
        return true;
      },
      [&] { ++checked; });
  EXPECT_LE(told, 513U);
  EXPECT_EQ(checked, 2U);
}

TEST(ClosedPlaces, AreGivenUpWhenTheCheckThrows) {
  const Case value = beadsWithGap(3);
  const auto stop = [] { throw std::runtime_error("stop"); };
  EXPECT_THROW(measureReachability(value.tree, caseField(value), stop), std::runtime_error);
}

}  // namespace
}  // namespace lumen::formats
