// SPDX-License-Identifier: Apache-2.0
#include "uploaded.h"

#include <algorithm>
#include <cstring>

namespace lumen::blob::cuda {

/// PTX of libblob/device/query.cu, zero-terminated; the build makes it (write_ptx.cmake).
extern const char kKernels[];

}  // namespace lumen::blob::cuda

using namespace lumen::blob::cuda;

namespace {

// as in query.cu; measured on an H100 (docs/benchmarks.md)
constexpr unsigned kThreadsOfBlock = 64;
constexpr std::uint32_t kMostOfPairs = 512, kMostOfCrowds = 1536, kManyBlocks = 4096;
constexpr std::size_t kVesselCountWord = 3, kHeaderWords = 4, kVesselWords = 8;
constexpr std::uint32_t kCauchy = 0;

bool areCauchy(const std::uint32_t* words) {
  for (std::size_t i = 0; i < words[kVesselCountWord]; ++i)
    if (words[kHeaderWords + kVesselWords * i] != kCauchy) return false;
  return true;
}

std::uint32_t quotientUp(std::uint64_t a, std::uint64_t b) {
  return static_cast<std::uint32_t>((a + b - 1) / b);
}

}  // namespace

std::string blob_cuda::reasonOf(const char* function, Result result) const {
  const char* text = nullptr;
  if (m_driver.errorString(result, &text) != kSuccess || text == nullptr) text = "unknown error";
  return std::string(function) + ": " + text + " (" + std::to_string(result) + ")";
}

blob_cuda_status blob_cuda::open(int device, const void* buffer, std::size_t size,
                                 std::string& reason) {
  if (!load(m_driver, reason)) return BLOB_CUDA_ERROR_NO_DRIVER;
  blob_cuda_status status = enterDevice(device, reason);
  if (status != BLOB_CUDA_OK) return status;
  const Entered entered(m_driver, m_context);
  if (entered.result() != kSuccess) {
    reason = reasonOf("cuCtxPushCurrent", entered.result());
    return BLOB_CUDA_ERROR_NO_DEVICE;
  }
  status = loadKernels(static_cast<const std::uint32_t*>(buffer), reason);
  return status == BLOB_CUDA_OK ? upload(buffer, size, reason) : status;
}

blob_cuda_status blob_cuda::enterDevice(int device, std::string& reason) {
  const auto failed = [&](const char* function, Result result) {
    if (result != kSuccess) reason = reasonOf(function, result);
    return result != kSuccess;
  };
  if (failed("cuInit", m_driver.init(0))) return BLOB_CUDA_ERROR_NO_DEVICE;
  if (device == kNone) {
    if (failed("cuCtxGetCurrent", m_driver.contextCurrent(&m_context)))
      return BLOB_CUDA_ERROR_NO_DEVICE;
    if (m_context != nullptr) return BLOB_CUDA_OK;
    device = 0;
  }
  int count = 0;
  if (failed("cuDeviceGetCount", m_driver.deviceCount(&count))) return BLOB_CUDA_ERROR_NO_DEVICE;
  if (device < 0 || device >= count) {
    reason = "there is no device " + std::to_string(device) + " among " + std::to_string(count);
    return BLOB_CUDA_ERROR_NO_DEVICE;
  }
  Device handle = 0;
  if (failed("cuDeviceGet", m_driver.deviceGet(&handle, device)) ||
      failed("cuDevicePrimaryCtxRetain", m_driver.primaryRetain(&m_context, handle)))
    return BLOB_CUDA_ERROR_NO_DEVICE;
  m_retained = handle;
  return BLOB_CUDA_OK;
}

blob_cuda_status blob_cuda::loadKernels(const std::uint32_t* words, std::string& reason) {
  char log[2048] = "";
  int names[2] = {kErrorLog, kErrorLogBytes};
  // the driver reads the size from the bits of the pointer
  void* values[2] = {log, reinterpret_cast<void*>(std::uintptr_t{sizeof log})};
  Result result = m_driver.moduleLoad(&m_module, kKernels, 2, names, values);
  if (result != kSuccess) {
    m_module = nullptr;
    log[sizeof log - 1] = '\0';
    reason = reasonOf("cuModuleLoadDataEx", result);
    if (log[0] != '\0') reason += std::string(": ") + log;
    return BLOB_CUDA_ERROR_KERNEL;
  }
  const std::string suffix = areCauchy(words) ? "_cauchy" : "";
  const auto find = [&](Function& function, const std::string& name) {
    if (result == kSuccess) result = m_driver.moduleFunction(&function, m_module, name.c_str());
  };
  find(m_query, "blob_query_points" + suffix);
  find(m_pairs, "blob_blend_pairs" + suffix);
  find(m_crowds, "blob_blend_crowds" + suffix);
  find(m_exactQuery, "blob_query_exact_points");
  if (result == kSuccess) return BLOB_CUDA_OK;
  reason = reasonOf("cuModuleGetFunction", result);
  return BLOB_CUDA_ERROR_KERNEL;
}

blob_cuda_status blob_cuda::upload(const void* buffer, std::size_t size, std::string& reason) {
  std::memcpy(&m_vesselCount,
              static_cast<const char*>(buffer) + kVesselCountWord * sizeof m_vesselCount,
              sizeof m_vesselCount);
  Result result = m_driver.allocate(&m_words, size);
  if (result != kSuccess) {
    m_words = 0;
    reason = reasonOf("cuMemAlloc", result);
    return BLOB_CUDA_ERROR_DEVICE_MEMORY;
  }
  const char* function = "cuMemcpyHtoD";
  result = m_driver.copyToDevice(m_words, buffer, size);
  if (result == kSuccess) {
    // the copy from pageable memory returns before the device has it, and streams of callers do not
    // wait for the default stream
    function = "cuStreamSynchronize";
    result = m_driver.streamSynchronize(nullptr);
  }
  if (result == kSuccess) return BLOB_CUDA_OK;
  reason = reasonOf(function, result);
  return BLOB_CUDA_ERROR_DEVICE_MEMORY;
}

blob_cuda_status blob_cuda::launch(CUstream_st* stream, std::uint32_t flags,
                                   const blob_cuda_columns& columns) const {
  blob_cuda_columns c = columns;
  std::uint64_t words = m_words;
  // few points are for as many blocks as possible, many for blocks with much to choose from
  const std::uint32_t wanted =
      kThreadsOfBlock * quotientUp(c.count, std::uint64_t{kThreadsOfBlock} * kManyBlocks);
  std::uint32_t span = 0;
  // in the order of the kernels' arguments, of which the driver copies the values
  void* arguments[] = {&words,    &c.vessel, &flags,   &c.count,           &c.point, &c.cursor,
                       &c.answer, &c.value,  &c.state, &c.vessel_of_point, &span};
  const Entered entered(m_driver, m_context);
  Result result = entered.result();
  const auto start = [&](Function kernel, std::uint32_t pointsOfBlock) {
    if (result == kSuccess)
      result = m_driver.launch(kernel, quotientUp(c.count, pointsOfBlock), 1, 1, kThreadsOfBlock, 1,
                               1, 0, stream, arguments, nullptr);
  };
  if ((flags & BLOB_DISTANCE_EXACT) != 0) {
    start(m_exactQuery, kThreadsOfBlock);
  } else {
    start(m_query, kThreadsOfBlock);
    if ((flags & BLOB_LOCAL) == 0) {
      start(m_pairs, span = std::min(wanted, kMostOfPairs));
      start(m_crowds, span = std::min(wanted, kMostOfCrowds));
    }
  }
  return result == kSuccess ? BLOB_CUDA_OK : BLOB_CUDA_ERROR_LAUNCH;
}

blob_cuda::~blob_cuda() {
  if (m_context != nullptr) {
    const Entered entered(m_driver, m_context);
    if (entered.result() == kSuccess) {
      if (m_words != 0) m_driver.release(m_words);
      if (m_module != nullptr) m_driver.moduleUnload(m_module);
    }
  }
  if (m_retained != kNone) m_driver.primaryRelease(m_retained);
}
