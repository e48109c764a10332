// SPDX-License-Identifier: Apache-2.0
// The host side of blob_cuda.h, on the stand-in for NVIDIA's driver.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "blob_cuda.h"
#include "blob_device_exact.h"
#include "stand_in_driver.h"
#include "tree.h"

namespace lumen::blob::test {
namespace {

using Words = std::vector<std::uint32_t>;
using Calls = std::vector<std::string>;

struct CloseVessels {
  void operator()(blob_cuda* vessels) const { blob_cuda_close(vessels); }
};
using Vessels = std::unique_ptr<blob_cuda, CloseVessels>;

// Points about the nodes of a model, and room for answers: "device" memory of the stand-in.
struct Points {
  std::vector<float> point, answer, value;
  Words cursor, vessel, state;

  Points(const blob_model* model, std::size_t count, unsigned seed = 1)
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
  blob_cuda_status create(const blob_cuda_def* def = nullptr) {
    blob_cuda* vessels = reinterpret_cast<blob_cuda*>(this);  // must not stay
    const blob_cuda_status status =
        blob_cuda_create(m_packed.data(), 4 * m_packed.size(), def, &vessels);
    EXPECT_EQ(vessels != nullptr, status == BLOB_CUDA_OK);
    m_vessels.reset(vessels);
    return status;
  }
  static void expectAnswersOf(const blob_model* model, std::uint32_t flags, const Points& before,
                              const Points& after) {
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

TEST_F(BlobCuda, AnswersAreThoseOfTheLibrary) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  for (const std::uint32_t flags : {BLOB_BLENDED, BLOB_LOCAL, BLOB_LOCAL | BLOB_HOLD}) {
    Points points(m_fork.get(), 3001);
    const Points before = points;
    blob_cuda_columns c = points.columns();
    c.vessel = 1;
    ASSERT_EQ(blob_cuda_query(m_vessels.get(), nullptr, flags, &c), BLOB_CUDA_OK);
    stand_in::run(nullptr);
    expectAnswersOf(m_fork.get(), flags, before, points);
  }
}

TEST_F(BlobCuda, ExactDistancesAreThoseOfTheHeader) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  Points points(m_tube.get(), 500);
  const Points before = points;
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
  Points a(m_tube.get(), 100), b(m_fork.get(), 100);
  Points mixed = a;
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
    const Points& alone = i % 2 == 0 ? a : b;
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
  Points points(m_tube.get(), 40), with = points;
  blob_cuda_columns c = points.columns(), all = with.columns();
  c.value = nullptr;
  c.state = nullptr;
  ASSERT_EQ(blob_cuda_query(m_vessels.get(), nullptr, 0, &c), BLOB_CUDA_OK);
  ASSERT_EQ(blob_cuda_query(m_vessels.get(), nullptr, 0, &all), BLOB_CUDA_OK);
  stand_in::run(nullptr);
  EXPECT_EQ(points.answer, with.answer);
  EXPECT_EQ(points.value, std::vector<float>(160, -7));
}

TEST_F(BlobCuda, AQueryIsOneLaunchThatNeitherWaitsNorAllocates) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  CUstream_st stream;
  Points points(m_tube.get(), 1000);
  blob_cuda_columns c = points.columns();
  stand_in::takeCalls();
  ASSERT_EQ(blob_cuda_query(m_vessels.get(), &stream, 0, &c), BLOB_CUDA_OK);
  EXPECT_EQ(stand_in::takeCalls(),
            (Calls{"cuCtxPushCurrent_v2", "cuLaunchKernel", "cuCtxPopCurrent_v2"}));
  EXPECT_EQ(stand_in::entered(), 0U);
  EXPECT_EQ(stand_in::waiting(&stream), 1U);
  EXPECT_EQ(points.answer, std::vector<float>(4000, -7));
  c.count = 0;  // the launch has its own copy of the arguments
  stand_in::run(&stream);
  EXPECT_NE(points.answer.back(), -7);
  EXPECT_EQ(stand_in::threadsOfLastLaunch(), 1024U);
}

TEST_F(BlobCuda, NoPointsAreNoLaunch) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  stand_in::takeCalls();
  const blob_cuda_columns none = blob_cuda_columns_default();
  EXPECT_EQ(blob_cuda_query(m_vessels.get(), nullptr, 0, &none), BLOB_CUDA_OK);
  EXPECT_EQ(stand_in::takeCalls(), Calls{});
}

TEST_F(BlobCuda, StreamsAreIndependentAndKeepTheirOrder) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  CUstream_st first, second;
  Points a(m_tube.get(), 200, 1), b(m_tube.get(), 200, 2), next = a;
  const Words unmoved = a.cursor;
  blob_cuda_columns ofA = a.columns(), ofB = b.columns(), ofNext = next.columns();
  ofNext.cursor = a.cursor.data();  // continues from the cursors that the first query has moved
  ASSERT_EQ(blob_cuda_query(m_vessels.get(), &first, 0, &ofA), BLOB_CUDA_OK);
  ASSERT_EQ(blob_cuda_query(m_vessels.get(), &second, 0, &ofB), BLOB_CUDA_OK);
  ASSERT_EQ(blob_cuda_query(m_vessels.get(), &first, BLOB_HOLD, &ofNext), BLOB_CUDA_OK);
  stand_in::run(&second);
  EXPECT_NE(b.answer.front(), -7);
  EXPECT_EQ(a.answer.front(), -7);
  EXPECT_EQ(a.cursor, unmoved);
  stand_in::run(&first);
  EXPECT_NE(a.cursor, unmoved);
  EXPECT_EQ(next.answer, a.answer);  // held where the first has moved to
}

TEST_F(BlobCuda, WrongArgumentsAreRefusedWithoutALaunch) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  Points points(m_tube.get(), 10);
  stand_in::takeCalls();
  const auto refused = [&](auto change) {
    blob_cuda_columns c = points.columns();
    change(c);
    return blob_cuda_query(m_vessels.get(), nullptr, 0, &c) == BLOB_CUDA_ERROR_ARGUMENT;
  };
  EXPECT_TRUE(refused([](blob_cuda_columns& c) { c.point = nullptr; }));
  EXPECT_TRUE(refused([](blob_cuda_columns& c) { c.cursor = nullptr; }));
  EXPECT_TRUE(refused([](blob_cuda_columns& c) { c.answer = nullptr; }));
  EXPECT_TRUE(refused([](blob_cuda_columns& c) { c.vessel = 2; }));
  EXPECT_TRUE(refused([](blob_cuda_columns& c) { c.cookie = 0; }));
  EXPECT_EQ(blob_cuda_query(m_vessels.get(), nullptr, 0, nullptr), BLOB_CUDA_ERROR_ARGUMENT);
  EXPECT_EQ(stand_in::takeCalls(), Calls{});
}

TEST_F(BlobCuda, AWrongBufferIsRefusedBeforeTheDriverIsLoaded) {
  m_packed[1] = BLOB_MAX_NODES;  // no such version
  char message[200] = "";
  blob_cuda_def def = blob_cuda_def_default();
  def.message = message;
  def.message_size = sizeof message;
  EXPECT_EQ(create(&def), BLOB_CUDA_ERROR_BUFFER);
  EXPECT_NE(std::strstr(message, blob_status_text(BLOB_ERROR_FORMAT)), nullptr) << message;
  EXPECT_EQ(stand_in::takeCalls(), Calls{});
  def.cookie = 0;
  EXPECT_EQ(create(&def), BLOB_CUDA_ERROR_ARGUMENT);
  blob_cuda* none = nullptr;
  EXPECT_EQ(blob_cuda_create(nullptr, 64, nullptr, &none), BLOB_CUDA_ERROR_ARGUMENT);
  EXPECT_EQ(blob_cuda_create(m_packed.data(), 64, nullptr, nullptr), BLOB_CUDA_ERROR_ARGUMENT);
}

struct FaultOfDriver {
  const char* function;
  blob_cuda_status status;
};

TEST_F(BlobCuda, EachFaultOfTheDriverHasItsStatusAndLeavesNothing) {
  const FaultOfDriver faults[] = {{"cuInit", BLOB_CUDA_ERROR_NO_DEVICE},
                                  {"cuCtxGetCurrent", BLOB_CUDA_ERROR_NO_DEVICE},
                                  {"cuDeviceGetCount", BLOB_CUDA_ERROR_NO_DEVICE},
                                  {"cuDeviceGet", BLOB_CUDA_ERROR_NO_DEVICE},
                                  {"cuDevicePrimaryCtxRetain", BLOB_CUDA_ERROR_NO_DEVICE},
                                  {"cuCtxPushCurrent_v2", BLOB_CUDA_ERROR_NO_DEVICE},
                                  {"cuModuleLoadDataEx", BLOB_CUDA_ERROR_KERNEL},
                                  {"cuModuleGetFunction", BLOB_CUDA_ERROR_KERNEL},
                                  {"cuMemAlloc_v2", BLOB_CUDA_ERROR_DEVICE_MEMORY},
                                  {"cuMemcpyHtoD_v2", BLOB_CUDA_ERROR_DEVICE_MEMORY},
                                  {"cuStreamSynchronize", BLOB_CUDA_ERROR_DEVICE_MEMORY}};
  for (const FaultOfDriver& fault : faults) {
    SCOPED_TRACE(fault.function);
    stand_in::reset();
    stand_in::failAt(fault.function, 2);
    char message[300] = "";
    blob_cuda_def def = blob_cuda_def_default();
    def.message = message;
    def.message_size = sizeof message;
    EXPECT_EQ(create(&def), fault.status);
    const std::string name = fault.function, plain = name.substr(0, name.find("_v2"));
    EXPECT_EQ(std::string(message).rfind(plain + ": out of memory (2)", 0), 0U) << message;
    EXPECT_EQ(stand_in::held(), 0U);
    EXPECT_EQ(stand_in::entered(), 0U);
  }
}

TEST_F(BlobCuda, TheLogOfTheTranslationIsReported) {
  stand_in::failAt("cuModuleLoadDataEx", 218);
  char message[300] = "", few[8] = "";
  blob_cuda_def def = blob_cuda_def_default();
  def.message = message;
  def.message_size = sizeof message;
  EXPECT_EQ(create(&def), BLOB_CUDA_ERROR_KERNEL);
  EXPECT_NE(std::strstr(message, "ptxas of the stand-in is not content"), nullptr) << message;
  def.message = few;
  def.message_size = sizeof few;
  EXPECT_EQ(create(&def), BLOB_CUDA_ERROR_KERNEL);
  EXPECT_STREQ(few, "cuModul");
}

TEST_F(BlobCuda, ARefusedLaunchIsReportedAndTheContextLeft) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  Points points(m_tube.get(), 10);
  const blob_cuda_columns c = points.columns();
  for (const char* function : {"cuLaunchKernel", "cuCtxPushCurrent_v2"}) {
    stand_in::failAt(function, 400);
    EXPECT_EQ(blob_cuda_query(m_vessels.get(), nullptr, 0, &c), BLOB_CUDA_ERROR_LAUNCH);
    EXPECT_EQ(stand_in::waiting(nullptr), 0U);
    EXPECT_EQ(stand_in::entered(), 0U);
  }
}

TEST_F(BlobCuda, ADeviceIsChosenByItsNumber) {
  stand_in::reset(2);
  blob_cuda_def def = blob_cuda_def_default();
  char message[100] = "";
  def.message = message;
  def.message_size = sizeof message;
  def.device = 1;
  EXPECT_EQ(create(&def), BLOB_CUDA_OK);
  def.device = 2;
  EXPECT_EQ(create(&def), BLOB_CUDA_ERROR_NO_DEVICE);
  EXPECT_STREQ(message, "there is no device 2 among 2");
  def.device = -2;
  EXPECT_EQ(create(&def), BLOB_CUDA_ERROR_NO_DEVICE);
  stand_in::reset(0);
  EXPECT_EQ(create(), BLOB_CUDA_ERROR_NO_DEVICE);
}

TEST_F(BlobCuda, TheCurrentContextIsUsedAndStaysCurrent) {
  stand_in::enterOwnContext();
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  const Calls calls = stand_in::takeCalls();
  EXPECT_EQ(std::count(calls.begin(), calls.end(), "cuDevicePrimaryCtxRetain"), 0);
  EXPECT_EQ(stand_in::entered(), 1U);
  m_vessels.reset();
  EXPECT_EQ(stand_in::held(), 0U);
  EXPECT_EQ(stand_in::entered(), 1U);
}

TEST_F(BlobCuda, TheBufferIsOnTheDeviceWhenCreationReturns) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  const Calls calls = stand_in::takeCalls();
  const auto copy = std::find(calls.begin(), calls.end(), "cuMemcpyHtoD_v2");
  EXPECT_NE(std::find(copy, calls.end(), "cuStreamSynchronize"), calls.end());
}

TEST_F(BlobCuda, ClosingFreesWhatWasMade) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  EXPECT_EQ(stand_in::held(), 3U);  // memory, module, context
  EXPECT_EQ(std::memcmp(blob_cuda_words(m_vessels.get()), m_packed.data(), 4 * m_packed.size()), 0);
  m_vessels.reset();
  EXPECT_EQ(stand_in::held(), 0U);
  blob_cuda_close(nullptr);
}

TEST(BlobCudaStatus, EachHasAText) {
  for (int status = BLOB_CUDA_OK; status <= BLOB_CUDA_ERROR_LAUNCH + 1; ++status)
    for (int other = BLOB_CUDA_OK; other < status; ++other)
      EXPECT_STRNE(blob_cuda_status_text(static_cast<blob_cuda_status>(status)),
                   blob_cuda_status_text(static_cast<blob_cuda_status>(other)));
}

}  // namespace
}  // namespace lumen::blob::test
