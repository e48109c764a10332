// SPDX-License-Identifier: Apache-2.0
#include "converters/app/file_digest.h"

#include <array>

#include <openssl/evp.h>

#include "converters/common/error.h"

namespace lumen::app {

std::string sha256(std::span<const std::byte> bytes) {
  std::array<unsigned char, 32> digest{};
  unsigned size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1 ||
      size != digest.size())
    throw failed("the SHA-256 digest of a file cannot be computed");
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : digest) {
    text += digits[byte >> 4];
    text += digits[byte & 0xfu];
  }
  return text;
}

}  // namespace lumen::app
