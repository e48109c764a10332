// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "blob.h"
#include "tree.h"

namespace lumen::blob::test {
namespace {

constexpr int kRow[6] = {0, 1, 2, 0, 0, 1}, kColumn[6] = {0, 1, 2, 1, 2, 2};

Point randomPoint(std::mt19937& random, double extent) {
  std::uniform_real_distribution<double> u(-extent, extent);
  return {u(random), u(random), u(random)};
}

class BlobKernel : public testing::TestWithParam<blob_kernel> {
protected:
  // Three blobs; compact ones reach all test points.
  static Tree cluster() {
    Tree tree;
    tree.kernel = GetParam();
    tree.parameter = tree.kernel == BLOB_GAUSSIAN ? 0.5 : 0.2;
    tree.addNode({0.1, 0, 0}, 1);
    const double scale = tree.kernel == BLOB_CAUCHY || tree.kernel == BLOB_GAUSSIAN ? 1 : 4;
    tree.addBlob({0, 0, 0}, 0.5 * scale);
    tree.addBlob({0.4, 0.3, -0.2}, 0.7 * scale);
    tree.addBlob({-0.3, 0.1, 0.5}, 0.6 * scale);
    return tree;
  }
};

TEST_P(BlobKernel, ValueAndGradientAreThoseOfTheSumInLongDoubles) {
  const Tree tree = cluster();
  const Model model = tree.build();
  std::mt19937 random(1);
  for (int n = 0; n < 500; ++n) {
    const Point p = randomPoint(random, 0.9);
    std::uint32_t cursor = 0;
    blob_sample s;
    blob_query(model.get(), 0, p.data(), &cursor, &s);
    const std::array<long double, 3> x{p[0], p[1], p[2]};
    ASSERT_NEAR(s.value, static_cast<double>(tree.value(0, x)), 2e-6 * std::abs(s.value));
    for (std::size_t i = 0; i < 3; ++i) {
      auto low = x, high = x;
      low[i] -= 1e-5L;
      high[i] += 1e-5L;
      const long double slope = (tree.value(0, high) - tree.value(0, low)) / 2e-5L;
      ASSERT_NEAR(s.gradient[i], static_cast<double>(slope), 3e-6);
    }
  }
}

TEST_P(BlobKernel, TheHessianIsThatOfTheSumInLongDoubles) {
  const Tree tree = cluster();
  const Model model = tree.build();
  std::mt19937 random(2);
  const long double h = 1e-4L;
  for (int n = 0; n < 200; ++n) {
    const Point p = randomPoint(random, 0.9);
    std::uint32_t cursor = 0;
    blob_hessian s;
    blob_query_hessian(model.get(), 0, p.data(), &cursor, &s);
    const auto shifted = [&](int i, long double a, int j, long double b) {
      std::array<long double, 3> x{p[0], p[1], p[2]};
      x[static_cast<std::size_t>(i)] += a;
      x[static_cast<std::size_t>(j)] += b;
      return tree.value(0, x);
    };
    for (int k = 0; k < 6; ++k) {
      const int i = kRow[k], j = kColumn[k];
      const long double mixed = (shifted(i, h, j, h) - shifted(i, h, j, -h) - shifted(i, -h, j, h) +
                                 shifted(i, -h, j, -h)) /
                                (4 * h * h);
      ASSERT_NEAR(s.hessian[k], static_cast<double>(mixed), 2e-5);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, BlobKernel,
                         testing::Values(BLOB_CAUCHY, BLOB_GAUSSIAN, BLOB_QUARTIC,
                                         BLOB_SOFT_OBJECT));

// The blended field in doubles: its gradient against its values, its Hessian against its gradients.
TEST(BlobBlended, GradientAndHessianAreDerivativesOfTheValue) {
  const Model model = fork(0.5, 0.05).build();
  std::mt19937 random(3);
  const double h = 1e-5;
  const auto hessianAt = [&](Point p, std::uint32_t cursor) {
    blob_hessian s;
    blob_query_hessian(model.get(), BLOB_HOLD, p.data(), &cursor, &s);
    return s;
  };
  for (int n = 0; n < 300; ++n) {
    Point p = randomPoint(random, 1.0);
    p[0] += 0.02 * n - 3;
    const std::uint32_t node = blob_cursor_locate(model.get(), p.data());
    const blob_hessian here = hessianAt(p, node);
    for (std::size_t i = 0; i < 3; ++i) {
      Point low = p, high = p;
      low[i] -= h;
      high[i] += h;
      const blob_hessian a = hessianAt(low, node), b = hessianAt(high, node);
      ASSERT_NEAR(here.gradient[i], (b.value - a.value) / (2 * h), 1e-7);
      for (int k = 0; k < 6; ++k)
        if (kRow[k] == static_cast<int>(i)) {
          ASSERT_NEAR(here.hessian[k], (b.gradient[kColumn[k]] - a.gradient[kColumn[k]]) / (2 * h),
                      1e-5);
        }
    }
  }
}

TEST(BlobBlended, FloatsAndDoublesAgree) {
  const Model model = fork(0.4, 0.05).build();
  std::mt19937 random(4);
  for (int n = 0; n < 3000; ++n) {
    Point p = randomPoint(random, 1.5);
    p[0] += 0.002 * n - 2;
    std::uint32_t cursor = BLOB_NOWHERE;
    blob_sample s;
    blob_hessian d;
    blob_query(model.get(), 0, p.data(), &cursor, &s);
    blob_query_hessian(model.get(), 0, p.data(), &cursor, &d);
    ASSERT_NEAR(s.value, d.value, 3e-6 * d.value);
    for (int i = 0; i < 3; ++i) ASSERT_NEAR(s.gradient[i], d.gradient[i], 1e-5);
  }
}

blob_sample at(const Model& model, const Point& p, std::uint32_t flags = 0) {
  std::uint32_t cursor = BLOB_NOWHERE;
  blob_sample sample;
  blob_query(model.get(), flags, p.data(), &cursor, &sample);
  return sample;
}

// w = 0.5, s^2 = 0.2, r = 1: x = 4, f = 0.5 / 1.8^2, |grad f| = 4 * 0.2 / 1.8^3 * r / w = 1.6
// / 5.832.
TEST(BlobClosedForm, OneCauchyBlobHasItsValueAndGradient) {
  const blob_sample s = at(oneBlob().build(), {1, 0, 0});
  EXPECT_NEAR(s.value, 0.5 / 3.24, 3e-8);
  EXPECT_NEAR(s.gradient[0], -1.6 / 5.832, 1e-7);
  EXPECT_EQ(s.gradient[1], 0.0);
}

// 0.5 (1 + 0.2 x)^-2 = 0.1 at x = 5 (sqrt(5) - 1), r = 0.5 sqrt(x).
TEST(BlobClosedForm, OneBlobIsASphere) {
  Tree tree = oneBlob({3, -2, 1});
  const double radius = 0.5 * std::sqrt(5 * (std::sqrt(5.0) - 1));
  tree.radius[0] = static_cast<float>(radius);
  const Model model = tree.build();
  for (const double r : {0.1, 0.5, 1.0, 1.5, 3.0}) {
    const blob_sample s = at(model, {3, -2 + r, 1});
    EXPECT_NEAR(s.normal[1], 1.0, 1e-6);
    EXPECT_EQ((s.state & BLOB_INSIDE) != 0, r < radius);
    const blob_sample exact = at(model, {3, -2 + r, 1}, BLOB_DISTANCE_EXACT);
    EXPECT_NEAR(exact.distance, r - radius, 3e-5);
    EXPECT_EQ(exact.state & BLOB_NOT_CONVERGED, 0U);
  }
}

// On the plane of symmetry, half way: 2 * 0.5 (1 + 0.2 * 0.36 / 0.25)^-2.
TEST(BlobClosedForm, TwoEqualBlobsAreSymmetric) {
  Tree tree;
  tree.addNode({0, 0, 0}, 1);
  tree.addBlob({-0.6, 0, 0}, 0.5);
  tree.addBlob({0.6, 0, 0}, 0.5);
  const Model model = tree.build();
  const blob_sample middle = at(model, {0, 0, 0});
  EXPECT_NEAR(middle.value, 1.0 / (1.288 * 1.288), 1e-7);
  EXPECT_EQ(norm(middle.gradient), 0.0);
  EXPECT_EQ(norm(middle.normal), 0.0);
  const blob_sample left = at(model, {-0.9, 0.2, 0}), right = at(model, {0.9, 0.2, 0});
  EXPECT_EQ(left.value, right.value);
  EXPECT_EQ(left.distance, right.distance);
  EXPECT_EQ(left.gradient[0], -right.gradient[0]);
}

// Distances from the axis of a tube of radius 1, mid-way, by both methods.
TEST(BlobClosedForm, ALineOfBlobsIsATube) {
  const Model model = tube(30).build();
  for (const double r : {0.0, 0.2, 0.5, 0.8, 0.95, 1.0, 1.05, 1.5, 2.0}) {
    const Point p{9.0, 0, r};
    EXPECT_NEAR(at(model, p).distance, r - 1, r > 1 ? 0.1 : 0.06) << r;
    EXPECT_NEAR(at(model, p, BLOB_DISTANCE_EXACT).distance, r - 1, 3e-3) << r;
  }
  EXPECT_NEAR(at(model, {9, 0, 1.05}).distance, 0.05, 0.003);
}

TEST(BlobClosedForm, TheDistanceOnTheAxisIsMinusTheRadius) {
  EXPECT_NEAR(at(oneBlob().build(), {0, 0, 0}).distance, -1.0, 1e-6);
}

// Cauchy: f falls with the fourth power, 25 w^5 / r^4, and the distance grows as r does.
TEST(BlobClosedForm, FarAwayTheDistanceGrowsWithTheWay) {
  const Model model = oneBlob({0, 0, 0}, 1.0).build();
  const blob_sample s = at(model, {0, 0, 1e4});
  EXPECT_NEAR(s.value / 25e-16, 1.0, 1e-5);
  EXPECT_NEAR(s.distance, 1e4, 2.0);
  EXPECT_NEAR(s.normal[2], 1.0, 1e-6);
}

// Gaussian: exp(-0.5 * 30^2) is 0 as a float, but its logarithm, and so the distance, is not lost.
TEST(BlobClosedForm, TheGaussiansFarFieldKeepsItsDistance) {
  Tree tree;
  tree.kernel = BLOB_GAUSSIAN;
  tree.parameter = 0.5;
  const double radius = std::sqrt(2 * std::log(10.0));
  tree.addNode({0, 0, 0}, radius);
  tree.addBlob({0, 0, 0}, 1.0);
  const Model model = tree.build();
  for (const double r : {0.5, 2.0, 5.0, 30.0, 1e4}) {
    const blob_sample s = at(model, {r, 0, 0});
    EXPECT_NEAR(s.distance, r - radius, 1e-5 * (1 + r)) << r;
    EXPECT_NEAR(s.normal[0], 1.0, 1e-6);
  }
  EXPECT_EQ(at(model, {30, 0, 0}).value, 0.0);
}

TEST(BlobClosedForm, ACompactKernelVanishesOutsideItsSupport) {
  for (const blob_kernel kernel : {BLOB_QUARTIC, BLOB_SOFT_OBJECT}) {
    Tree tree = oneBlob({0, 0, 0}, 2.0);
    tree.kernel = kernel;
    const Model model = tree.build();
    const blob_sample s = at(model, {0, 5, 0});
    EXPECT_EQ(s.value, 0.0);
    EXPECT_NEAR(s.distance, 4.0, 1e-6);  // to the node's ball
    EXPECT_NEAR(s.normal[1], 1.0, 1e-6);
    EXPECT_EQ(s.state & BLOB_INSIDE, 0U);
  }
}

// A sphere of radius 1.243: curvatures 1 / r at distance r from the centre.
TEST(BlobClosedForm, CurvaturesAreThoseOfASphere) {
  std::uint32_t cursor = 0;
  blob_hessian hessian;
  const Point p{0, 0.6, 0.8};
  blob_query_hessian(oneBlob().build().get(), 0, p.data(), &cursor, &hessian);
  EXPECT_NEAR(hessian.mean_curvature, 1.0, 1e-6);
  EXPECT_NEAR(hessian.gaussian_curvature, 1.0, 1e-6);
}

TEST(BlobClosedForm, ATubeCurvesInOneDirectionOnly) {
  Tree line;
  line.addNode({0, 0, 0}, 1.0);
  for (int i = -50; i <= 50; ++i) line.addBlob({0.3 * i, 0, 0}, 0.4);
  std::uint32_t cursor = 0;
  blob_hessian hessian;
  const Point p{0, 0, 1};
  blob_query_hessian(line.build().get(), 0, p.data(), &cursor, &hessian);
  EXPECT_NEAR(hessian.mean_curvature, 0.5, 0.01);
  EXPECT_NEAR(hessian.gaussian_curvature, 0.0, 0.01);
}

}  // namespace
}  // namespace lumen::blob::test
