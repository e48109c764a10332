// SPDX-License-Identifier: Apache-2.0
// The binary encoding, `.lumen`: from a case to bytes.
#pragma once

#include <cstddef>
#include <vector>

#include "formats/case/case.h"

namespace lumen::formats {

struct EncodeOptions {
  bool compress = false;  ///< zstd for every chunk that it makes smaller
  /// Bits of a coordinate of a wall point in the points' bounding box, 1 to 30, by Draco; 0: exact.
  int pointBits = 0;
};

/// The canonical bytes: equal cases give equal bytes (a negative zero is written as zero). The case
/// must pass validate(). With options the bytes depend on the versions of zstd and Draco too.
std::vector<std::byte> encodeBinary(const Case& value, const EncodeOptions& options = {});

/// Rounds the wall points as encodeBinary() with these bits does, and records it in the metadata.
/// Nothing happens to a case without points. Throws std::invalid_argument unless bits are 1 to 30.
void quantisePoints(Case& value, int bits);

}  // namespace lumen::formats
