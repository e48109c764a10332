// SPDX-License-Identifier: Apache-2.0
// Arrays as NumPy's .npy files, version 1.0, little-endian, in C order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lumen::convert {

/// The last entry of `shape` runs fastest; its product is the number of values.
std::string encodeNpy(std::span<const float> values, const std::vector<std::size_t>& shape);
std::string encodeNpy(std::span<const std::uint8_t> values, const std::vector<std::size_t>& shape);
std::string encodeNpy(std::span<const std::int64_t> values, const std::vector<std::size_t>& shape);

}  // namespace lumen::convert
