// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/plain_names.h"

#include <cstddef>
#include <set>

namespace lumen::convert {
namespace {

// Readers of STL accept lines of 255 bytes, and some less.
constexpr std::size_t kLongestWord = 100;

bool isAsciiWord(unsigned char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '.' || c == '-';
}

}  // namespace

std::string oneWord(const std::string& name) {
  std::string word = name.empty() ? "_" : name;
  for (char& c : word)
    if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f) c = '_';
  return word;
}

std::string openFoamWord(const std::string& name) {
  std::string word;
  for (const char byte : name) {
    const auto c = static_cast<unsigned char>(byte);
    const bool isContinued = (c & 0xc0U) == 0x80U;  // continuation byte of a UTF-8 character
    if (isContinued || word.size() == kLongestWord) continue;
    word += isAsciiWord(c) ? byte : '_';
  }
  return word.empty() ? "_" : word;
}

std::vector<std::string> distinct(const std::vector<std::string>& names,
                                  std::string (*rule)(const std::string&)) {
  std::set<std::string> taken;
  std::vector<std::string> words;
  for (const std::string& name : names) {
    const std::string stem = rule(name);
    std::string word = stem;
    for (int n = 2; !taken.insert(word).second; ++n) word = stem + "_" + std::to_string(n);
    words.push_back(word);
  }
  return words;
}

std::vector<std::string> plainGroupNames(const std::vector<FaceGroup>& groups) {
  std::vector<std::string> names;
  names.reserve(groups.size());
  for (const FaceGroup& group : groups) names.push_back(group.name);
  return names;
}

}  // namespace lumen::convert
