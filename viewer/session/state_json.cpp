// SPDX-License-Identifier: Apache-2.0
// session.h: the state as pages get it.
#include <set>
#include <string_view>

#include "converters/base/options/edit_steps.h"
#include "converters/engine/file_format.h"
#include "formats/case/enum_names.h"
#include "formats/container/printable.h"
#include "viewer/session/document/document_labels.h"
#include "viewer/session/document/document_seeds.h"
#include "viewer/session/proposals.h"
#include "viewer/session/session.h"
#include "viewer/session/source_match.h"

namespace lumen::viewer {

namespace {

Json orNull(const std::optional<std::string>& text) {
  return text ? Json(*text) : Json(nullptr);
}

Json seedsJson(const Document& document) {
  const auto labels = vesselLabels(document.value);
  Json list = Json::array();
  for (const convert::SeedBranch& seed : *document.seeds) {
    Json points = Json::array();
    for (const convert::SeedPoint& point : seed.points)
      points.push_back({{"position", engine::vectorJson(point.position)},
                        {"radius_mm", point.radius ? Json(*point.radius) : Json(nullptr)}});
    list.push_back({{"label", seed.label},
                    {"kind", formats::enumName(formats::kBranchKindNames, seed.kind)},
                    {"parent", orNull(seed.parent)},
                    {"points", std::move(points)},
                    {"tracked", isTracked(seed, labels)}});
  }
  return list;
}

Json filesJson(const Document& document, const std::set<int>& changed) {
  Json list = Json::array();
  for (const OpenFile& file : document.files)
    list.push_back({{"id", file.id},
                    {"kind", roleName(file.role)},
                    {"name", file.label},
                    {"changed", changed.contains(file.id)},
                    {"named", !file.path.empty()}});
  return list;
}

Json meshesJson(const Document& document) {
  Json list = Json::array();
  for (const OpenMesh& mesh : document.meshes)
    list.push_back({{"id", mesh.id}, {"name", mesh.label}});
  return list;
}

Json formatsJson(const Document& document) {
  Json list = Json::array();
  if (document.value)
    for (const engine::FileFormat& format : engine::fileFormats())
      if (engine::canWrite(format) && (!engine::needsModels(format) || document.hasModels() ||
                                       document.value->points.has_value()))
        list.push_back(format.name);
  if (document.value && (document.hasModels() || document.value->points))
    list.push_back("sofa.zip");
  if (!document.seeds->empty()) list.push_back("seeds");
  if (document.value || document.volume) list.push_back("html");
  return list;
}

Json secondJson(const Document& document) {
  if (!document.second) return nullptr;
  return {{"name", document.labelOf(FileRole::Second)}, {"doubt", orNull(secondDoubt(document))}};
}

std::string makeTitle(const Document& document) {
  for (const FileRole role : {FileRole::Case, FileRole::Volume, FileRole::Mesh})
    if (const std::string label = document.labelOf(role); !label.empty()) return label;
  return "lumen";
}

Json revisionsJson(const Session& session, const PartRevisions& parts) {
  const std::uint64_t surface = session.surfaces.revision();
  return {{"case", parts.value},
          {"surface", surface},
          {"volume", parts.volume},
          {"second", parts.second},
          {"labels", parts.labels},
          {"seeds", parts.seeds},
          {"proposals", parts.proposals},
          {"meshes", parts.meshes},
          {"truth", parts.truth},
          {"library", session.library.revision()},
          {"measures", session.findings.measuresRevision()},
          {"series", session.series.revision()},
          // of a surface and a truth
          {"distance", surface + parts.truth}};
}

/// Files of unsaved work; `target` is the one that is saved, or empty.
Json unsavedJson(const std::vector<std::filesystem::path>& files,
                 const std::filesystem::path& target) {
  constexpr std::int64_t kNanoseconds = 1000000;  // of a millisecond
  const std::int64_t saved = target.empty() ? 0 : readFileStamp(target).time;
  Json list = Json::array();
  for (const auto& file : files) {
    const std::int64_t written = readFileStamp(file).time;
    list.push_back({{"name", formats::printable(file.filename().string())},
                    {"written_ms", written / kNanoseconds},
                    {"newer", written > saved}});
  }
  return list;
}

}  // namespace

Json Session::state() const {
  const Moment now = history.now();
  const Document& document = now.document;
  Json json;
  json["revision"] = now.revision;
  json["revisions"] = revisionsJson(*this, now.parts);
  json["title"] = makeTitle(document);
  json["has_volume"] = document.volume != nullptr;
  json["has_case"] = document.value != nullptr;
  json["has_truth"] = document.truth != nullptr;
  json["assumptions"] = document.volume  ? document.volume->assumptions
                        : document.value ? recordedAssumptions(document.value->metadata)
                                         : std::vector<std::string>{};
  json["other_source"] = orNull(otherSource(document));
  json["second"] = secondJson(document);
  json["labels"] = labelsJson(document);
  json["meshes"] = meshesJson(document);
  json["seeds"] = seedsJson(document);
  json["proposals"] = proposalsJson(document);
  json["undo"] = orNull(history.undoName());
  json["redo"] = orNull(history.redoName());
  json["unsaved"] = saving.unsaved(document).any();
  const auto running = jobs.running();
  json["job"] = running ? Json({{"job", running->job}, {"name", running->name}}) : Json(nullptr);
  json["formats"] = formatsJson(document);
  json["files"] = filesJson(document, changedFiles.ids());
  const auto openCase = library.openCase();
  json["open_case"] = openCase ? Json(*openCase) : Json(nullptr);
  const auto target = saving.target(document);
  json["series"] = series.json();
  json["unsaved_before"] = unsavedJson(unsavedWork.found(), target);
  json["save_as"] = target.empty() ? Json(nullptr) : Json(target.filename().string());
  findings.addTo(json, document);
  const auto& look = options.look;
  json["look"] = look ? engine::vectorJson(*look) : Json(nullptr);
  const auto& time = options.time;
  json["time_s"] = time ? Json(*time) : Json(nullptr);
  json["measures_are_old"] = findings.areMeasuresOld(document);
  return json;
}

}  // namespace lumen::viewer
