// SPDX-License-Identifier: Apache-2.0
// record.h: reading record.json, and the statements of people about a case.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string_view>
#include <vector>

#include "converters/base/text.h"
#include "converters/library/index/json_values.h"
#include "converters/library/index/library_file.h"
#include "converters/library/index/record.h"

namespace lumen::convert {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostCodes = 64, kMostSteps = 1024, kMostParameters = 4096;

AnatomyCode readCode(const JsonPlace& place) {
  place.onlyKeys({"system", "code", "name"});
  AnatomyCode code;
  code.system = readWord(place.at("system"), {"SNOMED CT", "FMA"});
  code.code = plainText(place.at("code"), 18, 1);
  if (code.code.find_first_not_of("0123456789") != std::string::npos)
    place.at("code").refuse("1 to 18 digits");
  code.name = plainText(place.at("name"), 255);
  return code;
}

void readAnatomy(const JsonPlace& place, CaseAbout& about) {
  place.onlyKeys({"text", "codes"});
  about.anatomy = plainText(place.at("text"), 255);
  const auto codes = place.at("codes").elements();
  about.codes.clear();
  if (codes.size() > kMostCodes) place.at("codes").refuse("at most 64 codes");
  for (const JsonPlace& code : codes) about.codes.push_back(readCode(code));
}

/// Statements of an object; those of missing keys stay, unless all must be there.
void readStatements(const JsonPlace& root, bool isWhole, CaseAbout& about) {
  const auto has = [&](const char* key) { return isWhole || root.has(key); };
  for (const AboutText& one : kAboutTexts)
    if (has(one.key)) about.*one.text = plainText(root.at(one.key), one.most, one.least);
  if (has("doi") && !isDoi(about.doi))
    root.at("doi").refuse("a DOI such as \"10.5281/zenodo.1234\", or nothing");
  if (has("anatomy")) readAnatomy(root.at("anatomy"), about);
  if (has("laterality"))
    about.laterality =
        readWord(root.at("laterality"), {"left", "right", "bilateral", "midline", "unknown"});
  if (has("modality"))
    about.modality =
        readWord(root.at("modality"), {"XA", "CT", "MR", "US", "mesh", "synthetic", "other"});
  if (has("synthetic")) about.synthetic = root.at("synthetic").boolean();
}

Eigen::Vector3d unitVector(const JsonPlace& place) {
  const Eigen::Vector3d v = place.vector();
  if (std::abs(v.norm() - 1) > 1e-3) place.refuse("a vector of length 1");
  return v;
}

CasePlace readPlace(const JsonPlace& place, bool isEnd) {
  CasePlace result;
  if (isEnd) {
    place.onlyKeys({"name", "kind", "position", "direction", "radius"});
    result.name = plainText(place.at("name"), 300, 1);
    result.kind = readWord(place.at("kind"), {"inlet", "outlet"});
  } else {
    place.onlyKeys({"label", "position", "direction", "radius"});
    result.name = plainText(place.at("label"), 255, 1);
  }
  result.position = place.at("position").vector();
  result.direction = unitVector(place.at("direction"));
  result.radius = positive(place.at("radius"));
  return result;
}

GeometryFigures readGeometry(const JsonPlace& place) {
  place.onlyKeys({"path_tortuosity", "path_turning_deg_per_cm", "take_off_deg", "nascet_percent",
                  "aneurysm_reach_mm", "aneurysm_neck_mm"});
  GeometryFigures geometry;
  for (const GeometryKey& figure : kGeometryKeys) {
    const JsonPlace value = place.at(figure.key);
    if (!value.value().isNull()) geometry.*figure.value = notNegative(value);
  }
  return geometry;
}

CaseFigures readFigures(const JsonPlace& place) {
  place.onlyKeys({"branches", "aneurysms", "nodes", "length_mm", "radius_mm", "fit_error_mm",
                  "reachable_mm", "geometry", "systems"});
  CaseFigures figures;
  figures.branches = wholeNumber(place.at("branches"));
  figures.aneurysms = wholeNumber(place.at("aneurysms"));
  figures.nodes = wholeNumber(place.at("nodes"));
  figures.length = notNegative(place.at("length_mm"));
  const JsonPlace radius = place.at("radius_mm"), error = place.at("fit_error_mm"),
                  reachable = place.at("reachable_mm");
  radius.onlyKeys({"min", "mean", "max"});
  figures.radiusMin = notNegative(radius.at("min"));
  figures.radiusMean = notNegative(radius.at("mean"));
  figures.radiusMax = notNegative(radius.at("max"));
  if (!error.value().isNull()) {
    error.onlyKeys({"median", "p90"});
    figures.errorMedian = notNegative(error.at("median"));
    figures.errorP90 = notNegative(error.at("p90"));
  }
  if (!reachable.value().isNull()) figures.reachable = notNegative(reachable);
  if (place.has("geometry")) figures.geometry = readGeometry(place.at("geometry"));
  if (place.has("systems"))
    for (const JsonPlace& one : place.at("systems").elements())
      figures.systems.push_back(
          readWord(one, {"unknown", "artery", "vein", "true-lumen", "false-lumen"}));
  return figures;
}

Json readParameter(const JsonPlace& place) {
  const formats::JsonValue& value = place.value();
  if (const auto truth = value.boolean()) return *truth;
  if (value.text() != nullptr) return plainText(place, 65535);
  if (const auto number = value.number()) {
    if (number->isWhole()) {
      if (const auto whole = number->asInteger<std::int64_t>()) return *whole;
    } else if (const auto real = number->asDouble()) {
      return *real;
    }
  }
  place.refuse("true, false, a number or a text");
}

/// A step as the metadata of a case has it: name, tool, parameters, and keys with x-, which are not
/// kept.
Json readStep(const JsonPlace& place) {
  const JsonPlace parameters = place.at("parameters");
  Json step = {{"name", plainText(place.at("name"), 255, 1)},
               {"tool", plainText(place.at("tool"), 255, 1)},
               {"parameters", Json::object()}};
  for (const auto& [key, value] : place.value().members())
    if (key != "name" && key != "tool" && key != "parameters" && !key.starts_with("x-"))
      place.refuse("an object with name, tool and parameters");
  const auto members = parameters.value().members();
  if (!parameters.value().isObject() || members.size() > kMostParameters)
    parameters.refuse("an object of at most 4096 entries");
  for (const auto& [key, value] : members)
    step["parameters"][std::string(key)] = readParameter(parameters.at(key));
  return step;
}

Json readProvenance(const JsonPlace& place) {
  place.onlyKeys({"case_sha256", "generator", "source", "steps", "recipe_sha256"});
  Json source;
  if (const JsonPlace given = place.at("source"); !given.value().isNull()) {
    given.onlyKeys({"sha256"});
    source = {{"sha256", digest(given.at("sha256"))}};
  }
  const std::string generator = plainText(place.at("generator"), 255);
  if (!generator.starts_with("lumen ")) place.at("generator").refuse("\"lumen \" and a version");
  Json steps = Json::array();
  const auto given = place.at("steps").elements();
  if (given.size() > kMostSteps) place.at("steps").refuse("at most 1024 steps");
  for (const JsonPlace& step : given) steps.push_back(readStep(step));
  Json provenance = {{"case_sha256", digest(place.at("case_sha256"))},
                     {"generator", generator},
                     {"source", std::move(source)},
                     {"steps", std::move(steps)}};
  if (place.has("recipe_sha256")) provenance["recipe_sha256"] = digest(place.at("recipe_sha256"));
  return provenance;
}

bool isWord(const std::string& text, const char* extra) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
           std::string_view(extra).find(c) != std::string_view::npos;
  });
}

std::string readMedia(const JsonPlace& place) {
  const std::string text = plainText(place, 255, 3);
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos || !isWord(text.substr(0, slash), ".+-") ||
      !isWord(lowerCase(text.substr(slash + 1)), ".+-"))
    place.refuse("a media type such as \"image/png\"");
  return text;
}

[[noreturn]] void refusePath(const JsonPlace& place, const std::string& expected) {
  try {
    place.refuse(expected);
  } catch (const Error& error) {
    throw PathError(error.what());
  }
}

RecordedFile readFile(const JsonPlace& place) {
  place.onlyKeys({"path", "role", "target", "media", "bytes", "sha256"});
  RecordedFile file;
  file.path = place.at("path").text();
  if (!isRecordedPath(file.path))
    refusePath(place.at("path"),
               std::string("a path relative to the folder of the case, its parts of ") + kPathRule);
  file.role =
      readWord(place.at("role"), {"case", "surface", "export", "picture", "report", "other"});
  if (place.has("target") != (file.role == "export"))
    place.refuse("a target for an export, and for nothing else");
  if (place.has("target")) file.target = place.at("target").text();
  if (place.has("target") && (!isWord(file.target, "-") || file.target.size() > 32))
    place.at("target").refuse("the name of a target of lumen export");
  file.media = readMedia(place.at("media"));
  file.bytes = wholeNumber(place.at("bytes"));
  file.sha256 = digest(place.at("sha256"));
  return file;
}

/// Sorted, so that each is once there; apart on file systems that know no case; one case.
void checkFiles(const JsonPlace& all, const std::vector<JsonPlace>& places,
                const std::vector<RecordedFile>& files) {
  std::set<std::string> names = {kRecordFile, kCrateFile}, folders;
  std::size_t cases = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string path = lowerCase(files[i].path);
    if (i > 0 && files[i - 1].path >= files[i].path) all.refuse("files sorted by path");
    bool clashes = !names.insert(path).second || folders.contains(path);
    for (std::size_t slash = path.find('/'); slash != std::string::npos;
         slash = path.find('/', slash + 1)) {
      folders.insert(path.substr(0, slash));
      clashes = clashes || names.contains(path.substr(0, slash));
    }
    if (clashes)
      refusePath(places[i].at("path"),
                 "a path that differs from all others, from their folders and from the files that "
                 "lumen writes in more than upper and lower case");
    if (files[i].role == "case" && (++cases, files[i].path != kCaseFile))
      places[i].refuse("the role \"case\" for case.lumen alone");
  }
  if (cases != 1) all.refuse("exactly one file of the role \"case\", which is case.lumen");
}

}  // namespace

AnatomyCode parseCode(const std::string& text) {
  const std::size_t first = text.find(':');
  const std::size_t second = first == std::string::npos ? first : text.find(':', first + 1);
  if (second == std::string::npos) return {};
  return {text.substr(0, first), text.substr(first + 1, second - first - 1),
          text.substr(second + 1)};
}

CaseRecord readRecord(const std::string& text, const std::filesystem::path& file,
                      const std::set<std::size_t>& passedOver) {
  JsonFile document(text, file);
  const JsonPlace root(document);
  requireFormat(root, "lumen-library-case");
  root.onlyKeys({"format",    "formatVersion",    "id",          "version",    "date",
                 "title",     "description",      "anatomy",     "laterality", "modality",
                 "synthetic", "licence",          "attribution", "doi",        "origin",
                 "consent",   "deidentification", "units",       "frame",      "bounds",
                 "figures",   "insertions",       "ends",        "provenance", "files"});
  CaseRecord record;
  record.id = caseId(root.at("id"));
  record.version = static_cast<std::uint32_t>(wholeNumber(root.at("version"), 1, UINT32_MAX));
  record.date = day(root.at("date"));
  readStatements(root, true, record.about);
  readWord(root.at("units"), {"mm"});
  readWord(root.at("frame"), {"LPS"});
  root.at("bounds").onlyKeys({"min", "max"});
  record.boundsMin = root.at("bounds").at("min").vector();
  record.boundsMax = root.at("bounds").at("max").vector();
  record.figures = readFigures(root.at("figures"));
  for (const JsonPlace& place : root.at("insertions").elements())
    record.insertions.push_back(readPlace(place, false));
  for (const JsonPlace& place : root.at("ends").elements())
    record.ends.push_back(readPlace(place, true));
  record.provenance = readProvenance(root.at("provenance"));
  const auto all = root.at("files").elements();
  std::vector<JsonPlace> places;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!passedOver.contains(i)) places.push_back(all[i]);
  for (const JsonPlace& place : places) record.files.push_back(readFile(place));
  checkFiles(root.at("files"), places, record.files);
  return record;
}

CaseAbout readAbout(const std::string& text, const std::filesystem::path& file, CaseAbout known) {
  JsonFile document(text, file);
  const JsonPlace root(document);
  if (root.has("format")) return readRecord(text, file).about;
  root.onlyKeys({"title", "description", "anatomy", "laterality", "modality", "synthetic",
                 "licence", "attribution", "doi", "origin", "consent", "deidentification"});
  readStatements(root, false, known);
  return known;
}

}  // namespace lumen::convert
