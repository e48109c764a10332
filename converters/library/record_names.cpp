// SPDX-License-Identifier: Apache-2.0
// record.h: spelling of ids and paths, and statements that a record needs.
#include <algorithm>
#include <string_view>

#include "converters/base/option_name.h"
#include "converters/base/text.h"
#include "converters/library/record.h"
#include "converters/library/spdx.h"

namespace lumen::convert {

namespace {

constexpr std::size_t kMostId = 64, kMostPart = 128, kMostPath = 255;

bool isSmallLetterOrDigit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
}

bool isPathCharacter(char c) {
  return isSmallLetterOrDigit(c) || (c >= 'A' && c <= 'Z') ||
         std::string_view("._+-").find(c) != std::string_view::npos;
}

/// Names of devices, which Windows refuses for files whatever their ending ("Naming Files, Paths,
/// and Namespaces").
bool isOfWindows(std::string_view part) {
  const std::string stem = lowerCase(std::string(part.substr(0, part.find('.'))));
  if (stem.size() == 4 && (stem.starts_with("com") || stem.starts_with("lpt")))
    return stem[3] >= '0' && stem[3] <= '9';
  return stem == "con" || stem == "prn" || stem == "aux" || stem == "nul";
}

/// No hidden file, no option of a program, and nothing that Windows cannot keep.
bool isPart(std::string_view part) {
  return !part.empty() && part.size() <= kMostPart && part.front() != '.' && part.front() != '-' &&
         part.back() != '.' && !isOfWindows(part) &&
         std::all_of(part.begin(), part.end(), isPathCharacter);
}

}  // namespace

bool isCaseId(const std::string& id) {
  return !id.empty() && id.size() <= kMostId && id.front() != '-' && !isOfWindows(id) &&
         std::all_of(id.begin(), id.end(),
                     [](char c) { return isSmallLetterOrDigit(c) || c == '-'; });
}

bool isRecordedPath(const std::string& path) {
  if (path.size() > kMostPath) return false;
  std::string_view rest = path;
  for (std::size_t slash = 0; (slash = rest.find('/')) != std::string_view::npos;
       rest.remove_prefix(slash + 1))
    if (!isPart(rest.substr(0, slash))) return false;
  return isPart(rest);
}

bool isDoi(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (text.empty()) return true;
  if (!text.starts_with("10.") || slash == std::string::npos || slash + 1 == text.size())
    return false;
  const std::string prefix = text.substr(3, slash - 3);
  return prefix.size() >= 4 && prefix.size() <= 9 &&
         std::all_of(prefix.begin(), prefix.end(), [](char c) { return c >= '0' && c <= '9'; }) &&
         text.find(' ') == std::string::npos;
}

std::string missingStatement(const CaseAbout& about) {
  if (about.licence.empty())
    return "no licence is stated, so nobody may use the case; " + kOption.licence.shown() +
           " states one, such as CC-BY-4.0";
  if (const std::string fault = licenceFault(about.licence); !fault.empty()) return fault;
  if (about.synthetic) return {};
  if (!about.consent.empty() && !about.deidentification.empty()) return {};
  const bool lacksConsent = about.consent.empty();
  const OptionName& option = lacksConsent ? kOption.consent : kOption.deidentification;
  return std::string("no statement of ") + (lacksConsent ? "consent" : "de-identification") +
         " for a case that is not stated to be synthetic; " + option.shown() + " gives one, " +
         kOption.synthetic.shown() + " states that no patient is behind the case";
}

std::vector<std::pair<const char*, const std::string*>> textsToLookAt(const CaseAbout& about) {
  return {{"/title", &about.title},
          {"/description", &about.description},
          {"/anatomy/text", &about.anatomy},
          {"/consent", &about.consent},
          {"/deidentification", &about.deidentification}};
}

}  // namespace lumen::convert
