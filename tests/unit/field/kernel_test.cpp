// SPDX-License-Identifier: Apache-2.0
// Each kernel's formulas against each other, and against the C library's functions.
#include "formats/field/kernel.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "blob.h"

namespace lumen::field {
namespace {

template <class K>
class KernelFormulas : public testing::Test {};

using AllKernels = testing::Types<Cauchy, Gaussian, Quartic, SoftObject>;
TYPED_TEST_SUITE(KernelFormulas, AllKernels);

constexpr double kStep = 1e-5;
constexpr double kPlaces[] = {0.0001, 0.03, 0.2, 0.5, 0.77, 0.98, 1.3, 4.0};

TYPED_TEST(KernelFormulas, PhiIsOneAtTheCentre) {
  EXPECT_EQ(TypeParam::phi(0.0), 1.0);
}

TYPED_TEST(KernelFormulas, TheFirstDerivativeIsTheSlopeOfPhi) {
  for (const double u : kPlaces) {
    const double slope = (TypeParam::phi(u + kStep) - TypeParam::phi(u - kStep)) / (2 * kStep);
    EXPECT_NEAR(TypeParam::first(u), slope, 1e-8) << u;
  }
}

TYPED_TEST(KernelFormulas, TheSecondDerivativeIsTheSlopeOfTheFirst) {
  for (const double u : kPlaces) {
    const double slope = (TypeParam::first(u + kStep) - TypeParam::first(u - kStep)) / (2 * kStep);
    EXPECT_NEAR(TypeParam::second(u), slope, 1e-8) << u;
  }
}

TYPED_TEST(KernelFormulas, TheChainHasTheSameDerivativesTimesPowersOfTheScale) {
  const double s = TypeParam::kUsualParameter > 0 ? 0.37 : 1.0;
  for (const double u : kPlaces) {
    const KernelChain<double> chain = TypeParam::chain(u, s);
    EXPECT_EQ(chain.phi, TypeParam::phi(u)) << u;
    EXPECT_NEAR(chain.d1, s * TypeParam::first(u), 1e-15) << u;
    EXPECT_NEAR(chain.d2, s * s * TypeParam::second(u), 4e-15) << u;
  }
}

TYPED_TEST(KernelFormulas, TheChainsThirdDerivativeIsTheSlopeOfItsSecond) {
  for (const double u : kPlaces) {
    const auto second = [](double at) { return TypeParam::chain(at, 1.0).d2; };
    const double slope = (second(u + kStep) - second(u - kStep)) / (2 * kStep);
    EXPECT_NEAR(TypeParam::chain(u, 1.0).d3, slope, 1e-7) << u;
  }
}

TYPED_TEST(KernelFormulas, ATermIsAWeightedValueAndItsGradientsFactor) {
  const double a = 1.7, w = 0.6;
  for (const double u : kPlaces) {
    const BlobTerm<double> term = TypeParam::term(u, a, w);
    EXPECT_NEAR(term.value, w * TypeParam::phi(u), 1e-15) << u;
    EXPECT_NEAR(term.slope, 2 * a * w * TypeParam::first(u), 1e-14) << u;
  }
}

TYPED_TEST(KernelFormulas, TheInverseIsWherePhiHasTheValue) {
  const double s = TypeParam::kUsualParameter > 0 ? 0.37 : 1.0;
  for (const double value : {1e-6, 0.01, 0.3, 0.5, 0.9, 0.999999})
    EXPECT_NEAR(TypeParam::phi(s * TypeParam::inverse(value, s)), value, 3e-15) << value;
}

TYPED_TEST(KernelFormulas, BeyondItsReachPhiIsNoMoreThanTheShare) {
  for (const double ratio : {1.1, 3.0, 50.0, 1e4})
    EXPECT_LE(TypeParam::phi(TypeParam::reach(ratio)), (1 + 1e-14) / ratio) << ratio;
}

TYPED_TEST(KernelFormulas, TheLevelTransformFallsAsItsSlopeStates) {
  for (const double f : {0.02, 0.1, 0.8}) {
    const auto h = [](double at) { return TypeParam::level(at, 1 / at, 0.0); };
    const double slope = (h(f * (1 + kStep)) - h(f * (1 - kStep))) / (2 * kStep * f);
    EXPECT_NEAR(-TypeParam::levelSlope(h(f), 1 / f), slope, 1e-8 * std::abs(slope)) << f;
  }
}

TYPED_TEST(KernelFormulas, OnlyACompactKernelIsZeroFromOneOn) {
  const bool isZero = TypeParam::phi(1.0) == 0.0;
  EXPECT_EQ(isZero, TypeParam::kTail == KernelTail::Compact);
}

TEST(Kernel, EachIsFoundByItsStoredValue) {
  for (std::size_t i = 0; i < kKernelCount; ++i) {
    const auto kernel = static_cast<Kernel>(i);
    EXPECT_EQ(withKernel(kernel, [](auto k) { return k.kKernel; }), kernel);
    EXPECT_EQ(withKernel(kernel, [](auto k) { return std::string(k.kName); }), kKernelNames[i]);
  }
}

TEST(Kernel, ValuesAreThoseOfLibblob) {
  EXPECT_EQ(static_cast<int>(Kernel::Cauchy), BLOB_CAUCHY);
  EXPECT_EQ(static_cast<int>(Kernel::Gaussian), BLOB_GAUSSIAN);
  EXPECT_EQ(static_cast<int>(Kernel::Quartic), BLOB_QUARTIC);
  EXPECT_EQ(static_cast<int>(Kernel::SoftObject), BLOB_SOFT_OBJECT);
}

TEST(RepeatableMath, TheExponentialForLoopsIsRightToAFewUnits) {
  for (double t = 0; t < 600; t += 0.37)
    EXPECT_NEAR(expOfMinus(t), std::exp(-t), 1e-15 * std::exp(-t)) << t;
}

TEST(RepeatableMath, TheExponentialForLoopsStaysPositive) {
  EXPECT_GT(expOfMinus(1e300), 0.0);
  EXPECT_LT(expOfMinus(1e300), 1e-303);
}

}  // namespace
}  // namespace lumen::field
