// SPDX-License-Identifier: Apache-2.0
// The chunk table of a binary case, for `lumen info --chunks`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "converters/engine/answers/answer_text.h"
#include "formats/container/container.h"

namespace lumen::engine {

struct ChunkInfo {
  formats::Chunk chunk;  ///< without its bytes
  std::uint64_t storedSize = 0;
  bool known = false;
  bool intact = false;  ///< its checksum is right
};

/// Numbers that follow from the sizes of chunks.
struct ChunkCounts {
  std::uint64_t nodes = 0, branches = 0, points = 0, blobs = 0;
};

struct FileInfo {
  formats::FormatVersion version;
  std::uint64_t length = 0;
  ChunkCounts counts;
  std::vector<ChunkInfo> chunks;
};

/// Needs a whole container, but not a valid case. Throws Error(InvalidInput), and
/// Error(Unsupported) for JSON.
FileInfo describeChunks(std::span<const std::byte> bytes, const std::string& name);

Json chunkInfoJson(const FileInfo& info);
std::string chunkInfoText(const FileInfo& info);

}  // namespace lumen::engine
