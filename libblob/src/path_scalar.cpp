// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstring>
#include <limits>
#include <type_traits>

#include "path.h"
#include "support.h"

namespace lumen::blob {
namespace {
namespace scalar {
#include "lanes_scalar.h"
#include "path_body.h"
#include "path_locate.h"
#include "path_distance.h"
#include "path_query.h"
#include "path_table.h"
}  // namespace scalar
}  // namespace

const PathTable* scalarPath(blob_kernel kernel) noexcept {
  return scalar::tableOf(kernel);
}

}  // namespace lumen::blob
