// SPDX-License-Identifier: Apache-2.0
#include "converters/base/privacy.h"

#include <algorithm>
#include <array>
#include <regex>

#include "formats/case/case_file.h"
#include "formats/case/chunk_codec.h"
#include "formats/json/json_document.h"
#include "formats/view/case_chunks.h"
#include "formats/view/text_rules.h"

namespace lumen {

namespace {

using Findings = std::vector<PrivacyFinding>;

constexpr std::size_t kReadableRun = 6;  // characters that make bytes a text
constexpr std::size_t kShownBytes = 40;

struct Pattern {
  const char* code;
  int number;
  const char* what;
  std::regex regex;
};

// Repetitions are bounded, because the library recurses once per repetition.
const std::array<Pattern, 5>& patterns() {
  static const auto make = [](const char* text) {
    return std::regex(text, std::regex::icase | std::regex::optimize);
  };
  static const std::array<Pattern, 5> all = {{
      {"PRIVACY_DATE", 601, "a date",
       make(R"(\b(19|20)\d\d([-/. ])(0?[1-9]|1[0-2])\2(0?[1-9]|[12]\d|3[01])\b)"
            R"(|\b(0?[1-9]|[12]\d|3[01])([-/. ])(0?[1-9]|[12]\d|3[01])\6(19|20)\d\d\b)"
            R"(|\b\d{1,2}([-/])\d{1,2}\9\d\d\b)"
            R"(|\b(19|20)\d\d(0[1-9]|1[0-2])(0[1-9]|[12]\d|3[01])\b)"
            R"(|\d[ .,-]{0,4}\b(jan|feb|mar|apr|may|jun|jul|aug|sep|oct|nov|dec)[a-z]{0,6}\b)"
            R"(|\b(jan|feb|mar|apr|may|jun|jul|aug|sep|oct|nov|dec)[a-z]{0,6}[ .,-]{0,4}\d)")},
      {"PRIVACY_PATH", 602, "a path or an address of a file",
       make(R"(://|~/|\.\./|\.\.\\|\\\\|(^|\W)/[a-z]|\b[a-z]:[\\/])")},
      {"PRIVACY_ADDRESS", 603, "an e-mail address", make(R"(\w@[\w.-]{1,64}\.[a-z])")},
      {"PRIVACY_NUMBER", 604, "an identification number", make(R"(\d{7}|(\d{1,20}\.){4}\d)")},
      {"PRIVACY_NAME", 605, "the name or title of a person",
       make(R"([a-z]\^[a-z]|(^|[^a-z0-9])(patient|mr|mrs|ms|dr|prof|herr|frau|mme|born|dob|mrn|)"
            R"(birth|ssn|nhs)[ .:=_-]{1,4}[a-z0-9])")},
  }};
  return all;
}

std::string shown(std::string_view text) {
  std::size_t size = std::min(text.size(), kShownBytes);
  while (size < text.size() && size > 0 &&
         (static_cast<unsigned char>(text[size]) & 0xc0u) == 0x80u)
    --size;
  return std::string(text.substr(0, size));
}

void append(Findings& to, Findings more) {
  std::move(more.begin(), more.end(), std::back_inserter(to));
}

// Digests and the bytes of other chunks are full of digits and slashes.
bool isText(const std::string& pointer, const std::string& text) {
  constexpr std::size_t kDigestDigits = 64;
  const bool isDigest = pointer.ends_with("ha256") && text.size() == kDigestDigits &&
                        text.find_first_not_of("0123456789abcdef") == std::string::npos;
  return !isDigest && !(pointer.starts_with("/otherChunks/") && pointer.ends_with("/data"));
}

// Keys too: users choose the names of parameters and comments.
void scanJson(const formats::JsonValue& value, const std::string& pointer, Findings& findings) {
  if (value.text() != nullptr && isText(pointer, *value.text()))
    append(findings, scanText(*value.text(), pointer));
  for (std::size_t i = 0; i < value.arraySize(); ++i)
    if (!value[i].number()) scanJson(value[i], pointer + "/" + std::to_string(i), findings);
  for (const auto& [key, member] : value.members()) {
    const std::string place = pointer + "/" + formats::jsonPointerToken(key);
    append(findings, scanText(key, place));
    scanJson(member, place, findings);
  }
}

// Texts inside of bytes in an unknown format.
void scanBytes(std::span<const std::byte> bytes, const std::string& pointer, Findings& findings) {
  std::string run;
  for (std::size_t i = 0; i <= bytes.size(); ++i) {
    const char c = i < bytes.size() ? static_cast<char>(bytes[i]) : '\0';
    if (c >= 0x20 && c < 0x7f) {
      run += c;
      continue;
    }
    if (run.size() >= kReadableRun) append(findings, scanText(run, pointer));
    run.clear();
  }
}

// False if the bytes are no JSON.
bool scanJsonBytes(std::span<const std::byte> bytes, const std::string& pointer,
                   Findings& findings) {
  formats::IssueList issues(1);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto document = formats::parseJson(text, 0, pointer, issues);
  if (document) scanJson(document->root(), pointer, findings);
  return document.has_value();
}

// Seeds are JSON, whose coordinates are no numbers of persons.
void scanOther(const formats::OtherChunk& chunk, const std::string& pointer, Findings& findings) {
  const bool areSeeds = chunk.type == formats::chunkName(formats::chunk::kSeeds);
  if (!areSeeds || !scanJsonBytes(chunk.bytes, pointer, findings))
    scanBytes(chunk.bytes, pointer, findings);
}

// The texts of a binary file are its metadata, which are JSON, and its labels.
void scanBinary(std::span<const std::byte> file, const formats::Case& value, Findings& findings) {
  for (std::size_t b = 0; b < value.tree.branches.size(); ++b)
    append(findings, scanText(value.tree.branches[b].label,
                              "/tree/branches/" + std::to_string(b) + "/label"));
  const auto container = formats::readContainer(file);
  for (const formats::Chunk& chunk : container->chunks) {
    if (chunk.type != formats::chunk::kMetadata) continue;
    formats::IssueList issues(1);
    const auto decoded = chunk.encoding == 0 ? std::nullopt : formats::decodeChunk(chunk, issues);
    const auto bytes = decoded ? std::span<const std::byte>(*decoded) : chunk.stored;
    scanJsonBytes(bytes, "/metadata", findings);
  }
}

}  // namespace

std::vector<PrivacyFinding> scanText(std::string_view text, const std::string& pointer) {
  std::string plain(text);
  for (char& c : plain)
    if (static_cast<unsigned char>(c) >= 0x80) c = 'a';  // a letter of some language
  std::vector<PrivacyFinding> findings;
  for (const Pattern& pattern : patterns())
    if (std::regex_search(plain, pattern.regex))
      findings.push_back({pattern.code, pattern.number, pointer, shown(text),
                          std::string("looks like ") + pattern.what + ": \"" + shown(text) + "\""});
  return findings;
}

std::vector<PrivacyFinding> scanPrivacy(std::span<const std::byte> file) {
  Findings findings;
  const auto value = formats::decodeCase(file);
  if (!value) return findings;
  if (formats::hasContainerMagic(file)) {
    scanBinary(file, *value, findings);
  } else {
    scanJsonBytes(file, "", findings);
  }
  for (std::size_t i = 0; i < value->otherChunks.size(); ++i)
    scanOther(value->otherChunks[i], "/otherChunks/" + std::to_string(i), findings);
  return findings;
}

}  // namespace lumen
