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
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512bw,avx512dq"))), \
                             apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512bw,avx512dq")
#endif
namespace avx512 {
#include "lanes_avx.h"
#include "path_body.h"
#include "path_locate.h"
#include "path_distance.h"
#include "path_query.h"
#include "path_table.h"
}  // namespace avx512
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
}  // namespace

const PathTable* avx512Path(blob_kernel kernel) noexcept {
  return avx512::tableOf(kernel);
}

}  // namespace lumen::blob
#else
namespace lumen::blob {
const PathTable* avx512Path(blob_kernel) noexcept {
  return nullptr;
}
}  // namespace lumen::blob
#endif
