// SPDX-License-Identifier: Apache-2.0
#include "converters/library/index/spdx.h"

#include <algorithm>
#include <span>
#include <vector>

#include "converters/base/embedded_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"

namespace lumen::convert {

/// spdx_licences.txt and spdx_exceptions.txt.
std::span<const EmbeddedText> spdxTexts();

namespace {

constexpr std::size_t kMostBytes = 255;

std::vector<std::string_view> splitLines(std::string_view text) {
  std::vector<std::string_view> lines;
  for (std::size_t end = 0; (end = text.find('\n')) != std::string_view::npos;
       text.remove_prefix(end + 1))
    lines.push_back(text.substr(0, end));
  return lines;
}

bool isIn(const std::vector<std::string_view>& sorted, std::string_view word) {
  return std::binary_search(sorted.begin(), sorted.end(), word);
}

bool isIdCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '-';
}

/// LicenseRef-NAME, or DocumentRef-NAME:LicenseRef-NAME.
bool isOwnLicence(std::string_view word) {
  constexpr std::string_view kDocument = "DocumentRef-", kLicence = "LicenseRef-";
  const auto isNamed = [](std::string_view text, std::string_view prefix) {
    return text.size() > prefix.size() && text.starts_with(prefix) &&
           std::all_of(text.begin(), text.end(), isIdCharacter);
  };
  if (const auto colon = word.find(':'); colon != std::string_view::npos) {
    if (!isNamed(word.substr(0, colon), kDocument)) return false;
    word.remove_prefix(colon + 1);
  }
  return isNamed(word, kLicence);
}

/// Words and parentheses.
std::vector<std::string> splitTokens(const std::string& text) {
  std::vector<std::string> tokens;
  bool inWord = false;
  for (const char c : text) {
    const bool isBracket = c == '(' || c == ')';
    if (isBracket || (c != ' ' && !inWord))
      tokens.emplace_back(1, c);
    else if (c != ' ')
      tokens.back() += c;
    inWord = c != ' ' && !isBracket;
  }
  return tokens;
}

/// The listed identifier that is `word`, a hyphen and the greatest version number: CC-BY-4.0 for
/// CC-BY; or nothing.
std::string_view newestVersion(const std::string& word) {
  std::string_view newest;
  const std::string prefix = lowerCase(word) + "-";
  for (const std::string_view known : spdxLicences())
    if (lowerCase(std::string(known)).starts_with(prefix) &&
        known.find_first_not_of("0123456789.", prefix.size()) == std::string_view::npos)
      newest = std::max(newest, known);
  return newest;
}

std::string unknown(const std::string& word) {
  std::string text = quotedText(word) + " is no identifier of SPDX's list of licences";
  for (const std::string_view known : spdxLicences())
    if (lowerCase(std::string(known)) == lowerCase(word))
      return text + "; did you mean " + std::string(known) + "?";
  if (const std::string_view versioned = newestVersion(word); !versioned.empty())
    return text + "; did you mean " + std::string(versioned) + "?";
  return text + "; a licence of your own is written LicenseRef- and a name";
}

/// expression = term {("AND" | "OR") term}; term = "(" expression ")" | licence ["WITH" exception]
class LicenceParser {
public:
  explicit LicenceParser(const std::string& text) : m_tokens(splitTokens(text)) {}

  /// Fault of the whole text.
  std::string fault() {
    std::size_t open = 0;
    for (;;) {
      while (take("(")) ++open;
      if (const std::string what = licence(); !what.empty()) return what;
      while (open > 0 && take(")")) --open;
      if (m_next == m_tokens.size()) return open == 0 ? "" : "a parenthesis is not closed";
      if (!take("AND") && !take("OR"))
        return "expected AND or OR before " + quotedText(m_tokens[m_next]);
    }
  }

private:
  bool take(std::string_view word) {
    if (m_next == m_tokens.size() || m_tokens[m_next] != word) return false;
    ++m_next;
    return true;
  }

  std::string licence() {
    if (m_next == m_tokens.size()) return "expected a licence at its end";
    const std::string word = m_tokens[m_next++];
    std::string_view id = word;
    if (!isOwnLicence(id)) {
      if (id.ends_with('+')) id.remove_suffix(1);
      if (!isIn(spdxLicences(), id) && !isIn(spdxLicences(), word)) return unknown(word);
    }
    if (!take("WITH")) return {};
    if (m_next < m_tokens.size() && isIn(spdxExceptions(), m_tokens[m_next])) {
      ++m_next;
      return {};
    }
    return "WITH is followed by an exception of SPDX's list, such as Classpath-exception-2.0";
  }

  std::vector<std::string> m_tokens;
  std::size_t m_next = 0;
};

}  // namespace

const std::vector<std::string_view>& spdxLicences() {
  static const std::vector<std::string_view> lines = splitLines(spdxTexts()[0].bytes);
  return lines;
}

const std::vector<std::string_view>& spdxExceptions() {
  static const std::vector<std::string_view> lines = splitLines(spdxTexts()[1].bytes);
  return lines;
}

std::string licenceFault(const std::string& expression) {
  const std::string prefix = "licence " + quotedText(expression) + ": ";
  if (expression.size() > kMostBytes) return prefix + "expected at most 255 bytes";
  const std::string fault = LicenceParser(expression).fault();
  return fault.empty() ? fault : prefix + fault;
}

bool isListedLicence(std::string_view identifier) {
  return isIn(spdxLicences(), identifier);
}

}  // namespace lumen::convert
