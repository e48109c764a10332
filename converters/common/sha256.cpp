// SPDX-License-Identifier: Apache-2.0
#include "converters/common/sha256.h"

#include <array>

#include <openssl/evp.h>

#include "converters/common/error.h"

namespace lumen {

std::string sha256(std::span<const std::byte> bytes) {
  std::array<unsigned char, 32> digest{};
  unsigned size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1 ||
      size != digest.size())
    throw failed("the cryptography library offers no SHA-256");
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : digest) {
    text += digits[byte >> 4];
    text += digits[byte & 0xfu];
  }
  return text;
}

}  // namespace lumen
