// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <type_traits>

#include "answer.h"
#include "columns.h"
#include "hessian.h"
#include "simd/backend.h"

#if defined(__GNUC__) && defined(__x86_64__)
#include <immintrin.h>

namespace lumen::blob {
namespace {
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512bw,avx512dq"))), \
                             apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512bw,avx512dq")
#endif
namespace avx512 {
// clang-format off
#include "simd/f8_avx.h"
#include "simd/body.h"
// clang-format on
}  // namespace avx512
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
}  // namespace

const Backend* avx512Backend(blob_kernel kernel) noexcept {
  return avx512::backendOf(kernel);
}

}  // namespace lumen::blob
#else
namespace lumen::blob {
const Backend* avx512Backend(blob_kernel) noexcept {
  return nullptr;
}
}  // namespace lumen::blob
#endif
