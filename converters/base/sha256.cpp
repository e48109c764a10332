// SPDX-License-Identifier: Apache-2.0
#include "converters/base/sha256.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <vector>

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include "converters/base/error.h"
#include "formats/container/printable.h"

namespace lumen {

namespace {

[[noreturn]] void refuseDigest() {
  throw failed("the cryptography library offers no SHA-256");
}

/// A file that is open for reading.
class OpenFile {
public:
  explicit OpenFile(const std::filesystem::path& file)
      : m_name(formats::printable(file.string())),
        m_descriptor(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    if (m_descriptor < 0) refuse(std::strerror(errno));
    struct stat status {};
    if (fstat(m_descriptor, &status) == 0 && S_ISREG(status.st_mode)) return;
    close(m_descriptor);
    refuse("it is no file");
  }
  ~OpenFile() { close(m_descriptor); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  /// Fills a part of `block`; nothing at the end.
  std::span<const std::byte> read(std::span<std::byte> block) const {
    while (true) {
      const ssize_t size = ::read(m_descriptor, block.data(), block.size());
      if (size >= 0) return block.first(static_cast<std::size_t>(size));
      if (errno != EINTR) refuse(std::strerror(errno));
    }
  }

private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw failed(m_name + ": cannot be read: " + why);
  }
  std::string m_name;
  int m_descriptor;
};

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
  const OpenFile open(file);
  std::vector<std::byte> block(kBlock);
  Sha256 hash;
  FileDigest digest;
  for (auto part = open.read(block); !part.empty(); part = open.read(block)) {
    hash.add(part);
    digest.bytes += part.size();
  }
  digest.sha256 = hash.text();
  return digest;
}

}  // namespace lumen
