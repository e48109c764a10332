// SPDX-License-Identifier: Apache-2.0
// A packed buffer and the kernels on one device.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "blob_cuda.h"
#include "driver.h"

namespace lumen::blob::cuda {

/// Makes a context current on the calling thread while it lives.
class Entered {
public:
  Entered(const Driver& driver, Context context)
      : m_driver(driver), m_result(driver.contextPush(context)) {}
  Entered(const Entered&) = delete;
  Entered& operator=(const Entered&) = delete;
  ~Entered() {
    Context left;
    if (m_result == kSuccess) m_driver.contextPop(&left);
  }
  [[nodiscard]] Result result() const { return m_result; }

private:
  const Driver& m_driver;
  Result m_result;
};

}  // namespace lumen::blob::cuda

struct blob_cuda {
  blob_cuda() = default;
  blob_cuda(const blob_cuda&) = delete;
  blob_cuda& operator=(const blob_cuda&) = delete;
  ~blob_cuda();

  /// Loads the driver, enters a device's context, translates the kernels and copies the buffer.
  /// `reason` states the fault in one sentence without a full stop.
  blob_cuda_status open(int device, const void* buffer, std::size_t size, std::string& reason);

  [[nodiscard]] std::uint32_t vesselCount() const { return m_vesselCount; }
  [[nodiscard]] std::uint64_t words() const { return m_words; }
  /// Launches a query with checked columns.
  [[nodiscard]] blob_cuda_status launch(CUstream_st* stream, std::uint32_t flags,
                                        const blob_cuda_columns& columns) const;

private:
  blob_cuda_status enterDevice(int device, std::string& reason);
  /// Kernels for a checked buffer.
  blob_cuda_status loadKernels(const std::uint32_t* words, std::string& reason);
  blob_cuda_status upload(const void* buffer, std::size_t size, std::string& reason);
  [[nodiscard]] std::string reasonOf(const char* function, lumen::blob::cuda::Result result) const;

  lumen::blob::cuda::Driver m_driver;
  lumen::blob::cuda::Context m_context = nullptr;
  lumen::blob::cuda::Device m_retained = kNone;  // whose primary context is held
  lumen::blob::cuda::Module m_module = nullptr;
  lumen::blob::cuda::Function m_query = nullptr, m_pairs = nullptr, m_crowds = nullptr,
                              m_exactQuery = nullptr;
  lumen::blob::cuda::Address m_words = 0;
  std::uint32_t m_vesselCount = 0;
  static constexpr int kNone = -1;
};
