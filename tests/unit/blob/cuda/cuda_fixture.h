// SPDX-License-Identifier: Apache-2.0
// Two vessels on the stand-in for NVIDIA's driver, and points about them.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "blob_cuda.h"
#include "stand_in_driver.h"
#include "tree.h"

namespace lumen::blob::test {

using Words = std::vector<std::uint32_t>;
using Calls = std::vector<std::string>;

struct CloseVessels {
  void operator()(blob_cuda* vessels) const { blob_cuda_close(vessels); }
};
using Vessels = std::unique_ptr<blob_cuda, CloseVessels>;

/// AskedPoints about the nodes of a model, and room for answers: "device" memory of the stand-in.
struct AskedPoints {
  std::vector<float> point, answer, value;
  Words cursor, vessel, state;

  AskedPoints(const blob_model* model, std::size_t count, unsigned seed = 1)
      : answer(4 * count, -7), value(4 * count, -7), vessel(count, 0), state(count, 7) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-1.5, 1.5);
    const std::size_t nodes = blob_model_describe(model).node_count;
    for (std::size_t i = 0; i < count; ++i) {
      cursor.push_back(static_cast<std::uint32_t>(random() % nodes));
      const blob_node at = blob_model_node(model, cursor.back());
      for (const double centre : at.centre)
        point.push_back(static_cast<float>(centre + at.radius * u(random)));
    }
  }
  blob_cuda_columns columns() {
    blob_cuda_columns c = blob_cuda_columns_default();
    c.count = static_cast<std::uint32_t>(cursor.size());
    c.point = point.data();
    c.cursor = cursor.data();
    c.answer = answer.data();
    c.value = value.data();
    c.state = state.data();
    return c;
  }
};

class BlobCuda : public testing::Test {
protected:
  void SetUp() override {
    stand_in::reset();
    const blob_model* models[2] = {m_tube.get(), m_fork.get()};
    m_packed.resize(blob_device_pack(models, 2, nullptr, 0) / 4);
    blob_device_pack(models, 2, m_packed.data(), 4 * m_packed.size());
  }
  void pack(const blob_model* model) {
    m_packed.resize(blob_device_pack(&model, 1, nullptr, 0) / 4);
    blob_device_pack(&model, 1, m_packed.data(), 4 * m_packed.size());
  }
  // Creates, asks and runs; answers are expected to be those of the library.
  void expectAnswers(const blob_model* model, std::uint32_t flags, std::uint32_t vessel,
                     AskedPoints points) {
    ASSERT_EQ(create(), BLOB_CUDA_OK);
    const AskedPoints before = points;
    blob_cuda_columns c = points.columns();
    c.vessel = vessel;
    ASSERT_EQ(blob_cuda_query(m_vessels.get(), nullptr, flags, &c), BLOB_CUDA_OK);
    stand_in::run(nullptr);
    expectAnswersOf(model, flags, before, points);
  }
  blob_cuda_status create(const blob_cuda_def* def = nullptr) {
    blob_cuda* vessels = reinterpret_cast<blob_cuda*>(this);  // must not stay
    const blob_cuda_status status =
        blob_cuda_create(m_packed.data(), 4 * m_packed.size(), def, &vessels);
    EXPECT_EQ(vessels != nullptr, status == BLOB_CUDA_OK);
    m_vessels.reset(vessels);
    return status;
  }
  static void expectAnswersOf(const blob_model* model, std::uint32_t flags,
                              const AskedPoints& before, const AskedPoints& after) {
    for (std::size_t i = 0; i < before.cursor.size() && !HasFailure(); ++i) {
      const float* p = &before.point[3 * i];
      const double at[3] = {double{p[0]}, double{p[1]}, double{p[2]}};
      std::uint32_t cursor = before.cursor[i];
      blob_sample wanted;
      blob_query(model, flags, at, &cursor, &wanted);
      EXPECT_EQ(after.cursor[i], cursor);
      EXPECT_EQ(double{after.answer[4 * i]}, wanted.distance);
      EXPECT_EQ(double{after.value[4 * i]}, wanted.value);
      EXPECT_EQ(after.state[i], wanted.state);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(double{after.answer[4 * i + 1 + k]}, wanted.normal[k]);
        EXPECT_EQ(double{after.value[4 * i + 1 + k]}, wanted.gradient[k]);
      }
    }
  }

  Model m_tube = tube(20, 0.01).build(), m_fork = fork(0.7, 0.02).build();
  Words m_packed;
  Vessels m_vessels;
};

}  // namespace lumen::blob::test
