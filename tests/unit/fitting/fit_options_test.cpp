// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "converters/stages/fitting/fit.h"

namespace lumen::convert {
namespace {

void expectRefused(const FitOptions& options, const std::string& name) {
  try {
    (void)options.resolved(0.2);
    ADD_FAILURE() << name << " was accepted";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::InvalidInput);
    EXPECT_NE(std::string(e.what()).find(name), std::string::npos) << e.what();
  }
}

TEST(FitOptions, LengthsScaleWithTheVoxel) {
  const FitOptions full = FitOptions().resolved(0.4);
  EXPECT_DOUBLE_EQ(*full.isoLevel, 0.2);
  EXPECT_DOUBLE_EQ(*full.accuracy, 0.6);
  EXPECT_DOUBLE_EQ(*full.maxDistance, 40);
  EXPECT_DOUBLE_EQ(*full.minWidth, 0.04);
}

TEST(FitOptions, GivenLengthsStay) {
  FitOptions options;
  options.accuracy = 0.25;
  EXPECT_EQ(*options.resolved(0.4).accuracy, 0.25);
}

TEST(FitOptions, TheKernelChoosesItsParameter) {
  FitOptions options;
  EXPECT_EQ(*options.resolved(0.2).kernelParameter, 0.2);
  options.kernel = formats::Kernel::Gaussian;
  EXPECT_EQ(*options.resolved(0.2).kernelParameter, 0.5);
}

TEST(FitOptions, WithoutAVoxelSizeEveryLengthMustBeGiven) {
  FitOptions options;
  EXPECT_THROW((void)options.resolved(0), Error);
  options.isoLevel = 0.1;
  options.accuracy = 0.3;
  options.maxDistance = 20;
  EXPECT_THROW((void)options.resolved(0), Error);
  options.minWidth = 0.02;
  EXPECT_NO_THROW((void)options.resolved(0));
}

TEST(FitOptions, OutOfRangeValuesAreRefusedByName) {
  const auto with = [](auto member, auto value) {
    FitOptions options;
    options.*member = value;
    return options;
  };
  expectRefused(with(&FitOptions::kernelParameter, 0.0), "kernel-parameter");
  expectRefused(with(&FitOptions::cohesionWeight, -1.0), "cohesion-weight");
  expectRefused(with(&FitOptions::curvatureWeight, std::nan("")), "curvature-weight");
  expectRefused(with(&FitOptions::cohesionScale, 0.0), "cohesion-scale");
  expectRefused(with(&FitOptions::maxSubdivisions, -1), "max-subdivisions");
  expectRefused(with(&FitOptions::maxSubdivisions, 1001), "max-subdivisions");
  expectRefused(with(&FitOptions::neighbourhood, -1), "neighbourhood");
  expectRefused(with(&FitOptions::seamSweeps, 101), "seam-sweeps");
  expectRefused(with(&FitOptions::seamWeight, -1.0), "seam-weight");
  expectRefused(with(&FitOptions::isoLevel, 0.0), "iso-level");
  expectRefused(with(&FitOptions::accuracy, -0.1), "accuracy");
  expectRefused(with(&FitOptions::maxDistance, std::numeric_limits<double>::infinity()),
                "max-distance");
  expectRefused(with(&FitOptions::minWidth, 0.0), "min-width");
}

TEST(FitOptions, ParametersHaveTheNamesOfTheOptions) {
  const auto values = FitOptions().resolved(0.2).parameters();
  std::string names;
  for (const auto& [name, value] : values) names += name + " ";
  EXPECT_EQ(names,
            "accuracy cohesion-scale cohesion-weight curvature-weight iso-level kernel "
            "kernel-parameter max-distance max-subdivisions min-width neighbourhood seam-sweeps "
            "seam-weight ");
  EXPECT_EQ(std::get<std::string>(values.at("kernel")), "cauchy");
  EXPECT_EQ(std::get<std::int64_t>(values.at("max-subdivisions")), 100);
  EXPECT_DOUBLE_EQ(std::get<double>(values.at("iso-level")), 0.1);
}

}  // namespace
}  // namespace lumen::convert
