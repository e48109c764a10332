// SPDX-License-Identifier: Apache-2.0
// Value, gradient and distance along paths that cross seams between models that disagree.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "blob.h"
#include "tree.h"

namespace lumen::blob::test {
namespace {

// Smoothness is promised in the lumen and a little beyond the wall, mm.
constexpr double kOutside = 0.3;

struct Jumps {
  double value = 0, gradient = 0, distance = 0;
  int seams = 0;
};

Point between(const Point& a, const Point& b, double t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

// Adds the differences between what two nodes answer at one point.
void compare(const Model& model, std::uint32_t flags, const Point& p, std::uint32_t a,
             std::uint32_t b, Jumps& jumps) {
  blob_sample s, t;
  blob_query(model.get(), flags | BLOB_HOLD, p.data(), &a, &s);
  blob_query(model.get(), flags | BLOB_HOLD, p.data(), &b, &t);
  if (s.distance > kOutside) return;
  double change[3];
  for (int i = 0; i < 3; ++i) change[i] = s.gradient[i] - t.gradient[i];
  jumps.value = std::max(jumps.value, std::abs(s.value - t.value));
  jumps.gradient = std::max(jumps.gradient, norm(change));
  jumps.distance = std::max(jumps.distance, std::abs(s.distance - t.distance));
  ++jumps.seams;
}

// Walks from one point to another and compares the two nodes wherever the cursor changes.
Jumps sweep(const Model& model, std::uint32_t flags, const Point& from, const Point& to) {
  constexpr int kSteps = 20000;
  Jumps jumps;
  std::uint32_t cursor = blob_cursor_locate(model.get(), from.data());
  for (int n = 1; n <= kSteps; ++n) {
    const std::uint32_t before = cursor;
    double low = static_cast<double>(n - 1) / kSteps, high = static_cast<double>(n) / kSteps;
    cursor = blob_cursor_follow(model.get(), between(from, to, high).data(), before);
    if (cursor == before) continue;
    while (high - low > 1e-12) {
      const double middle = 0.5 * (low + high);
      const bool moved =
          blob_cursor_follow(model.get(), between(from, to, middle).data(), before) != before;
      (moved ? high : low) = middle;
    }
    compare(model, flags, between(from, to, high), before, cursor, jumps);
  }
  return jumps;
}

struct Stop {
  double t;
  std::uint32_t cursor;
  blob_sample sample;
};

double changeOf(const Stop& a, const Stop& b) {
  double change[3];
  for (int i = 0; i < 3; ++i) change[i] = a.sample.gradient[i] - b.sample.gradient[i];
  return std::abs(a.sample.value - b.sample.value) + norm(change);
}

// The greatest change of value and gradient that remains when each step of a walk in the lumen is
// halved until nothing is left of it, always keeping the half with the greater change. Continuous
// functions leave nothing.
double jumpAnywhere(const Model& model, const Point& from, const Point& to) {
  constexpr int kSteps = 200, kHalvings = 36;
  const auto stopAt = [&](double t, std::uint32_t cursor) {
    Stop stop{t, cursor, {}};
    blob_query(model.get(), BLOB_BLENDED, between(from, to, t).data(), &stop.cursor, &stop.sample);
    return stop;
  };
  double greatest = 0;
  Stop last = stopAt(0, BLOB_NOWHERE);
  for (int n = 1; n <= kSteps; ++n) {
    const Stop next = stopAt(static_cast<double>(n) / kSteps, last.cursor);
    Stop low = last, high = next;
    for (int k = 0; k < kHalvings; ++k) {
      const Stop middle = stopAt(0.5 * (low.t + high.t), low.cursor);
      (changeOf(low, middle) >= changeOf(middle, high) ? high : low) = middle;
    }
    if (low.sample.distance < 0) greatest = std::max(greatest, changeOf(low, high));
    last = next;
  }
  return greatest;
}

// Widths of neighbours differ by 10 %: the models disagree by a tenth of the radius.
TEST(BlobSeam, LocalModelsJump) {
  const Jumps jumps = sweep(tube(12, 0.05).build(), BLOB_LOCAL, {0, 0.8, 0}, {6, 0.8, 0});
  EXPECT_EQ(jumps.seams, 10);
  EXPECT_GT(jumps.distance, 0.05);
}

TEST(BlobSeam, BlendedModelsDoNotJumpAlongATube) {
  const Jumps jumps = sweep(tube(12, 0.05).build(), BLOB_BLENDED, {0, 0.8, 0}, {6, 0.8, 0});
  EXPECT_EQ(jumps.seams, 10);
  EXPECT_LT(jumps.value, 1e-6);
  EXPECT_LT(jumps.gradient, 2e-6);
  EXPECT_LT(jumps.distance, 2e-6);
}

TEST(BlobSeam, BlendedModelsDoNotJumpThroughAFork) {
  for (const double halfAngle : {0.4, 0.7, 1.2}) {
    const Model model = fork(halfAngle, 0.04).build();
    for (const double z : {0.0, 0.5}) {
      const double x = 3 * std::cos(halfAngle), y = 3 * std::sin(halfAngle);
      for (const double side : {1.0, -1.0}) {
        const Jumps along = sweep(model, BLOB_BLENDED, {-3, 0.3, z}, {x, side * y, z});
        EXPECT_LT(along.value, 1e-6) << halfAngle;
        EXPECT_LT(along.gradient, 1e-5) << halfAngle;
      }
      const Jumps across = sweep(model, BLOB_BLENDED, {1.0, 0.9, z}, {1.0, -0.9, z});
      EXPECT_LT(across.value, 1e-6) << halfAngle;
      EXPECT_LT(across.gradient, 1e-5) << halfAngle;
    }
  }
}

// Floats leave a rounding of up to 3e-5: weights change by their whole in 0.04 mm^2 of power here.
TEST(BlobSeam, NothingJumpsAnywhereInATightBendOrAFork) {
  const Model bent = bend(0.05).build(), forked = fork(0.5, 0.04).build();
  for (int i = 0; i < 24; ++i) {
    const double a = 0.2618 * i, z = 0.07 * (i % 7) - 0.2;
    const Point from{0.4 + 2 * std::cos(a), 0.5 + 2 * std::sin(a), z};
    const Point to{0.4 - 2 * std::cos(a + 0.3), 0.5 - 2 * std::sin(a + 0.3), 0.4};
    EXPECT_LT(jumpAnywhere(bent, from, to), 1e-4) << i;
    EXPECT_LT(jumpAnywhere(forked, from, to), 1e-4) << i;
  }
}

// The value does not depend on which of the nodes near the point is the cursor.
TEST(BlobSeam, ABlendedValueIsTheSameFromEitherNodeOfASeam) {
  const Model model = tube(12, 0.05).build();
  const Point p{3.3, 0.4, -0.6};  // half way between nodes 5 and 6
  std::uint32_t a = 5, b = 6;
  blob_sample fromA, fromB;
  blob_query(model.get(), BLOB_HOLD, p.data(), &a, &fromA);
  blob_query(model.get(), BLOB_HOLD, p.data(), &b, &fromB);
  EXPECT_NEAR(fromA.value, fromB.value, 1e-7);
  EXPECT_NEAR(fromA.distance, fromB.distance, 1e-6);
}

TEST(BlobSeam, AtANodeOfAStraightTubeItsModelAnswersAlone) {
  const Model model = tube(12, 0.05).build();
  const Point p{3.0, 0.7, 0};  // the plane of node 5
  std::uint32_t a = 5, b = 5;
  blob_sample blended, local;
  blob_query(model.get(), BLOB_BLENDED, p.data(), &a, &blended);
  blob_query(model.get(), BLOB_LOCAL, p.data(), &b, &local);
  EXPECT_NEAR(blended.value, local.value, 1e-7);
}

// A hub and ten leaves, more neighbours than one block of lanes. The last leaf, close to the hub,
// beats it by tau; the others are its rivals and would have weights.
// A hub with more neighbours than fit into a block, in all directions and at many distances.
Tree hub() {
  constexpr int kArms = 14;
  Tree tree;
  const std::int32_t middle = tree.addNode({0, 0, 0}, 1);
  tree.addBlob({0, 0, 0}, 0.5);
  for (int n = 0; n < kArms; ++n) {
    const double z = 1 - (2 * n + 1.0) / kArms, across = std::sqrt(1 - z * z), turn = 2.4 * n;
    const Point side = {across * std::cos(turn), across * std::sin(turn), z};
    std::int32_t parent = middle;
    for (int k = 1; k <= 3; ++k) {
      const double away = (0.5 + 0.05 * n) * k;
      const Point at = {away * side[0], away * side[1], away * side[2]};
      parent = tree.addNode(at, 0.9 - 0.02 * n, parent);
      tree.addBlob(at, 0.4 + 0.02 * n);
    }
  }
  return tree;
}

TEST(BlobSeam, ANodeOfManyNeighboursBlendsWithAllOfThem) {
  const Model model = hub().build();
  std::array<std::uint32_t, 64> around{};
  const std::size_t count = blob_model_neighbours(model.get(), 0, around.data(), around.size());
  ASSERT_GT(count, 16U);
  EXPECT_TRUE(std::is_sorted(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(count)));
  std::uint64_t state = 1;
  const auto uniform = [&state] {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 11) / 9007199254740992.0;
  };
  for (int n = 0; n < 20000; ++n) {
    const Point p = {3 * uniform() - 1.5, 3 * uniform() - 1.5, 3 * uniform() - 1.5};
    std::uint32_t cursor = BLOB_NOWHERE;
    blob_sample sample;
    blob_query(model.get(), BLOB_BLENDED, p.data(), &cursor, &sample);
    // in doubles, from all neighbours of each node
    blob_hessian all;
    blob_query_hessian(model.get(), BLOB_BLENDED | BLOB_HOLD, p.data(), &cursor, &all);
    double change[3];
    for (int i = 0; i < 3; ++i) change[i] = sample.gradient[i] - all.gradient[i];
    ASSERT_NEAR(sample.value, all.value, 1e-5 * all.value) << p[0] << " " << p[1] << " " << p[2];
    ASSERT_LT(norm(change), 1e-4 * norm(all.gradient) + 1e-5 * all.value)
        << p[0] << " " << p[1] << " " << p[2];
  }
}

TEST(BlobSeam, AHeldNodeWithoutWeightAnswersAlone) {
  Tree tree;
  tree.addNode({0, 0, 0}, 0.6);
  tree.addBlob({0, 0, 0}, 0.3);
  for (int leaf = 1; leaf <= 10; ++leaf) {
    const double angle = 0.7 * leaf;
    const Point far{0.5, 0.8 * std::cos(angle), 0.8 * std::sin(angle)}, close{0.5, 0, 0};
    tree.addNode(leaf == 10 ? close : far, leaf == 10 ? 0.6 : 0.97, 0);
    tree.addBlob(leaf == 10 ? close : far, 0.3 + 0.02 * leaf);
  }
  const Model model = tree.build();
  const Point p{0.45, 0, 0};
  std::uint32_t hub = 0;
  blob_sample blended, local;
  blob_query(model.get(), BLOB_BLENDED | BLOB_HOLD, p.data(), &hub, &blended);
  blob_query(model.get(), BLOB_LOCAL | BLOB_HOLD, p.data(), &hub, &local);
  EXPECT_TRUE(sameBits(blended, local));
}

// A second vessel that touches changes nothing, not even the last bit.
TEST(BlobSeam, AVesselThatTouchesHasNoInfluence) {
  const Model both = kissing(0.0).build();
  const Model alone = tube(30).build();
  std::uint32_t a = 0, b = 0;
  for (int n = 0; n < 1000; ++n) {
    const Point p{0.0174 * n, 0.99, 0.1};
    blob_sample s, t;
    blob_query(both.get(), BLOB_BLENDED, p.data(), &a, &s);
    blob_query(alone.get(), BLOB_BLENDED, p.data(), &b, &t);
    ASSERT_TRUE(sameBits(s, t)) << n;
  }
}

}  // namespace
}  // namespace lumen::blob::test
