// SPDX-License-Identifier: Apache-2.0
#include "converters/base/embedded_text.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <vector>

namespace lumen::convert {

namespace {

bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// The name of the placeholder that begins at a brace, if one does.
std::optional<std::string_view> nameAt(std::string_view text, std::size_t brace) {
  std::size_t end = brace + 1;
  while (end < text.size() && isLetter(text[end])) ++end;
  const bool isName = end > brace + 1 && text[brace + 1] >= 'a' && end < text.size();
  if (!isName || text[end] != '}') return std::nullopt;
  return text.substr(brace + 1, end - brace - 1);
}

bool endsLine(const std::string& value) {
  return value.empty() || value.back() == '\n';
}

}  // namespace

std::string filled(std::string_view text, std::initializer_list<TextValue> values) {
  std::vector<char> isUsed(values.size(), 0);
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const auto name = text[at] == '{' ? nameAt(text, at) : std::nullopt;
    if (!name) {
      out += text[at];
      continue;
    }
    const auto* const found = std::find_if(values.begin(), values.end(),
                                           [&](const TextValue& one) { return one.name == *name; });
    if (found == values.end())
      throw std::logic_error("a text has the placeholder " + std::string(*name) + " without value");
    isUsed[static_cast<std::size_t>(found - values.begin())] = 1;
    const bool beginsLine = out.empty() || out.back() == '\n';
    out += found->value;
    at += name->size() + 1;
    const bool isAlone = beginsLine && at + 1 < text.size() && text[at + 1] == '\n';
    if (isAlone && endsLine(found->value)) ++at;
  }
  const auto unused = std::find(isUsed.begin(), isUsed.end(), 0);
  if (unused != isUsed.end())
    throw std::logic_error("no placeholder for " +
                           std::string((values.begin() + (unused - isUsed.begin()))->name));
  return out;
}

}  // namespace lumen::convert
