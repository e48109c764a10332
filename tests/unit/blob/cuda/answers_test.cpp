// SPDX-License-Identifier: Apache-2.0
// Answers of the kernels of query.cu, on the stand-in for NVIDIA's driver.
#include <algorithm>
#include <cmath>

#include "blob_device_exact.h"
#include "cuda_fixture.h"

namespace lumen::blob::test {
namespace {

TEST_F(BlobCuda, AnswersAreThoseOfTheLibrary) {
  for (const std::uint32_t flags : {BLOB_BLENDED, BLOB_HOLD, BLOB_LOCAL, BLOB_LOCAL | BLOB_HOLD})
    expectAnswers(m_fork.get(), flags, 1, AskedPoints(m_fork.get(), 3001));
}

// Blocks gather from spans of several times their threads.
TEST_F(BlobCuda, AnswersOfManyPointsAreThoseOfTheLibrary) {
  expectAnswers(m_fork.get(), BLOB_BLENDED, 1, AskedPoints(m_fork.get(), 300'001));
}

TEST_F(BlobCuda, AnswersOfEachKernelAreThoseOfTheLibrary) {
  for (const auto& [kernel, parameter] :
       {std::pair{BLOB_GAUSSIAN, 0.5}, {BLOB_QUARTIC, 0.0}, {BLOB_SOFT_OBJECT, 0.0}}) {
    Tree tree = fork(0.7, 0.02);
    tree.kernel = kernel;
    tree.parameter = parameter;
    for (float& width : tree.blobWidth) width *= 2.5f;
    const Model model = tree.build();
    pack(model.get());
    expectAnswers(model.get(), BLOB_BLENDED, 0, AskedPoints(model.get(), 2000));
    EXPECT_EQ(stand_in::takeLaunches().back().kernel, "blob_blend_crowds");
  }
}

TEST_F(BlobCuda, CursorsThatAreNowhereAreLocated) {
  AskedPoints points(m_fork.get(), 200);
  for (std::size_t i = 0; i < 200; i += 3) points.cursor[i] = BLOB_NOWHERE;
  expectAnswers(m_fork.get(), BLOB_BLENDED, 1, points);
}

TEST_F(BlobCuda, APointOutOfRangeHasNoFieldAndLeavesItsCursor) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  AskedPoints points(m_tube.get(), 200);
  const std::uint32_t cursor = points.cursor[100];
  points.point[300] = 1e15f;
  const blob_cuda_columns c = points.columns();
  ASSERT_EQ(blob_cuda_query(m_vessels.get(), nullptr, 0, &c), BLOB_CUDA_OK);
  stand_in::run(nullptr);
  EXPECT_EQ(points.cursor[100], cursor);
  EXPECT_FLOAT_EQ(points.answer[400], 1e15f);
  EXPECT_FLOAT_EQ(points.answer[401], 1);
  EXPECT_EQ(points.value[400], 0);
}

TEST_F(BlobCuda, RowsOfAnswersNeedNoAlignment) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  AskedPoints points(m_fork.get(), 500), shifted = points;
  for (std::vector<float>* rows : {&shifted.answer, &shifted.value}) rows->push_back(-7);
  blob_cuda_columns c = points.columns(), d = shifted.columns();
  c.vessel = d.vessel = 1;
  ++d.answer;
  ++d.value;
  for (const blob_cuda_columns& columns : {c, d})
    ASSERT_EQ(blob_cuda_query(m_vessels.get(), nullptr, 0, &columns), BLOB_CUDA_OK);
  stand_in::run(nullptr);
  EXPECT_TRUE(std::equal(points.answer.begin(), points.answer.end(), shifted.answer.begin() + 1));
  EXPECT_TRUE(std::equal(points.value.begin(), points.value.end(), shifted.value.begin() + 1));
  EXPECT_EQ(shifted.answer.front(), -7);
}

TEST_F(BlobCuda, ExactDistancesAreThoseOfTheHeader) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  AskedPoints points(m_tube.get(), 500);
  const AskedPoints before = points;
  const blob_cuda_columns c = points.columns();
  ASSERT_EQ(blob_cuda_query(m_vessels.get(), nullptr, BLOB_DISTANCE_EXACT, &c), BLOB_CUDA_OK);
  stand_in::run(nullptr);
  for (std::size_t i = 0; i < 500; ++i) {
    std::uint32_t cursor = before.cursor[i];
    blob_device_sample wanted;
    blob_device_query_exact(m_packed.data(), 0, BLOB_DISTANCE_EXACT, &before.point[3 * i], &cursor,
                            &wanted);
    EXPECT_EQ(points.answer[4 * i], wanted.distance);
    EXPECT_EQ(points.answer[4 * i + 1], wanted.normal[0]);
    EXPECT_EQ(points.value[4 * i], wanted.value);
    EXPECT_EQ(points.state[i], wanted.state);
  }
}

TEST_F(BlobCuda, APointMayHaveAVesselOfItsOwn) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  EXPECT_EQ(blob_cuda_vessel_count(m_vessels.get()), 2U);
  AskedPoints a(m_tube.get(), 100), b(m_fork.get(), 100);
  AskedPoints mixed = a;
  for (std::size_t i = 1; i < 100; i += 2) {
    std::copy_n(&b.point[3 * i], 3, &mixed.point[3 * i]);
    mixed.cursor[i] = b.cursor[i];
    mixed.vessel[i] = 1;
  }
  mixed.vessel[50] = 2;  // there is none
  const std::uint32_t unmoved = mixed.cursor[50];
  for (const auto& [points, vessel] : {std::pair{&a, 0U}, {&b, 1U}}) {
    blob_cuda_columns c = points->columns();
    c.vessel = vessel;
    ASSERT_EQ(blob_cuda_query(m_vessels.get(), nullptr, 0, &c), BLOB_CUDA_OK);
  }
  blob_cuda_columns c = mixed.columns();
  c.vessel_of_point = mixed.vessel.data();
  ASSERT_EQ(blob_cuda_query(m_vessels.get(), nullptr, 0, &c), BLOB_CUDA_OK);
  stand_in::run(nullptr);
  for (std::size_t i = 0; i < 100; ++i) {
    if (i == 50) continue;
    const AskedPoints& alone = i % 2 == 0 ? a : b;
    EXPECT_EQ(mixed.answer[4 * i], alone.answer[4 * i]);
    EXPECT_EQ(mixed.cursor[i], alone.cursor[i]);
    EXPECT_EQ(mixed.state[i], alone.state[i]);
  }
  EXPECT_TRUE(std::isnan(mixed.answer[200]) && std::isnan(mixed.value[203]));
  EXPECT_EQ(mixed.state[50], 0U);
  EXPECT_EQ(mixed.cursor[50], unmoved);
}

TEST_F(BlobCuda, ValueAndStateAreOptional) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  AskedPoints points(m_tube.get(), 40), with = points;
  blob_cuda_columns c = points.columns(), all = with.columns();
  c.value = nullptr;
  c.state = nullptr;
  ASSERT_EQ(blob_cuda_query(m_vessels.get(), nullptr, 0, &c), BLOB_CUDA_OK);
  ASSERT_EQ(blob_cuda_query(m_vessels.get(), nullptr, 0, &all), BLOB_CUDA_OK);
  stand_in::run(nullptr);
  EXPECT_EQ(points.answer, with.answer);
  EXPECT_EQ(points.value, std::vector<float>(160, -7));
}

}  // namespace
}  // namespace lumen::blob::test
