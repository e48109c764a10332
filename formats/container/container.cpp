// SPDX-License-Identifier: Apache-2.0
#include "formats/container/container.h"

#include <algorithm>
#include <array>
#include <utility>

#include "formats/container/bytes.h"
#include "formats/container/crc32c.h"

namespace lumen::formats {
namespace {

using Bytes = std::span<const std::byte>;

// The high bit shows a seven-bit channel, CR LF and LF a change of line ends; ^Z stops a DOS
// listing.
constexpr std::array<unsigned char, 10> kMagic = {0x8c, 'L',  'U',  'M',  'E',
                                                  'N',  0x0d, 0x0a, 0x1a, 0x0a};
constexpr std::size_t kHeaderChecksumAt = 60;
constexpr std::size_t kFlagsAt = 6;  // in an entry of the table
constexpr std::uint8_t kCriticalFlag = 1;
constexpr std::uint8_t kIndependentFlag = 2;

std::uint64_t alignUp(std::uint64_t size) {
  return (size + kChunkAlignment - 1) / kChunkAlignment * kChunkAlignment;
}

bool startsLikeMagic(Bytes bytes) {
  const std::size_t count = std::min(bytes.size(), kMagic.size());
  for (std::size_t i = 0; i < count; ++i)
    if (static_cast<unsigned char>(bytes[i]) != kMagic[i]) return false;
  return true;
}

// Offset of the first byte that is not zero, or bytes.size().
std::size_t firstNonZero(Bytes bytes) {
  return static_cast<std::size_t>(
      std::find_if(bytes.begin(), bytes.end(), [](std::byte b) { return b != std::byte{0}; }) -
      bytes.begin());
}

std::string hex(std::uint32_t value) {
  return "0x" + checksumText(value);
}

std::vector<Argument> foundExpected(std::uint64_t found, std::uint64_t expected) {
  return {{"found", std::to_string(found)}, {"expected", std::to_string(expected)}};
}

struct Header {
  FormatVersion version, minimumReader;
  std::uint16_t headerSize = 0;
  std::uint64_t length = 0;
  std::uint32_t chunkCount = 0, tableChecksum = 0;
};

Header parseHeader(Bytes bytes) {
  ByteCursor cursor(bytes.subspan(kMagic.size()));
  Header header;
  header.version.major = cursor.read<std::uint8_t>();
  header.version.minor = cursor.read<std::uint8_t>();
  header.minimumReader.major = cursor.read<std::uint8_t>();
  header.minimumReader.minor = cursor.read<std::uint8_t>();
  header.headerSize = cursor.read<std::uint16_t>();
  header.length = cursor.read<std::uint64_t>();
  header.chunkCount = cursor.read<std::uint32_t>();
  header.tableChecksum = cursor.read<std::uint32_t>();
  return header;
}

// The signature and the checksum come before the version: they are the same in every version.
Status checkFrame(Bytes bytes) {
  if (!startsLikeMagic(bytes))
    return Issue{ErrorCode::Magic, 0,
                 "the first ten bytes are not those of a .lumen file; a transfer in text mode "
                 "changes them"};
  if (bytes.size() < kHeaderSize)
    return Issue{ErrorCode::Truncated, bytes.size(), "the file ends inside its header of 64 bytes",
                 foundExpected(bytes.size(), kHeaderSize)};
  const auto stated = loadLittle<std::uint32_t>(bytes.data() + kHeaderChecksumAt);
  const std::uint32_t found = crc32c(bytes.first(kHeaderChecksumAt));
  if (stated != found)
    return Issue{ErrorCode::HeaderChecksum,
                 kHeaderChecksumAt,
                 "the header states checksum " + hex(stated) + ", its bytes have " + hex(found),
                 {{"found", hex(found)}, {"expected", hex(stated)}}};
  return {};
}

Status checkVersion(const Header& header) {
  if (header.version.major == 0 || header.minimumReader.major == 0 ||
      header.minimumReader > header.version)
    return Issue{ErrorCode::Version,
                 header.version.major == 0 ? std::uint64_t{10} : std::uint64_t{12},
                 "version " + versionText(header.version) + " with minimum reader version " +
                     versionText(header.minimumReader) + " does not exist",
                 {{"found", versionText(header.version)}}};
  if (header.minimumReader > kFormatVersion)
    return Issue{
        ErrorCode::Version,
        12,
        "the file needs a reader of version " + versionText(header.minimumReader) +
            "; this one reads up to " + versionText(kFormatVersion),
        {{"found", versionText(header.minimumReader)}, {"expected", versionText(kFormatVersion)}}};
  return {};
}

Status checkLength(const Header& header, Bytes bytes) {
  if (header.length > bytes.size())
    return Issue{ErrorCode::Truncated, bytes.size(),
                 "the file has " + std::to_string(bytes.size()) + " of the " +
                     std::to_string(header.length) + " bytes that its header states",
                 foundExpected(bytes.size(), header.length)};
  if (header.length < bytes.size())
    return Issue{ErrorCode::TrailingBytes, header.length,
                 "the file has " + std::to_string(bytes.size()) + " bytes, its header states " +
                     std::to_string(header.length),
                 foundExpected(bytes.size(), header.length)};
  return {};
}

Status checkTable(const Header& header, Bytes bytes) {
  if (header.chunkCount > kMaxChunks ||
      header.chunkCount > (bytes.size() - kHeaderSize) / kTableEntrySize)
    return Issue{
        ErrorCode::ChunkCount,
        24,
        std::to_string(header.chunkCount) + " chunks in a file of " + std::to_string(bytes.size()) +
            " bytes; the limit is " + std::to_string(kMaxChunks),
        {{"found", std::to_string(header.chunkCount)}, {"limit", std::to_string(kMaxChunks)}}};
  const std::uint32_t found =
      crc32c(bytes.subspan(kHeaderSize, header.chunkCount * kTableEntrySize));
  if (found != header.tableChecksum)
    return Issue{ErrorCode::TableChecksum,
                 kHeaderSize,
                 "the header states checksum " + hex(header.tableChecksum) +
                     " for the chunk table, its bytes have " + hex(found),
                 {{"found", hex(found)}, {"expected", hex(header.tableChecksum)}}};
  return {};
}

Status checkHeader(const Header& header, Bytes bytes) {
  if (auto version = checkVersion(header); !version) return version;
  if (header.headerSize != kHeaderSize)
    return Issue{ErrorCode::HeaderField, 14,
                 "header size " + std::to_string(header.headerSize) + ", expected 64",
                 foundExpected(header.headerSize, kHeaderSize)};
  const Bytes reserved = bytes.subspan(32, kHeaderChecksumAt - 32);
  if (header.version <= kFormatVersion && firstNonZero(reserved) < reserved.size())
    return Issue{ErrorCode::HeaderField, 32 + firstNonZero(reserved),
                 "a reserved byte is not zero"};
  if (auto length = checkLength(header, bytes); !length) return length;
  return checkTable(header, bytes);
}

bool isLetterOrDigit(unsigned char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

// One entry of the chunk table, not yet checked.
struct Entry {
  Chunk chunk;
  std::uint8_t flags = 0;
  std::uint64_t storedSize = 0;
  Bytes reserved;
};

Entry parseEntry(Bytes bytes) {
  ByteCursor cursor(bytes);
  Entry entry;
  entry.chunk.type = cursor.read<std::uint32_t>();
  entry.chunk.version = cursor.read<std::uint16_t>();
  entry.flags = cursor.read<std::uint8_t>();
  entry.chunk.critical = (entry.flags & kCriticalFlag) != 0;
  entry.chunk.independent = (entry.flags & kIndependentFlag) != 0;
  entry.chunk.encoding = cursor.read<std::uint8_t>();
  entry.chunk.offset = cursor.read<std::uint64_t>();
  entry.storedSize = cursor.read<std::uint64_t>();
  entry.chunk.rawSize = cursor.read<std::uint64_t>();
  entry.chunk.checksum = cursor.read<std::uint32_t>();
  entry.reserved = bytes.subspan(cursor.position());
  return entry;
}

Status checkEntry(const Entry& entry, std::uint64_t entryAt, bool strict) {
  for (int i = 0; i < 4; ++i)
    if (!isLetterOrDigit(static_cast<unsigned char>(entry.chunk.type >> (8 * i))))
      return Issue{ErrorCode::ChunkType,
                   entryAt,
                   "chunk type " + hex(entry.chunk.type) + " is not four ASCII letters or digits",
                   {{"found", hex(entry.chunk.type)}}};
  const auto refuse = [&](std::size_t at, const char* what) {
    const std::string name = chunkName(entry.chunk.type);
    return Issue{ErrorCode::ChunkField,
                 entryAt + at,
                 "chunk " + name + " has a reserved " + what + " that is not zero",
                 {{"chunk", name}}};
  };
  if (!strict) return {};
  if ((entry.flags & ~(kCriticalFlag | kIndependentFlag)) != 0) return refuse(kFlagsAt, "flag");
  if (const std::size_t at = firstNonZero(entry.reserved); at < entry.reserved.size())
    return refuse(kTableEntrySize - entry.reserved.size() + at, "byte");
  return {};
}

// The chunk of a checked entry, with its bytes. `end` is the end of the previous chunk, padding
// included; it moves to the end of this one.
Expected<Chunk> locateChunk(Bytes bytes, const Entry& entry, std::uint64_t entryAt,
                            std::uint64_t& end) {
  Chunk chunk = entry.chunk;
  const std::string name = "chunk " + chunkName(chunk.type);
  if (chunk.offset != end)
    return Issue{ErrorCode::ChunkOffset,
                 entryAt + 8,
                 name + " starts at byte " + std::to_string(chunk.offset) + ", expected " +
                     std::to_string(end),
                 {{"chunk", chunkName(chunk.type)},
                  {"found", std::to_string(chunk.offset)},
                  {"expected", std::to_string(end)}}};
  const bool fits = end <= bytes.size() && entry.storedSize <= bytes.size() - end;
  if (!fits || (chunk.encoding == 0 && chunk.rawSize != entry.storedSize))
    return Issue{ErrorCode::ChunkSize,
                 entryAt + (fits ? 24 : 16),
                 name + " states " + std::to_string(entry.storedSize) + " stored and " +
                     std::to_string(chunk.rawSize) + " raw bytes at byte " + std::to_string(end) +
                     " of " + std::to_string(bytes.size()),
                 {{"chunk", chunkName(chunk.type)},
                  {"found", std::to_string(entry.storedSize)},
                  {"expected", std::to_string(chunk.rawSize)}}};
  const bool known = chunk.encoding == static_cast<std::uint8_t>(ChunkEncoding::Zstd) ||
                     chunk.encoding == static_cast<std::uint8_t>(ChunkEncoding::Draco);
  if (known && chunk.rawSize > kMaxExpansion * entry.storedSize)
    return Issue{ErrorCode::ChunkExpansion,
                 entryAt + 24,
                 name + " states " + std::to_string(chunk.rawSize) + " raw bytes for " +
                     std::to_string(entry.storedSize) + " stored ones; the limit is 256 times",
                 {{"chunk", chunkName(chunk.type)},
                  {"found", std::to_string(chunk.rawSize)},
                  {"limit", std::to_string(kMaxExpansion * entry.storedSize)}}};
  chunk.stored =
      bytes.subspan(static_cast<std::size_t>(end), static_cast<std::size_t>(entry.storedSize));
  end += entry.storedSize;
  return chunk;
}

// Moves `end` over the zeros that fill the last 64-byte unit.
Status skipPadding(Bytes bytes, Padding check, std::uint64_t& end) {
  const std::uint64_t next = alignUp(end);
  if (next > bytes.size())
    return Issue{ErrorCode::ChunkPadding, bytes.size(),
                 "the file ends inside the padding up to byte " + std::to_string(next)};
  const Bytes padding =
      bytes.subspan(static_cast<std::size_t>(end), static_cast<std::size_t>(next - end));
  if (check == Padding::Check)
    if (const std::size_t at = firstNonZero(padding); at < padding.size())
      return Issue{ErrorCode::ChunkPadding, end + at, "a padding byte is not zero"};
  end = next;
  return {};
}

void storeEntry(std::byte* to, const ChunkSource& chunk, std::uint64_t offset) {
  const std::uint64_t size = chunk.bytes.size();
  storeLittle(to, chunk.type);
  storeLittle(to + 4, chunk.version);
  storeLittle(to + 6, static_cast<std::uint8_t>((chunk.critical ? kCriticalFlag : 0) |
                                                (chunk.independent ? kIndependentFlag : 0)));
  storeLittle(to + 7, chunk.encoding);
  storeLittle(to + 8, offset);
  storeLittle(to + 16, size);
  storeLittle(to + 24, chunk.encoding == 0 ? size : chunk.rawSize);
  storeLittle(to + 32, crc32c(chunk.bytes));
}

// The header of a file whose table is in place.
void storeHeader(std::span<std::byte> file, std::size_t chunkCount, FormatVersion version) {
  std::byte* to = file.data();
  for (const unsigned char c : kMagic) *to++ = static_cast<std::byte>(c);
  to = file.data();
  storeLittle(to + 10, version.major);
  storeLittle(to + 11, version.minor);
  storeLittle(to + 12, kMinimumReader.major);
  storeLittle(to + 13, kMinimumReader.minor);
  storeLittle(to + 14, static_cast<std::uint16_t>(kHeaderSize));
  storeLittle(to + 16, std::uint64_t{file.size()});
  storeLittle(to + 24, static_cast<std::uint32_t>(chunkCount));
  storeLittle(to + 28, crc32c(file.subspan(kHeaderSize, chunkCount * kTableEntrySize)));
  storeLittle(to + kHeaderChecksumAt, crc32c(file.first(kHeaderChecksumAt)));
}

}  // namespace

std::string versionText(FormatVersion version) {
  return std::to_string(version.major) + "." + std::to_string(version.minor);
}

std::string chunkName(ChunkType type) {
  std::string name;
  for (int i = 0; i < 4; ++i) name += static_cast<char>((type >> (8 * i)) & 0xffu);
  return name;
}

bool hasContainerMagic(std::span<const std::byte> bytes) {
  return bytes.size() >= kMagic.size() && startsLikeMagic(bytes);
}

Expected<Container> readContainer(std::span<const std::byte> bytes, Padding padding) {
  if (auto frame = checkFrame(bytes); !frame) return frame.error();
  const Header header = parseHeader(bytes);
  if (auto checked = checkHeader(header, bytes); !checked) return checked.error();

  Container container;
  container.version = header.version;
  container.chunks.reserve(header.chunkCount);
  std::uint64_t end = kHeaderSize + std::uint64_t{header.chunkCount} * kTableEntrySize;
  for (std::uint32_t i = 0; i < header.chunkCount; ++i) {
    const std::size_t entryAt = kHeaderSize + i * kTableEntrySize;
    Entry entry = parseEntry(bytes.subspan(entryAt, kTableEntrySize));
    entry.chunk.entryOffset = entryAt;
    if (auto checked = checkEntry(entry, entryAt, container.fullyKnown()); !checked)
      return checked.error();
    auto chunk = locateChunk(bytes, entry, entryAt, end);
    if (!chunk) return chunk.error();
    if (auto skipped = skipPadding(bytes, padding, end); !skipped) return skipped.error();
    container.chunks.push_back(*std::move(chunk));
  }
  if (end != bytes.size())
    return Issue{
        ErrorCode::TrailingBytes, end,
        "the last chunk ends here, the file has " + std::to_string(bytes.size()) + " bytes",
        foundExpected(bytes.size(), end)};
  return container;
}

Status verifyChunk(const Chunk& chunk) {
  const std::uint32_t found = crc32c(chunk.stored);
  if (found != chunk.checksum)
    return Issue{ErrorCode::ChunkChecksum,
                 chunk.offset,
                 "chunk " + chunkName(chunk.type) + " should have checksum " + hex(chunk.checksum) +
                     ", its bytes have " + hex(found),
                 {{"chunk", chunkName(chunk.type)},
                  {"found", hex(found)},
                  {"expected", hex(chunk.checksum)}}};
  return {};
}

std::vector<std::byte> writeContainer(std::span<const ChunkSource> chunks, FormatVersion version) {
  std::uint64_t end = kHeaderSize + chunks.size() * kTableEntrySize;
  std::uint64_t length = end;
  for (const ChunkSource& chunk : chunks) length += alignUp(chunk.bytes.size());
  std::vector<std::byte> file(static_cast<std::size_t>(length));
  std::byte* entry = file.data() + kHeaderSize;
  for (const ChunkSource& chunk : chunks) {
    storeEntry(entry, chunk, end);
    std::copy(chunk.bytes.begin(), chunk.bytes.end(),
              file.begin() + static_cast<std::ptrdiff_t>(end));
    end += alignUp(chunk.bytes.size());
    entry += kTableEntrySize;
  }
  storeHeader(file, chunks.size(), version);
  return file;
}

}  // namespace lumen::formats
