// SPDX-License-Identifier: Apache-2.0
// SHA-256, by which a case identifies its volume and its parent, and a library its files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "converters/base/sha256_blocks.h"

namespace lumen {

/// SHA-256 (FIPS 180-4), 64 lower-case hexadecimal digits.
std::string sha256(std::span<const std::byte> bytes);
inline std::string sha256(std::string_view text) {
  return sha256(std::as_bytes(std::span(text.data(), text.size())));
}

/// SHA-256 of bytes that arrive piece by piece.
class Sha256 {
public:
  void add(std::span<const std::byte> bytes);
  void add(std::string_view text) { add(std::as_bytes(std::span(text.data(), text.size()))); }
  std::string text();  ///< digest, once, after the last piece

private:
  Sha256Words m_state = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::byte, kSha256Block> m_rest{};  ///< bytes that fill no block yet
  std::size_t m_restSize = 0;
  std::uint64_t m_size = 0;  ///< bytes so far
};

struct FileDigest {
  std::uint64_t bytes = 0;
  std::string sha256;
};

/// SHA-256 of a file's content, read block by block. Throws Error(Failed), naming the file, if it
/// cannot be read or is no regular file, such as a pipe, on which reading would block.
FileDigest digestOfFile(const std::filesystem::path& file);

}  // namespace lumen
