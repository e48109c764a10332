// SPDX-License-Identifier: Apache-2.0
// The search of blob_device_exact.h for the nearest point of the wall, on this processor.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "blob.h"
#include "blob_device_exact.h"
#include "tree.h"

namespace lumen::blob::test {
namespace {

constexpr double kPromised = 1e-5;  // share of the radius
constexpr int kPoints = 10000;

// Answers of both sides at random points about the nodes of a model, out to 1.6 radii.
struct Answers {
  struct Pair {
    double point[3], radius;
    blob_sample library;
    blob_device_sample device;
  };
  Model model;
  std::vector<Pair> pairs;

  explicit Answers(const Tree& tree, std::uint32_t flags = BLOB_BLENDED) : model(tree.build()) {
    const blob_model* models[1] = {model.get()};
    std::vector<std::uint32_t> words(blob_device_pack(models, 1, nullptr, 0) / 4);
    blob_device_pack(models, 1, words.data(), 4 * words.size());
    std::mt19937 random(5);
    std::uniform_real_distribution<double> u(-1.6, 1.6);
    for (int n = 0; n < kPoints; ++n) {
      std::uint32_t here = static_cast<std::uint32_t>(random() % tree.radius.size()), there = here;
      const blob_node about = blob_model_node(model.get(), here);
      float point[3];
      for (std::size_t k = 0; k < 3; ++k)
        point[k] = static_cast<float>(about.centre[k] + about.radius * u(random));
      Pair pair{{double{point[0]}, double{point[1]}, double{point[2]}}, 0, {}, {}};
      blob_query(model.get(), flags | BLOB_DISTANCE_EXACT, pair.point, &here, &pair.library);
      blob_device_query_exact(words.data(), 0, flags, point, &there, &pair.device);
      pair.radius = blob_model_node(model.get(), here).radius;
      pairs.push_back(pair);
    }
  }
  // Number of points for which a condition holds.
  template <class Holds>
  [[nodiscard]] int count(Holds holds) const {
    return static_cast<int>(std::count_if(pairs.begin(), pairs.end(), holds));
  }
};

bool hasConverged(const Answers::Pair& pair) {
  return (pair.device.state & BLOB_DEVICE_NOT_CONVERGED) == 0;
}

bool hasLibraryConverged(const Answers::Pair& pair) {
  return (pair.library.state & BLOB_NOT_CONVERGED) == 0;
}

// Whether the library has found a nearer place of the wall.
bool isFarther(const Answers::Pair& pair) {
  return std::abs(double{pair.device.distance}) >
         std::abs(pair.library.distance) + kPromised * pair.radius;
}

bool isAsNear(const Answers::Pair& pair) {
  return std::abs(double{pair.device.distance} - pair.library.distance) <= kPromised * pair.radius;
}

std::vector<Tree> smoothTrees() {
  return {tube(20, 0.01), helix(120, 0.02), fork(0.7, 0.02), kissing(0)};
}

TEST(BlobDeviceExact, DistancesAreThoseOfTheLibrary) {
  for (const Tree& tree : smoothTrees()) {
    const Answers answers(tree);
    EXPECT_GE(answers.count(isAsNear), kPoints * 999 / 1000);
    EXPECT_LE(answers.count(isFarther), kPoints / 1000);
    EXPECT_EQ(answers.count(hasConverged), kPoints);
  }
}

TEST(BlobDeviceExact, NodeSideAndFieldAreThoseOfTheLibrary) {
  for (const Tree& tree : smoothTrees()) {
    const Answers answers(tree);
    for (const Answers::Pair& pair : answers.pairs) {
      ASSERT_EQ(pair.device.node, pair.library.node);
      ASSERT_EQ(pair.device.state & BLOB_INSIDE, pair.library.state & BLOB_INSIDE);
      ASSERT_EQ(double{pair.device.value}, pair.library.value);
      ASSERT_EQ(pair.device.distance < 0, (pair.device.state & BLOB_INSIDE) != 0);
    }
  }
}

// Where several points of the wall are nearest of all places about them, the two sides may find
// different ones, so each foot is looked at by itself.
TEST(BlobDeviceExact, FeetLieOnTheWallAndTheirNormalsLeadToThePoint) {
  for (const Tree& tree : {helix(120, 0.02), fork(0.7, 0.02)}) {
    const Answers answers(tree);
    int turned = 0;
    for (const Answers::Pair& pair : answers.pairs) {
      double foot[3], cosine = 0;
      for (std::size_t k = 0; k < 3; ++k)
        foot[k] = pair.point[k] - double{pair.device.distance} * double{pair.device.normal[k]};
      std::uint32_t cursor = pair.library.node;
      blob_sample there;
      blob_query(answers.model.get(), BLOB_BLENDED, foot, &cursor, &there);
      for (std::size_t k = 0; k < 3; ++k) cosine += there.normal[k] * double{pair.device.normal[k]};
      ASSERT_LE(std::abs(there.distance), 1e-3 * pair.radius);
      turned += cosine < 0.9999 ? 1 : 0;
    }
    EXPECT_LE(turned, kPoints / 500);  // where arms meet
  }
}

TEST(BlobDeviceExact, MorePointsConvergeThanInTheLibraryWhereTheWallIsCreased) {
  const Answers answers(bend(0.03));
  EXPECT_GE(answers.count(hasConverged), answers.count(hasLibraryConverged));
  EXPECT_LE(answers.count(isFarther), kPoints / 50);
}

// The wall of models that do not blend has steps, at which neither side converges.
TEST(BlobDeviceExact, ALocalModelHasItsOwnWall) {
  const Answers answers(tube(20, 0.01), BLOB_LOCAL);
  const int whole = answers.count(hasLibraryConverged);
  EXPECT_GE(whole, kPoints * 98 / 100);
  EXPECT_GE(answers.count([](const Answers::Pair& pair) {
    return hasLibraryConverged(pair) && isAsNear(pair);
  }),
            whole * 999 / 1000);
}

TEST(BlobDeviceExact, ABallHasItsRadius) {
  const Answers answers(oneBlob());
  const double wall =
      std::abs(answers.pairs[0].library.distance) +
      (answers.pairs[0].library.distance < 0 ? 1 : -1) * norm(answers.pairs[0].point);
  for (const Answers::Pair& pair : answers.pairs)
    EXPECT_NEAR(double{pair.device.distance}, norm(pair.point) - std::abs(wall), 1e-5);
}

TEST(BlobDeviceExact, APointThatIsNotANumberIsOutsideAndItsCursorStays) {
  const Model model = tube(20).build();
  const blob_model* models[1] = {model.get()};
  std::vector<std::uint32_t> words(blob_device_pack(models, 1, nullptr, 0) / 4);
  blob_device_pack(models, 1, words.data(), 4 * words.size());
  const float point[3] = {std::numeric_limits<float>::quiet_NaN(), 0, 0};
  std::uint32_t cursor = 4;
  blob_device_sample sample;
  blob_device_query_exact(words.data(), 0, 0, point, &cursor, &sample);
  EXPECT_EQ(cursor, 4U);
  EXPECT_EQ(sample.state, 0U);
  EXPECT_TRUE(std::isnan(sample.distance));
}

}  // namespace
}  // namespace lumen::blob::test
