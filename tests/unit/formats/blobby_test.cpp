// SPDX-License-Identifier: Apache-2.0
#include "formats/case/blobby.h"

#include <gtest/gtest.h>

namespace lumen::formats {
namespace {

struct KernelCase {
  Kernel kernel;
  double parameter;
  const char* name;
};

class EachKernel : public testing::TestWithParam<KernelCase> {
protected:
  [[nodiscard]] static KernelValue at(double x) {
    return evaluateKernel(GetParam().kernel, GetParam().parameter, x);
  }
};

INSTANTIATE_TEST_SUITE_P(All, EachKernel,
                         testing::Values(KernelCase{Kernel::Cauchy, 0.2, "cauchy"},
                                         KernelCase{Kernel::Cauchy, 3.0, "wide_cauchy"},
                                         KernelCase{Kernel::Gaussian, 0.5, "gaussian"},
                                         KernelCase{Kernel::Quartic, 0, "quartic"},
                                         KernelCase{Kernel::SoftObject, 0, "soft_object"}),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(EachKernel, IsOneAtTheCentre) {
  EXPECT_EQ(at(0).phi, 1.0);
}

TEST_P(EachKernel, HasTheDerivativesOfItsValue) {
  const double h = 1e-5;
  for (double x = 0.05; x < 0.96; x += 0.1) {
    const KernelValue low = at(x - h), high = at(x + h), here = at(x);
    const double tolerance = 1e-8 * (1 + std::abs(here.d3));
    EXPECT_NEAR(here.d1, (high.phi - low.phi) / (2 * h), tolerance) << x;
    EXPECT_NEAR(here.d2, (high.d1 - low.d1) / (2 * h), tolerance) << x;
    EXPECT_NEAR(here.d3, (high.d2 - low.d2) / (2 * h), tolerance) << x;
  }
}

TEST_P(EachKernel, HasTheLevelAtItsIsoRadius) {
  const KernelCase& k = GetParam();
  for (const double level : {1e-6, 0.1, 1.0, 1.999}) {
    const double r = isoRadius(k.kernel, k.parameter, 2.0, level);
    EXPECT_GT(r, 0);
    EXPECT_NEAR(2.0 * at(r * r / 4.0).phi / level, 1.0, 1e-11) << level;
  }
}

TEST_P(EachKernel, HasNoIsoRadiusWhereTheCentreIsNotAboveTheLevel) {
  const KernelCase& k = GetParam();
  EXPECT_EQ(isoRadius(k.kernel, k.parameter, 0.1, 0.1), 0.0);
  EXPECT_EQ(isoRadius(k.kernel, k.parameter, 0.1, 5.0), 0.0);
}

TEST_P(EachKernel, FindsTheWidthWhoseSurfaceHasTheRadius) {
  const KernelCase& k = GetParam();
  for (const double radius : {1e-3, 0.25, 1.0, 3.0, 100.0})
    for (const double level : {1e-3, 0.1, 10.0})
      for (const int count : {1, 2, 7}) {
        const double w = widthForRadius(k.kernel, k.parameter, radius, level, count);
        const double back = isoRadius(k.kernel, k.parameter, w, level / count);
        EXPECT_NEAR(back / radius, 1.0, radius < 0.01 * level ? 1e-3 : 1e-8)
            << radius << " " << level << " " << count;
      }
}

TEST_P(EachKernel, FindsTheWidthToATrillionth) {
  const KernelCase& k = GetParam();
  const double w = widthForRadius(k.kernel, k.parameter, 1.0, 0.1);
  const auto f = [&](double width) { return width * at(1.0 / (width * width)).phi; };
  EXPECT_LT(f(w * (1 - 2e-12)), 0.1);
  EXPECT_GT(f(w * (1 + 2e-12)), 0.1);
}

TEST_P(EachKernel, NeedsAWidthOfTheLevelForRadiusZero) {
  EXPECT_DOUBLE_EQ(widthForRadius(GetParam().kernel, GetParam().parameter, 0, 0.1, 2), 0.05);
}

TEST_P(EachKernel, HasNoWidthForSenselessArguments) {
  const KernelCase& k = GetParam();
  EXPECT_TRUE(std::isnan(widthForRadius(k.kernel, k.parameter, -1, 0.1)));
  EXPECT_TRUE(std::isnan(widthForRadius(k.kernel, k.parameter, 1, 0)));
  EXPECT_TRUE(std::isnan(widthForRadius(k.kernel, k.parameter, 1, 0.1, 0)));
  EXPECT_TRUE(std::isnan(widthForRadius(k.kernel, k.parameter, INFINITY, 0.1)));
}

TEST(Kernels, HaveTheirClosedForms) {
  EXPECT_DOUBLE_EQ(evaluateKernel(Kernel::Cauchy, 0.2, 5.0).phi, 0.25);  // (1 + 1)^-2
  EXPECT_DOUBLE_EQ(evaluateKernel(Kernel::Cauchy, 0.2, 5.0).d1, -0.05);  // -2/5 * 2^-3
  EXPECT_NEAR(evaluateKernel(Kernel::Gaussian, 0.5, 2.0).phi, 0.36787944117144233, 1e-16);
  EXPECT_DOUBLE_EQ(evaluateKernel(Kernel::Quartic, 0, 0.5).phi, 0.25);
  const double x = 0.5;  // 1 - 4/72 + 17/36 - 22/18
  EXPECT_NEAR(evaluateKernel(Kernel::SoftObject, 0, x).phi, 14.0 / 72.0, 1e-16);
}

TEST(Kernels, OfCompactSupportAreZeroFromTheEdgeOn) {
  for (const Kernel kernel : {Kernel::Quartic, Kernel::SoftObject})
    for (const double x : {1.0, 1.5, 1e30}) {
      const KernelValue k = evaluateKernel(kernel, 0, x);
      EXPECT_EQ(k.phi, 0);
      EXPECT_EQ(k.d1, 0);
      EXPECT_EQ(k.d2, 0);
      EXPECT_EQ(k.d3, 0);
    }
}

TEST(Kernels, HaveTheirInflectionAtRadiusOneByDefault) {
  // d2/dr2 phi(r^2) = 2 phi' + 4 r^2 phi''
  for (const Kernel kernel : {Kernel::Cauchy, Kernel::Gaussian}) {
    const KernelValue k = evaluateKernel(kernel, defaultKernelParameter(kernel), 1.0);
    EXPECT_NEAR(2 * k.d1 + 4 * k.d2, 0, 1e-15);
  }
  EXPECT_EQ(defaultKernelParameter(Kernel::Quartic), 0);
}

TEST(IsoRadius, OfACauchyBlobIsKnown) {
  // width 0.4, T 0.1: (1 + x/5)^-2 = 1/4, x = 5
  EXPECT_DOUBLE_EQ(isoRadius(Kernel::Cauchy, 0.2, 0.4, 0.1), 0.4 * std::sqrt(5.0));
}

TEST(RepeatableExp, AgreesWithTheLibraryWithinTwoUnits) {
  for (double x = -740.3; x < 709; x += 0.73) {
    const double expected = std::exp(x);
    EXPECT_NEAR(repeatableExp(x), expected, std::max(expected * 4.5e-16, 1e-323)) << x;
  }
  EXPECT_EQ(repeatableExp(0), 1.0);
  EXPECT_EQ(repeatableExp(-800), 0.0);
  EXPECT_EQ(repeatableExp(800), INFINITY);
  EXPECT_TRUE(std::isnan(repeatableExp(NAN)));
}

TEST(RepeatableLog, AgreesWithTheLibraryWithinTwoUnits) {
  for (double x = 1e-300; x < 1e300; x *= 3.7)
    EXPECT_NEAR(repeatableLog(x), std::log(x), std::abs(std::log(x)) * 4.5e-16) << x;
  for (double x = 0.5; x < 2; x += 0.0137)
    EXPECT_NEAR(repeatableLog(x), std::log(x), std::abs(std::log(x)) * 4.5e-16) << x;
  EXPECT_EQ(repeatableLog(1), 0.0);
}

TEST(Field, OfOneBlobIsItsWidthAtTheCentre) {
  const BlobbyModels models{Kernel::Cauchy, 0.2, 0.1, {0, 1}, {{1, 2, 3}}, {0.5f}};
  const FieldValue value = evaluateField(models, 0, {1, 2, 3});
  EXPECT_EQ(value.f, 0.5);
  EXPECT_EQ(value.gradient.x, 0);
}

TEST(Field, SumsOnlyTheBlobsOfItsNode) {
  const BlobbyModels models{
      Kernel::Quartic, 0, 0.1, {0, 1, 1, 3}, {{9, 9, 9}, {0, 0, 0}, {0, 0, 0}}, {1, 1, 2}};
  EXPECT_EQ(evaluateField(models, 2, {0, 0, 0}).f, 3.0);
  EXPECT_EQ(evaluateField(models, 1, {0, 0, 0}).f, 0.0);
}

TEST(Field, HasNoGradientComponentAcrossASymmetryPlane) {
  const BlobbyModels models{Kernel::Gaussian, 0.5, 0.1, {0, 2}, {{-1, 0, 0}, {1, 0, 0}}, {1, 1}};
  const FieldValue value = evaluateField(models, 0, {0, 0.5, -0.25});
  EXPECT_EQ(value.gradient.x, 0);
  EXPECT_LT(value.gradient.y, 0);
  EXPECT_GT(value.gradient.z, 0);
}

TEST_P(EachKernel, GivesAFieldWhoseGradientIsItsDerivative) {
  const BlobbyModels models{
      GetParam().kernel, GetParam().parameter, 0.1, {0, 2}, {{0, 0, 0}, {0.5f, 0.25f, -0.5f}},
      {2.0f, 1.5f}};
  const Vec3d p{0.3, -0.2, 0.4};
  const double h = 1e-6;
  const auto f = [&](double x, double y, double z) {
    return evaluateField(models, 0, {p.x + x, p.y + y, p.z + z}).f;
  };
  const Vec3d gradient = evaluateField(models, 0, p).gradient;
  EXPECT_NEAR(gradient.x, (f(h, 0, 0) - f(-h, 0, 0)) / (2 * h), 1e-8);
  EXPECT_NEAR(gradient.y, (f(0, h, 0) - f(0, -h, 0)) / (2 * h), 1e-8);
  EXPECT_NEAR(gradient.z, (f(0, 0, h) - f(0, 0, -h)) / (2 * h), 1e-8);
}

}  // namespace
}  // namespace lumen::formats
