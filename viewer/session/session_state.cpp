// SPDX-License-Identifier: Apache-2.0
// Session: the state, as pages are told it.
#include <string_view>

#include "converters/engine/file_format.h"
#include "formats/case/enum_names.h"
#include "formats/container/printable.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

namespace {

Json orNull(const std::optional<std::string>& text) {
  return text ? Json(*text) : Json(nullptr);
}

Json seedsJson(const Document& document) {
  std::set<std::string_view> labels;
  if (document.value)
    for (const formats::Branch& branch : document.value->tree.branches) labels.insert(branch.label);
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
                    {"tracked", labels.contains(seed.label)}});
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
    for (const app::FileFormat& format : app::fileFormats())
      if (app::canWrite(format) && (!app::canWriteMesh(format) || document.hasModels() ||
                                    document.value->points.has_value()))
        list.push_back(format.name);
  if (!document.seeds->empty()) list.push_back("seeds");
  if (document.value || document.volume) list.push_back("html");
  return list;
}

std::string titleOf(const Document& document) {
  for (const FileRole role : {FileRole::Case, FileRole::Volume, FileRole::Mesh})
    if (const std::string label = document.labelOf(role); !label.empty()) return label;
  return "lumen";
}

}  // namespace

Json Session::state() {
  const Moment now = m_history.now();
  const Document& document = now.document;
  Json json;
  json["revision"] = now.revision;
  json["revisions"] = {{"case", now.parts.value},
                       {"surface", m_surfaces.revision()},
                       {"volume", now.parts.volume},
                       {"seeds", now.parts.seeds},
                       {"meshes", now.parts.meshes},
                       {"truth", now.parts.truth},
                       {"library", m_library ? m_library->readCount() + 1 : 0},
                       // of a surface and a truth
                       {"distance", m_surfaces.revision() + now.parts.truth}};
  json["title"] = titleOf(document);
  json["hasVolume"] = document.volume != nullptr;
  json["hasCase"] = document.value != nullptr;
  json["hasTruth"] = document.truth != nullptr;
  json["meshes"] = meshesJson(document);
  json["seeds"] = seedsJson(document);
  json["undo"] = orNull(m_history.undoName());
  json["redo"] = orNull(m_history.redoName());
  json["unsaved"] = unsaved();
  const auto running = m_jobs.running();
  json["job"] = running ? Json({{"job", running->job}, {"name", running->name}}) : Json(nullptr);
  json["formats"] = formatsJson(document);
  const std::lock_guard lock(m_mutex);
  json["files"] = filesJson(document, m_changedFiles);
  json["unsavedBefore"] = Json::array();
  for (const auto& file : m_leftBehind)
    json["unsavedBefore"].push_back(formats::printable(file.filename().string()));
  json["openCase"] = m_openCase ? Json(*m_openCase) : Json(nullptr);
  const auto target = saveTarget(document);
  json["saveAs"] = target.empty() ? Json(nullptr) : Json(target.filename().string());
  json["check"] = m_check;
  json["checkIsOld"] = m_check.is_object() && m_checkedCase != document.value;
  json["figures"] = m_comparedCase == document.value && m_comparedTruth == document.truth
                        ? m_figures
                        : Json(nullptr);
  return json;
}

}  // namespace lumen::viewer
