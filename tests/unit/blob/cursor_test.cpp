// SPDX-License-Identifier: Apache-2.0
// Cursors, and points beyond 1e9 mm, where f counts as zero, on every back end.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "blob.h"
#include "tree.h"

namespace lumen::blob::test {
namespace {

constexpr double kBeyond = 1.5e9;  // mm; f of a Cauchy kernel is not yet zero there
constexpr double kWithin = 0.5e9;  // mm

class FarPoint : public testing::TestWithParam<std::tuple<blob_simd, std::size_t, double>> {
protected:
  void SetUp() override {
    m_model = tube(12, 0.1).build(std::get<0>(GetParam()));
    if (blob_model_describe(m_model.get()).simd != std::get<0>(GetParam()))
      GTEST_SKIP() << "this processor or build does not have the back end";
  }

  /// A point of that coordinate along the axis and sign of the test, in the tube along the others.
  [[nodiscard]] static Point at(double coordinate) {
    const auto [simd, axis, sign] = GetParam();
    Point p{3, 0.1, 0.2};
    p[axis] = sign * coordinate;
    return p;
  }

  static void expectFar(const blob_sample& sample) {
    const auto [simd, axis, sign] = GetParam();
    EXPECT_EQ(sample.value, 0.0);
    EXPECT_EQ(sample.state, 0U);
    EXPECT_NEAR(sample.distance, kBeyond, 10.0);
    EXPECT_NEAR(sample.normal[axis], sign, 1e-6);
  }

  Model m_model;
};

TEST_P(FarPoint, BeyondTheRangeFIsZeroForOnePoint) {
  for (const std::uint32_t start : {5U, BLOB_NOWHERE}) {
    std::uint32_t cursor = start;
    blob_sample sample;
    blob_query(m_model.get(), 0, at(kBeyond).data(), &cursor, &sample);
    expectFar(sample);
  }
}

// Eight at once with known cursors, the last of which is far.
TEST_P(FarPoint, BeyondTheRangeFIsZeroForOneOfEight) {
  for (std::size_t lane = 0; lane < 8; ++lane) {
    std::vector<Point> points(8, Point{3, 0.1, 0.2});
    points[lane] = at(kBeyond);
    std::array<std::uint32_t, 8> cursors;
    cursors.fill(5);
    std::array<blob_sample, 8> samples;
    blob_query_many(m_model.get(), 0, points.size(),
                    reinterpret_cast<const double(*)[3]>(points.data()), cursors.data(),
                    samples.data());
    expectFar(samples[lane]);
    EXPECT_LT(samples[(lane + 1) % 8].distance, 0.0) << "the other lanes are in the tube";
  }
}

TEST_P(FarPoint, WithinTheRangeFIsNotZero) {
  std::uint32_t cursor = 5;
  blob_sample sample;
  blob_query(m_model.get(), 0, at(kWithin).data(), &cursor, &sample);
  EXPECT_GT(sample.value, 0.0);
  EXPECT_NEAR(sample.distance / kWithin, 1.0, 1e-3);
}

std::string nameOf(const testing::TestParamInfo<FarPoint::ParamType>& info) {
  const auto [simd, axis, sign] = info.param;
  const char* const backEnds[] = {"Best", "Scalar", "Portable", "Avx2", "Avx512"};
  return std::string(backEnds[simd]) + (sign > 0 ? "Plus" : "Minus") + "XYZ"[axis];
}

INSTANTIATE_TEST_SUITE_P(All, FarPoint,
                         testing::Combine(testing::Values(BLOB_SIMD_SCALAR, BLOB_SIMD_PORTABLE,
                                                          BLOB_SIMD_AVX2, BLOB_SIMD_AVX512),
                                          testing::Values(0U, 1U, 2U), testing::Values(1.0, -1.0)),
                         nameOf);

double power(const Tree& tree, std::size_t node, const Point& p) {
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double d = p[i] - double{tree.centre[node][i]};
    square += d * d;
  }
  return square - double{tree.radius[node]} * double{tree.radius[node]};
}

std::uint32_t leastPower(const Tree& tree, const Point& p) {
  std::uint32_t best = 0;
  for (std::uint32_t i = 1; i < tree.centre.size(); ++i)
    if (power(tree, i, p) < power(tree, best, p)) best = i;
  return best;
}

Tree scattered(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-30, 30), r(0.2, 3);
  Tree tree;
  for (int i = 0; i < count; ++i) tree.addNode({u(random), u(random), u(random)}, r(random));
  tree.offset.back() = 0;
  return tree;
}

TEST(BlobLocate, IsTheNodeOfLeastPowerForEverySizeOfTree) {
  for (const int count : {1, 2, 7, 8, 9, 63, 64, 65, 513, 5000}) {
    const Tree tree = scattered(count, static_cast<unsigned>(count));
    const Model model = tree.build();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> u(-45, 45);
    for (int n = 0; n < 300; ++n) {
      const Point p{u(random), u(random), u(random)};
      ASSERT_EQ(blob_cursor_locate(model.get(), p.data()), leastPower(tree, p)) << count;
    }
  }
}

// Where the search in floats separates few nodes, or none.
TEST(BlobLocate, IsTheNodeOfLeastPowerFarFromTheOriginAndFromTheTree) {
  Tree tree = scattered(700, 3);
  for (auto& centre : tree.centre) centre[0] += 3e5f;
  for (const blob_simd simd : {BLOB_SIMD_SCALAR, BLOB_SIMD_PORTABLE, BLOB_SIMD_BEST}) {
    const Model model = tree.build(simd);
    std::mt19937 random(11);
    std::normal_distribution<double> u;
    for (const double reach : {1e-3, 1.0, 30.0, 1e4, 1e7, 1e10, 1e200})
      for (int n = 0; n < 100; ++n) {
        const Point p{3e5 + reach * u(random), reach * u(random), reach * u(random)};
        ASSERT_EQ(blob_cursor_locate(model.get(), p.data()), leastPower(tree, p)) << reach;
      }
  }
}

// Two nodes apart by less than floats of the point resolve.
TEST(BlobLocate, AlmostEqualNodesAreToldApart) {
  Tree tree;
  const double x = 1e4;
  tree.addNode({x - 1, 0, 0}, 1.0);
  tree.addNode({x + 1, 0, 0}, 1.0);
  tree.offset.back() = 0;
  const Model model = tree.build();
  EXPECT_EQ(blob_cursor_locate(model.get(), Point{x - 1e-9, 0, 0}.data()), 0U);
  EXPECT_EQ(blob_cursor_locate(model.get(), Point{x + 1e-9, 0, 0}.data()), 1U);
  EXPECT_EQ(blob_cursor_locate(model.get(), Point{x, 0, 0}.data()), 0U);
}

TEST(BlobLocate, AmongEqualNodesTheFirstIsFound) {
  Tree tree;
  for (int i = 0; i < 100; ++i) tree.addNode({1, 2, 3}, 1.0);
  const Point p{1.5, 2, 3};
  EXPECT_EQ(blob_cursor_locate(tree.build().get(), p.data()), 0U);
}

TEST(BlobLocate, AnInfinitePointIsNowhere) {
  const Point p{1, HUGE_VAL, 0};
  EXPECT_EQ(blob_cursor_locate(oneBlob().build().get(), p.data()), BLOB_NOWHERE);
}

// A point on the trunk or an arm, carried along from the trunk's start.
TEST(BlobFollow, WalkingATreeFindsWhatBruteForceFinds) {
  const Tree tree = fork(0.6, 0.0);
  const Model model = tree.build();
  for (const double side : {1.0, -1.0}) {
    std::uint32_t cursor = 0;
    for (int n = 0; n <= 1500; ++n) {
      const double s = -6 + 0.01 * n;
      const double x = s < 0 ? s : s * std::cos(0.6), y = s < 0 ? 0 : side * s * std::sin(0.6);
      const Point p{x, y, 0.5 * std::sin(s)};
      cursor = blob_cursor_follow(model.get(), p.data(), cursor);
      ASSERT_NEAR(power(tree, cursor, p), power(tree, leastPower(tree, p), p), 1e-5) << s;
    }
  }
}

TEST(BlobFollow, FromAnyNodeOfAStraightVesselTheNearestIsReached) {
  const Tree tree = tube(100);
  const Model model = tree.build();
  for (std::uint32_t start = 0; start < 100; start += 9)
    for (double x = -1; x < 61; x += 0.37) {
      const Point p{x, 0.3, -0.4};
      const std::uint32_t node = blob_cursor_follow(model.get(), p.data(), start);
      ASSERT_NEAR(power(tree, node, p), power(tree, leastPower(tree, p), p), 1e-5);
    }
}

// In the bend, cells of nodes far apart along the vessel meet.
TEST(BlobFollow, InATightBendTheNodeDoesNotDependOnTheWay) {
  const Model model = bend(0).build();
  const std::size_t count = blob_model_describe(model.get()).node_count;
  for (int i = 0; i < 500; ++i) {
    const double a = 2.4 * i, r = 0.05 * (i % 25);
    const Point p{0.3 + r * std::cos(a), 0.4 + r * std::sin(a), 0.1 * (i % 11) - 0.5};
    const std::uint32_t least = blob_cursor_locate(model.get(), p.data());
    for (std::uint32_t k = 0; k < count; ++k)
      ASSERT_EQ(blob_cursor_follow(model.get(), p.data(), k), least) << i << ' ' << k;
  }
}

TEST(BlobFollow, ALinkIsAStepAsGoodAsAParent) {
  Tree tree;
  addVessel(tree, straight({0, 0, 0}, {6, 0, 0}, 11), 1.0, -1, 0);
  addVessel(tree, straight({6.6, 0, 0}, {12, 0, 0}, 10), 1.0, -1, 0);
  const Point p{12, 0, 0};
  EXPECT_EQ(blob_cursor_follow(tree.build().get(), p.data(), 0), 10U);
  tree.links.push_back({10, 11});
  EXPECT_EQ(blob_cursor_follow(tree.build().get(), p.data(), 0), 20U);
}

TEST(BlobFollow, AThinNodeBetweenTwoWideOnesIsNoBarrier) {
  Tree tree;
  tree.addNode({0, 0, 0}, 2.0);
  tree.addNode({0.5, 0, 0}, 1.0, 0);  // its cell lies outside of the vessel
  tree.addNode({1.0, 0, 0}, 2.0, 1);
  const Point p{1.2, 0, 0};
  EXPECT_EQ(blob_cursor_follow(tree.build().get(), p.data(), 0), 2U);
}

TEST(BlobFollow, WalksAtMost256Steps) {
  const Model model = tube(2000).build();
  const Point p{1199, 0, 0};
  EXPECT_EQ(blob_cursor_follow(model.get(), p.data(), 0), 512U);  // two nodes a step
}

TEST(BlobFollow, CrossesTheMouthOfAFork) {
  const Model model = fork(0.45, 0.0).build();
  Point p{1.3, 0.5, 0};
  const std::uint32_t upper = blob_cursor_locate(model.get(), p.data());
  p[1] = -0.5;
  EXPECT_EQ(blob_cursor_follow(model.get(), p.data(), upper),
            blob_cursor_locate(model.get(), p.data()));
}

TEST(BlobNeighbours, AreSymmetric) {
  const Model model = fork(0.3, 0.0).build();
  const auto count = static_cast<std::uint32_t>(blob_model_describe(model.get()).node_count);
  const auto neighbours = [&](std::uint32_t node) {
    std::vector<std::uint32_t> result(64);
    result.resize(blob_model_neighbours(model.get(), node, result.data(), result.size()));
    return result;
  };
  for (std::uint32_t i = 0; i < count; ++i)
    for (const std::uint32_t k : neighbours(i)) {
      const auto back = neighbours(k);
      EXPECT_NE(std::find(back.begin(), back.end(), i), back.end()) << i << " " << k;
    }
}

// spec: M5
// Both vessels are swept by a tool that is pressed against, and through, the common wall.
TEST(BlobKissing, APointInOneVesselNeverReportsTheOther) {
  const Model model = kissing(0.02).build();
  for (const std::uint32_t flags : {BLOB_BLENDED, BLOB_LOCAL}) {
    std::uint32_t lower = 0, upper = 59;
    for (int n = 0; n <= 1740; ++n) {
      const double x = 0.01 * n, press = 0.9 + 0.4 * std::sin(0.1 * n);
      const Point p{x, press, 0}, q{17.4 - x, 2.02 - press, 0};
      blob_sample a, b;
      blob_query(model.get(), flags, p.data(), &lower, &a);
      blob_query(model.get(), flags, q.data(), &upper, &b);
      ASSERT_LT(lower, 30U);
      ASSERT_GE(upper, 30U);
      if (x > 2 && x < 15) {
        ASSERT_NEAR(a.distance, press - 1, 0.06);
        ASSERT_GT(a.normal[1], 0.99);
        ASSERT_LT(b.normal[1], -0.99);
      }
    }
  }
}

}  // namespace
}  // namespace lumen::blob::test
