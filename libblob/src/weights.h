// SPDX-License-Identifier: Apache-2.0
// The nodes that answer at a point, and how they move.
#pragma once

#include <cstdint>

#include "formats/field/blend.h"
#include "formats/field/vector.h"
#include "posed_model.h"

namespace lumen::blob {

struct NodeWeights {
  unsigned count = 0;
  std::uint32_t node[field::ActiveNodes::kMostActive];
  double weight[field::ActiveNodes::kMostActive];  ///< their sum is 1
};

/// The nodes of positive weight at a point for the cursor at `node`; `node` alone where none has.
NodeWeights weighNodes(const blob_model& model, std::uint32_t flags, const double* point,
                       std::uint32_t node) noexcept;

/// The way of a point, mm, that rides on a node from one pose to another, in which it is given.
field::Vec displacementOf(const blob_pose& pose, const blob_pose& before, std::uint32_t node,
                          const double* point) noexcept;

}  // namespace lumen::blob
