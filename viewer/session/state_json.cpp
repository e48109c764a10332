// SPDX-License-Identifier: Apache-2.0
// workspace.h: the state as pages get it.
#include <set>
#include <string_view>

#include "converters/base/options/edit_steps.h"
#include "converters/engine/file_format.h"
#include "formats/case/enum_names.h"
#include "formats/container/printable.h"
#include "viewer/session/document/document_seeds.h"
#include "viewer/session/proposals.h"
#include "viewer/session/source_match.h"
#include "viewer/session/workspace.h"

namespace lumen::viewer {

namespace {

Json orNull(const std::optional<std::string>& text) {
  return text ? Json(*text) : Json(nullptr);
}

Json seedsJson(const Document& document) {
  const auto labels = vesselLabels(document);
  Json list = Json::array();
  for (const convert::SeedBranch& seed : *document.seeds) {
    Json points = Json::array();
    for (const convert::SeedPoint& point : seed.points)
      points.push_back({{"position", {point.position.x(), point.position.y(), point.position.z()}},
                        {"radius", point.radius ? Json(*point.radius) : Json(nullptr)}});
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
      if (engine::canWrite(format) && (!engine::canWriteMesh(format) || document.hasModels() ||
                                       document.value->points.has_value()))
        list.push_back(format.name);
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

Json revisionsJson(const Workspace& workspace, const PartRevisions& parts) {
  const std::uint64_t surface = workspace.surfaces.revision();
  return {{"case", parts.value},
          {"surface", surface},
          {"volume", parts.volume},
          {"second", parts.second},
          {"seeds", parts.seeds},
          {"proposals", parts.proposals},
          {"meshes", parts.meshes},
          {"truth", parts.truth},
          {"library", workspace.library.revision()},
          {"measures", workspace.findings.measuresRevision()},
          {"series", workspace.series.revision()},
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
                    {"written", written / kNanoseconds},
                    {"newer", written > saved}});
  }
  return list;
}

}  // namespace

Json Workspace::state() const {
  const Workspace& workspace = *this;
  const Moment now = workspace.history.now();
  const Document& document = now.document;
  Json json;
  json["revision"] = now.revision;
  json["revisions"] = revisionsJson(workspace, now.parts);
  json["title"] = makeTitle(document);
  json["hasVolume"] = document.volume != nullptr;
  json["hasCase"] = document.value != nullptr;
  json["hasTruth"] = document.truth != nullptr;
  json["assumptions"] = document.volume  ? document.volume->assumptions
                        : document.value ? recordedAssumptions(document.value->metadata)
                                         : std::vector<std::string>{};
  json["otherSource"] = orNull(otherSource(document));
  json["second"] = secondJson(document);
  json["meshes"] = meshesJson(document);
  json["seeds"] = seedsJson(document);
  json["proposals"] = proposalsJson(document);
  json["undo"] = orNull(workspace.history.undoName());
  json["redo"] = orNull(workspace.history.redoName());
  json["unsaved"] = workspace.saving.unsaved(document).any();
  const auto running = workspace.jobs.running();
  json["job"] = running ? Json({{"job", running->job}, {"name", running->name}}) : Json(nullptr);
  json["formats"] = formatsJson(document);
  json["files"] = filesJson(document, workspace.changedFiles.ids());
  const auto openCase = workspace.library.openCase();
  json["openCase"] = openCase ? Json(*openCase) : Json(nullptr);
  const auto target = workspace.saving.target(document);
  json["series"] = workspace.series.json();
  json["unsavedBefore"] = unsavedJson(workspace.unsavedWork.found(), target);
  json["saveAs"] = target.empty() ? Json(nullptr) : Json(target.filename().string());
  json["check"] = workspace.findings.check();
  json["work"] = workspace.findings.work(document);
  json["checkIsOld"] = workspace.findings.isCheckOld(document);
  json["figures"] = workspace.findings.figures(document);
  const auto& look = workspace.options.look;
  json["look"] = look ? Json({look->x(), look->y(), look->z()}) : Json(nullptr);
  const auto& time = workspace.options.time;
  json["time"] = time ? Json(*time) : Json(nullptr);
  json["measuresAreOld"] = workspace.findings.areMeasuresOld(document);
  return json;
}

}  // namespace lumen::viewer
