// SPDX-License-Identifier: Apache-2.0
#include "converters/io/labels/label_role.h"

#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>

#include "converters/base/embedded_text.h"
#include "converters/io/volume/text_header.h"

namespace lumen::convert {

std::span<const EmbeddedText> labelRoleTexts();

namespace {

struct RoleRule {
  LabelRole role;
  std::vector<std::string> words;  // "_vein_"; "_calcif" is every word that begins so
};

std::vector<RoleRule> readRules() {
  std::vector<RoleRule> rules;
  for (const std::string& line : splitWords(labelRoleTexts().front().bytes, "\n")) {
    if (line.starts_with('#')) continue;
    std::vector<std::string> words = splitWords(line, ": ");
    const std::optional<LabelRole> role = roleOfWord(words.front());
    if (!role) throw std::logic_error("roles.txt: " + words.front() + " is no role");
    words.erase(words.begin());
    for (std::string& word : words)
      word = "_" + (word.ends_with('*') ? word.substr(0, word.size() - 1) : word + "_");
    rules.push_back({*role, std::move(words)});
  }
  return rules;
}

bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         static_cast<unsigned char>(c) >= 0x80U;
}

}  // namespace

const std::vector<std::string>& roleWords() {
  static const std::vector<std::string> words = {
      "unknown",     "vessel", "artery", "vein",    "chamber", "aneurysm", "true-lumen",
      "false-lumen", "bone",   "metal",  "calcium", "organ",   "region"};
  return words;
}

const std::string& roleWord(LabelRole role) {
  return roleWords()[static_cast<std::size_t>(role)];
}

std::optional<LabelRole> roleOfWord(std::string_view word) {
  const auto found = std::find(roleWords().begin(), roleWords().end(), word);
  if (found == roleWords().end()) return {};
  return static_cast<LabelRole>(found - roleWords().begin());
}

std::string plainName(std::string_view name) {
  std::string plain;
  char before = '_';
  for (const char c : name) {
    const bool isCapital = c >= 'A' && c <= 'Z';
    const bool begins = isCapital && before >= 'a' && before <= 'z';
    if (begins || (isLetter(c) && !isLetter(before) && !plain.empty())) plain += '_';
    if (isLetter(c)) plain += isCapital ? static_cast<char>(c - 'A' + 'a') : c;
    before = c;
  }
  return plain;
}

LabelRole roleOfName(std::string_view name) {
  static const std::vector<RoleRule> rules = readRules();
  const std::string words = "_" + plainName(name) + "_";
  for (const RoleRule& rule : rules)
    for (const std::string& word : rule.words)
      if (words.find(word) != words.npos) return rule.role;
  return LabelRole::Unknown;
}

}  // namespace lumen::convert
