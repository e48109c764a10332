// SPDX-License-Identifier: Apache-2.0
// f, its gradient and its Hessian in doubles; the SIMD back ends compute f in floats.
#pragma once

#include <cstdint>

#include "model.h"

namespace lumen::blob {

/// blob_query_hessian() at a finite point in range of its node, which is not moved.
void evaluateHessian(const blob_model& model, std::uint32_t flags, const double* point,
                     std::uint32_t node, blob_hessian& answer) noexcept;

}  // namespace lumen::blob
