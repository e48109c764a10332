// SPDX-License-Identifier: Apache-2.0
// The bytes of a file from a place on, plain or inflated as they are asked for.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "converters/common/progress.h"

namespace lumen::convert {

/// Deflate: a zlib stream, or a gzip stream of one member or several.
enum class Packing { None, Deflate };

class VoxelStream {
public:
  /// Begins at byte `offset` of the file. Throws Error(InvalidInput) if it cannot be opened.
  VoxelStream(std::filesystem::path path, std::size_t offset, Packing packing,
              const Progress& progress);
  ~VoxelStream();
  VoxelStream(VoxelStream&&) noexcept;
  VoxelStream& operator=(VoxelStream&&) = delete;

  /// Fills `to`; gives fewer bytes where the data ends. Throws Error(InvalidInput), naming the file,
  /// for a stream that is damaged or, deflated, ends before its checksum; Error(Cancelled).
  std::size_t read(std::span<std::byte> to);
  /// Reads `count` bytes to nowhere; gives fewer where the data ends. Throws as read() does.
  std::size_t skip(std::size_t count);
  [[nodiscard]] const std::filesystem::path& path() const { return m_path; }

private:
  struct Inflater;
  std::size_t readPlain(std::span<std::byte> to);
  std::size_t inflateSome(std::span<std::byte> to);
  bool fillInput();

  std::filesystem::path m_path;
  std::ifstream m_file;
  std::unique_ptr<Inflater> m_inflater;  ///< null for plain bytes
  std::size_t m_given = 0;               ///< bytes that have come out
  const Progress* m_progress;
};

/// True if the file begins as a gzip stream does.
bool isGzip(const std::filesystem::path& path);

/// `count` values as they lie in the file. Memory grows with what comes out, not with what was
/// announced. Throws Error(InvalidInput) if there are fewer, and as VoxelStream::read() does.
template <class T>
std::vector<T> readValues(VoxelStream& stream, std::size_t count);

/// Throws Error(InvalidInput): `got` bytes of `needed` are there.
[[noreturn]] void refuseShort(const std::filesystem::path& path, std::size_t got,
                              std::size_t needed);

template <class T>
std::vector<T> readValues(VoxelStream& stream, std::size_t count) {
  constexpr std::size_t kFirst = (std::size_t{64} << 20) / sizeof(T);
  std::vector<T> values;
  while (values.size() < count) {
    const std::size_t done = values.size();
    values.resize(std::min(count, std::max(kFirst, 2 * done)));
    const auto to = std::as_writable_bytes(std::span(values).subspan(done));
    const std::size_t got = stream.read(to);
    if (got != to.size()) refuseShort(stream.path(), done * sizeof(T) + got, count * sizeof(T));
  }
  return values;
}

}  // namespace lumen::convert
