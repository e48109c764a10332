// SPDX-License-Identifier: Apache-2.0
// Texts of headers and names.
#pragma once

#include <cstddef>
#include <string>

namespace lumen {

/// ASCII letters in lower case, whatever the locale.
inline std::string lowerCase(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Without white space at either end.
inline std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// "1 node", "2 nodes".
inline std::string counted(std::size_t count, const std::string& noun, const std::string& plural) {
  return std::to_string(count) + " " + (count == 1 ? noun : plural);
}

}  // namespace lumen
