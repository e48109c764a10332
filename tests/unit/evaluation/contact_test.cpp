// SPDX-License-Identifier: Apache-2.0
// Counts of contact_bench on two tubes that touch: the exact field knows them apart, a grid does not.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "blob.h"
#include "exact_field.h"
#include "formats/case/case.h"
#include "measure.h"
#include "method.h"
#include "signed_mesh.h"
#include "tally.h"
#include "vessel.h"
#include "wires.h"

namespace lumen::bench {
namespace {

constexpr float kRadius = 1.0f, kApart = 1.9f;  // the lumens overlap by a tenth of a radius

formats::Case straightTube(float y) {
  std::vector<formats::Vec3f> line;
  for (int i = 0; i <= 80; ++i) line.push_back({0.5f * static_cast<float>(i), y, 0});
  return tubeAlong(line, 0.5, static_cast<double>(kRadius));
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

// A forest of two trees.
formats::Case twoTubes() {
  formats::Case result = straightTube(0);
  const formats::Case other = straightTube(kApart);
  const auto nodes = static_cast<std::uint32_t>(result.tree.nodeCount());
  append(result.tree.centre, other.tree.centre);
  append(result.tree.direction, other.tree.direction);
  append(result.tree.radius, other.tree.radius);
  append(result.tree.height, other.tree.height);
  for (const std::int32_t parent : other.tree.parent)
    result.tree.parent.push_back(parent < 0 ? parent : parent + static_cast<std::int32_t>(nodes));
  result.tree.branch.insert(result.tree.branch.end(), nodes, 1);
  result.tree.branches.push_back(other.tree.branches.front());
  result.tree.branches.back().label = "other";
  result.tree.branches.back().firstNode = nodes;
  const auto blobs = static_cast<std::uint32_t>(result.models->centre.size());
  for (std::size_t i = 1; i < other.models->offset.size(); ++i)
    result.models->offset.push_back(blobs + other.models->offset[i]);
  append(result.models->centre, other.models->centre);
  append(result.models->width, other.models->width);
  return result;
}

Vessel vesselOf(const OwnedVessel& owned) {
  Vessel vessel = owned.vessel;
  vessel.gridCell = 0.1;
  return vessel;
}

TEST(ContactTally, CountsOnlyWhatIsBeyondTheTolerance) {
  // tolerance 0.05 mm; a wire of 0.178 mm touches where its distance is more than -0.178 mm
  const std::vector<Truth> truth{{0.06, 1},  {0.04, 1},  {-0.06, 1}, {-0.04, 1},
                                 {-0.30, 1}, {-0.20, 1}, {-0.10, 1}, {-0.15, 1}};
  const double distance[] = {-0.01, -0.01, 0.01, 0.01, -0.1, -0.1, -0.2, -0.2};
  Tally tally;
  countWires(truth, distance, tally);
  EXPECT_EQ(tally.points, 8U);
  EXPECT_EQ(tally.wrongSigns, 2U);     // 0 and 2
  EXPECT_EQ(tally.falseContacts, 1U);  // 4
  EXPECT_EQ(tally.missed, 1U);         // 6
  const std::vector<Truth> inside{{-0.5, 1}};
  const double none[] = {std::nan("")};
  countWires(inside, none, tally);
  EXPECT_EQ(tally.wrongSigns, 3U);
  EXPECT_EQ(tally.falseContacts, 2U);
}

TEST(ContactExactField, KnowsTouchingTubesApart) {
  const ExactField exact(twoTubes());
  const std::uint32_t own = 40, other = 81 + 40;
  const double between[] = {20, 0.95, 0}, across[] = {20, 1.9, 0}, beyond[] = {20, 4, 0};
  EXPECT_NEAR(exact.distance(own, between), -0.05, 5e-3);
  EXPECT_NEAR(exact.distance(other, between), -0.05, 5e-3);
  EXPECT_NEAR(exact.distance(own, across), 0.9, 5e-3);
  EXPECT_NEAR(exact.ownDistance(own, across), 0.9, 5e-3);
  EXPECT_NEAR(exact.otherVessel(own, across).distance, -1.0, 5e-3);
  EXPECT_EQ(exact.otherVessel(own, across).node, other);
  EXPECT_NEAR(exact.otherVessel(own, beyond).distance, 1.1, 5e-3);
  // four times the sum of both radii is 8 mm: 16 nodes to either side
  EXPECT_EQ(exact.vesselOf(own).front(), 24U);
  EXPECT_EQ(exact.vesselOf(own).back(), 56U);
  EXPECT_EQ(exact.vesselOf(own).size(), 33U);
}

TEST(ContactLeaks, AGridLeaksWhereVesselsTouchAndACursorDoesNot) {
  const OwnedVessel owned = openVessel(twoTubes(), "two tubes");
  const Vessel vessel = vesselOf(owned);
  const ExactField exact(owned.source);
  const std::vector<Kiss> kisses = findKisses(exact, owned.source.tree, 3000, 100);
  ASSERT_EQ(kisses.size(), 100U);
  for (const Kiss& kiss : kisses) {
    const bool isFirst = kiss.station < 81;
    EXPECT_LT(exact.distance(kiss.station, kiss.inside), 0);
    if (kiss.pushed[0] < 3 || kiss.pushed[0] > 37) continue;  // ends are wider
    // in the lumen of the other tube alone
    EXPECT_GT(std::hypot(kiss.pushed[1] - (isFirst ? 0 : 1.9), kiss.pushed[2]), 1.04);
    EXPECT_LT(std::hypot(kiss.pushed[1] - (isFirst ? 1.9 : 0), kiss.pushed[2]), 0.96);
  }
  Methods grid;
  addGrid(grid);
  grid.front()->prepare(vessel);
  Tally merged;
  countLeaks(*grid.front(), kisses, merged);
  EXPECT_EQ(merged.kisses, 100U);
  EXPECT_EQ(merged.leaks, 100U);
  for (const std::uint32_t flags : {BLOB_BLENDED, BLOB_LOCAL, BLOB_DISTANCE_EXACT})
    for (const BlobCall call : {BlobCall::Single, BlobCall::Samples, BlobCall::Columns}) {
      const auto method = blobMethod("libblob", flags, call);
      method->prepare(vessel);
      Tally tally;
      countLeaks(*method, kisses, tally);
      EXPECT_EQ(tally.leaks, 0U) << flags;
    }
}

TEST(ContactWires, LieFromTheAxisToJustPastTheWallAndMoveALittle) {
  const OwnedVessel owned = openVessel(twoTubes(), "two tubes");
  WireOptions options;
  options.environments = 20;
  options.points = 50;
  const Wires wires = makeWires(owned.source.tree, owned.vessel.model, options);
  ASSERT_EQ(wires.count(), 1000U);
  EXPECT_EQ(makeWires(owned.source.tree, owned.vessel.model, options).position, wires.position);
  options.seed = 2;
  EXPECT_NE(makeWires(owned.source.tree, owned.vessel.model, options).position, wires.position);
  const ExactField exact(owned.source);
  const std::vector<Truth> truth = computeTruth(exact, wires, wires.frames() - 1, 20);
  const auto share = [&](auto holds) {
    return static_cast<double>(std::count_if(truth.begin(), truth.end(), holds)) / 1000;
  };
  EXPECT_NEAR(share([](const Truth& t) { return t.distance > 0; }), 0.14, 0.04);
  EXPECT_NEAR(share([](const Truth& t) { return std::abs(t.distance) < 0.1; }), 0.3, 0.06);
  EXPECT_EQ(share([](const Truth& t) { return t.distance > 0.06; }), 0);
  for (std::size_t frame = 1; frame < wires.frames(); ++frame)
    for (std::size_t i = 0; i < 3000; ++i)
      ASSERT_LT(std::abs(wires.position[frame][i] - wires.position[frame - 1][i]), 0.1);
}

TEST(ContactMeasure, EveryThreadsWiresAreAnsweredInTheirPlace) {
  const OwnedVessel owned = openVessel(twoTubes(), "two tubes");
  WireOptions options;
  options.environments = 3;
  options.points = 10;
  options.frames = 3;
  const Wires wires = makeWires(owned.source.tree, owned.vessel.model, options);
  const auto method = blobMethod("libblob", BLOB_BLENDED, BlobCall::Columns);
  method->prepare(owned.vessel);
  AnswerBuffer answers(wires.count());
  placeWires(*method, wires, 3);
  Stepper first(*method, wires, 0, 1, answers), rest(*method, wires, 1, 2, answers);
  std::vector<std::size_t> frames;
  for (int i = 0; i < 6; ++i) {
    first.step();
    rest.step();
    frames.push_back(rest.frame());
  }
  EXPECT_EQ(frames, (std::vector<std::size_t>{0, 1, 2, 1, 0, 1}));
  for (std::size_t i = 0; i < wires.count(); ++i) {
    std::uint32_t cursor = wires.station[1][i];
    blob_sample sample;
    blob_query(owned.vessel.model, 0, &wires.position[1][3 * i], &cursor, &sample);
    EXPECT_EQ(answers.distance()[i], sample.distance);
    EXPECT_EQ(answers.from(0).normal[1][i], sample.normal[1]);
  }
}

// A needle: near its tip faces' own normals mistake outside for inside.
TEST(ContactSignedMesh, SignsAreRightAroundSharpCorners) {
  Triangles mesh;
  mesh.closed = true;
  mesh.vertex = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2f, 0.2f, 8}};
  mesh.face = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  SignedMesh signs;
  signs.prepare(mesh);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> share(0, 1);
  int inside = 0;
  for (int n = 0; n < 20000; ++n) {
    const float p[3] = {3 * share(random) - 1, 3 * share(random) - 1, 11 * share(random) - 1};
    float best[3] = {}, nearest = 1e9f;
    std::uint32_t face = 0;
    Feature feature = Feature::Face;
    for (std::uint32_t f = 0; f < 4; ++f) {
      float q[3];
      const Feature at = signs.closest(p, f, q);
      if (const float d = squareOf(p, q); d < nearest) {
        nearest = d;
        face = f;
        feature = at;
        std::copy(q, q + 3, best);
      }
    }
    double distance, normal[3];
    signs.answer(p, best, face, feature, 0, {&distance, {normal, normal + 1, normal + 2}});
    // the needle is what lies below all four planes
    const float z = p[2], t = 1 - z / 8;
    const float low = 0.2f * z / 8, x = p[0] - low, y = p[1] - low;
    const bool isInside = z > 0 && x > 0 && y > 0 && x + y < t;
    ASSERT_EQ(distance < 0, isInside) << p[0] << " " << p[1] << " " << p[2];
    inside += isInside ? 1 : 0;
    ASSERT_NEAR(std::hypot(normal[0], normal[1], normal[2]), 1, 1e-5);
  }
  EXPECT_GT(inside, 100);
}

}  // namespace
}  // namespace lumen::bench
