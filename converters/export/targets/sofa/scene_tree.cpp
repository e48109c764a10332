// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/sofa/scene_tree.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/base/xml_text.h"
#include "converters/export/targets/sofa/scene_parts.h"

namespace lumen::convert {

std::string SceneItem::value(const std::string& name) const {
  const auto found = std::find_if(data.begin(), data.end(),
                                  [&](const SceneDatum& datum) { return datum.name == name; });
  return found == data.end() ? std::string() : found->value;
}

SceneItem& SceneItem::set(const std::string& name, const std::string& value) {
  data.push_back({name, value});
  return *this;
}

SceneItem& SceneItem::set(const std::string& name, double value) {
  return set(name, numberText(value));
}

SceneItem& SceneItem::set(const std::string& name, int value) {
  return set(name, std::to_string(value));
}

SceneItem& SceneItem::setFile(const std::string& name, const std::string& file) {
  data.push_back({name, file, true});
  return *this;
}

SceneItem& SceneItem::add(const std::string& component, const std::string& about) {
  return children.emplace_back(SceneItem{component, about});
}

SceneItem& SceneItem::addNode(const std::string& name, const std::string& about) {
  return add("Node", about).set("name", name);
}

std::string sceneNumbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) {
    if (!text.empty()) text += ' ';
    text += numberText(value);
  }
  return text;
}

namespace {

void xmlItem(const SceneItem& item, const std::string& indent, std::string& out) {
  if (!item.comment.empty()) out += indent + "<!-- " + xmlComment(item.comment) + " -->\n";
  out += indent + "<" + item.type;
  for (const SceneDatum& datum : item.data)
    out += " " + datum.name + "=\"" + xmlText(datum.value) + "\"";
  if (item.children.empty()) {
    out += "/>\n";
    return;
  }
  out += ">\n";
  for (const SceneItem& child : item.children) xmlItem(child, indent + "  ", out);
  out += indent + "</" + item.type + ">\n";
}

/// A literal of Python.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n')
      out += "\\n";
    else
      out += c;
  }
  return out + "\"";
}

std::string pythonValue(const SceneDatum& datum) {
  return datum.isFile ? "os.path.join(HERE, " + quoted(datum.value) + ")" : quoted(datum.value);
}

/// A number, or a list of several.
std::string numbers(const std::string& text) {
  if (text.find(' ') == std::string::npos) return text;
  std::string list = "[";
  for (const char c : text) list += c == ' ' ? std::string(", ") : std::string(1, c);
  return list + "]";
}

void pythonChildren(const SceneItem& node, const std::string& variable, std::string& out) {
  for (const SceneItem& item : node.children) {
    out += "\n";
    if (!item.comment.empty()) out += "    # " + item.comment + "\n";
    if (item.isNode()) {
      const std::string name = item.value("name");
      out += "    " + name + " = " + variable + ".addChild(" + quoted(name) + ")\n";
      pythonChildren(item, name, out);
      continue;
    }
    out += "    " + variable + ".addObject(" + quoted(item.type);
    for (const SceneDatum& datum : item.data)
      out += ",\n        " + datum.name + "=" + pythonValue(datum);
    out += ")\n";
  }
}

}  // namespace

std::string printXml(const SceneItem& root, const std::vector<std::string>& about) {
  std::string out = "<?xml version=\"1.0\"?>\n<!--\n";
  for (const std::string& line : about) out += "  " + xmlComment(line) + "\n";
  out += "-->\n";
  xmlItem(root, "", out);
  return out;
}

std::string printPython(const SceneItem& root, const std::vector<std::string>& about) {
  std::string out;
  for (const std::string& line : about) out += line.empty() ? "#\n" : "# " + line + "\n";
  out += "import os\n\nHERE = os.path.dirname(os.path.abspath(__file__))\n\n\n";
  out += "def createScene(root):\n";
  for (const SceneDatum& datum : root.data)
    if (datum.name != "name") out += "    root." + datum.name + " = " + numbers(datum.value) + "\n";
  pythonChildren(root, "root", out);
  return out + "    return root\n";
}

namespace {

// clang-format off
const std::map<std::string, std::string_view>& plugins() {
  static const std::map<std::string, std::string_view> table = {
      {"AdaptiveBeamForceFieldAndMass", "BeamAdapter"},
      {"AdaptiveBeamMapping", "BeamAdapter"},
      {"BTDLinearSolver", "Sofa.Component.LinearSolver.Direct"},
      {"BVHNarrowPhase", "Sofa.Component.Collision.Detection.Algorithm"},
      {"BeamAdapterActionController", "BeamAdapter"},
      {"BeamBlobContact", "LumenSofa"},
      {"BeamInterpolation", "BeamAdapter"},
      {"BlobField", "LumenSofa"},
      {"BlobMotion", "LumenSofa"},
      {"BlobPose", "LumenSofa"},
      {"BruteForceBroadPhase", "Sofa.Component.Collision.Detection.Algorithm"},
      {"CollisionPipeline", "Sofa.Component.Collision.Detection.Algorithm"},
      {"CollisionResponse", "Sofa.Component.Collision.Response.Contact"},
      {"DefaultContactManager", "Sofa.Component.Collision.Response.Contact"},
      {"DefaultPipeline", "Sofa.Component.Collision.Detection.Algorithm"},
      {"DefaultVisualManagerLoop", ""},
      {"DirectionalLight", "Sofa.GL.Component.Shader"},
      {"DiscreteGridField", "SofaImplicitField"},
      {"DiscreteIntersection", "Sofa.Component.Collision.Detection.Intersection"},
      {"Edge2QuadTopologicalMapping", "Sofa.Component.Topology.Mapping"},
      {"EdgeSetGeometryAlgorithms", "Sofa.Component.Topology.Container.Dynamic"},
      {"EdgeSetTopologyContainer", "Sofa.Component.Topology.Container.Dynamic"},
      {"EdgeSetTopologyModifier", "Sofa.Component.Topology.Container.Dynamic"},
      {"EulerImplicitSolver", "Sofa.Component.ODESolver.Backward"},
      {"FixedConstraint", "Sofa.Component.Constraint.Projective"},
      {"FixedProjectiveConstraint", "Sofa.Component.Constraint.Projective"},
      {"FreeMotionAnimationLoop", "Sofa.Component.AnimationLoop"},
      {"IdentityMapping", "Sofa.Component.Mapping.Linear"},
      {"InteractiveCamera", "Sofa.Component.Visual"},
      {"InterventionalRadiologyController", "BeamAdapter"},
      {"LCPConstraintSolver", "Sofa.Component.Constraint.Lagrangian.Solver"},
      {"LightManager", "Sofa.GL.Component.Shader"},
      {"LineCollisionModel", "Sofa.Component.Collision.Geometry"},
      {"LinearSolverConstraintCorrection", "Sofa.Component.Constraint.Lagrangian.Correction"},
      {"LocalMinDistance", "Sofa.Component.Collision.Detection.Intersection"},
      {"MechanicalObject", "Sofa.Component.StateContainer"},
      {"MeshOBJLoader", "Sofa.Component.IO.Mesh"},
      {"MeshTopology", "Sofa.Component.Topology.Container.Constant"},
      {"MultiAdaptiveBeamMapping", "BeamAdapter"},
      {"OglModel", "Sofa.GL.Component.Rendering3D"},
      {"PointCollisionModel", "Sofa.Component.Collision.Geometry"},
      {"QuadSetGeometryAlgorithms", "Sofa.Component.Topology.Container.Dynamic"},
      {"QuadSetTopologyContainer", "Sofa.Component.Topology.Container.Dynamic"},
      {"QuadSetTopologyModifier", "Sofa.Component.Topology.Container.Dynamic"},
      {"RegularGridTopology", "Sofa.Component.Topology.Container.Grid"},
      {"RestShapeSpringsForceField", "Sofa.Component.SolidMechanics.Spring"},
      {"RigidDistanceGridCollisionModel", "SofaDistanceGrid"},
      {"RodSpireSection", "BeamAdapter"},
      {"RodStraightSection", "BeamAdapter"},
      {"TriangleCollisionModel", "Sofa.Component.Collision.Geometry"},
      {"VisualStyle", "Sofa.Component.Visual"},
      {"WireBeamInterpolation", "BeamAdapter"},
      {"WireRestShape", "BeamAdapter"},
      {"WriteState", "Sofa.Component.Playback"},
  };
  return table;
}

constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kOldNames = {{
    {"CollisionPipeline", "DefaultPipeline"},
    {"CollisionResponse", "DefaultContactManager"},
    {"FixedProjectiveConstraint", "FixedConstraint"},
}};
// clang-format on

double numberOf(const SceneItem& item, const std::string& name) {
  const std::string value = item.value(name);
  return value.empty() ? 0 : std::stod(value);
}

/// The material and shape of a straight shaft and a curved tip, at the WireRestShape itself. The
/// lengths of a wire without a straight part, or of a tip without a curl, state that.
void stateAtRestShape(SceneItem& node) {
  std::vector<SceneItem> sections;
  for (const SceneItem& item : node.children)
    if (item.type == "RodStraightSection" || item.type == "RodSpireSection")
      sections.push_back(item);
  std::erase_if(node.children, [](const SceneItem& item) {
    return item.type == "RodStraightSection" || item.type == "RodSpireSection";
  });
  const auto shape =
      std::find_if(node.children.begin(), node.children.end(),
                   [](const SceneItem& item) { return item.type == "WireRestShape"; });
  if (sections.empty() || shape == node.children.end()) return;
  const SceneItem &shaft = sections.front(), &tip = sections.back();
  const double straight = numberOf(shaft, "length");
  const double whole = straight + (sections.size() > 1 ? numberOf(tip, "length") : 0);
  std::erase_if(shape->data, [](const SceneDatum& datum) { return datum.name == "wireMaterials"; });
  shape->comment =
      "lengths and radii in mm, moduli in kPa, densities in kg / mm^3; Extremity: of the tip";
  shape->set("length", whole)
      .set("straightLength", straight)
      .set("spireDiameter", std::max(numberOf(tip, "spireDiameter"), 1.0))
      .set("spireHeight", numberOf(tip, "spireHeight"))
      .set("youngModulus", shaft.value("youngModulus"))
      .set("youngModulusExtremity", tip.value("youngModulus"))
      .set("poissonRatio", shaft.value("poissonRatio"))
      .set("radius", shaft.value("radius"))
      .set("radiusExtremity", tip.value("radius"))
      .set("massDensity", shaft.value("massDensity"))
      .set("massDensityExtremity", tip.value("massDensity"))
      .set("keyPoints", sceneNumbers({0, straight, whole}))
      .set("densityOfBeams", shaft.value("nbBeams") + " " + tip.value("nbBeams"))
      .set("numEdgesCollis", shaft.value("nbBeams") + " " + tip.value("nbBeams"))
      .set("numEdges",
           static_cast<int>(numberOf(shaft, "nbEdgesVisu") + numberOf(tip, "nbEdgesVisu")));
}

void collectTypes(const SceneItem& item, std::set<std::string>& types) {
  if (!item.isNode()) types.insert(item.type);
  for (const SceneItem& child : item.children) collectTypes(child, types);
}

}  // namespace

void toV23_06(SceneItem& root) {
  for (const auto& [now, then] : kOldNames)
    if (root.type == now) root.type = then;
  stateAtRestShape(root);
  for (SceneItem& child : root.children) toV23_06(child);
}

std::string sofaPlugin(const std::string& type) {
  const auto found = plugins().find(type);
  if (found == plugins().end()) throw std::logic_error(type + " has no plugin");
  return std::string(found->second);
}

void addPlugins(SceneItem& root) {
  std::set<std::string> types, names;
  collectTypes(root, types);
  for (const std::string& type : types) names.insert(sofaPlugin(type));
  names.erase("");
  std::vector<SceneItem> items;
  for (const std::string& name : names) {
    SceneItem item{"RequiredPlugin", ""};
    item.set("pluginName", name);
    items.push_back(std::move(item));
  }
  root.children.insert(root.children.begin(), items.begin(), items.end());
}

}  // namespace lumen::convert
