// SPDX-License-Identifier: Apache-2.0
// Declared in record_of_case.h.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "converters/base/json_place.h"
#include "converters/base/privacy.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/library/record_of_case.h"
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

constexpr double kSame = 1e-3;          // mm, and of unit vectors
constexpr double kSameRelative = 1e-5;  // sums of lengths: a hundred roundings of a float

bool isSame(double a, double b) {
  return std::abs(a - b) <= std::max(kSame, kSameRelative * std::max(std::abs(a), std::abs(b)));
}

/// Measures of geometry are extremes over places, which rounding may exchange.
bool isAlike(double a, double b) {
  constexpr double kAlike = 0.01;
  return std::abs(a - b) <= kAlike * std::max({1.0, std::abs(a), std::abs(b)});
}

bool isSame(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return isSame(a.x(), b.x()) && isSame(a.y(), b.y()) && isSame(a.z(), b.z());
}

/// Comparison of the record's figures with those of the case.
class Figures {
public:
  Figures(const CaseRecord& record, const std::string& path, FaultList& faults)
      : m_id(record.id), m_path(path), m_faults(faults) {}

  void compare(const std::string& what, const std::optional<double>& found,
               const std::optional<double>& expected) {
    if (found.has_value() != expected.has_value() || (found && !isSame(*found, *expected)))
      report(what + " " + (found ? shownNumber(*found) : "null"),
             expected ? shownNumber(*expected) : "null");
  }
  void compareAlike(const std::string& what, const std::optional<double>& found,
                    const std::optional<double>& expected) {
    if (found && expected && isAlike(*found, *expected)) return;
    compare(what, found, expected);
  }
  void compare(const std::string& what, std::size_t found, std::size_t expected) {
    if (found != expected) report(what + " " + std::to_string(found), std::to_string(expected));
  }
  void compare(const std::string& what, const Eigen::Vector3d& found,
               const Eigen::Vector3d& expected) {
    if (!isSame(found, expected)) report(what + " " + vectorText(found), vectorText(expected));
  }
  void compare(const std::string& what, const std::string& found, const std::string& expected) {
    if (found != expected) report(what + " " + quotedText(found), quotedText(expected));
  }
  void compare(const std::string& what, const std::vector<CasePlace>& found,
               const std::vector<CasePlace>& expected) {
    compare("a number of " + what + " of", found.size(), expected.size());
    for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
      const CasePlace &a = found[i], &b = expected[i];
      const std::string which = what + "/" + std::to_string(i) + "/";
      compare(which + "name", a.name, b.name);
      compare(which + "kind", a.kind, b.kind);
      compare(which + "position", a.position, b.position);
      compare(which + "direction", a.direction, b.direction);
      compare(which + "radius", std::optional(a.radius), std::optional(b.radius));
    }
  }

  void report(const std::string& found, const std::string& expected) {
    m_faults.add({FaultCode::CaseFigures, m_id, m_path, found, expected + ", as the case gives"});
  }

private:
  const std::string& m_id;
  const std::string& m_path;
  FaultList& m_faults;
};

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
  Figures figures(record, path, faults);
  CaseRecord made = record;
  try {
    Progress quiet;  // one of many cases at once: their stages are not shown
    describe(value, "", made, quiet);
  } catch (const Error& error) {
    return figures.report("figures", std::string("none (") + error.what() + ")");
  }
  const CaseFigures &found = record.figures, &expected = made.figures;
  using Number = std::optional<double>;
  figures.compare("bounds/min", record.boundsMin, made.boundsMin);
  figures.compare("bounds/max", record.boundsMax, made.boundsMax);
  figures.compare("figures/branches", found.branches, expected.branches);
  figures.compare("figures/aneurysms", found.aneurysms, expected.aneurysms);
  figures.compare("figures/nodes", found.nodes, expected.nodes);
  figures.compare("figures/length_mm", Number(found.length), Number(expected.length));
  figures.compare("figures/radius_mm/min", Number(found.radiusMin), Number(expected.radiusMin));
  figures.compare("figures/radius_mm/mean", Number(found.radiusMean), Number(expected.radiusMean));
  figures.compare("figures/radius_mm/max", Number(found.radiusMax), Number(expected.radiusMax));
  figures.compare("figures/fit_error_mm/median", found.errorMedian, expected.errorMedian);
  figures.compare("figures/fit_error_mm/p90", found.errorP90, expected.errorP90);
  figures.compare("figures/reachable_mm", found.reachable, expected.reachable);
  if (found.geometry)
    for (const GeometryKey& figure : kGeometryKeys)
      figures.compareAlike(std::string("figures/geometry/") + figure.key,
                           (*found.geometry).*figure.value, (*expected.geometry).*figure.value);
  figures.compare("insertions", record.insertions, made.insertions);
  figures.compare("ends", record.ends, made.ends);
}

}  // namespace lumen::convert
