// SPDX-License-Identifier: Apache-2.0
// Texts of headers and names.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

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

// "Did you mean ...?"

/// The candidate of which `word` is most likely a misspelling: fewest letters inserted, dropped,
/// replaced or swapped with a neighbour, whatever the case, and at most a third of them; or the
/// only one that begins with it. Empty if there is none.
std::string closest(std::string_view word, const std::vector<std::string>& candidates);

/// "; did you mean --seeds?", or empty.
std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates);

/// "a, b or c".
std::string alternatives(const std::vector<std::string>& names);

}  // namespace lumen
