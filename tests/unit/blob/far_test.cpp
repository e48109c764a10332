// SPDX-License-Identifier: Apache-2.0
// Points beyond 1e9 mm, where f counts as zero, on every back end.
#include <array>
#include <cmath>
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

}  // namespace
}  // namespace lumen::blob::test
