// SPDX-License-Identifier: Apache-2.0
// Walls of vessels that touch.
#pragma once

#include <cstdint>

namespace lumen::convert {

enum class Touching : std::uint8_t {
  Share,  ///< they have one wall between them
  Apart   ///< each has its own, and a gap is between them
};

}  // namespace lumen::convert
