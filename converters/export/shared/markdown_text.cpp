// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/markdown_text.h"

#include <cstddef>

#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

bool isWordPart(char c) {
  return isDigit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// Whether the character at `at` could begin a block: a heading, a list, a line.
bool beginsBlock(std::string_view text, std::size_t at) {
  if (at == 0) return std::string_view("#+-=").find(text[0]) != std::string_view::npos;
  const bool endsNumber = text[at] == '.' || text[at] == ')';
  return endsNumber && text.find_first_not_of("0123456789") == at;
}

/// Whether the character at `at` is within "://" or "www.", of which GitHub makes links.
bool isOfAddress(std::string_view text, std::size_t at) {
  return (text[at] == ':' && text.substr(at, 3) == "://") ||
         (text[at] == '.' && at >= 3 && text.substr(at - 3, 3) == "www");
}

bool isMarkup(std::string_view text, std::size_t at) {
  const char c = text[at];
  if (std::string_view("\\`*[]<>|~&!").find(c) != std::string_view::npos) return true;
  if (c == '_')  // emphasis has one of its marks at the edge of a word
    return at == 0 || at + 1 == text.size() || !isWordPart(text[at - 1]) ||
           !isWordPart(text[at + 1]);
  return beginsBlock(text, at) || isOfAddress(text, at);
}

}  // namespace

std::string markdownText(std::string_view text) {
  const std::string line = formats::printable(text);
  std::string out;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (isMarkup(line, at)) out += '\\';
    out += line[at];
  }
  return out;
}

}  // namespace lumen::convert
