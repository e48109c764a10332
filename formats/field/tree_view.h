// SPDX-License-Identifier: Apache-2.0
// Nodes and models that define the field of a case, as arrays of another owner.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/field/kernel.h"

namespace lumen::field {

/// No node.
inline constexpr std::uint32_t kNowhere = UINT32_MAX;

/// The nodes of a centerline tree. Indices are in range, numbers finite, radii more than 0.
struct TreeView {
  std::size_t nodeCount = 0;
  const float (*centre)[3] = nullptr;    ///< mm, LPS
  const float* radius = nullptr;         ///< mm
  const std::int32_t* parent = nullptr;  ///< a node, or -1; null: no node has a parent
  std::size_t linkCount = 0;
  const std::uint32_t (*link)[2] = nullptr;  ///< pairs of nodes that are joined besides
};

/// The blobs of the nodes: node i owns offset[i] .. offset[i + 1] - 1.
struct ModelsView {
  Kernel kernel = Kernel::Cauchy;
  double parameter = 0;                   ///< not used by a kernel without one
  double level = 0;                       ///< T, mm
  const std::uint32_t* offset = nullptr;  ///< nodeCount + 1 entries, from 0, not decreasing
  const float (*centre)[3] = nullptr;     ///< mm, LPS
  const float* width = nullptr;           ///< mm, more than 0
};

}  // namespace lumen::field
