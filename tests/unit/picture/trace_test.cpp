// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/picture/trace.h"

#include <cmath>
#include <cstring>
#include <memory>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "blob.h"
#include "formats/case/case_encoding.h"
#include "straight_vessels.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using test::straightVessels;

constexpr double kRadius = 2;

Camera smallCameraOf(const formats::Case& value, View view, double turn = 0) {
  Framing framing;
  framing.view = view;
  framing.turn = turn;
  framing.width = 200;
  framing.height = 160;
  return cameraFor(value.tree, framing);
}

TracedSurface traced(const formats::Case& value, const Camera& camera) {
  Progress progress;
  return SurfaceTracer(value).trace(camera, progress);
}

/// Two vessels along z that run into each other by a tenth of a radius, the first in front.
formats::Case kissing() {
  return straightVessels({{{0, 0, 0}, {0, 0, 20}},
                          {{1.5 * kRadius, 1.1 * kRadius, 0}, {1.5 * kRadius, 1.1 * kRadius, 20}}},
                         kRadius);
}

TEST(Trace, EveryHitLiesOnTheWall) {
  const formats::Case value =
      straightVessels({{{0, 0, 0}, {0, 0, 20}}, {{3, -9, 4}, {-6, 9, 15}}}, kRadius);
  const std::vector<std::byte> file = formats::encodeBinary(value);
  blob_model* opened = nullptr;
  ASSERT_EQ(blob_model_open_bytes(file.data(), file.size(), nullptr, &opened), BLOB_OK);
  const std::unique_ptr<blob_model, void (*)(blob_model*)> model(opened, &blob_model_close);
  for (const double turn : {0.0, 0.7, 2.5}) {
    const Camera camera = smallCameraOf(value, View::Anterior, turn);
    const TracedSurface surface = traced(value, camera);
    int hits = 0;
    for (int y = 0; y < surface.height; ++y)
      for (int x = 0; x < surface.width; ++x) {
        const std::size_t pixel = surface.at(x, y);
        if (!surface.isHit(pixel)) continue;
        ++hits;
        const Vector3d p = camera.place(x + 0.5, y + 0.5, double{surface.depth[pixel]});
        std::uint32_t cursor = surface.node[pixel];
        blob_sample sample{};
        blob_query(model.get(), BLOB_DISTANCE_EXACT, p.data(), &cursor, &sample);
        ASSERT_LT(std::abs(sample.distance), 0.005 * kRadius) << x << " " << y;
      }
    EXPECT_GT(hits, 2000);
  }
}

TEST(Trace, ATubeIsSeenAsWideAsItIsWithItsNormals) {
  const formats::Case value = straightVessels({{{0, 0, 0}, {0, 0, 20}}}, kRadius);
  const Camera camera = smallCameraOf(value, View::Anterior);
  const TracedSurface surface = traced(value, camera);
  const int y = surface.height / 2;
  for (int x = 0; x < surface.width; ++x) {
    const double off = camera.place(x + 0.5, y + 0.5, 0).x();
    const std::size_t pixel = surface.at(x, y);
    if (std::abs(std::abs(off) - kRadius) < 0.01 * kRadius) continue;
    ASSERT_EQ(surface.isHit(pixel), std::abs(off) < kRadius) << x;
    if (!surface.isHit(pixel)) continue;
    EXPECT_NEAR(double{surface.normal[pixel].x()}, off / kRadius, 0.02);
    EXPECT_NEAR(camera.place(x + 0.5, y + 0.5, double{surface.depth[pixel]}).y(),
                -std::sqrt(kRadius * kRadius - off * off), 0.02 * kRadius);
  }
}

// At each pixel the vessel whose cylinder is nearer, although each lies in part in the other.
TEST(Trace, VesselsThatTouchStayApart) {
  const formats::Case value = kissing();
  const Camera camera = smallCameraOf(value, View::Anterior);
  const TracedSurface surface = traced(value, camera);
  const auto front = [](double off, double axis) {
    const double square = kRadius * kRadius - off * off;
    return square > 0 ? std::sqrt(square) - axis : -INFINITY;
  };
  int seen[2] = {0, 0};
  for (int y = surface.height / 3; y < 2 * surface.height / 3; ++y)
    for (int x = 0; x < surface.width; ++x) {
      const double off = camera.place(x + 0.5, y + 0.5, 0).x();
      const double first = front(off, 0), second = front(off - 1.5 * kRadius, 1.1 * kRadius);
      const std::size_t pixel = surface.at(x, y);
      if (std::abs(first - second) < 0.02 * kRadius || !surface.isHit(pixel)) continue;
      const std::uint32_t branch = value.tree.branch[surface.node[pixel]];
      ASSERT_EQ(branch, first > second ? 0U : 1U) << x << " " << y;
      ++seen[branch];
    }
  EXPECT_GT(seen[0], 500);
  EXPECT_GT(seen[1], 500);
}

TEST(Trace, WhatIsInFrontHidesWhatIsBehind) {
  const formats::Case value =
      straightVessels({{{0, 0, 0}, {0, 0, 20}}, {{0, 8, 0}, {0, 8, 20}}}, kRadius);
  for (const auto& [view, branch] : {std::pair{View::Anterior, 0U}, {View::Posterior, 1U}}) {
    const TracedSurface surface = traced(value, smallCameraOf(value, view));
    for (std::size_t pixel = 0; pixel < surface.depth.size(); ++pixel) {
      if (!surface.isHit(pixel)) continue;
      ASSERT_EQ(value.tree.branch[surface.node[pixel]], branch);
    }
  }
}

TEST(Trace, AnyNumberOfThreadsGivesTheSameBits) {
  const formats::Case value = kissing();
  const Camera camera = smallCameraOf(value, View::Left, 0.4);
  const TracedSurface many = traced(value, camera);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const TracedSurface single = traced(value, camera);
  EXPECT_EQ(std::memcmp(many.depth.data(), single.depth.data(), many.depth.size() * sizeof(float)),
            0);
  EXPECT_EQ(many.node, single.node);
  EXPECT_EQ(many.normal, single.normal);
}

TEST(Trace, StopsWhenItIsCancelled) {
  const formats::Case value = kissing();
  Progress progress;
  progress.cancel();
  EXPECT_THROW((void)SurfaceTracer(value).trace(smallCameraOf(value, View::Best), progress), Error);
}

}  // namespace
}  // namespace lumen::convert
