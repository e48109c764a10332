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
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace avx2 {
// clang-format off
#include "simd/f8_avx.h"
#include "simd/body.h"
// clang-format on
}  // namespace avx2
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
}  // namespace

const Backend* avx2Backend(blob_kernel kernel) noexcept {
  return avx2::backendOf(kernel);
}

}  // namespace lumen::blob
#else
namespace lumen::blob {
const Backend* avx2Backend(blob_kernel) noexcept {
  return nullptr;
}
}  // namespace lumen::blob
#endif
