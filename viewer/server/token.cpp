// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/token.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <sys/random.h>

#include "converters/base/error.h"

namespace lumen::viewer {

std::string randomToken() {
  std::array<unsigned char, 16> bits{};
  if (getrandom(bits.data(), bits.size(), 0) != static_cast<ssize_t>(bits.size()))
    throw failed(std::string("the system gives no random numbers: ") + std::strerror(errno));
  std::string text;
  for (const unsigned char byte : bits)
    for (const int digit : {byte >> 4, byte & 15}) text += "0123456789abcdef"[digit];
  return text;
}

bool sameSecret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

}  // namespace lumen::viewer
