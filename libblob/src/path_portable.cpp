// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstring>
#include <limits>
#include <type_traits>

#include "path.h"
#include "support.h"

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
#include "lanes_pair.h"
#include "path_body.h"
#include "path_locate.h"
#include "path_distance.h"
#include "path_query.h"
#include "path_table.h"
}  // namespace portable
}  // namespace

const PathTable* portablePath(blob_kernel kernel) noexcept {
  return portable::tableOf(kernel);
}
#else
const PathTable* portablePath(blob_kernel) noexcept {
  return nullptr;
}
#endif
}  // namespace lumen::blob
