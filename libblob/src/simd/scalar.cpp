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

namespace lumen::blob {

#if defined(__wasm__)

// A download would grow by a quarter for the reference, whose bits the vectors of this target give, too.
const Backend* scalarBackend(blob_kernel kernel) noexcept {
  return portableBackend(kernel);
}

#else

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

#endif

}  // namespace lumen::blob
