// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "blob.h"
#include "tree.h"

namespace lumen::blob::test {
namespace {

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
