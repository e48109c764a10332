// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <random>

#include <gtest/gtest.h>

#include "allocations.h"
#include "blob.h"
#include "tree.h"

namespace lumen::blob::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Every query of the interface at one point.
struct Everything {
  blob_sample sample, exact, local;
  blob_nearest_point nearest;
  blob_hessian hessian;
  blob_hit hit;
  blob_approach approach;
  int inside;
};

Everything queryAll(const Model& model, const Point& p, const Point& to, std::uint32_t cursor) {
  Everything e;
  const auto ask = [&](std::uint32_t flags, blob_sample& s) {
    std::uint32_t own = cursor;
    blob_query(model.get(), flags, p.data(), &own, &s);
  };
  ask(0, e.sample);
  ask(BLOB_DISTANCE_EXACT, e.exact);
  ask(BLOB_LOCAL, e.local);
  std::uint32_t own = cursor;
  e.inside = blob_inside(model.get(), 0, p.data(), &own);
  blob_nearest(model.get(), 0, p.data(), &own, 0, 0, &e.nearest);
  blob_query_hessian(model.get(), 0, p.data(), &own, &e.hessian);
  blob_segment_hit(model.get(), 0, p.data(), to.data(), &own, 0, 200, &e.hit);
  blob_capsule_approach(model.get(), 0, p.data(), to.data(), 0.2, &own, &e.approach);
  return e;
}

TEST(BlobRobust, NanGivesNanAndOutside) {
  const Model model = tube(10).build();
  for (std::size_t k = 0; k < 3; ++k) {
    Point p{1, 0, 0};
    p[k] = NAN;
    for (const std::uint32_t cursor : {4U, BLOB_NOWHERE}) {
      const Everything e = queryAll(model, p, {2, 0, 0}, cursor);
      EXPECT_TRUE(std::isnan(e.sample.value));
      EXPECT_TRUE(std::isnan(e.sample.distance));
      EXPECT_TRUE(std::isnan(e.sample.normal[0]));
      EXPECT_TRUE(std::isnan(e.sample.gradient[2]));
      EXPECT_EQ(e.sample.node, cursor);
      EXPECT_EQ(e.sample.state, 0U);
      EXPECT_EQ(e.inside, 0);
      EXPECT_TRUE(std::isnan(e.nearest.point[0]));
      EXPECT_TRUE(std::isnan(e.hessian.hessian[5]));
      EXPECT_EQ(e.hit.hit, 0);
      EXPECT_TRUE(std::isnan(e.approach.depth));
    }
  }
}

TEST(BlobRobust, InfinityIsFarOutside) {
  const Model model = tube(10).build();
  const Everything e = queryAll(model, {-kInfinity, 0, 0}, {2, 0, 0}, 4);
  EXPECT_EQ(e.sample.value, 0.0);
  EXPECT_EQ(e.sample.distance, kInfinity);
  EXPECT_EQ(e.sample.normal[0], 0.0);
  EXPECT_EQ(e.inside, 0);
}

TEST(BlobRobust, EveryFinitePointHasFiniteAnswers) {
  const Model model = tube(10, 0.02).build();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> exponent(-320, 308);
  std::bernoulli_distribution negative(0.5);
  const auto coordinate = [&] {
    return (negative(random) ? -1 : 1) * std::pow(10.0, exponent(random));
  };
  for (int n = 0; n < 5000; ++n) {
    const Point p{coordinate(), coordinate(), coordinate()};
    std::uint32_t cursor = n % 2 == 0 ? 3 : BLOB_NOWHERE;
    blob_sample s;
    blob_query(model.get(), n % 3 == 0 ? BLOB_LOCAL : 0, p.data(), &cursor, &s);
    ASSERT_TRUE(std::isfinite(s.value));
    ASSERT_FALSE(std::isnan(s.distance));
    ASSERT_NEAR(norm(s.normal), 1.0, 1e-5) << p[0] << " " << p[1] << " " << p[2];
    ASSERT_EQ((s.state & BLOB_INSIDE) != 0, s.distance < 0);
  }
}

TEST(BlobRobust, DenormalCoordinatesAreZero) {
  const Model model = tube(10).build();
  const double tiny = std::numeric_limits<double>::denorm_min();
  const Everything a = queryAll(model, {tiny, 0.5, -tiny}, {2, 0, 0}, 0);
  const Everything b = queryAll(model, {0, 0.5, 0}, {2, 0, 0}, 0);
  EXPECT_EQ(a.sample.distance, b.sample.distance);
}

// 200,000 points in and around a fork, or as many as LUMEN_BLOB_QUERIES says; with LUMEN_SANITIZE
// this is more than a smoke test.
TEST(BlobRobust, RandomQueriesKeepTheirPromises) {
  const char* wanted = std::getenv("LUMEN_BLOB_QUERIES");
  const long count = wanted != nullptr ? std::atol(wanted) : 200000;
  const Model model = fork(0.5, 0.03).build();
  std::mt19937 random(9);
  std::uniform_real_distribution<double> u(-12, 12);
  std::uint32_t cursor = 0;
  for (long n = 0; n < count; ++n) {
    const Point p{u(random), u(random), u(random)};
    blob_sample s;
    if (n % 100 == 0) cursor = static_cast<std::uint32_t>(random());
    blob_query(model.get(), static_cast<std::uint32_t>(n % 16), p.data(), &cursor, &s);
    ASSERT_LT(cursor, 41U);
    ASSERT_EQ(cursor, s.node);
    ASSERT_TRUE(std::isfinite(s.distance) && std::isfinite(s.value));
    ASSERT_EQ((s.state & BLOB_INSIDE) != 0, s.distance < 0);
  }
}

TEST(BlobRobust, QueriesDoNotAllocate) {
  const Model model = fork(0.5, 0.03).build();
  const std::vector<Point> at(20, Point{1, 0.3, 0});
  std::vector<blob_sample> samples(at.size());
  const std::size_t before = countAllocations();
  for (int n = 0; n < 50; ++n) {
    const Point p{0.1 * n - 3, 0.02 * n, 0.5};
    queryAll(model, p, {3, 2, 0}, BLOB_NOWHERE);
  }
  blob_query_many(model.get(), BLOB_DISTANCE_EXACT, at.size(),
                  reinterpret_cast<const double(*)[3]>(at.data()), nullptr, samples.data());
  EXPECT_EQ(countAllocations(), before);
  ::operator delete(::operator new(1));  // the counter counts
  EXPECT_EQ(countAllocations(), before + 1);
}

TEST(BlobDegenerate, AModelWithoutAnyBlobIsOutsideEverywhere) {
  Tree tree;
  tree.addNode({0, 0, 0}, 1.0);
  tree.addNode({1, 0, 0}, 1.0, 0);
  const Everything e = queryAll(tree.build(), {0.2, 0, 0}, {5, 0, 0}, 0);
  EXPECT_EQ(e.sample.value, 0.0);
  EXPECT_EQ(e.sample.state, 0U);
  EXPECT_EQ(e.sample.distance, 0.0);
  EXPECT_EQ(e.hit.hit, 0);
  EXPECT_EQ(e.nearest.converged, 0);
}

// Node 1 of three has no blobs and answers with those of node 0, the nearer and lower.
TEST(BlobDegenerate, ANodeWithoutBlobsBorrowsFromTheNearestAlongTheTree) {
  Tree tree;
  tree.addNode({0, 0, 0}, 1.0);
  tree.addBlob({0.4, 0, 0}, 0.6);
  tree.addNode({0.5, 0, 0}, 1.0, 0);
  tree.addNode({1, 0, 0}, 1.0, 1);
  tree.addBlob({0.9, 0, 0}, 0.6);
  const Model model = tree.build();
  const Point p{0.5, 0.3, 0.2};
  std::uint32_t at1 = 1, at0 = 0;
  blob_sample borrowed, own;
  blob_query(model.get(), BLOB_LOCAL | BLOB_HOLD, p.data(), &at1, &borrowed);
  blob_query(model.get(), BLOB_LOCAL | BLOB_HOLD, p.data(), &at0, &own);
  EXPECT_NEAR(borrowed.value, own.value, 1e-7);
  EXPECT_EQ(borrowed.node, 1U);
}

TEST(BlobDegenerate, NodesInOnePlaceShareEvenly) {
  Tree tree;
  for (int i = 0; i < 3; ++i) {
    tree.addNode({0, 0, 0}, 1.0, i - 1);
    tree.addBlob({0, 0, 0}, 0.4 + 0.1 * i);
  }
  std::uint32_t cursor = 0;
  const Point p{0.3, 0, 0};
  blob_sample s;
  blob_query(tree.build().get(), 0, p.data(), &cursor, &s);
  const std::array<long double, 3> x{p[0], 0, 0};
  const long double mean = (tree.value(0, x) + tree.value(1, x) + tree.value(2, x)) / 3;
  EXPECT_NEAR(s.value, static_cast<double>(mean), 1e-6);
}

// Blobs that belong to a node may be far from it. As a point leaves the seam, less and less of the
// neighbour's model is left, down to none.
TEST(BlobDegenerate, AShareOfANeighbourThatVanishesKeepsItsDigits) {
  Tree tree;
  tree.kernel = BLOB_GAUSSIAN;
  tree.parameter = 0.5;
  tree.addNode({0, 0, 0}, 1.0);
  tree.addBlob({0, 40, 0}, 1.0);
  tree.addNode({1, 0, 0}, 1.0, 0);
  tree.addBlob({1, 0, 0}, 1.0);
  const Model model = tree.build();
  double before = 1;
  int small = 0;
  for (double x = 0.5; x > 0; x -= 1e-5) {
    const Point p{x, 0.2, 0.1};
    std::uint32_t cursor = 0;
    blob_sample s;
    blob_query(model.get(), BLOB_HOLD, p.data(), &cursor, &s);
    if (s.value < 1e-12) break;  // the seam has ended
    EXPECT_LT(s.value, before * (1 + 1e-6)) << x;
    EXPECT_GT(s.distance, -1.0);
    before = s.value;
    small += s.value < 1e-7 ? 1 : 0;
  }
  EXPECT_GT(small, 10);  // of f in the lumen, about 0.5
}

blob_status statusOf(const blob_model_def& def) {
  blob_model* model = reinterpret_cast<blob_model*>(1);
  const blob_status status = blob_model_create(&def, &model);
  EXPECT_EQ(model == nullptr, status != BLOB_OK);
  blob_model_close(model);
  return status;
}

TEST(BlobCreate, ChecksWhatQueriesRelyOn) {
  const Tree good = tube(3);
  const auto broken = [&](auto change) {
    Tree tree = good;
    change(tree);
    return statusOf(tree.definition());
  };
  EXPECT_EQ(statusOf(good.definition()), BLOB_OK);
  EXPECT_EQ(broken([](Tree& t) { t.centre[1][2] = NAN; }), BLOB_ERROR_RANGE);
  EXPECT_EQ(broken([](Tree& t) { t.radius[0] = 0; }), BLOB_ERROR_RANGE);
  EXPECT_EQ(broken([](Tree& t) { t.blobWidth[4] = -1; }), BLOB_ERROR_RANGE);
  EXPECT_EQ(broken([](Tree& t) { t.level = 0; }), BLOB_ERROR_RANGE);
  EXPECT_EQ(broken([](Tree& t) { t.parameter = -0.2; }), BLOB_ERROR_RANGE);
  EXPECT_EQ(broken([](Tree& t) { std::memcpy(&t.kernel, "\4\0\0", 4); }), BLOB_ERROR_KERNEL);
  EXPECT_EQ(broken([](Tree& t) { t.parent[2] = 3; }), BLOB_ERROR_TOPOLOGY);
  EXPECT_EQ(broken([](Tree& t) { t.parent[2] = 2; }), BLOB_ERROR_TOPOLOGY);
  EXPECT_EQ(broken([](Tree& t) { t.links.push_back({0, 3}); }), BLOB_ERROR_TOPOLOGY);
  EXPECT_EQ(broken([](Tree& t) { t.offset[1] = 6, t.offset[2] = 5; }), BLOB_ERROR_TOPOLOGY);
}

TEST(BlobCreate, RefusesWhatWasNotMadeByTheDefaultFunction) {
  blob_model_def def{};
  EXPECT_EQ(statusOf(def), BLOB_ERROR_ARGUMENT);
  EXPECT_EQ(statusOf(blob_model_def_default()), BLOB_ERROR_EMPTY);
  EXPECT_EQ(blob_model_create(nullptr, nullptr), BLOB_ERROR_ARGUMENT);
}

TEST(BlobStatus, EveryCodeHasItsText) {
  for (int code = BLOB_OK; code <= BLOB_ERROR_NO_MOTION; ++code)
    EXPECT_STRNE(blob_status_text(static_cast<blob_status>(code)), "unknown status");
  blob_status future;
  std::memcpy(&future, "\16\0\0", 4);  // one more than the last
  EXPECT_STREQ(blob_status_text(future), "unknown status");
}

}  // namespace
}  // namespace lumen::blob::test
