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

}  // namespace
}  // namespace lumen::blob::test
