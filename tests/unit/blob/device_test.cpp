// SPDX-License-Identifier: Apache-2.0
// The flat buffer of blob_device.h, and its functions on this processor.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "blob.h"
#include "blob_device_exact.h"
#include "blob_pose.h"
#include "tree.h"

namespace lumen::blob::test {
namespace {

using Words = std::vector<std::uint32_t>;

Words pack(const std::vector<const blob_model*>& models) {
  const std::size_t bytes = blob_device_pack(models.data(), models.size(), nullptr, 0);
  Words words(bytes / 4);
  EXPECT_EQ(blob_device_pack(models.data(), models.size(), words.data(), bytes), bytes);
  return words;
}

blob_status check(const Words& words) {
  return blob_device_check(words.data(), 4 * words.size());
}

// A wavy vessel of another kernel; its widths are those of the Cauchy kernel, so f is not T at the
// radius.
Tree ofKernel(blob_kernel kernel, double parameter, double level) {
  Tree tree = helix(60, 0.02);
  tree.kernel = kernel;
  tree.parameter = parameter;
  tree.level = level;
  for (float& width : tree.blobWidth) width *= 2.5f;
  return tree;
}

std::vector<Tree> trees() {
  return {tube(20, 0.01),
          helix(120, 0.02),
          fork(0.7, 0.02),
          bend(0.03),
          kissing(0),
          ofKernel(BLOB_GAUSSIAN, 0.5, 0.1),
          ofKernel(BLOB_QUARTIC, 0, 0.1),
          ofKernel(BLOB_SOFT_OBJECT, 0, 0.1)};
}

void expectNear(const blob_device_sample& found, const blob_sample& wanted, double error) {
  EXPECT_EQ(found.node, wanted.node);
  EXPECT_EQ(found.state, wanted.state);
  EXPECT_NEAR(double{found.value}, wanted.value, error);
  EXPECT_NEAR(double{found.distance}, wanted.distance, error * std::max(1.0, wanted.distance));
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(double{found.gradient[k]}, wanted.gradient[k], error);
    EXPECT_NEAR(double{found.normal[k]}, wanted.normal[k], error);
  }
}

// Walks a cursor of each kind to random points about the nodes of a model. Every operation on floats
// is that of the library, so answers have its bits where centres are floats.
void compare(const blob_model* model, std::uint32_t flags, double error) {
  const Words words = pack({model});
  ASSERT_EQ(check(words), BLOB_OK);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1.6, 1.6);
  const std::size_t count = blob_model_describe(model).node_count;
  std::uint32_t here = 0, there = 0;
  for (int n = 0; n < 20000 && !testing::Test::HasFailure(); ++n) {
    const auto node = static_cast<std::uint32_t>(n % 3 == 0 ? random() % count : here);
    const blob_node about = blob_model_node(model, node);
    float point[3];
    for (std::size_t k = 0; k < 3; ++k)
      point[k] = static_cast<float>(about.centre[k] + about.radius * u(random));
    const double same[3] = {point[0], point[1], point[2]};
    blob_sample wanted;
    blob_device_sample found;
    blob_query(model, flags, same, &here, &wanted);
    blob_device_query(words.data(), 0, flags, point, &there, &found);
    expectNear(found, wanted, error);
  }
}

void compare(const Tree& tree, std::uint32_t flags) {
  compare(tree.build().get(), flags, 0);
}

TEST(BlobDevice, BlendedAnswersAreThoseOfTheLibrary) {
  for (const Tree& tree : trees()) compare(tree, BLOB_BLENDED);
}

TEST(BlobDevice, LocalAnswersAreThoseOfTheLibrary) {
  for (const Tree& tree : trees()) compare(tree, BLOB_LOCAL);
}

TEST(BlobDevice, APosedModelKeepsTheDigitsOfItsCentres) {
  const Tree tree = fork(0.7, 0.02);
  const Model model = tree.build();
  blob_pose* pose = nullptr;
  ASSERT_EQ(blob_pose_create(model.get(), nullptr, &pose), BLOB_OK);
  std::vector<std::uint32_t> nodes;
  std::vector<std::array<double, 3>> centres;
  for (std::size_t i = 0; i < tree.centre.size(); ++i) {
    nodes.push_back(static_cast<std::uint32_t>(i));
    centres.push_back({tree.centre[i][0] + 100.123456789, tree.centre[i][1] + 0.0123456789,
                       tree.centre[i][2] - 300.0 / 7});
  }
  ASSERT_EQ(blob_pose_set_centres(pose, nodes.size(), nodes.data(),
                                  reinterpret_cast<const double(*)[3]>(centres.data()), nullptr),
            BLOB_OK);
  compare(blob_pose_model(pose), BLOB_BLENDED, 1e-5);
  blob_pose_close(pose);
}

TEST(BlobDevice, AHeldCursorStays) {
  const Model model = tube(20).build();
  const Words words = pack({model.get()});
  const float point[3] = {6, 0.5f, 0};
  std::uint32_t cursor = 3;
  blob_device_sample sample;
  blob_device_query(words.data(), 0, BLOB_DEVICE_HOLD | BLOB_DEVICE_LOCAL, point, &cursor, &sample);
  EXPECT_EQ(cursor, 3U);
  EXPECT_EQ(sample.node, 3U);
}

TEST(BlobDevice, AnUnknownCursorIsLocated) {
  const Model model = kissing(0.1).build();
  const Words words = pack({model.get()});
  for (const float y : {0.3f, 1.9f}) {
    const float point[3] = {6, y, 0};
    const double same[3] = {6, double{y}, 0};
    std::uint32_t cursor = BLOB_NOWHERE;
    blob_device_sample sample;
    blob_device_query(words.data(), 0, 0, point, &cursor, &sample);
    EXPECT_EQ(cursor, blob_cursor_locate(model.get(), same));
  }
}

TEST(BlobDevice, APointThatIsNotANumberIsOutside) {
  const Model model = tube(20).build();
  const Words words = pack({model.get()});
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  for (const float x : {nan, infinity, 1e20f}) {
    const float point[3] = {x, 0, 0};
    std::uint32_t cursor = 4;
    blob_device_sample sample;
    blob_device_query(words.data(), 0, 0, point, &cursor, &sample);
    EXPECT_EQ(cursor, 4U);
    EXPECT_EQ(sample.state, 0U);
    EXPECT_EQ(std::isnan(sample.distance), std::isnan(x));
    EXPECT_EQ(std::isnan(sample.value), std::isnan(x));
  }
}

TEST(BlobDevice, ABufferHoldsManyVessels) {
  const Model a = tube(20, 0.01).build(), b = fork(0.7, 0.02).build();
  const Words words = pack({a.get(), b.get()});
  ASSERT_EQ(check(words), BLOB_OK);
  EXPECT_EQ(words[3], 2U);
  const float point[3] = {1.1f, 0.4f, 0.2f};
  const double same[3] = {double{point[0]}, double{point[1]}, double{point[2]}};
  for (std::uint32_t i = 0; i < 2; ++i) {
    std::uint32_t here = BLOB_NOWHERE, there = BLOB_NOWHERE;
    blob_sample wanted;
    blob_device_sample found;
    blob_query(i == 0 ? a.get() : b.get(), 0, same, &here, &wanted);
    blob_device_query(words.data(), i, 0, point, &there, &found);
    EXPECT_EQ(there, here);
    EXPECT_EQ(double{found.distance}, wanted.distance);
  }
}

TEST(BlobDevice, ATooSmallBufferIsLeftAlone) {
  const Model model = tube(20).build();
  const blob_model* models[1] = {model.get()};
  Words words(100, 7);
  EXPECT_GT(blob_device_pack(models, 1, words.data(), 400), 400U);
  EXPECT_EQ(words, Words(100, 7));
  EXPECT_EQ(blob_device_pack(models, 0, nullptr, 0), 0U);
}

TEST(BlobDeviceCheck, NamesTheFault) {
  const Words good = pack({tube(20).build().get()});
  ASSERT_EQ(check(good), BLOB_OK);
  const std::size_t row = BLOB_DEVICE_HEADER_WORDS, nodes = good[row + 2],
                    neighbours = good[row + 3], blobs = good[row + 4];
  const auto with = [&good](std::size_t word, std::uint32_t value) {
    Words bad = good;
    bad[word] = value;
    return check(bad);
  };
  constexpr std::uint32_t kNan = 0x7fc00000U;
  EXPECT_EQ(blob_device_check(nullptr, 64), BLOB_ERROR_ARGUMENT);
  EXPECT_EQ(blob_device_check(good.data(), 4 * good.size() - 4), BLOB_ERROR_FORMAT);
  EXPECT_EQ(blob_device_check(good.data(), 8), BLOB_ERROR_FORMAT);
  EXPECT_EQ(with(0, 1), BLOB_ERROR_FORMAT);
  EXPECT_EQ(with(1, BLOB_DEVICE_VERSION + 1), BLOB_ERROR_FORMAT);
  EXPECT_EQ(with(3, 0), BLOB_ERROR_EMPTY);
  EXPECT_EQ(with(3, 0xFFFFFFFFU), BLOB_ERROR_FORMAT);
  EXPECT_EQ(with(row, 4), BLOB_ERROR_KERNEL);
  EXPECT_EQ(with(row + 1, 0), BLOB_ERROR_EMPTY);
  EXPECT_EQ(with(row + 1, BLOB_MAX_NODES + 1), BLOB_ERROR_LIMIT);
  EXPECT_EQ(with(row + 2, good[row + 2] + 16), BLOB_ERROR_FORMAT);
  EXPECT_EQ(with(row + 5, kNan), BLOB_ERROR_RANGE);
  EXPECT_EQ(with(row + 7, 0xFFFFFFF0U), BLOB_ERROR_FORMAT);
  EXPECT_EQ(with(nodes, kNan), BLOB_ERROR_RANGE);
  EXPECT_EQ(with(nodes + 3, 0), BLOB_ERROR_RANGE);
  EXPECT_EQ(with(nodes + 9, 0xFFFFFFFFU), BLOB_ERROR_TOPOLOGY);
  EXPECT_EQ(with(nodes + 10, 0xFFFFFFFFU), BLOB_ERROR_TOPOLOGY);
  EXPECT_EQ(with(neighbours + 40, 20), BLOB_ERROR_TOPOLOGY);
  EXPECT_EQ(with(neighbours + 32, 0), BLOB_ERROR_RANGE);
  EXPECT_EQ(with(blobs + 32, kNan), BLOB_ERROR_RANGE);
}

// With the address sanitizer: no query of a buffer that passes reads outside of it.
TEST(BlobDeviceCheck, AChangedBufferThatPassesIsQueriedWithinItsBounds) {
  const Words good = pack({fork(0.7, 0.02).build().get()});
  std::mt19937 random(9);
  int passed = 0;
  for (int n = 0; n < 3000; ++n) {
    Words words = good;
    const std::size_t word = random() % words.size();
    words[word] = n % 2 == 0 ? words[word] ^ (1U << random() % 32) : random() % 64;
    if (check(words) != BLOB_OK) continue;
    ++passed;
    std::uint32_t cursor = 0;
    for (int k = 0; k < 5; ++k) {
      const float point[3] = {static_cast<float>(k) - 2, 0.3f, 0.1f};
      blob_device_sample sample;
      blob_device_query(words.data(), 0, 0, point, &cursor, &sample);
      blob_device_query_exact(words.data(), 0, 0, point, &cursor, &sample);
    }
    ASSERT_LT(cursor, words[BLOB_DEVICE_HEADER_WORDS + 1]);
  }
  EXPECT_GT(passed, 500);
}

}  // namespace
}  // namespace lumen::blob::test
