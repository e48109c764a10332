// SPDX-License-Identifier: Apache-2.0
#include "converters/base/html.h"

#include <cstddef>
#include <span>

#include "formats/case/base64.h"
#include "formats/container/printable.h"

namespace lumen {

namespace {

/// The replacement of a character that could be markup; empty for all others.
std::string_view reference(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {};
  }
}

}  // namespace

std::string htmlText(std::string_view text) {
  std::string safe;
  for (const char c : formats::printable(text)) {
    const std::string_view instead = reference(c);
    if (instead.empty())
      safe += c;
    else
      safe += instead;
  }
  return safe;
}

std::string htmlName(std::string_view text) {
  std::string element = "<bdi>";
  element += htmlText(text);
  element += "</bdi>";
  return element;
}

std::string dataAddress(std::string_view type, std::string_view bytes) {
  std::string address = "data:";
  address += type;
  address += ";base64,";
  address += formats::base64(std::as_bytes(std::span(bytes)));
  return address;
}

}  // namespace lumen
