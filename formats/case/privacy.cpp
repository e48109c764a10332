// SPDX-License-Identifier: Apache-2.0
#include "formats/case/privacy.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>

#include "formats/case/issue_text.h"

namespace lumen::formats {
namespace {

constexpr std::size_t kLongNumber = 7;   // digits; a date without separators has eight
constexpr std::size_t kReadableRun = 6;  // characters that make bytes a text
constexpr std::size_t kShownBytes = 40;

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}
bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
         (static_cast<unsigned char>(c) & 0x80u);
}
bool isWordCharacter(char c) {
  return isDigit(c) || isLetter(c);
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return lower;
}

// The text from `at` on that is all digits.
std::string_view digitsAt(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && isDigit(text[end])) ++end;
  return text.substr(at, end - at);
}

int valueOf(std::string_view digits) {
  int value = 0;
  for (const char c : digits.substr(0, 6)) value = 10 * value + (c - '0');
  return value;
}

bool isYear(int value) {
  return value >= 1900 && value < 2100;
}
bool isMonth(int value) {
  return value >= 1 && value <= 12;
}
bool isDay(int value) {
  return value >= 1 && value <= 31;
}

bool isSeparator(char c) {
  return c == '-' || c == '/' || c == '.' || c == ' ';
}

// 2014-03-21, 21.3.2014, 3/21/14 and the like: three numbers with the same separator between.
bool isSeparatedDate(std::string_view text, std::size_t at) {
  std::array<int, 3> part{};
  std::array<std::size_t, 3> size{};
  char separator = '\0';
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string_view digits = digitsAt(text, at);
    if (digits.empty() || digits.size() > 4) return false;
    part[i] = valueOf(digits);
    size[i] = digits.size();
    at += digits.size();
    if (i == 2) break;
    if (at >= text.size() || !isSeparator(text[at]) || (i == 1 && text[at] != separator))
      return false;
    separator = text[at++];
  }
  const bool yearFirst = size[0] == 4 && isYear(part[0]) && isMonth(part[1]) && isDay(part[2]);
  const bool longYear = size[2] == 4 && isYear(part[2]);
  const bool shortYear = size[2] == 2 && size[0] <= 2 && separator != '.' && separator != ' ';
  const bool dayAndMonth =
      (isDay(part[0]) && isMonth(part[1])) || (isMonth(part[0]) && isDay(part[1]));
  return yearFirst || ((longYear || shortYear) && dayAndMonth);
}

// 20140321.
bool isCompactDate(std::string_view digits) {
  return digits.size() == 8 && isYear(valueOf(digits.substr(0, 4))) &&
         isMonth(valueOf(digits.substr(4, 2))) && isDay(valueOf(digits.substr(6, 2)));
}

constexpr std::array<std::string_view, 12> kMonths = {"jan", "feb", "mar", "apr", "may", "jun",
                                                      "jul", "aug", "sep", "oct", "nov", "dec"};

// "March 2014", "21 Mar": a month's name beside a number.
bool hasNamedDate(const std::string& lower) {
  for (const std::string_view month : kMonths)
    for (std::size_t at = lower.find(month); at != std::string::npos;
         at = lower.find(month, at + 1)) {
      if (at > 0 && isLetter(lower[at - 1])) continue;
      const std::size_t before = lower.find_last_not_of(" .-,", at == 0 ? 0 : at - 1);
      std::size_t after = at;
      while (after < lower.size() && isLetter(lower[after])) ++after;
      if (after - at > 9) continue;  // no month is longer than September
      after = lower.find_first_not_of(" .-,", after);
      const bool numberBefore = at > 0 && before != std::string::npos && isDigit(lower[before]);
      const bool numberAfter = after != std::string::npos && isDigit(lower[after]);
      if (numberBefore || numberAfter) return true;
    }
  return false;
}

bool hasDate(std::string_view text) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (!isDigit(text[at]) || (at > 0 && isDigit(text[at - 1]))) continue;
    if (isSeparatedDate(text, at) || isCompactDate(digitsAt(text, at))) return true;
  }
  return hasNamedDate(lowerCase(text));
}

// A slash after a word's start ("/home/x"), a drive ("C:\x"), a share ("\\x"), a home ("~/x"), a
// URL.
bool hasPath(std::string_view text) {
  if (text.find("://") != std::string_view::npos || text.find("~/") != std::string_view::npos ||
      text.find("..\\") != std::string_view::npos || text.find("../") != std::string_view::npos ||
      text.find("\\\\") != std::string_view::npos)
    return true;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    const bool startsWord = i == 0 || !isWordCharacter(text[i - 1]);
    if (text[i] == '/' && startsWord && isLetter(text[i + 1])) return true;
    if (i + 2 < text.size() && startsWord && isLetter(text[i]) && text[i + 1] == ':' &&
        (text[i + 2] == '\\' || text[i + 2] == '/'))
      return true;
  }
  return false;
}

bool hasAddress(std::string_view text) {
  for (std::size_t at = text.find('@'); at != std::string_view::npos; at = text.find('@', at + 1)) {
    const std::size_t dot = text.find('.', at);
    if (at > 0 && isWordCharacter(text[at - 1]) && dot != std::string_view::npos && dot > at + 1 &&
        dot + 1 < text.size() && isLetter(text[dot + 1]))
      return true;
  }
  return false;
}

// Long runs of digits, and object identifiers such as DICOM's.
bool hasNumber(std::string_view text) {
  std::size_t dots = 0, run = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool inNumber = i > 0 && text[i] == '.' && isDigit(text[i - 1]);
    run = isDigit(text[i]) ? run + 1 : 0;
    dots = isDigit(text[i]) ? dots : inNumber ? dots + 1 : 0;
    if (run >= kLongNumber || dots >= 4) return true;
  }
  return false;
}

constexpr auto kNameWords =
    std::to_array<std::string_view>({"patient", "mr", "mrs", "ms", "dr", "prof", "herr", "frau",
                                     "mme", "born", "dob", "mrn", "birth", "ssn", "nhs"});

// A title or a word that a name follows, or DICOM's Family^Given.
bool hasName(std::string_view text) {
  for (std::size_t i = 0; i + 1 < text.size(); ++i)
    if (text[i] == '^' && i > 0 && isLetter(text[i - 1]) && isLetter(text[i + 1])) return true;
  const std::string lower = lowerCase(text);
  for (const std::string_view word : kNameWords)
    for (std::size_t at = lower.find(word); at != std::string::npos;
         at = lower.find(word, at + 1)) {
      const std::size_t end = at + word.size();
      const bool whole = (at == 0 || !isWordCharacter(lower[at - 1])) &&
                         (end == lower.size() || !isWordCharacter(lower[end]));
      if (!whole) continue;
      const std::size_t next = lower.find_first_not_of(" .:=_-", end);
      if (next != std::string::npos && isWordCharacter(lower[next])) return true;
    }
  return false;
}

struct Finding {
  bool (*present)(std::string_view);
  ErrorCode code;
  const char* what;
};
constexpr auto kFindings = std::to_array<Finding>({
    {hasDate, ErrorCode::PrivacyDate, "a date"},
    {hasPath, ErrorCode::PrivacyPath, "a path or an address of a file"},
    {hasAddress, ErrorCode::PrivacyAddress, "an e-mail address"},
    {hasNumber, ErrorCode::PrivacyNumber, "an identification number"},
    {hasName, ErrorCode::PrivacyName, "the name or title of a person"},
});

std::string shown(std::string_view text) {
  std::size_t size = std::min(text.size(), kShownBytes);
  while (size < text.size() && size > 0 &&
         (static_cast<unsigned char>(text[size]) & 0xc0u) == 0x80u)
    --size;
  return std::string(text.substr(0, size));
}

// Texts inside of bytes that nobody here understands.
void scanBytes(std::span<const std::byte> bytes, const std::string& pointer, IssueList& issues) {
  std::string run;
  const auto flush = [&] {
    if (run.size() >= kReadableRun) scanText(run, pointer, issues);
    run.clear();
  };
  for (const std::byte b : bytes) {
    const auto c = static_cast<char>(b);
    if (c >= 0x20 && c < 0x7f)
      run += c;
    else
      flush();
  }
  flush();
}

void scanStep(const Step& step, const std::string& place, IssueList& issues) {
  scanText(step.name, place + "/name", issues);
  for (const auto& [name, value] : step.parameters) {
    const std::string at = place + "/parameters/" + jsonPointerToken(name);
    scanText(name, at, issues);
    if (const auto* text = std::get_if<std::string>(&value)) scanText(*text, at, issues);
  }
}

}  // namespace

void scanText(std::string_view text, const std::string& pointer, IssueList& issues) {
  for (const Finding& finding : kFindings) {
    if (!finding.present(text)) continue;
    std::string message = "looks like ";
    message.append(finding.what).append(": \"").append(shown(text)).append("\"");
    issues.add(pointerIssue(finding.code, pointer, std::move(message), {{"found", shown(text)}}));
  }
}

void scanPrivacy(const Case& value, IssueList& issues) {
  const Metadata& metadata = value.metadata;
  for (std::size_t b = 0; b < value.tree.branches.size(); ++b)
    scanText(value.tree.branches[b].label, "/tree/branches/" + std::to_string(b) + "/label",
             issues);
  scanText(metadata.note, "/metadata/note", issues);
  for (std::size_t i = 0; i < metadata.steps.size(); ++i) {
    const std::string place = "/metadata/steps/" + std::to_string(i);
    scanText(metadata.steps[i].tool, place + "/tool", issues);
    scanStep(metadata.steps[i], place, issues);
  }
  for (std::size_t i = 0; i < value.nodeArrays.size(); ++i) {
    const std::string place = "/metadata/nodeArrays/" + std::to_string(i);
    scanText(value.nodeArrays[i].name, place + "/name", issues);
    scanText(value.nodeArrays[i].unit, place + "/unit", issues);
  }
  for (std::size_t i = 0; i < metadata.extensionsUsed.size(); ++i)
    scanText(metadata.extensionsUsed[i], "/metadata/extensionsUsed/" + std::to_string(i), issues);
  for (std::size_t i = 0; i < value.otherChunks.size(); ++i)
    scanBytes(value.otherChunks[i].bytes, "/otherChunks/" + std::to_string(i), issues);
}

}  // namespace lumen::formats
