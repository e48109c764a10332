// SPDX-License-Identifier: Apache-2.0
// Walls around vessels that overlap, and the two surfaces of CathSim.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/progress.h"
#include "converters/export/targets/targets.h"
#include "kissing.h"

namespace lumen::test {

using namespace convert;

namespace {

constexpr double kDeep = -0.3;  // mm, the gap of two vessels that overlap

ExportResult write(ExportResult (*target)(const ExportInput&), const CommonOptions& options = {}) {
  Progress silent;
  const formats::Case source = kissingCase(kDeep);
  return target({source, options, {LengthUnit::Metre, Axes::Lps}, silent});
}

/// The number of triangles of a binary STL.
std::uint32_t trianglesOf(const ExportResult& result, const std::string& file) {
  for (const ExportFile& one : result.files) {
    if (!one.name.ends_with(file)) continue;
    std::uint32_t count = 0;
    std::memcpy(&count, one.bytes.data() + 80, sizeof count);
    return count;
  }
  return 0;
}

}  // namespace

TEST(WallFiles, VesselsThatOverlapGetAWall) {
  for (const auto target : {exportPrint, exportIsaac, exportGodot}) {
    const ExportResult result = write(target);
    ASSERT_TRUE(result.surface.has_value());
    ASSERT_TRUE(result.surface->wall.has_value());
    EXPECT_EQ(result.surface->crossings, 0U);
  }
}

TEST(WallFiles, CathSimShowsAllTrianglesAndTouchesFewer) {
  CommonOptions options;
  options.maxPieces = 500;
  const ExportResult result = write(exportCathsim, options);
  const std::uint32_t shown = trianglesOf(result, "visual.stl"),
                      touched = trianglesOf(result, "simplified.stl");
  EXPECT_GT(shown, 500U);
  EXPECT_LE(touched, 500U);
  EXPECT_EQ(result.surface->triangles, touched);
  ASSERT_EQ(result.surface->errors.size(), 1U);
  EXPECT_GT(result.surface->errors.front(), 0);
}

TEST(WallFiles, CathSimShowsTheSimplifiedSurfaceWhereAnErrorIsAskedFor) {
  CommonOptions options;
  options.surface.maxError = 0.05;
  const ExportResult result = write(exportCathsim, options);
  EXPECT_EQ(trianglesOf(result, "visual.stl"), trianglesOf(result, "simplified.stl"));
  options.maxPieces = trianglesOf(result, "visual.stl") / 2;
  const ExportResult fewer = write(exportCathsim, options);
  EXPECT_EQ(trianglesOf(fewer, "visual.stl"), trianglesOf(result, "visual.stl"));
  EXPECT_LE(trianglesOf(fewer, "simplified.stl"), options.maxPieces);
}

}  // namespace lumen::test
