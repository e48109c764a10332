// SPDX-License-Identifier: Apache-2.0
// blob_query_columns() as kernels of CUDA: a thread for each tool point. They include nothing of an
// SDK, so that clang alone compiles them to PTX, as for blob_cuda.h:
//
//     clang -x cuda --cuda-gpu-arch=sm_70 -nocudainc -nocudalib --cuda-device-only -S -O3
//           -ffp-contract=off -I INCLUDE query.cu
//
// BLOB_DEVICE_THREAD, where it is defined, is the index of a thread instead.
#include "blob_device_exact.h"

#if !defined(__global__)
#define __global__ __attribute__((global))
#endif
#if !defined(BLOB_DEVICE_THREAD)
#if defined(__CUDA_ARCH__) && defined(__clang__)
#define BLOB_DEVICE_THREAD                                                    \
  ((uint64_t)__nvvm_read_ptx_sreg_ctaid_x() * __nvvm_read_ptx_sreg_ntid_x() + \
   __nvvm_read_ptx_sreg_tid_x())
#else
#define BLOB_DEVICE_THREAD ((uint64_t)blockIdx.x * blockDim.x + threadIdx.x)
#endif
#endif

namespace {

// Columns of points and answers.
struct Columns {
  const float* point;
  uint32_t* cursor;
  float *answer, *value;
  uint32_t* state;
};

BLOB_DEVICE_FN void writeAnswer(const Columns& to, uint64_t i, const blob_device_sample& sample) {
  to.answer[4 * i] = sample.distance;
  for (uint32_t k = 0; k < 3; ++k) to.answer[4 * i + 1 + k] = sample.normal[k];
  if (to.state != nullptr) to.state[i] = sample.state;
  if (to.value == nullptr) return;
  to.value[4 * i] = sample.value;
  for (uint32_t k = 0; k < 3; ++k) to.value[4 * i + 1 + k] = sample.gradient[k];
}

BLOB_DEVICE_FN void answerNoVessel(const Columns& to, uint64_t i) {
  const float nan = blob_device_float(0x7fc00000u);
  writeAnswer(to, i, blob_device_sample{nan, {nan, nan, nan}, nan, {nan, nan, nan}, 0, 0});
}

// Answers point i of its vessel; `Exact` is a constant, so that each kernel holds one query.
template <bool Exact>
BLOB_DEVICE_FN void answerPoint(const uint32_t* words, uint32_t vessel, uint32_t flags,
                                const Columns& columns, uint64_t i) {
  if (vessel >= words[3]) {
    answerNoVessel(columns, i);
    return;
  }
  const float* from = columns.point + 3 * i;
  const float at[3] = {from[0], from[1], from[2]};
  uint32_t node = columns.cursor[i];
  blob_device_sample sample;
  if (Exact)
    blob_device_query_exact(words, vessel, flags, at, &node, &sample);
  else
    blob_device_query(words, vessel, flags, at, &node, &sample);
  columns.cursor[i] = node;
  writeAnswer(columns, i, sample);
}

}  // namespace

// Arguments are those of the kernel in query.cl, and the vessel of each point, or null where all are
// of `vessel`. A vessel that the buffer has not gives NaN, outside, and leaves the cursor.
extern "C" __global__ void blob_query_points(const uint32_t* words, uint32_t vessel, uint32_t flags,
                                             uint32_t count, const float* point, uint32_t* cursor,
                                             float* answer, float* value, uint32_t* state,
                                             const uint32_t* vessel_of_point) {
  const uint64_t i = BLOB_DEVICE_THREAD;
  if (i >= count) return;
  answerPoint<false>(words, vessel_of_point != nullptr ? vessel_of_point[i] : vessel, flags,
                     Columns{point, cursor, answer, value, state}, i);
}

// The same with the distance to the nearest point of the wall and the normal there, as for
// BLOB_DISTANCE_EXACT; `state` may have BLOB_DEVICE_NOT_CONVERGED.
extern "C" __global__ void blob_query_exact_points(const uint32_t* words, uint32_t vessel,
                                                   uint32_t flags, uint32_t count,
                                                   const float* point, uint32_t* cursor,
                                                   float* answer, float* value, uint32_t* state,
                                                   const uint32_t* vessel_of_point) {
  const uint64_t i = BLOB_DEVICE_THREAD;
  if (i >= count) return;
  answerPoint<true>(words, vessel_of_point != nullptr ? vessel_of_point[i] : vessel, flags,
                    Columns{point, cursor, answer, value, state}, i);
}
