// SPDX-License-Identifier: Apache-2.0
#include "converters/library/record_faults.h"

#include <algorithm>
#include <set>
#include <utility>

#include "converters/base/json_place.h"
#include "converters/base/privacy.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/library/spdx.h"

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

}  // namespace lumen::convert
