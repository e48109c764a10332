// SPDX-License-Identifier: Apache-2.0
// SHA-256, by which a case identifies its volume and its parent, and a library its files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace lumen {

/// SHA-256 (FIPS 180-4), 64 lower-case hexadecimal digits. Throws Error(Failed) if the cryptography
/// library does not offer it.
std::string sha256(std::span<const std::byte> bytes);
inline std::string sha256(std::string_view text) {
  return sha256(std::as_bytes(std::span(text.data(), text.size())));
}

/// SHA-256 of bytes that arrive piece by piece.
class Sha256 {
public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;
  void add(std::span<const std::byte> bytes);
  void add(std::string_view text) { add(std::as_bytes(std::span(text.data(), text.size()))); }
  std::string text();  ///< digest, once, after the last piece

private:
  struct State;
  std::unique_ptr<State> m_state;
};

struct FileDigest {
  std::uint64_t bytes = 0;
  std::string sha256;
};

/// SHA-256 of a file's content, read block by block. Throws Error(Failed), naming the file, if it
/// cannot be read or is no regular file, such as a pipe, on which reading would block.
FileDigest digestOfFile(const std::filesystem::path& file);

}  // namespace lumen
