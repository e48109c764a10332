// SPDX-License-Identifier: Apache-2.0
// A chunk of one file for another file.
#pragma once

#include "formats/container/container.h"

namespace lumen::formats {

inline ChunkSource sourceOf(const Chunk& c) {
  return {c.type,        c.version,  c.critical, {c.stored.begin(), c.stored.end()},
          c.independent, c.encoding, c.rawSize};
}

}  // namespace lumen::formats
