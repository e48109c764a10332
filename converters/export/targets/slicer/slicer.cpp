// SPDX-License-Identifier: Apache-2.0
// Tags and attributes as Slicer's nodes read them: vtkMRMLModelNode, vtkMRMLModelStorageNode,
// vtkMRMLMarkupsCurveNode, vtkMRMLMarkupsFiducialNode, vtkMRMLMarkupsJsonStorageNode,
// vtkMRMLMarkupsDisplayNode.
// Declared in targets.h.
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "converters/base/xml_text.h"
#include "converters/export/shared/paths.h"
#include "converters/export/shared/surface.h"
#include "converters/export/shared/text_files.h"
#include "converters/export/targets/targets.h"
#include "converters/io/centerline/write_centerline.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vertex_streams.h"
#include "converters/io/mesh/write_plain.h"
#include "formats/case/vessel_system.h"

namespace lumen::convert {

namespace {

using Json = nlohmann::ordered_json;

/// A node of the scene with where it is stored and how it is shown.
class SceneText {
public:
  void addModel(const std::string& name, const std::string& file, const std::string& color,
                bool isShown) {
    add("Model", name, file, R"( coordinateSystem="LPS")",
        " color=\"" + color + R"(" opacity="0.5" visibility=")" + (isShown ? "true" : "false") +
            R"(" backfaceCulling="0")");
  }
  void addCurve(const std::string& name, const std::string& file, const std::string& color) {
    add("MarkupsCurve", name, file, R"( coordinateSystem="LPS")",
        " color=\"" + color +
            R"(" visibility="true" pointLabelsVisibility="false" glyphScale="0.5")");
  }
  void addPoints(const std::string& name, const std::string& file, const std::string& color) {
    add("MarkupsFiducial", name, file, R"( coordinateSystem="LPS")",
        " color=\"" + color + R"(" visibility="true" pointLabelsVisibility="true")");
  }
  [[nodiscard]] std::string text() const {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<MRML version=\"Slicer4.4.0\" "
           "userTags=\"\">\n" +
           m_text + "</MRML>\n";
  }

private:
  /// Markups have one class of storage and one of display, models others.
  void add(const std::string& tag, const std::string& name, const std::string& file,
           const std::string& storage, const std::string& display) {
    const bool isModel = tag == "Model";
    const std::string kind = isModel ? "Model" : "Markups";
    const std::string stored = isModel ? "ModelStorage" : "MarkupsJsonStorage";
    const std::string number = std::to_string(++m_count);
    const std::string displayId = "vtkMRML" + kind + "DisplayNode" + number;
    const std::string storageId = "vtkMRML" + stored + "Node" + number;
    m_text += " <" + kind + "Display id=\"" + displayId + "\" name=\"display " + number + "\"" +
              display + "/>\n";
    m_text += " <" + stored + " id=\"" + storageId + "\" name=\"storage " + number +
              "\" fileName=\"" + xmlText(file) + "\"" + storage + "/>\n";
    m_text += " <" + tag + " id=\"vtkMRML" + tag + "Node" + number + "\" name=\"" + xmlText(name) +
              "\" displayNodeRef=\"" + displayId + "\" storageNodeRef=\"" + storageId +
              "\" references=\"display:" + displayId + ";storage:" + storageId +
              ";\" userTags=\"\"/>\n";
  }

  std::string m_text;
  std::size_t m_count = 0;
};

Json pointJson(std::size_t id, const std::string& label, const std::string& description,
               const Eigen::Vector3d& p) {
  return {{"id", std::to_string(id)},
          {"label", label},
          {"description", description},
          {"position", {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}},
          {"positionStatus", "defined"}};
}

std::string markupsText(const std::string& name, Json points) {
  const Json markup = {{"type", "Fiducial"},        {"name", name},
                       {"coordinateSystem", "LPS"}, {"coordinateUnits", "mm"},
                       {"labelFormat", "%N-%d"},    {"controlPoints", std::move(points)}};
  const Json file = {{"@schema", kMarkupsSchema}, {"markups", {markup}}};
  return file.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// A control point for the beginning of each branch, with the description that spec/seeds.md has
/// for facts that Slicer has no place for. A label with characters that end a word there is left
/// out as a parent: tracking finds it by place.
std::string seedsText(const formats::CenterlineTree& tree) {
  Json points = Json::array();
  for (const formats::Branch& branch : tree.branches) {
    if (branch.nodeCount == 0) continue;
    std::string description = "radius=" + numberText(tree.radius[branch.firstNode]);
    if (branch.kind == formats::BranchKind::Aneurysm) description += "; kind=aneurysm";
    if (branch.parentNode >= 0) {
      const auto parent = tree.branch[static_cast<std::size_t>(branch.parentNode)];
      const std::string& label = tree.branches[parent].label;
      if (label.find_first_of(";=\n\r") == std::string::npos) description += "; parent=" + label;
    }
    points.push_back(pointJson(points.size() + 1, branch.label, description,
                               toEigen(tree.centre[branch.firstNode])));
  }
  return markupsText("seeds", std::move(points));
}

std::string colorText(formats::VesselSystem system) {
  const auto [red, green, blue] = systemColor(system);
  return numberText(red, 3) + " " + numberText(green, 3) + " " + numberText(blue, 3);
}

/// The surface as a model; where it states systems of vessels, a model for each in its colour, and
/// the whole one is hidden.
std::vector<ExportFile> addModels(SceneText& scene, const SurfaceMesh& surface) {
  const std::vector<SystemPart> parts = splitBySystem(surface);
  scene.addModel("vessels", "vessels.vtp", "0.76 0.23 0.2", parts.empty());
  std::vector<ExportFile> files;
  for (const SystemPart& part : parts) {
    const std::string file = "vessels-" + part.name() + ".vtp";
    scene.addModel(part.name(), file, colorText(part.system), true);
    files.push_back({file, encodeVtp(part.surface),
                     "the part of the surface that is of the system " + part.name(), ""});
  }
  return files;
}

std::string endMarkups(const std::vector<NamedEnd>& ends) {
  Json points = Json::array();
  for (const NamedEnd& end : ends)
    points.push_back(pointJson(points.size() + 1, end.name,
                               "radius " + numberText(end.radius) + " mm", end.position));
  return markupsText("ends", std::move(points));
}

}  // namespace

ExportResult exportSlicer(const ExportInput& input) {
  const formats::CenterlineTree& tree = input.source.tree;
  ExportedSurface made = lumenSurface(input);
  ExportResult result;
  SceneText scene;
  std::vector<ExportFile> models = addModels(scene, made.mesh);
  const std::vector<formats::VesselSystem> systems = formats::knownBranchSystems(input.source);
  std::vector<ExportFile> curves;
  for (const BranchPath& path : branchPaths(tree)) {
    const formats::Branch& branch = tree.branches[path.branch];
    const std::string file = "centerlines/" + path.name + ".mrk.json";
    scene.addCurve(branch.label, file,
                   systems.empty() ? "1 0.85 0.2" : colorText(systems[path.branch]));
    curves.push_back({file, encodeCurve(tree, branch), "", ""});
  }
  scene.addPoints("seeds", "seeds.mrk.json", "0.3 0.8 0.3");
  scene.addPoints("ends", "ends.mrk.json", "0.3 0.6 1");
  result.files = {{"scene.mrml", scene.text(), "opens all of the others", ""},
                  {"vessels.vtp", encodeVtp(made.mesh),
                   "the closed surface of the vessels, with radii and faces by name", ""},
                  {"seeds.mrk.json", seedsText(tree),
                   "where each branch begins; `lumen track` takes it as seeds", ""},
                  {"ends.mrk.json", endMarkups(made.ends), "the named ends", ""}};
  for (std::vector<ExportFile>* more : {&models, &curves})
    std::move(more->begin(), more->end(), std::back_inserter(result.files));
  result.others.push_back(
      {"centerlines/*.mrk.json", "a curve for each branch, with the measurement Radius"});
  result.start = exportText("slicer/README.md");
  result.losses = treeLosses(tree, "a set of curves");
  result.ends = std::move(made.ends);
  result.surface = std::move(made.report);
  return result;
}

TargetRow slicerRow() {
  return {.name = "slicer",
          .title = "3D Slicer",
          .files = {"scene.mrml", "vessels.vtp", "seeds.mrk.json", "ends.mrk.json"},
          .units = {LengthUnit::Millimetre},
          .axes = {Axes::Lps},
          .holds = "the surface; the branches as curves with radii; where they begin; the ends",
          .lacks = "links that close loops, and that an aneurysm is one",
          .options = {"edge", "max-error", "triangles"}};
}

}  // namespace lumen::convert
