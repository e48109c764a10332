// SPDX-License-Identifier: Apache-2.0
// Seeds come from files only, so a target puts its input into one that is in memory.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lumen::fuzz {

/// Reads the bytes as a seeds file; whatever is accepted must obey the rules of spec/seeds.md.
void readSeedsOf(const std::uint8_t* data, std::size_t size);

}  // namespace lumen::fuzz
