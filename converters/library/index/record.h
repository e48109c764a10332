// SPDX-License-Identifier: Apache-2.0
// Record of one case of a library: data/ID/record.json (spec/library.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "converters/base/error.h"

namespace lumen::convert {

/// A code of a terminology.
struct AnatomyCode {
  std::string system;  ///< "SNOMED CT" or "FMA"
  std::string code;    ///< digits
  std::string name;
  bool operator==(const AnatomyCode&) const = default;
};

/// "SNOMED CT:86117002:Internal carotid artery"; empty for a text without two colons.
AnatomyCode parseCode(const std::string& text);

/// Facts of a case that only people know. All texts are UTF-8 without control characters.
struct CaseAbout {
  std::string title, description;
  std::string anatomy;
  std::vector<AnatomyCode> codes;
  std::string laterality = "unknown";  ///< left, right, bilateral, midline, unknown
  std::string modality = "other";      ///< XA, CT, MR, US, mesh, synthetic, other
  bool synthetic = false;
  std::string licence;  ///< an SPDX expression
  std::string attribution, doi, origin, consent, deidentification;
  bool operator==(const CaseAbout&) const = default;
};

/// A statement that is any text, with its key in a record and its length in bytes.
struct AboutText {
  const char* key;
  std::string CaseAbout::*text;
  std::size_t most;
  std::size_t least = 0;
};
inline constexpr AboutText kAboutTexts[] = {
    {"title", &CaseAbout::title, 255, 1},
    {"description", &CaseAbout::description, 4096},
    {"licence", &CaseAbout::licence, 255},
    {"attribution", &CaseAbout::attribution, 1024},
    {"doi", &CaseAbout::doi, 1024},
    {"origin", &CaseAbout::origin, 1024},
    {"consent", &CaseAbout::consent, 4096},
    {"deidentification", &CaseAbout::deidentification, 4096}};

/// The extremes of what `lumen measure` finds in a case, by which people search; empty where no place
/// of the case has the measure. Definitions: docs/measures.md.
struct GeometryFigures {
  std::optional<double> tortuosity;     ///< greatest of a path from an inlet to an end
  std::optional<double> turning;        ///< greatest of a path, degrees per cm
  std::optional<double> takeOff;        ///< greatest of a path, degrees
  std::optional<double> stenosis;       ///< greatest NASCET degree of a narrowing, percent
  std::optional<double> aneurysmReach;  ///< of the aneurysm that reaches farthest from its neck, mm
  std::optional<double> aneurysmNeck;   ///< neck diameter of that aneurysm, mm
};

/// A figure with its key in a record.
struct GeometryKey {
  const char* key;
  std::optional<double> GeometryFigures::*value;
};
inline constexpr GeometryKey kGeometryKeys[] = {
    {"path_tortuosity", &GeometryFigures::tortuosity},
    {"path_turning_deg_per_cm", &GeometryFigures::turning},
    {"take_off_deg", &GeometryFigures::takeOff},
    {"nascet_percent", &GeometryFigures::stenosis},
    {"aneurysm_reach_mm", &GeometryFigures::aneurysmReach},
    {"aneurysm_neck_mm", &GeometryFigures::aneurysmNeck},
};

/// Facts of a case that lumen computes. Lengths: mm.
struct CaseFigures {
  std::size_t branches = 0, aneurysms = 0, nodes = 0;
  double length = 0;
  double radiusMin = 0, radiusMean = 0, radiusMax = 0;
  std::optional<double> errorMedian, errorP90;  ///< without models or points: none
  std::optional<double> reachable;              ///< without models: none
  std::optional<GeometryFigures> geometry;      ///< none in records of lumen before 0.2
  std::vector<std::string> systems;             ///< those of its branches; empty if it states none
};

/// A place where an instrument enters, or a vessel ends. mm, LPS.
struct CasePlace {
  std::string name;
  std::string kind;  ///< kind of an end: inlet or outlet
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  /// Unit vector; insertions: into, ends: out of the vessel.
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  double radius = 0;
};

struct RecordedFile {
  std::string path;    ///< relative to the folder of the record
  std::string role;    ///< case, surface, export, picture, report, other
  std::string target;  ///< target of an export
  std::string media;   ///< media type
  std::uint64_t bytes = 0;
  std::string sha256;
};

struct CaseRecord {
  std::string id;
  std::uint32_t version = 1;
  std::string date;  ///< YYYY-MM-DD: of the library's revision that brought this version
  CaseAbout about;
  Eigen::Vector3d boundsMin = Eigen::Vector3d::Zero(), boundsMax = Eigen::Vector3d::Zero();
  CaseFigures figures;
  std::vector<CasePlace> insertions, ends;
  nlohmann::ordered_json provenance;  ///< as spec/library.md has it
  std::vector<RecordedFile> files;    ///< sorted by path
};

/// The keys of record.json whose values follow from the case: bounds, figures, insertions, ends.
nlohmann::ordered_json factsOfCase(const CaseRecord& record);

/// The bytes of record.json. Equal records give equal bytes.
std::string recordText(const CaseRecord& record);

/// A path that spec/library.md does not allow: one that could leave the folder, or clash with
/// another.
class PathError : public Error {
public:
  explicit PathError(const std::string& what) : Error(ErrorKind::InvalidInput, what) {}
};

/// Throws Error(InvalidInput) with `file`, the place, what was found and what was expected;
/// PathError for a path. Checks those rules beyond the schema that concern files alone: exactly one
/// case, and sorted paths that all file systems keep apart. Entries of `files` in `passedOver` are
/// left out.
CaseRecord readRecord(const std::string& text, const std::filesystem::path& file,
                      const std::set<std::size_t>& passedOver = {});

/// The texts that may reveal whose case it is, with their places in the record. Credit, licence,
/// DOI and origin are meant to name people and places.
std::vector<std::pair<const char*, const std::string*>> textsToLookAt(const CaseAbout& about);

/// A missing fact without which such a record may exist but not be shared under the format's rules:
/// no licence, or no consent or de-identification of a patient. One sentence, or nothing.
std::string missingStatement(const CaseAbout& about);

/// Takes the keys of CaseAbout from an object of their own, such as people write for `lumen library
/// add --about`, or from a whole record.json; the members of missing keys are those of `known`.
/// Throws as readRecord().
CaseAbout readAbout(const std::string& text, const std::filesystem::path& file,
                    CaseAbout known = {});

/// Rules of spec/library.md for ids and paths, in words; isCaseId() and isRecordedPath() test them.
inline constexpr const char* kCaseIdRule =
    "1 to 64 of a to z, 0 to 9 and -, not beginning with - and no device of Windows such as con";
inline constexpr const char* kPathRule =
    "A to Z, a to z, 0 to 9, ., _, + and -, not beginning with . or -, not ending with ., and no "
    "device of Windows such as con";
bool isCaseId(const std::string& id);
bool isRecordedPath(const std::string& path);
/// A digital object identifier, or nothing.
bool isDoi(const std::string& text);

}  // namespace lumen::convert
