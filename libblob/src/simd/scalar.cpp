// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <type_traits>

#include "answer.h"
#include "columns.h"
#include "simd/backend.h"

namespace lumen::blob {
namespace {
namespace scalar {
// clang-format off
#include "simd/f8_scalar.h"
#include "simd/body.h"
// clang-format on
}  // namespace scalar
}  // namespace

const Backend* scalarBackend(blob_kernel kernel) noexcept {
  return scalar::backendOf(kernel);
}

}  // namespace lumen::blob
