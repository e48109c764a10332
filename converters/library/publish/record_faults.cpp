// SPDX-License-Identifier: Apache-2.0
#include "converters/library/publish/record_faults.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "converters/base/json_place.h"
#include "converters/base/privacy.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/library/index/record_of_case.h"
#include "converters/library/index/spdx.h"

namespace lumen::convert {

namespace {

/// A message of a reader, without the name of the file, which a fault has anyhow.
std::string withoutFile(const Error& error, const std::string& path) {
  std::string text = error.what();
  const std::size_t at = text.find(path + ": ");
  return at == std::string::npos ? text : text.substr(at + path.size() + 2);
}

/// The indices of a record's files whose paths none may have, or which another file has in upper or
/// lower case. Adds a fault for each.
std::set<std::size_t> faultyPaths(const formats::JsonValue& record, const std::string& caseId,
                                  const std::string& path, FaultList& faults) {
  std::set<std::size_t> faulty;
  const auto files = record.find("files");
  std::set<std::string> names{lowerCase(kRecordFile), lowerCase(kCrateFile)};
  for (std::size_t i = 0; files && i < files->arraySize(); ++i) {
    const auto found = (*files)[i].find("path");
    const std::string* const name = found ? found->text() : nullptr;
    if (name == nullptr) continue;
    const bool isPath = isRecordedPath(*name);
    if (isPath && names.insert(lowerCase(*name)).second) continue;
    faulty.insert(i);
    faults.add({FaultCode::FilePath, caseId, path, "the path " + quotedText(*name),
                isPath ? "one that differs from all others, record.json and "
                         "ro-crate-metadata.json in more than upper and lower case"
                       : "one that stays in the folder of the case, of the letters that a path "
                         "may have"});
  }
  return faulty;
}

void checkSame(const std::string& what, const std::string& found, const std::string& expected,
               const LibraryEntry& entry, const std::string& path, FaultList& faults) {
  if (found == expected) return;
  faults.add({FaultCode::RecordCase, entry.id, path, what + " " + found,
              expected + ", as in library.json"});
}

using Json = nlohmann::ordered_json;

bool isSame(double a, double b, bool isGeometry) {
  constexpr double kSame = 1e-3;          // mm, and of unit vectors
  constexpr double kSameRelative = 1e-5;  // sums of lengths: a hundred roundings of a float
  constexpr double kAlike = 0.01;  // of geometry: extremes over places, which rounding may exchange
  const double size = std::max(std::abs(a), std::abs(b));
  return std::abs(a - b) <=
         (isGeometry ? kAlike * std::max(1.0, size) : std::max(kSame, kSameRelative * size));
}

std::string factText(const Json& value) {
  if (value.is_number_float()) return shownNumber(value.get<double>());
  return value.is_string() ? quotedText(value.get<std::string>()) : value.dump();
}

/// Calls `report` with each value of the record that is not the one of the case, and the latter;
/// `place` is that in the record.
template <class Report>
void compareFacts(const Json& found, const Json& expected, const std::string& place,
                  const Report& report) {
  const bool isList = found.is_array() && expected.is_array();
  if (isList && found.size() != expected.size())
    report("a number of " + place + " of " + std::to_string(found.size()),
           std::to_string(expected.size()));
  for (std::size_t i = 0; isList && i < std::min(found.size(), expected.size()); ++i)
    compareFacts(found[i], expected[i], place + "/" + std::to_string(i), report);
  if (isList) return;
  if (found.is_object() && expected.is_object()) {
    for (const auto& [key, value] : found.items())
      compareFacts(value, expected.value(key, Json()), place.empty() ? key : place + "/" + key,
                   report);
    return;
  }
  const bool isReal = found.is_number_float() && expected.is_number_float();
  if (isReal ? !isSame(found.get<double>(), expected.get<double>(),
                       place.find("/geometry/") != std::string::npos)
             : found != expected)
    report(place + " " + factText(found), factText(expected));
}

}  // namespace

std::optional<CaseRecord> readRecordFaults(const std::string& text, const std::string& caseId,
                                           const std::string& path, FaultList& faults) {
  try {
    return readRecord(text, path);
  } catch (const PathError&) {  // below
  } catch (const Error& error) {
    faults.add({FaultCode::RecordFile, caseId, path, withoutFile(error, path), ""});
    return {};
  }
  const JsonFile document(text, path);
  try {
    return readRecord(text, path, faultyPaths(document.root(), caseId, path, faults));
  } catch (const Error& error) {
    faults.add({FaultCode::RecordFile, caseId, path, withoutFile(error, path), ""});
    return {};
  }
}

void checkLicence(const std::string& licence, const std::string& caseId, const std::string& path,
                  FaultList& faults) {
  if (licence.empty())
    faults.add({FaultCode::LibraryLicence, caseId, path, "no licence", "an SPDX expression"});
  else if (const std::string fault = licenceFault(licence); !fault.empty())
    faults.add({FaultCode::LibraryLicence, caseId, path, "the licence " + quotedText(licence),
                "an SPDX expression: " + fault});
}

void checkPrivacy(const std::string& text, const std::string& pointer, const std::string& caseId,
                  const std::string& path, FaultList& faults) {
  for (const PrivacyFinding& finding : scanText(text, pointer))
    faults.add(
        {FaultCode::Privacy, caseId, path, "at \"" + pointer + "\": " + finding.message, ""});
}

void checkRecord(const CaseRecord& record, const LibraryEntry& entry, const std::string& path,
                 FaultList& faults) {
  std::uint64_t bytes = 0;
  for (const RecordedFile& file : record.files) bytes += file.bytes;
  const auto number = [](std::uint64_t n) { return std::to_string(n); };
  checkSame("the id", quotedText(record.id), quotedText(entry.id), entry, path, faults);
  checkSame("version", number(record.version), number(entry.version), entry, path, faults);
  checkSame("the title", quotedText(record.about.title), quotedText(entry.title), entry, path,
            faults);
  checkSame("a number of files of", number(record.files.size()), number(entry.files), entry, path,
            faults);
  checkSame("a sum of bytes of", number(bytes), number(entry.bytes), entry, path, faults);

  const CaseAbout& about = record.about;
  checkLicence(about.licence, entry.id, path, faults);
  for (const auto& [text, what] : {std::pair(&about.consent, "consent"),
                                   std::pair(&about.deidentification, "de-identification")})
    if (text->empty() && !about.synthetic)
      faults.add({FaultCode::LibraryConsent, entry.id, path, std::string("no statement of ") + what,
                  "one, as the case is not synthetic"});
  for (const auto& [pointer, text] : textsToLookAt(about))
    checkPrivacy(*text, pointer, entry.id, path, faults);
}

void checkFigures(const formats::Case& value, const CaseRecord& record, const std::string& path,
                  FaultList& faults) {
  const auto report = [&](const std::string& found, const std::string& expected) {
    faults.add({FaultCode::CaseFigures, record.id, path, found, expected + ", as the case gives"});
  };
  CaseRecord made = record;
  try {
    Progress quiet;  // one of many cases at once: their stages are not shown
    describe(value, "", made, quiet);
  } catch (const Error& error) {
    return report("figures", std::string("none (") + error.what() + ")");
  }
  if (!record.figures.geometry) made.figures.geometry.reset();
  if (record.figures.systems.empty()) made.figures.systems.clear();
  compareFacts(factsOfCase(record), factsOfCase(made), "", report);
}

}  // namespace lumen::convert
