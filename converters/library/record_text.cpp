// SPDX-License-Identifier: Apache-2.0
// record.h: the bytes of record.json.
#include "converters/library/json_values.h"
#include "converters/library/record.h"

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

}  // namespace

std::string recordText(const CaseRecord& record) {
  const CaseAbout& about = record.about;
  const Json json = {
      {"format", "lumen-library-case"},
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
      {"frame", "LPS"},
      {"bounds", {{"min", vectorJson(record.boundsMin)}, {"max", vectorJson(record.boundsMax)}}},
      {"figures", figuresJson(record.figures)},
      {"insertions", placesJson(record.insertions, false)},
      {"ends", placesJson(record.ends, true)},
      {"provenance", record.provenance},
      {"files", filesJson(record.files)}};
  return json.dump(1) + "\n";
}

}  // namespace lumen::convert
