/* SPDX-License-Identifier: Apache-2.0 */
/* Layouts that programs have compiled in, which the sonames libblob.so.1, libblob-cuda.so.1 and liblumen-case.so.1 promise:
 * size of each struct and offset of its last member, and the last value of each enumeration, on 64-bit Linux. A line that no
 * longer holds is a change that breaks these programs: take it back, or raise the soname. Values are added at the end. */
#include <assert.h>
#include <stddef.h>

#include "blob_cuda.h"
#include "blob_pose.h"
#include "lumen/case.h"

#define LAYOUT(type, size, last, offset) \
  static_assert(sizeof(type) == (size) && offsetof(type, last) == (offset), #type)

LAYOUT(blob_open_def, 32, cookie, 24);
LAYOUT(blob_blobs, 48, width, 40);
LAYOUT(blob_model_def, 104, cookie, 100);
LAYOUT(blob_model_info, 104, bytes, 96);
LAYOUT(blob_node, 40, parent, 32);
LAYOUT(blob_sample, 72, state, 68);
LAYOUT(blob_columns, 144, state_stride, 136);
LAYOUT(blob_nearest_point, 72, converged, 64);
LAYOUT(blob_hessian, 96, gaussian_curvature, 88);
LAYOUT(blob_hit, 72, steps, 68);
LAYOUT(blob_approach, 80, state, 76);
LAYOUT(blob_transform, 64, factor, 56);
LAYOUT(blob_pose_def, 16, cookie, 12);
LAYOUT(blob_pose_change, 16, stale, 12);
LAYOUT(blob_motion_info, 40, period, 32);
LAYOUT(blob_cuda_def, 32, cookie, 24);
LAYOUT(blob_cuda_columns, 64, cookie, 56);
LAYOUT(lumen_case_fault, 808, message, 296);
LAYOUT(lumen_case_nodes, 80, link, 72);
LAYOUT(lumen_case_branch, 32, mean_inlier_rate, 28);
LAYOUT(lumen_case_points, 24, position, 16);
LAYOUT(lumen_case_models, 56, width, 48);
LAYOUT(lumen_case_motion, 48, pose, 40);
LAYOUT(lumen_case_source, 144, sha256, 136);
LAYOUT(lumen_case_step, 16, tool, 8);
LAYOUT(lumen_case_array, 32, values, 24);
LAYOUT(lumen_case_counts, 24, information, 16);
LAYOUT(lumen_case_write_def, 16, cookie, 12);

static_assert(BLOB_ERROR_NO_MOTION == 13, "BLOB_ERROR_NO_MOTION");
static_assert(BLOB_SOFT_OBJECT == 3, "BLOB_SOFT_OBJECT");
static_assert(BLOB_SIMD_AVX512 == 4, "BLOB_SIMD_AVX512");
static_assert(BLOB_CUDA_ERROR_LAUNCH == 8, "BLOB_CUDA_ERROR_LAUNCH");
static_assert(LUMEN_CASE_ERROR_WRITE == 5, "LUMEN_CASE_ERROR_WRITE");
static_assert(LUMEN_CASE_INFORMATION == 2, "LUMEN_CASE_INFORMATION");
static_assert(LUMEN_CASE_ANEURYSM == 1, "LUMEN_CASE_ANEURYSM");
static_assert(LUMEN_CASE_STOP_STEP_LIMIT == 6, "LUMEN_CASE_STOP_STEP_LIMIT");
static_assert(LUMEN_CASE_U32 == 2, "LUMEN_CASE_U32");
static_assert(LUMEN_CASE_JSON == 2, "LUMEN_CASE_JSON");
