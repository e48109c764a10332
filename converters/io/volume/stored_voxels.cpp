// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/stored_voxels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

#include "converters/base/error.h"
#include "converters/io/volume/packed_file.h"
#include "converters/io/volume/volume_checks.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "voxels are swapped if big-endian");

// Bytes per block of voxels: few calls, and each within the cache and 100 ms.
constexpr std::size_t kBlockBytes = 1 << 18;

std::uint64_t bytesOfEachFile(const StoredVoxels& stored) {
  return stored.count / stored.files.size() * sizeOf(stored.type);
}

/// The minimum size, bytes, of the voxels of one file; for a deflated file, unpacked.
double leastBytes(const StoredVoxels& stored) {
  const auto bytes = static_cast<double>(bytesOfEachFile(stored));
  if (stored.packing == Packing::Hex) return 2 * bytes;
  if (stored.packing == Packing::Text)  // a digit per voxel, and separators
    return 2 * bytes / static_cast<double>(sizeOf(stored.type)) - 1;
  return bytes;
}

void reverseBytes(std::byte* bytes, std::size_t size, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) std::reverse(bytes + i * size, bytes + (i + 1) * size);
}

/// Reads voxels of type From into those of type To, file after file.
template <class From, class To>
class VoxelReader {
public:
  VoxelReader(const StoredVoxels& stored, const Progress& progress,
              std::vector<std::string>& assumptions)
      : m_stored(stored), m_progress(progress), m_assumptions(assumptions) {}

  Voxels read() {
    m_voxels.reserve(m_stored.wantedCount() +
                     (m_stored.together > 0 ? kBlockBytes / sizeof(From) : 0));
    const std::uint64_t each = m_stored.count / m_stored.files.size();
    const std::uint64_t end =
        m_stored.together > 0 ? m_stored.count : m_stored.first + m_stored.wantedCount();
    for (std::uint64_t f = 0; f < m_stored.files.size(); ++f) {
      const std::uint64_t from = std::max(m_stored.first, f * each),
                          to = std::min(end, (f + 1) * each);
      m_before = f * each;
      if (from < to) readFile(m_stored.files[f], from - f * each, to - f * each);
    }
    return std::move(m_voxels);
  }

private:
  /// Reads voxels [from, to) of a file.
  void readFile(const InputFile& file, std::uint64_t from, std::uint64_t to) {
    const std::uint64_t bytes = bytesOfEachFile(m_stored);
    const auto packed = openPacked(m_stored, file, bytes, m_progress);
    constexpr std::size_t kBlock = kBlockBytes / sizeof(From);
    for (std::uint64_t done = 0; done < to;) {
      m_progress.check();
      const std::uint64_t end = done < from ? from : to;
      const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(kBlock, end - done));
      const std::size_t got = done < from ? packed->read(m_block.data(), wanted * sizeof(From))
                                          : readWanted(*packed, wanted, m_before + done);
      done += got / sizeof(From);
      if (got < wanted * sizeof(From)) refuseTruncated(file.path(), done * sizeof(From), bytes);
    }
    if (to * sizeof(From) == bytes && packed->hasMore())
      m_assumptions.push_back(
          "the data in " + formats::printable(file.path().filename().string()) +
          " goes on after the voxels that the header announces; the rest is not read");
  }

  /// Appends those of up to `count` voxels, of which the first is the `place`th of all files, that
  /// belong to the wanted volume. Returns the number of bytes read.
  std::size_t readWanted(PackedFile& packed, std::size_t count, std::uint64_t place) {
    const std::size_t before = m_voxels.size();
    const std::size_t got = readBlock(packed, count);
    if (m_stored.together == 0) return got;
    std::size_t kept = before;
    for (std::size_t i = 0; i < got / sizeof(From); ++i)
      if ((place + i) / m_stored.together % m_stored.volumes == m_stored.volume)
        m_voxels[kept++] = m_voxels[before + i];
    m_voxels.resize(kept);
    return got;
  }

  /// Appends up to `wanted` voxels, and returns the number of bytes read.
  std::size_t readBlock(PackedFile& packed, std::size_t wanted) {
    const std::size_t before = m_voxels.size();
    m_voxels.resize(before + wanted);
    To* to = m_voxels.data() + before;
    if (isPlain()) {
      const std::size_t got = packed.read(reinterpret_cast<std::byte*>(to), wanted * sizeof(From));
      swapIfNeeded(reinterpret_cast<std::byte*>(to), got / sizeof(From));
      return got;
    } else {
      const std::size_t got = packed.read(m_block.data(), wanted * sizeof(From));
      swapIfNeeded(m_block.data(), got / sizeof(From));
      for (std::size_t i = 0; i < got / sizeof(From); ++i) {
        From value;
        std::memcpy(&value, m_block.data() + i * sizeof(From), sizeof(From));
        to[i] = converted(value);
      }
      return got;
    }
  }

  /// True if voxels in the file and in memory have equal bytes.
  [[nodiscard]] bool isPlain() const { return std::is_same_v<From, To> && !m_stored.scaling; }

  [[nodiscard]] To converted(From value) const {
    if (!m_stored.scaling) return static_cast<To>(value);
    return static_cast<To>(m_stored.scaling->slope * static_cast<double>(value) +
                           m_stored.scaling->intercept);
  }

  void swapIfNeeded(std::byte* bytes, std::size_t count) const {
    if (m_stored.bigEndian && sizeof(From) > 1 && m_stored.packing != Packing::Text)
      reverseBytes(bytes, sizeof(From), count);
  }

  [[noreturn]] void refuseTruncated(const fs::path& file, std::uint64_t got,
                                    std::uint64_t expected) const {
    std::string limit;
    if (m_stored.packedSize)
      limit = " within the " + std::to_string(*m_stored.packedSize) +
              " bytes that the header calls their compressed size";
    throw invalidInput(formats::printable(file.string()) +
                       ": its voxels are truncated or damaged: " + std::to_string(got) + " of " +
                       std::to_string(expected) + " bytes come out" + limit);
  }

  const StoredVoxels& m_stored;
  const Progress& m_progress;
  std::vector<std::string>& m_assumptions;
  std::vector<To> m_voxels;
  std::uint64_t m_before = 0;  // voxels in the files before the current one
  std::array<std::byte, kBlockBytes> m_block{};
};

template <class From, class To>
Voxels readAs(const StoredVoxels& stored, const Progress& progress,
              std::vector<std::string>& assumptions) {
  if (stored.scaling && !std::is_same_v<To, float>)
    return readAs<From, float>(stored, progress, assumptions);
  return std::make_unique<VoxelReader<From, To>>(stored, progress, assumptions)->read();
}

/// The type in memory: the widest that Voxels has, where the file's is none of them.
template <class From>
using InMemory =
    std::conditional_t<std::is_same_v<From, std::int8_t>, std::int16_t,
                       std::conditional_t<(sizeof(From) < sizeof(float)), From, float>>;

}  // namespace

std::size_t sizeOf(PixelType type) {
  return withPixelType(type, [](auto zero) { return sizeof(zero); });
}

std::string nameOf(PixelType type) {
  constexpr std::array<const char*, 10> kNames = {"int8",    "uint8",  "int16", "uint16",
                                                  "int32",   "uint32", "int64", "uint64",
                                                  "float32", "float64"};
  return kNames.at(static_cast<std::size_t>(type));
}

std::uint64_t checkStored(const StoredVoxels& stored, std::vector<std::string>& assumptions) {
  std::uint64_t total = 0;
  for (const InputFile& file : stored.files) {
    const std::uint64_t size = file.size();
    total += size;
    // from the header on, and if from the file's end backwards, not into the header
    const double needed =
        leastBytes(stored) + (stored.byteSkip < 0 ? -1 - static_cast<double>(stored.byteSkip)
                                                  : static_cast<double>(stored.byteSkip));
    const double room = static_cast<double>(size) - static_cast<double>(stored.offset);
    const auto limit = static_cast<double>(stored.packedSize.value_or(size));
    checkRoom(file.path(), needed, std::min(room, limit), stored.packing == Packing::Deflate);
    const bool exact =
        stored.packing == Packing::Raw && stored.lineSkip == 0 && stored.byteSkip >= 0;
    if (exact && room > needed)
      assumptions.push_back("the data in " + formats::printable(file.path().filename().string()) +
                            " goes on for " + longNumber(room - needed) +
                            " bytes after the voxels that the header announces; the rest is not "
                            "read");
  }
  return total;
}

Voxels readStored(const StoredVoxels& stored, const Progress& progress,
                  std::vector<std::string>& assumptions) {
  try {
    return withPixelType(stored.type, [&](auto zero) {
      using From = decltype(zero);
      return readAs<From, InMemory<From>>(stored, progress, assumptions);
    });
  } catch (const std::bad_alloc&) {
    throw invalidInput(stored.header.string() + ": its " + std::to_string(stored.wantedCount()) +
                       " voxels do not fit in memory");
  }
}

}  // namespace lumen::convert
