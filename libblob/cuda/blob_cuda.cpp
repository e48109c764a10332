// SPDX-License-Identifier: Apache-2.0
// The functions of blob_cuda.h.
#include "blob_cuda.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>

#include "uploaded.h"

namespace {

constexpr std::uint32_t kDefinition = 0x41445543U, kColumns = 0x4f435543U;  // cookies

void report(const blob_cuda_def& def, const std::string& reason) {
  if (def.message == nullptr || def.message_size == 0) return;
  const std::size_t length = std::min(reason.size(), def.message_size - 1);
  std::memcpy(def.message, reason.data(), length);
  def.message[length] = '\0';
}

blob_cuda_status create(const void* buffer, std::size_t size, const blob_cuda_def& def,
                        blob_cuda** vessels) {
  const blob_status checked = blob_device_check(buffer, size);
  if (checked != BLOB_OK) {
    report(def, std::string("the packed buffer is refused: ") + blob_status_text(checked));
    return BLOB_CUDA_ERROR_BUFFER;
  }
  auto made = std::make_unique<blob_cuda>();
  std::string reason;
  const blob_cuda_status status = made->open(def.device, buffer, size, reason);
  if (status == BLOB_CUDA_OK)
    *vessels = made.release();
  else
    report(def, reason);
  return status;
}

}  // namespace

extern "C" {

const char* blob_cuda_status_text(blob_cuda_status status) noexcept {
  switch (status) {
    case BLOB_CUDA_OK:
      return "done";
    case BLOB_CUDA_ERROR_MEMORY:
      return "the system has no more memory";
    case BLOB_CUDA_ERROR_ARGUMENT:
      return "a pointer is null, a structure was not made by its default function, or the buffer "
             "has no such vessel";
    case BLOB_CUDA_ERROR_BUFFER:
      return "the packed buffer is refused";
    case BLOB_CUDA_ERROR_NO_DRIVER:
      return "NVIDIA's driver cannot be loaded, or lacks a function";
    case BLOB_CUDA_ERROR_NO_DEVICE:
      return "there is no such device, or it cannot be used";
    case BLOB_CUDA_ERROR_DEVICE_MEMORY:
      return "the device has not enough memory, or copying to it failed";
    case BLOB_CUDA_ERROR_KERNEL:
      return "the driver does not translate the kernels";
    case BLOB_CUDA_ERROR_LAUNCH:
      return "the driver refuses the query";
  }
  return "no status of libblob";
}

blob_cuda_def blob_cuda_def_default(void) noexcept {
  return {-1, nullptr, 0, kDefinition};
}

blob_cuda_status blob_cuda_create(const void* buffer, size_t size, const blob_cuda_def* def,
                                  blob_cuda** vessels) noexcept {
  const blob_cuda_def usual = blob_cuda_def_default();
  if (vessels == nullptr) return BLOB_CUDA_ERROR_ARGUMENT;
  *vessels = nullptr;
  if (def == nullptr) def = &usual;
  if (def->cookie != kDefinition || buffer == nullptr) return BLOB_CUDA_ERROR_ARGUMENT;
  try {
    return create(buffer, size, *def, vessels);
  } catch (const std::exception&) {
    return BLOB_CUDA_ERROR_MEMORY;
  }
}

void blob_cuda_close(blob_cuda* vessels) noexcept {
  delete vessels;
}

const uint32_t* blob_cuda_words(const blob_cuda* vessels) noexcept {
  return reinterpret_cast<const uint32_t*>(static_cast<std::uintptr_t>(vessels->words()));
}

uint32_t blob_cuda_vessel_count(const blob_cuda* vessels) noexcept {
  return vessels->vesselCount();
}

blob_cuda_columns blob_cuda_columns_default(void) noexcept {
  return {0, 0, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, kColumns};
}

blob_cuda_status blob_cuda_query(const blob_cuda* vessels, CUstream_st* stream, uint32_t flags,
                                 const blob_cuda_columns* columns) noexcept {
  if (vessels == nullptr || columns == nullptr || columns->cookie != kColumns)
    return BLOB_CUDA_ERROR_ARGUMENT;
  const blob_cuda_columns& c = *columns;
  if (c.vessel_of_point == nullptr && c.vessel >= vessels->vesselCount())
    return BLOB_CUDA_ERROR_ARGUMENT;
  if (c.count == 0) return BLOB_CUDA_OK;
  if (c.point == nullptr || c.cursor == nullptr || c.answer == nullptr)
    return BLOB_CUDA_ERROR_ARGUMENT;
  return vessels->launch(stream, flags, c);
}

}  // extern "C"
