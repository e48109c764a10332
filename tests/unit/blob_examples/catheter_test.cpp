// SPDX-License-Identifier: Apache-2.0
// The catheter's parts. See libblob/examples/catheter.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "banded.h"
#include "rod.h"
#include "score.h"
#include "tube.h"
#include "wall.h"

namespace {

using lumen::test::makeTube;
using lumen::test::Model;

constexpr int kDiagonal = kBand - 1;

TEST(Banded, SolvesTwoEquations) {
  // 2x - y = 0, -x + 2y = 3: x = 1, y = 2
  double lower[2][kBand] = {}, b[2] = {0, 3};
  lower[0][kDiagonal] = lower[1][kDiagonal] = 2;
  lower[1][kDiagonal - 1] = -1;
  ASSERT_TRUE(banded_solve(2, lower, b));
  EXPECT_NEAR(b[0], 1, 1e-14);
  EXPECT_NEAR(b[1], 2, 1e-14);
}

TEST(Banded, SolvesAWideBand) {
  constexpr std::size_t kSize = 40;
  double lower[kSize][kBand] = {}, b[kSize] = {};
  // 20 on the diagonal, -1 beside it eight times; the solution is all ones
  for (std::size_t i = 0; i < kSize; ++i) {
    lower[i][kDiagonal] = b[i] = 20;
    for (std::size_t j = i < 8 ? 0 : i - 8; j < i; ++j) lower[i][kDiagonal - (i - j)] = -1;
    for (std::size_t j = 0; j < kSize; ++j)
      if (i != j && std::max(i, j) - std::min(i, j) <= 8) b[i] -= 1;
  }
  ASSERT_TRUE(banded_solve(kSize, lower, b));
  for (double x : b) EXPECT_NEAR(x, 1, 1e-13);
}

TEST(Banded, RefusesAMatrixThatIsNotPositiveDefinite) {
  double lower[1][kBand] = {}, b[1] = {1};
  lower[0][kDiagonal] = -1;
  EXPECT_FALSE(banded_solve(1, lower, b));
}

struct Push {
  Model model = makeTube();
  wall around = wall_of_model(model.get(), 0, 4);
  rod r{};

  Push(double tiltDegrees, double friction) {
    rod_def def = rod_def_default();
    const double tilt = tiltDegrees * 3.14159265358979324 / 180;
    def.entry[0] = 2;
    def.direction[0] = std::cos(tilt);
    def.direction[1] = std::sin(tilt);
    def.elements = 60;
    def.element_length = 0.25;
    def.friction = friction;
    EXPECT_TRUE(rod_create(&r, &def, &around, 0));
  }
  ~Push() {
    rod_destroy(&r);
    around.close(around.self);
  }
  Push(const Push&) = delete;
  Push& operator=(const Push&) = delete;

  void run(int steps) {
    for (int i = 0; i < steps; ++i) rod_step(&r, &around, 50);
  }
  /// Greatest distance of the rod's surface beyond the exact wall, mm.
  [[nodiscard]] double deepest() const {
    double most = -1e9;
    for (std::size_t i = 0; i < r.free_count; ++i) {
      blob_sample s;
      blob_query(model.get(), BLOB_DISTANCE_EXACT, r.position[i], nullptr, &s);
      most = std::max(most, s.distance + r.def.radius);
    }
    return most;
  }
  /// Compression of the element at the entry, N.
  [[nodiscard]] double pushingForce() const {
    const double* a = r.position[r.free_count - 1];
    const double* b = r.position[r.free_count];
    const double length = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    const double area = 3.14159265358979324 * r.def.radius * r.def.radius;
    return r.def.young * area * (1 - length / r.def.element_length);
  }
};

TEST(Rod, OnTheAxisItTouchesNothingAndGoesAsFarAsItIsPushed) {
  Push push(0, 0.1);
  push.run(200);
  EXPECT_EQ(push.r.contact_count, 0U);
  EXPECT_NEAR(push.r.position[0][0], 2 + 200 * 0.05, 1e-6);
  EXPECT_NEAR(push.r.position[0][1], 0, 1e-6);
}

TEST(Rod, ObliqueItSlidesAlongTheWallAndStaysWithin) {
  Push push(20, 0.1);
  push.run(140);  // 7 mm; the wall is met after about 5
  EXPECT_GT(push.r.contact_count, 0U);
  // the one-evaluation distance is a few micrometres off at this depth
  EXPECT_LT(push.deepest(), 0.01);
  EXPECT_GT(push.deepest(), -0.01);
  EXPECT_GT(push.r.position[0][0], 8);
}

TEST(Rod, KeepsItsLength) {
  Push push(20, 0.1);
  push.run(140);
  double length = 0;
  for (std::size_t i = 0; i + 1 < push.r.node_count; ++i) {
    const double *a = push.r.position[i], *b = push.r.position[i + 1];
    length += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  }
  EXPECT_NEAR(length, 60 * 0.25, 0.01);
}

TEST(Rod, FrictionAsksForMoreForce) {
  // Against a plane met at the angle a, force / normal force is tan(a) + friction to first order.
  Push smooth(20, 0), rough(20, 0.3);
  smooth.run(130);
  rough.run(130);
  EXPECT_GT(smooth.pushingForce(), 0);
  EXPECT_GT(rough.pushingForce(), 1.3 * smooth.pushingForce());
}

/// Positions on the lower side of the tube, 0.05 mm from its wall for a tool of 0.15 mm.
std::vector<std::array<double, 3>> slide(const blob_model* model, std::size_t count,
                                         double zigzag) {
  const double axis[3] = {10, 0, 0}, below[3] = {10, -1, 0};
  blob_nearest_point wall;
  blob_nearest(model, 0, below, nullptr, 1e-9, 0, &wall);
  const double radius = std::abs(wall.point[1] - axis[1]);
  std::vector<std::array<double, 3>> path;
  for (std::size_t i = 0; i < count; ++i)
    path.push_back(
        {9 + 0.01 * static_cast<double>(i), -(radius - 0.2), i % 2 == 0 ? zigzag : -zigzag});
  return path;
}

const double (*rows(const std::vector<std::array<double, 3>>& path))[3] {
  return reinterpret_cast<const double(*)[3]>(path.data());
}

TEST(Score, OfAStraightSlideIsTheGapAlone) {
  const Model model = makeTube();
  const auto path = slide(model.get(), 100, 0);
  const std::vector<unsigned char> touches(path.size(), 1);
  const score s = score_path(model.get(), path.size(), rows(path), touches.data(), 0.15);
  EXPECT_EQ(s.used, 100U);
  EXPECT_NEAR(s.line_rms, 0, 1e-9);
  EXPECT_NEAR(s.gap_median, 0.05, 1e-4);
  EXPECT_LT(s.gap_jerk, 1e-5);
}

TEST(Score, OfAZigzagIsItsAmplitude) {
  const Model model = makeTube();
  const auto path = slide(model.get(), 1000, 0.002);
  const std::vector<unsigned char> touches(path.size(), 1);
  const score s = score_path(model.get(), path.size(), rows(path), touches.data(), 0.15);
  EXPECT_NEAR(s.line_rms, 0.002, 1e-5);
}

TEST(Score, LeavesOutWhatComesBeforeTheFirstContactAndAfterTheLast) {
  const Model model = makeTube();
  const auto path = slide(model.get(), 100, 0);
  std::vector<unsigned char> touches(path.size(), 0);
  touches[10] = touches[59] = 1;
  EXPECT_EQ(score_path(model.get(), path.size(), rows(path), touches.data(), 0.15).used, 50U);
  EXPECT_EQ(score_path(model.get(), 9, rows(path), touches.data(), 0.15).used, 0U);
}

#ifdef CATHETER_HAS_EMBREE
// The cube [-1, 1]^3: of each face two triangles, facing outwards.
wall makeCube(double reach) {
  float corner[8][3];
  for (int i = 0; i < 8; ++i)
    for (int a = 0; a < 3; ++a) corner[i][a] = (i >> a & 1) != 0 ? 1.0F : -1.0F;
  const std::uint32_t triangle[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                         {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                         {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return wall_of_mesh(8, corner, 12, triangle, reach);
}

TEST(MeshWall, GivesSignedDistanceAndOutwardNormalOfACube) {
  wall cube = makeCube(2);
  ASSERT_NE(cube.self, nullptr);
  const double points[3][3] = {{0.1, 0.2, 0.5}, {0.1, 0.2, 1.25}, {-0.9, 0, 0.3}};
  std::uint32_t cursors[3] = {cube.start_cursor, cube.start_cursor, cube.start_cursor};
  double distances[3], normals[3][3];
  for (int again = 0; again < 2; ++again) {
    cube.query(cube.self, 3, points, cursors, distances, normals);
    EXPECT_NEAR(distances[0], -0.5, 1e-7);
    EXPECT_NEAR(normals[0][2], 1, 1e-7);
    EXPECT_NEAR(distances[1], 0.25, 1e-7);
    EXPECT_NEAR(normals[1][2], 1, 1e-7);
    EXPECT_NEAR(distances[2], -0.1, 1e-7);
    EXPECT_NEAR(normals[2][0], -1, 1e-7);
  }
  cube.close(cube.self);
}

TEST(MeshWall, SeesNothingBeyondItsReach) {
  wall cube = makeCube(0.25);
  const double points[1][3] = {{0, 0, 0}};
  std::uint32_t cursor = cube.start_cursor;
  double distance, normal[1][3];
  cube.query(cube.self, 1, points, &cursor, &distance, normal);
  EXPECT_EQ(distance, -0.25);
  EXPECT_EQ(normal[0][0], 0);
  cube.close(cube.self);
}
#endif

}  // namespace
