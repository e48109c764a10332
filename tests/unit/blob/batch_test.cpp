// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "blob.h"
#include "tree.h"

namespace lumen::blob::test {
namespace {

constexpr std::uint32_t kFlags[] = {BLOB_BLENDED, BLOB_LOCAL, BLOB_LOCAL | BLOB_HOLD,
                                    BLOB_DISTANCE_EXACT};

std::vector<Point> points(std::size_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1.2, 1.2), x(-6, 8);
  std::vector<Point> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back({x(random), 2 * u(random), u(random)});
  if (count > 5) result[5] = {NAN, 0, 0};
  return result;
}

std::vector<blob_sample> single(const blob_model* model, std::uint32_t flags,
                                const std::vector<Point>& at) {
  std::vector<blob_sample> samples(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    std::uint32_t cursor = BLOB_NOWHERE;
    blob_query(model, flags, at[i].data(), &cursor, &samples[i]);
  }
  return samples;
}

std::vector<blob_sample> batch(const blob_model* model, std::uint32_t flags,
                               const std::vector<Point>& at) {
  std::vector<blob_sample> samples(at.size());
  std::vector<std::uint32_t> cursors(at.size(), BLOB_NOWHERE);
  blob_query_many(model, flags, at.size(), reinterpret_cast<const double(*)[3]>(at.data()),
                  cursors.data(), samples.data());
  return samples;
}

// Not-a-numbers have many bit patterns; elsewhere bits must agree.
void expectSame(const std::vector<blob_sample>& a, const std::vector<blob_sample>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i].value))
      ASSERT_TRUE(std::isnan(b[i].value));
    else
      ASSERT_TRUE(sameBits(a[i], b[i])) << i;
  }
}

TEST(BlobBatch, HasTheBitsOfSingleQueries) {
  const Model model = fork(0.5, 0.03).build();
  for (const std::uint32_t flags : kFlags)
    for (const std::size_t count : {1U, 7U, 8U, 9U, 203U})
      expectSame(single(model.get(), flags, points(count)),
                 batch(model.get(), flags, points(count)));
}

class BlobPath : public testing::TestWithParam<std::tuple<blob_simd, blob_kernel>> {};

TEST_P(BlobPath, HasTheBitsOfTheScalarReference) {
  const auto [simd, kernel] = GetParam();
  Tree tree;
  tree.kernel = kernel;
  tree.parameter = kernel == BLOB_GAUSSIAN ? 0.5 : 0.2;
  addVessel(tree, straight({-6, 0, 0}, {8, 1, 0}, 22), 1.0, -1, 0.02);
  tree.addNode({9, 1, 0}, 1.0, 21);
  for (int i = 0; i < 19; ++i) tree.addBlob({8 + 0.1 * i, 1, 0.02 * i}, 0.3);  // three blocks
  const Model reference = tree.build(BLOB_SIMD_SCALAR), model = tree.build(simd);
  if (blob_model_describe(model.get()).simd != simd)
    GTEST_SKIP() << "this processor or build does not have the back end";
  for (const std::uint32_t flags : kFlags)
    expectSame(batch(reference.get(), flags, points(1000)),
               batch(model.get(), flags, points(1000)));
  for (const Point& p : points(300)) {
    std::uint32_t a = BLOB_NOWHERE, b = BLOB_NOWHERE;
    ASSERT_EQ(blob_inside(reference.get(), 0, p.data(), &a),
              blob_inside(model.get(), 0, p.data(), &b));
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, BlobPath,
    testing::Combine(testing::Values(BLOB_SIMD_PORTABLE, BLOB_SIMD_AVX2, BLOB_SIMD_AVX512),
                     testing::Values(BLOB_CAUCHY, BLOB_GAUSSIAN, BLOB_QUARTIC, BLOB_SOFT_OBJECT)));

TEST(BlobColumns, StructureOfArraysGivesTheSameNumbers) {
  const Model model = fork(0.5, 0.03).build();
  const std::vector<Point> at = points(101);
  const std::vector<blob_sample> expected = single(model.get(), 0, at);
  std::vector<double> in[3], out[8];
  for (std::size_t k = 0; k < 3; ++k)
    for (const Point& p : at) in[k].push_back(p[k]);
  for (auto& column : out) column.resize(at.size());
  std::vector<std::uint8_t> state(at.size());
  blob_columns c = blob_columns_default();
  c.count = at.size();
  c.value = out[0].data();
  c.distance = out[4].data();
  for (std::size_t k = 0; k < 3; ++k) {
    c.point[k] = in[k].data();
    c.gradient[k] = out[1 + k].data();
    c.normal[k] = out[5 + k].data();
  }
  c.state = state.data();
  blob_query_columns(model.get(), 0, &c);
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (i == 5) continue;  // no number
    EXPECT_EQ(out[0][i], expected[i].value);
    EXPECT_EQ(out[4][i], expected[i].distance);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(out[1 + k][i], expected[i].gradient[k]);
      EXPECT_EQ(out[5 + k][i], expected[i].normal[k]);
    }
    EXPECT_EQ(state[i], expected[i].state);
  }
}

TEST(BlobColumns, NormalsMayOverwriteThePoints) {
  const Model model = fork(0.5, 0.03).build();
  std::vector<Point> at = points(101);
  const std::vector<blob_sample> expected = single(model.get(), 0, at);
  blob_columns c = blob_columns_default();
  c.count = at.size();
  c.point_stride = c.answer_stride = sizeof(Point);
  for (std::size_t k = 0; k < 3; ++k) {
    c.point[k] = &at[0][k];
    c.normal[k] = &at[0][k];
  }
  blob_query_columns(model.get(), 0, &c);
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (i != 5) {
      EXPECT_EQ(at[i][1], expected[i].normal[1]);
    }
  }
}

TEST(BlobColumns, NothingNeedsToBeAligned) {
  const Model model = fork(0.5, 0.03).build();
  const Point p{1, 0.2, 0.1};
  std::vector<char> bytes(100);
  std::memcpy(&bytes[1], p.data(), sizeof p);
  const std::uint32_t start = 3;
  std::memcpy(&bytes[31], &start, sizeof start);
  blob_columns c = blob_columns_default();
  c.count = 1;
  for (std::size_t k = 0; k < 3; ++k)
    c.point[k] = reinterpret_cast<const double*>(&bytes[1 + 8 * k]);
  c.cursor = reinterpret_cast<std::uint32_t*>(&bytes[31]);
  c.distance = reinterpret_cast<double*>(&bytes[41]);
  blob_query_columns(model.get(), 0, &c);
  std::uint32_t cursor = start, moved;
  blob_sample expected;
  blob_query(model.get(), 0, p.data(), &cursor, &expected);
  double distance;
  std::memcpy(&distance, &bytes[41], sizeof distance);
  std::memcpy(&moved, &bytes[31], sizeof moved);
  EXPECT_EQ(distance, expected.distance);
  EXPECT_EQ(moved, cursor);
}

TEST(BlobThreads, ResultsDoNotDependOnTheirNumber) {
  const Model model = helix(200, 0.02).build();
  std::vector<Point> at;
  for (int i = 0; i < 4000; ++i) {
    const double a = 0.007 * i;
    at.push_back({4.3 * std::cos(a), 4.3 * std::sin(a), 5 * a / 6.283185307179586});
  }
  const std::vector<blob_sample> expected = batch(model.get(), 0, at);
  for (const std::size_t threadCount : {2U, 3U, 5U}) {
    std::vector<blob_sample> samples(at.size());
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < threadCount; ++t)
      threads.emplace_back([&, t] {
        const std::size_t begin = at.size() * t / threadCount,
                          end = at.size() * (t + 1) / threadCount;
        blob_query_many(model.get(), 0, end - begin,
                        reinterpret_cast<const double(*)[3]>(&at[begin]), nullptr, &samples[begin]);
      });
    for (std::thread& thread : threads) thread.join();
    expectSame(expected, samples);
  }
}

}  // namespace
}  // namespace lumen::blob::test
