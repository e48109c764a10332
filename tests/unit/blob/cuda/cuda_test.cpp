// SPDX-License-Identifier: Apache-2.0
// The host side of blob_cuda.h, on the stand-in for NVIDIA's driver.
#include <algorithm>
#include <cstring>

#include "cuda_fixture.h"

namespace lumen::blob::test {
namespace {

// Names of the kernels that ran.
Calls kernelsOf(const std::vector<stand_in::Launch>& launches) {
  Calls names;
  for (const stand_in::Launch& launch : launches) names.push_back(launch.kernel);
  return names;
}

TEST_F(BlobCuda, AQueryIsThreeLaunchesThatNeitherWaitNorAllocate) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  CUstream_st stream;
  AskedPoints points(m_tube.get(), 1000);
  blob_cuda_columns c = points.columns();
  stand_in::takeCalls();
  ASSERT_EQ(blob_cuda_query(m_vessels.get(), &stream, 0, &c), BLOB_CUDA_OK);
  EXPECT_EQ(stand_in::takeCalls(), (Calls{"cuCtxPushCurrent_v2", "cuLaunchKernel", "cuLaunchKernel",
                                          "cuLaunchKernel", "cuCtxPopCurrent_v2"}));
  EXPECT_EQ(stand_in::entered(), 0U);
  EXPECT_EQ(stand_in::waiting(&stream), 3U);
  EXPECT_EQ(points.answer, std::vector<float>(4000, -7));
  c.count = 0;  // the launches have their own copy of the arguments
  stand_in::run(&stream);
  EXPECT_NE(points.answer.back(), -7);
  const std::vector<stand_in::Launch> launches = stand_in::takeLaunches();
  EXPECT_EQ(kernelsOf(launches), (Calls{"blob_query_points_cauchy", "blob_blend_pairs_cauchy",
                                        "blob_blend_crowds_cauchy"}));
  for (const stand_in::Launch& launch : launches) EXPECT_EQ(launch.threads, 1024U);
}

TEST_F(BlobCuda, LocalAndExactQueriesAreOneLaunch) {
  ASSERT_EQ(create(), BLOB_CUDA_OK);
  AskedPoints points(m_tube.get(), 100);
  const blob_cuda_columns c = points.columns();
  for (const std::uint32_t flags : {BLOB_LOCAL, BLOB_DISTANCE_EXACT})
    ASSERT_EQ(blob_cuda_query(m_vessels.get(), nullptr, flags, &c), BLOB_CUDA_OK);
  stand_in::run(nullptr);
  EXPECT_EQ(kernelsOf(stand_in::takeLaunches()),
            (Calls{"blob_query_points_cauchy", "blob_query_exact_points"}));
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
  AskedPoints a(m_tube.get(), 200, 1), b(m_tube.get(), 200, 2), next = a;
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
  AskedPoints points(m_tube.get(), 10);
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
  AskedPoints points(m_tube.get(), 10);
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
