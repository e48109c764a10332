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

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__ARM_NEON) && defined(__aarch64__)
#include <arm_neon.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace lumen::blob {
#if defined(__GNUC__)
namespace {
namespace portable {
// clang-format off
#include "simd/f8_pair.h"
#include "simd/body.h"
// clang-format on
}  // namespace portable
}  // namespace

const Backend* portableBackend(blob_kernel kernel) noexcept {
  return portable::backendOf(kernel);
}
#else
const Backend* portableBackend(blob_kernel) noexcept {
  return nullptr;
}
#endif
}  // namespace lumen::blob
