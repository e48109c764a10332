// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstring>
#include <limits>
#include <type_traits>

#include "path.h"
#include "support.h"

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
#include "lanes_avx.h"
#include "path_body.h"
#include "path_locate.h"
#include "path_distance.h"
#include "path_query.h"
#include "path_table.h"
}  // namespace avx2
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
}  // namespace

const PathTable* avx2Path(blob_kernel kernel) noexcept {
  return avx2::tableOf(kernel);
}

}  // namespace lumen::blob
#else
namespace lumen::blob {
const PathTable* avx2Path(blob_kernel) noexcept {
  return nullptr;
}
}  // namespace lumen::blob
#endif
