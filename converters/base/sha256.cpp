// SPDX-License-Identifier: Apache-2.0
#include "converters/base/sha256.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <vector>

#include <openssl/evp.h>
#include <sys/stat.h>

#include "converters/base/error.h"
#include "formats/case/file_descriptor.h"
#include "formats/container/printable.h"

namespace lumen {

namespace {

[[noreturn]] void refuseDigest() {
  throw failed("the cryptography library offers no SHA-256");
}

[[noreturn]] void refuseFile(const std::filesystem::path& file, const std::string& why) {
  throw failed(formats::printable(file.string()) + ": cannot be read: " + why);
}

}  // namespace

struct Sha256::State {
  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

Sha256::Sha256() : m_state(std::make_unique<State>()) {
  EVP_MD_CTX* const context = m_state->context.get();
  if (context == nullptr || EVP_DigestInit_ex(context, EVP_sha256(), nullptr) != 1) refuseDigest();
}

Sha256::~Sha256() = default;

void Sha256::add(std::span<const std::byte> bytes) {
  if (EVP_DigestUpdate(m_state->context.get(), bytes.data(), bytes.size()) != 1) refuseDigest();
}

std::string Sha256::text() {
  std::array<unsigned char, 32> digest{};
  unsigned size = 0;
  if (EVP_DigestFinal_ex(m_state->context.get(), digest.data(), &size) != 1 ||
      size != digest.size())
    refuseDigest();
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : digest) {
    text += digits[byte >> 4];
    text += digits[byte & 0xfu];
  }
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
