// SPDX-License-Identifier: Apache-2.0
#include "converters/base/sha256.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include <sys/stat.h>

#include "converters/base/error.h"
#include "formats/case/file_descriptor.h"
#include "formats/container/printable.h"

namespace lumen {

namespace {

[[noreturn]] void refuseFile(const std::filesystem::path& file, const std::string& why) {
  throw failed(formats::printable(file.string()) + ": cannot be read: " + why);
}

}  // namespace

void Sha256::add(std::span<const std::byte> bytes) {
  m_size += bytes.size();
  const auto keep = [&](std::size_t most) {
    const std::size_t count = std::min(most, bytes.size());
    std::copy_n(bytes.begin(), count, m_rest.begin() + static_cast<std::ptrdiff_t>(m_restSize));
    m_restSize += count;
    bytes = bytes.subspan(count);
  };
  if (m_restSize > 0) {
    keep(kSha256Block - m_restSize);
    if (m_restSize < kSha256Block) return;
    addBlocks(m_state, m_rest.data(), 1);
    m_restSize = 0;
  }
  const std::size_t whole = bytes.size() / kSha256Block;
  addBlocks(m_state, bytes.data(), whole);
  bytes = bytes.subspan(whole * kSha256Block);
  keep(kSha256Block);
}

std::string Sha256::text() {
  constexpr std::size_t kSizeBytes = 8;
  const std::uint64_t bits = m_size * 8;
  // a one, zeros, and the number of bits fill up the last block
  std::array<std::byte, kSha256Block> end{std::byte{0x80}};
  const std::size_t zerosEnd = 2 * kSha256Block - kSizeBytes - m_restSize;
  add(std::span(end).first((zerosEnd - 1) % kSha256Block + 1));
  for (std::size_t i = 0; i < kSizeBytes; ++i)
    end[i] = static_cast<std::byte>(bits >> (56 - 8 * i) & 0xff);
  add(std::span(end).first(kSizeBytes));
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (const std::uint32_t word : m_state)
    for (int shift = 28; shift >= 0; shift -= 4) text += digits[word >> shift & 0xfU];
  return text;
}

std::string sha256(std::span<const std::byte> bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.text();
}

FileDigest digestOfFile(const std::filesystem::path& file) {
  constexpr std::size_t kBlock = std::size_t{1} << 18;
  const formats::FileDescriptor open = formats::openForReading(file);
  struct stat status {};
  if (!open.isOpen() || ::fstat(open.get(), &status) != 0) refuseFile(file, std::strerror(errno));
  if (!S_ISREG(status.st_mode)) refuseFile(file, "it is no file");
  std::vector<std::byte> block(kBlock);
  Sha256 hash;
  FileDigest digest;
  for (std::ptrdiff_t size = 0; (size = formats::readInto(block, open.get())) != 0;) {
    if (size < 0) refuseFile(file, std::strerror(errno));
    hash.add(std::span(block).first(static_cast<std::size_t>(size)));
    digest.bytes += static_cast<std::uint64_t>(size);
  }
  digest.sha256 = hash.text();
  return digest;
}

}  // namespace lumen
