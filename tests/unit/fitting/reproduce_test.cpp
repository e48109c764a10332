// SPDX-License-Identifier: Apache-2.0
// The measuring instruments of the reproduction programs, on surfaces that are known.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "formats/case/blobby.h"
#include "tests/evaluation/reproduce/convolution_shapes.h"
#include "tests/evaluation/reproduce/implicit_surface.h"
#include "tests/evaluation/reproduce/shape_fit.h"

namespace lumen::reproduce {
namespace {

/// Nodes of radius 1 along x at `x`, each with one blob in its centre whose surface has that
/// radius.
formats::Case spheres(const std::vector<float>& x, const std::vector<double>& surface) {
  formats::Case value;
  value.models = formats::BlobbyModels{};
  value.models->offset = {0};
  for (std::size_t i = 0; i < x.size(); ++i) {
    value.tree.centre.push_back({x[i], 0, 0});
    value.tree.direction.push_back({1, 0, 0});
    value.tree.radius.push_back(1);
    value.tree.height.push_back(1);
    value.tree.parent.push_back(static_cast<std::int32_t>(i) - 1);
    value.tree.branch.push_back(0);
    value.models->centre.push_back({x[i], 0, 0});
    value.models->width.push_back(
        static_cast<float>(formats::widthForRadius(formats::Kernel::Cauchy, 0.2, surface[i], 0.1)));
    value.models->offset.push_back(static_cast<std::uint32_t>(i + 1));
  }
  return value;
}

TEST(ImplicitSurfaceTest, NearestPointOfASphereIsOnTheRay) {
  const formats::Case value = spheres({0}, {1});
  const auto p = ImplicitSurface(*value.models, 0).nearest({1.2, 0.9, 0}, 0.3);
  ASSERT_TRUE(p.has_value());
  EXPECT_LT((*p - Vector3d(0.8, 0.6, 0)).norm(), 1e-6);
}

TEST(ImplicitSurfaceTest, ARayLeavesASphereAtItsRadius) {
  const formats::Case value = spheres({0}, {1});
  const auto p = ImplicitSurface(*value.models, 0).leave({0.5, 0, 0}, {1, 0, 0}, 0.1, 4);
  ASSERT_TRUE(p.has_value());
  EXPECT_NEAR(p->x(), 1, 1e-6);
  EXPECT_FALSE(ImplicitSurface(*value.models, 0).leave({0, 0, 0}, {1, 0, 0}, 0.1, 0.9));
}

TEST(MeasureSeams, EqualSpheresMeetWithoutAJump) {
  Progress progress;
  const SeamJumps seams = measureSeams(spheres({0, 1}, {1, 1}), progress);
  EXPECT_EQ(seams.seams, 1U);
  ASSERT_EQ(seams.jump.size(), 64U);
  EXPECT_LT(seams.jump.back(), 1e-6);
}

TEST(MeasureSeams, JumpIsTheDistanceBetweenTheSurfaces) {
  Progress progress;
  const SeamJumps seams = measureSeams(spheres({0, 1}, {1, 1.1}), progress);
  ASSERT_EQ(seams.jump.size(), 64U);
  // on x = 1/2 the first circle has the radius sqrt(0.75), sqrt(1) from the second centre; the
  // second has sqrt(1.1^2 - 0.25), 1.1 from the first
  EXPECT_NEAR(seams.jump.front(), 0.1, 1e-6);
  EXPECT_NEAR(seams.jump.back(), 0.1, 1e-6);
}

TEST(SampleSurface, NoTwoParticlesAreCloserThanHalfTheEvenSpacing) {
  const formats::Case value = spheres({0}, {1});
  const ImplicitSurface surface(*value.models, 0);
  Random random(1);
  ParticleOptions options;
  options.count = 200;
  const auto points = sampleSurface(
      surface, [](Random& r) { return besideSkeleton({Vector3d::Zero()}, r); }, options, random);
  ASSERT_EQ(points.size(), 200U);
  for (const Vector3d& p : points) {
    double least = 1e300;
    for (const Vector3d& q : points) {
      if (&p != &q) least = std::min(least, (p - q).norm());
    }
    EXPECT_NEAR(p.norm(), 1, 1e-6);
    // in a hexagonal pattern, sqrt(8 pi / (sqrt(3) 200)) = 0.269
    EXPECT_GT(least, 0.5 * 0.269);
  }
}

TEST(ConvolutionShapes, AreAMillimetreWideInTheMiddle) {
  for (const ConvolutionShape& shape : convolutionShapes()) {
    if (shape.name == "bifurcation") continue;  // its widths are a compromise
    const Vector3d middle = shape.skeleton[shape.skeleton.size() / 2];
    const auto p = shape.surface().leave(middle, {0, 0, 1}, 0.1, 4);
    ASSERT_TRUE(p.has_value()) << shape.name;
    EXPECT_NEAR(p->z(), 1, 1e-5) << shape.name;
  }
}

TEST(ConvolutionShapes, TheOpenCapsuleIsSampledWithinItsBoxOnly) {
  const ConvolutionShape open = convolutionShapes()[3];
  Random random(1);
  for (const Vector3d& p : open.samples(random)) {
    EXPECT_GE(p.x(), -4.1);
    EXPECT_LE(p.x(), 0);
  }
}

TEST(FamilyFit, CountsTheChangesThatAShapeHas) {
  const std::vector<ConvolutionShape> shapes = convolutionShapes();
  const auto unknowns = [&](std::size_t i) {
    Random random(1);
    return FamilyFit(shapes[i], shapes[i].samples(random), Random(2)).unknowns();
  };
  EXPECT_EQ(unknowns(0), 9U);   // place, attitude, radius of curvature, length, width
  EXPECT_EQ(unknowns(1), 18U);  // of two arcs
  EXPECT_EQ(unknowns(2), 7U);   // no curvature, and its spin changes nothing
}

TEST(FamilyFit, FindsAShapeThatMoved) {
  const ConvolutionShape capsule = convolutionShapes()[2];
  Random random(1);
  const std::vector<Vector3d> points = capsule.samples(random);
  Eigen::VectorXd moved(static_cast<Eigen::Index>(points.size()));
  for (std::size_t k = 0; k < points.size(); ++k) {
    moved[static_cast<Eigen::Index>(k)] =
        -0.01 * capsule.surface().at(points[k]).gradient.normalized().z();
  }
  const auto distances = FamilyFit(capsule, points, Random(2)).distances(moved);
  EXPECT_NEAR(distances.back(), 0.01, 1e-4);
  EXPECT_NEAR(distances.front(), 0, 1e-4);
}

TEST(FitShape, NoiseDoesNotDriveTheBlobsOfAFlatShapeAway) {
  const ConvolutionShape fork = convolutionShapes()[1];
  Random random(1, 1);
  const std::vector<Vector3d> points =
      withNoise(fork, fork.samples(random), 0.175, Random(3, 1180));
  convert::fitting::LocalModelOptions options;
  options.accuracy = 3 * 0.175;
  const formats::BlobbyModels model = fitShape(fork, points, options);
  EXPECT_GE(model.width.size(), 5U);
  // one wide blob far beside the plane of the fork would have its surface along it; the wall and
  // 1.5 radii are 2.5 mm
  for (const formats::Vec3f& c : model.centre) EXPECT_LT(std::abs(c.z), 2.5);
}

}  // namespace
}  // namespace lumen::reproduce
