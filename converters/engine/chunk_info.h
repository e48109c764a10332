// SPDX-License-Identifier: Apache-2.0
// The chunk table of a binary case, for `lumen info --chunks`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "converters/engine/answer_text.h"
#include "formats/container/container.h"

namespace lumen::engine {

struct ChunkInfo {
  formats::Chunk chunk;  ///< without its bytes
  std::uint64_t storedSize = 0;
  bool known = false;
  std::optional<bool> intact;  ///< its checksum is right; none where its bytes were not read
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
FileInfo describeChunks(const std::filesystem::path& file);

/// As describeChunks(), of the header and the table alone: the bytes of chunks are not looked at,
/// and need not be those of the file.
FileInfo describeChunkTable(const std::filesystem::path& file);

/// Bytes of a header and a table of 64 chunks, which few cases exceed.
constexpr std::uint64_t kUsualTable = formats::kHeaderSize + 64 * formats::kTableEntrySize;
/// Bytes of the header and the table of a file whose first 64 bytes or more are `head`; 0 if it is
/// no such file.
std::uint64_t tableBytes(std::span<const std::byte> head);

Json chunkInfoJson(const FileInfo& info);
std::string chunkInfoText(const FileInfo& info);

}  // namespace lumen::engine
