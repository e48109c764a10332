// SPDX-License-Identifier: Apache-2.0
// The frame that tests draw phantoms in, and the voxels of a phantom.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "converters/stages/phantom/design.h"
#include "converters/stages/phantom/phantom.h"

namespace lumen::convert {

inline const Frame kFrame{0.2, 25.4};

inline const std::vector<std::int16_t>& voxelsOf(const Phantom& phantom) {
  return std::get<std::vector<std::int16_t>>(phantom.volume.voxels);
}

}  // namespace lumen::convert
