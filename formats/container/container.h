// SPDX-License-Identifier: Apache-2.0
// Typed, checksummed, aligned pieces of bytes in one file: the outer layer of `.lumen`. See
// spec/lumen.md, "Container". Standard library only; no exception for bad input, no output.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/container/expected.h"
#include "formats/container/issue.h"

namespace lumen::formats {

struct FormatVersion {
  std::uint8_t major = 0, minor = 0;
  friend auto operator<=>(const FormatVersion&, const FormatVersion&) = default;
};

/// The newest version that this code reads in full.
constexpr FormatVersion kFormatVersion{1, 2};

/// Version of a file that has nothing of a newer one; a case with a motion is one of version 1.2.
constexpr FormatVersion kPlainVersion{1, 1};
constexpr FormatVersion kMotionVersion{1, 2};

/// Oldest reader that understands every file that this code writes.
constexpr FormatVersion kMinimumReader{1, 0};

/// Text of a version, such as "1.1".
std::string versionText(FormatVersion version);

/// Every chunk starts at a multiple of this, in bytes, and so may be used in place in a mapped
/// file.
constexpr std::size_t kChunkAlignment = 64;
constexpr std::size_t kHeaderSize = 64;
constexpr std::size_t kTableEntrySize = 64;
constexpr std::size_t kMaxChunks = 4096;

/// Type of a chunk: four ASCII letters or digits, the first in the lowest byte.
using ChunkType = std::uint32_t;

constexpr ChunkType chunkType(const char (&name)[5]) {
  ChunkType type = 0;
  for (int i = 3; i >= 0; --i) type = (type << 8) | static_cast<unsigned char>(name[i]);
  return type;
}
std::string chunkName(ChunkType type);

enum class ChunkEncoding : std::uint8_t { Raw = 0, Zstd = 1, Draco = 2 };

/// A chunk of a known encoding decodes to at most this many times its stored size, so memory stays
/// bounded by the bytes that are there.
constexpr std::uint64_t kMaxExpansion = 256;

/// One piece of a file that was read. `stored` points into the bytes that were given to
/// readContainer().
struct Chunk {
  ChunkType type = 0;
  std::uint16_t version = 0;
  bool critical = false;          ///< a reader that does not know the type must refuse the file
  bool independent = false;       ///< stays right when the nodes, points or models change
  std::uint8_t encoding = 0;      ///< encoding of `stored`; possibly an unknown one
  std::uint32_t checksum = 0;     ///< CRC-32C of `stored`, not yet verified
  std::uint64_t offset = 0;       ///< position of `stored` in the file, bytes
  std::uint64_t rawSize = 0;      ///< bytes once decoded
  std::uint64_t entryOffset = 0;  ///< position of its entry in the chunk table
  std::span<const std::byte> stored;
};

/// A view: it owns nothing but the list of chunks.
struct Container {
  FormatVersion version;
  std::vector<Chunk> chunks;  ///< in file order

  /// False if a newer writer may have put something here that this code does not know.
  [[nodiscard]] bool fullyKnown() const { return version <= kFormatVersion; }
};

/// True if `bytes` start with the signature, whatever follows.
bool hasContainerMagic(std::span<const std::byte> bytes);

/// Whether the zeros behind each chunk are checked, which touches a page of a mapped file per
/// chunk.
enum class Padding : std::uint8_t { Check, Skip };

/// Checks everything but the bytes of chunks: header, table, order, alignment and padding. The
/// chunks themselves are verified by verifyChunk(). Allocates only the list of chunks.
Expected<Container> readContainer(std::span<const std::byte> bytes,
                                  Padding padding = Padding::Check);

/// Success, or CHUNK_CHECKSUM. Reads the whole chunk.
Status verifyChunk(const Chunk& chunk);

/// A chunk to be written.
struct ChunkSource {
  ChunkType type = 0;
  std::uint16_t version = 1;
  bool critical = false;
  std::vector<std::byte> bytes{};  ///< as they are stored
  bool independent = false;
  std::uint8_t encoding = 0;
  std::uint64_t rawSize = 0;  ///< decoded bytes of an encoded chunk
};

/// The file that holds `chunks` in that order. At most kMaxChunks.
std::vector<std::byte> writeContainer(std::span<const ChunkSource> chunks,
                                      FormatVersion version = kPlainVersion);

}  // namespace lumen::formats
