// SPDX-License-Identifier: Apache-2.0
// Declared in shown_text.h.
#include "converters/base/shown_text.h"
#include "formats/container/printable.h"

namespace lumen {

namespace {

// digits; a checksum has eight, and the address of an object has more
constexpr std::size_t kShortestAddress = 9;

std::size_t hexDigits(std::string_view text) {
  const auto end = text.find_first_not_of("0123456789abcdefABCDEF");
  return end == std::string_view::npos ? text.size() : end;
}

std::string withoutAddresses(std::string text) {
  for (std::size_t at = text.find("0x"); at != std::string::npos; at = text.find("0x", at)) {
    const std::size_t digits = hexDigits(std::string_view(text).substr(at + 2));
    std::size_t begin = at, end = at + 2 + digits;
    const bool bracketed = at > 0 && text[at - 1] == '(' && end < text.size() && text[end] == ')';
    if (bracketed) --begin, ++end;
    if (digits >= kShortestAddress)
      text.erase(begin, end - begin);
    else
      at += 2;
  }
  return text;
}

}  // namespace

std::string messageText(std::string_view message) {
  std::string text;
  while (true) {
    const std::size_t end = message.find('\n');
    text += formats::printable(withoutAddresses(std::string(message.substr(0, end))));
    if (end == std::string_view::npos) return text;
    text += '\n';
    message.remove_prefix(end + 1);
  }
}

}  // namespace lumen
