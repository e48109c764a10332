// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <cstring>

extern "C" {
#include "cuda_runtime.h"
}
#include "stand_in_driver.h"

extern "C" {

cudaError_t cudaStreamCreate(cudaStream_t* stream) {
  static CUstream_st only;
  *stream = &only;
  return cudaSuccess;
}

cudaError_t cudaMalloc(void** memory, size_t bytes) {
  *memory = std::malloc(bytes);
  return cudaSuccess;
}

cudaError_t cudaMemcpyAsync(void* to, const void* from, size_t bytes, cudaMemcpyKind,
                            cudaStream_t stream) {
  stream->launches.emplace_back([=] { std::memcpy(to, from, bytes); });
  return cudaSuccess;
}

cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  lumen::blob::test::stand_in::run(stream);
  return cudaSuccess;
}

}  // extern "C"
