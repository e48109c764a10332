// SPDX-License-Identifier: Apache-2.0
// record.h: the bytes of record.json, spelling of ids and paths, statements that a record needs.
#include <algorithm>
#include <string_view>

#include "converters/base/options/option_name.h"
#include "converters/base/text.h"
#include "converters/library/index/json_values.h"
#include "converters/library/index/record.h"
#include "converters/library/index/spdx.h"

namespace lumen::convert {

namespace {

using Json = nlohmann::ordered_json;

Json vectorJson(const Eigen::Vector3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Json anatomyJson(const CaseAbout& about) {
  Json codes = Json::array();
  for (const AnatomyCode& code : about.codes)
    codes.push_back({{"system", code.system}, {"code", code.code}, {"name", code.name}});
  return {{"text", about.anatomy}, {"codes", std::move(codes)}};
}

Json numberOrNull(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

Json figuresJson(const CaseFigures& figures) {
  Json error;
  if (figures.errorMedian && figures.errorP90)
    error = {{"median", *figures.errorMedian}, {"p90", *figures.errorP90}};
  Json json = {
      {"branches", figures.branches},
      {"aneurysms", figures.aneurysms},
      {"nodes", figures.nodes},
      {"length_mm", figures.length},
      {"radius_mm",
       {{"min", figures.radiusMin}, {"mean", figures.radiusMean}, {"max", figures.radiusMax}}},
      {"fit_error_mm", std::move(error)},
      {"reachable_mm", numberOrNull(figures.reachable)}};
  if (figures.geometry)
    for (const GeometryKey& figure : kGeometryKeys)
      json["geometry"][figure.key] = numberOrNull((*figures.geometry).*figure.value);
  if (!figures.systems.empty()) json["systems"] = figures.systems;
  return json;
}

Json placesJson(const std::vector<CasePlace>& places, bool areEnds) {
  Json all = Json::array();
  for (const CasePlace& place : places) {
    Json one = {{areEnds ? "name" : "label", place.name}};
    if (areEnds) one["kind"] = place.kind;
    one["position"] = vectorJson(place.position);
    one["direction"] = vectorJson(place.direction);
    one["radius"] = place.radius;
    all.push_back(std::move(one));
  }
  return all;
}

Json filesJson(const std::vector<RecordedFile>& files) {
  Json all = Json::array();
  for (const RecordedFile& file : files) {
    Json one = {{"path", file.path}, {"role", file.role}};
    if (!file.target.empty()) one["target"] = file.target;
    one["media"] = file.media;
    one["bytes"] = file.bytes;
    one["sha256"] = file.sha256;
    all.push_back(std::move(one));
  }
  return all;
}

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

nlohmann::ordered_json factsOfCase(const CaseRecord& record) {
  return {
      {"bounds", {{"min", vectorJson(record.boundsMin)}, {"max", vectorJson(record.boundsMax)}}},
      {"figures", figuresJson(record.figures)},
      {"insertions", placesJson(record.insertions, false)},
      {"ends", placesJson(record.ends, true)}};
}

std::string recordText(const CaseRecord& record) {
  const CaseAbout& about = record.about;
  Json json = {{"format", "lumen-library-case"},
               {"formatVersion", kLibraryFormat},
               {"id", record.id},
               {"version", record.version},
               {"date", record.date},
               {"title", about.title},
               {"description", about.description},
               {"anatomy", anatomyJson(about)},
               {"laterality", about.laterality},
               {"modality", about.modality},
               {"synthetic", about.synthetic},
               {"licence", about.licence},
               {"attribution", about.attribution},
               {"doi", about.doi},
               {"origin", about.origin},
               {"consent", about.consent},
               {"deidentification", about.deidentification},
               {"units", "mm"},
               {"frame", "LPS"}};
  json.update(factsOfCase(record));
  json["provenance"] = record.provenance;
  json["files"] = filesJson(record.files);
  return json.dump(1) + "\n";
}

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
