// SPDX-License-Identifier: Apache-2.0
// blob_query_columns() as a kernel of CUDA: a thread for each tool point. It includes nothing of an
// SDK, so that clang alone compiles it to PTX:
//
//     clang -x cuda --cuda-gpu-arch=sm_80 -nocudainc -nocudalib --cuda-device-only -S -O3
//           -ffp-contract=off -I INCLUDE query.cu
#include "blob_device.h"

#if !defined(__global__)
#define __global__ __attribute__((global))
#endif

namespace {

#if defined(__CUDA_ARCH__) && defined(__clang__)
__attribute__((device)) unsigned indexOfThread() {
  return __nvvm_read_ptx_sreg_ctaid_x() * __nvvm_read_ptx_sreg_ntid_x() +
         __nvvm_read_ptx_sreg_tid_x();
}
#elif defined(__CUDA_ARCH__)
__attribute__((device)) unsigned indexOfThread() {
  return blockIdx.x * blockDim.x + threadIdx.x;
}
#else
__attribute__((device)) unsigned indexOfThread();
#endif

}  // namespace

// Arguments are those of the kernel in query.cl.
extern "C" __global__ void blob_query_points(const uint32_t* words, uint32_t vessel, uint32_t flags,
                                             uint32_t count, const float* point, uint32_t* cursor,
                                             float* answer, float* value, uint32_t* state) {
  const uint32_t i = indexOfThread();
  if (i >= count) return;
  const float at[3] = {point[3 * i], point[3 * i + 1], point[3 * i + 2]};
  uint32_t node = cursor[i];
  blob_device_sample sample;
  blob_device_query(words, vessel, flags, at, &node, &sample);
  cursor[i] = node;
  answer[4 * i] = sample.distance;
  for (int k = 0; k < 3; ++k) answer[4 * i + 1 + k] = sample.normal[k];
  if (state != nullptr) state[i] = sample.state;
  if (value == nullptr) return;
  value[4 * i] = sample.value;
  for (int k = 0; k < 3; ++k) value[4 * i + 1 + k] = sample.gradient[k];
}
