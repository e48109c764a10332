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
#include "simd/body.h"
#include "simd/f8_scalar.h"
}  // namespace scalar
}  // namespace

const Backend* scalarBackend(blob_kernel kernel) noexcept {
  return scalar::backendOf(kernel);
}

}  // namespace lumen::blob
