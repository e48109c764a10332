// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/sofa_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/vtk/xml_events.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;

constexpr std::size_t kDeepest = 64;  // maximum nesting of nodes
constexpr std::size_t kMostListed = 20;

/// Transform that SOFA makes of translation, rotation and scale: first the scale, then the
/// rotations about x, y and z in this order (MeshLoader::reinit(); Quat::createQuaterFromEuler(),
/// whose default is ZYX), degrees.
struct Placement {
  Vector3d translation = Vector3d::Zero(), rotation = Vector3d::Zero(), scale = Vector3d::Ones();
  [[nodiscard]] Affine3d transform() const {
    const Vector3d angle = rotation * (std::numbers::pi / 180);
    return Eigen::Translation3d(translation) * Eigen::AngleAxisd(angle.z(), Vector3d::UnitZ()) *
           Eigen::AngleAxisd(angle.y(), Vector3d::UnitY()) *
           Eigen::AngleAxisd(angle.x(), Vector3d::UnitX()) * Eigen::Scaling(scale);
  }
};

/// An open <Node>.
struct OpenNode {
  std::string name;
  std::vector<std::size_t> loaders;   // the node's own
  std::optional<Affine3d> movedOnce;  // transform of its MechanicalObject
  bool isStill = false;
};

class SceneHandler : XmlEvents {
public:
  SceneHandler(std::string_view text, const std::string& name) : XmlEvents(text, name) {}

  std::vector<SofaLoader> parse() {
    run("; lumen reads scenes in XML (.scn)");
    return std::move(m_loaders);
  }

private:
  void begin(std::string_view tag, const char** attributes) override {
    if (tag == "Node") {
      if (m_nodes.size() == kDeepest) return refuse("has nodes more than 64 deep");
      m_nodes.push_back({std::string(attribute(attributes, "name")), {}, {}, false});
      return;
    }
    if (m_nodes.empty())
      return refuse("begins with " + quotedText(std::string(tag)) +
                    "; expected <Node>, with which a scene of SOFA begins");
    // older scenes write it as <Object type="MeshOBJLoader">
    const std::string component(tag == "Object" ? attribute(attributes, "type") : tag);
    if (component.starts_with("Mesh") && component.ends_with("Loader"))
      addLoader(component, attributes);
    else if (component == "MechanicalObject")
      addObject(attributes);
    else if (component.ends_with("CollisionModel") || component == "Triangle" ||
             component == "TriangleModel")
      m_nodes.back().isStill |= isFalse(attribute(attributes, "moving"));
  }

  void end(std::string_view tag) override {
    if (tag != "Node" || m_nodes.empty()) return;
    const OpenNode node = std::move(m_nodes.back());
    m_nodes.pop_back();
    for (const std::size_t i : node.loaders) {
      SofaLoader& loader = m_loaders[i];
      loader.isStill = node.isStill;
      if (!node.movedOnce || node.movedOnce->isApprox(Affine3d::Identity(), 0)) continue;
      loader.toScene = *node.movedOnce * loader.toScene;
      loader.isMovedTwice = true;
    }
    if (!m_nodes.empty()) m_nodes.back().isStill |= node.isStill;
  }

  void addLoader(const std::string& component, const char** attributes) {
    SofaLoader loader;
    loader.component = component;
    loader.name = attribute(attributes, "name");
    if (loader.name.empty()) loader.name = "loader";
    for (const OpenNode& node : m_nodes)
      loader.node += (loader.node.empty() ? "" : "/") + node.name;
    loader.filename = attribute(attributes, "filename");
    loader.line = line();
    Placement placement;
    read(attributes, "translation", placement.translation);
    read(attributes, "rotation", placement.rotation);
    read(attributes, "scale3d", placement.scale);
    placement.scale *= readScale(attributes);
    loader.toScene = placement.transform();
    if (const auto matrix = numbers(attributes, "transformation", 16)) {
      Eigen::Matrix4d rows;
      for (int i = 0; i < 16; ++i) rows(i / 4, i % 4) = (*matrix)[static_cast<std::size_t>(i)];
      if (rows != Eigen::Matrix4d::Identity()) loader.toScene = Affine3d(rows);
    }
    m_nodes.back().loaders.push_back(m_loaders.size());
    m_loaders.push_back(std::move(loader));
  }

  /// Adds a MechanicalObject. Points of its own replace the mesh's; a single point (its default)
  /// does not count.
  void addObject(const char** attributes) {
    const std::string_view position = attribute(attributes, "position");
    const bool isLink = position.starts_with('@');
    if (!isLink && words(position).size() > 3) return;
    Placement first, second;
    read(attributes, "translation", first.translation);
    read(attributes, "rotation", first.rotation);
    read(attributes, "scale3d", first.scale);
    if (!attribute(attributes, "scale").empty()) first.scale.setConstant(readScale(attributes));
    readAxes(attributes, {"sx", "sy", "sz"}, 1, first.scale);
    readAxes(attributes, {"rx", "ry", "rz"}, 0, first.rotation);
    readAxes(attributes, {"dx", "dy", "dz"}, 0, first.translation);
    read(attributes, "translation2", second.translation);
    read(attributes, "rotation2", second.rotation);
    readAxes(attributes, {"rx2", "ry2", "rz2"}, 0, second.rotation);
    readAxes(attributes, {"dx2", "dy2", "dz2"}, 0, second.translation);
    m_nodes.back().movedOnce = second.transform() * first.transform();
  }

  void read(const char** attributes, const char* name, Vector3d& value) {
    if (const auto three = numbers(attributes, name, 3))
      value = Vector3d((*three)[0], (*three)[1], (*three)[2]);
  }

  double readScale(const char** attributes) {
    const auto one = numbers(attributes, "scale", 1);
    return one ? (*one)[0] : 1.0;
  }

  /// Reads three attributes into `value`; if any is present, missing ones become `none`.
  void readAxes(const char** attributes, const std::array<const char*, 3>& names, double none,
                Vector3d& value) {
    const auto isThere = [&](const char* name) { return !attribute(attributes, name).empty(); };
    if (std::none_of(names.begin(), names.end(), isThere)) return;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto one = numbers(attributes, names[a], 1);
      value[static_cast<Eigen::Index>(a)] = one ? (*one)[0] : none;
    }
  }

  std::optional<std::vector<double>> numbers(const char** attributes, const char* name,
                                             std::size_t count) {
    const std::string_view text = attribute(attributes, name);
    if (text.empty()) return {};
    std::vector<double> values;
    for (const std::string_view word : words(text)) {
      const auto value = parsedNumber(word);
      if (!value || !(std::abs(*value) < 1e12)) break;
      values.push_back(*value);
    }
    if (values.size() == count && words(text).size() == count) return values;
    refuse(std::string("has the ") + name + " " + quotedText(std::string(text)) + "; expected " +
           (count == 1 ? "a number" : std::to_string(count) + " numbers"));
    return {};
  }

  static std::vector<std::string_view> words(std::string_view text) {
    std::vector<std::string_view> out;
    for (std::size_t at = 0; (at = text.find_first_not_of(" \t\r\n", at)) != text.npos;) {
      const std::size_t to = std::min(text.find_first_of(" \t\r\n", at), text.size());
      out.push_back(text.substr(at, to - at));
      at = to;
    }
    return out;
  }

  static bool isFalse(std::string_view text) {
    return text == "0" || lowerCase(std::string(text)) == "false";
  }

  std::vector<OpenNode> m_nodes;
  std::vector<SofaLoader> m_loaders;
};

using Loaders = std::vector<const SofaLoader*>;

template <class Test>
Loaders those(const std::vector<SofaLoader>& loaders, Test&& test) {
  Loaders out;
  for (const SofaLoader& loader : loaders)
    if (test(loader)) out.push_back(&loader);
  return out;
}

std::string lastName(const std::string& node) {
  return node.substr(node.rfind('/') == node.npos ? 0 : node.rfind('/') + 1);
}

std::string listOf(const Loaders& loaders) {
  std::string text;
  for (std::size_t i = 0; i < std::min(loaders.size(), kMostListed); ++i) {
    text.append(i == 0 ? "" : ", ").append(formats::printable(loaders[i]->name));
    text.append(" in ").append(formats::printable(loaders[i]->node));
    text.append(" (").append(formats::printable(loaders[i]->filename)).append(")");
  }
  return loaders.size() > kMostListed ? text + " and so on" : text;
}

Loaders chosen(const std::vector<SofaLoader>& loaders, const std::string& wanted) {
  if (!wanted.empty()) {
    const Loaders whole = those(loaders, [&](const SofaLoader& loader) {
      return loader.node == wanted || loader.node + "/" + loader.name == wanted;
    });
    if (!whole.empty()) return whole;
    return those(loaders, [&](const SofaLoader& loader) {
      return loader.name == wanted || lastName(loader.node) == wanted;
    });
  }
  if (loaders.size() == 1) return {loaders.data()};
  Loaders out = those(loaders, [](const SofaLoader& loader) {
    return lowerCase(lastName(loader.node)).find("vessel") != std::string::npos;
  });
  if (out.empty()) out = those(loaders, [](const SofaLoader& loader) { return loader.isStill; });
  return out;
}

}  // namespace

std::vector<SofaLoader> sofaLoaders(std::string_view text, const std::string& name) {
  return SceneHandler(text, name).parse();
}

const SofaLoader& vesselLoader(const std::vector<SofaLoader>& loaders, const std::string& wanted,
                               const std::string& name) {
  if (loaders.empty())
    throw invalidInput(name + ": loads no mesh; expected a MeshOBJLoader or a MeshSTLLoader");
  const Loaders found = chosen(loaders, wanted);
  const Loaders all = those(loaders, [](const SofaLoader&) { return true; });
  if (found.empty() && !wanted.empty())
    throw invalidInput(name + ": loads no mesh called \"" + formats::printable(wanted) +
                       "\"; it loads " + listOf(all));
  if (found.size() != 1)
    throw invalidInput(name + ": it is not clear which of its meshes are the vessels: " +
                       listOf(found.empty() ? all : found) +
                       "; expected mesh to name one, by its loader or its node");
  const SofaLoader& loader = *found.front();
  const std::string kind = lowerCase(loader.component);
  const std::string place = name + ": line " + std::to_string(loader.line) + ": ";
  if (kind != "meshobjloader" && kind != "meshstlloader")
    throw unsupported(place + "the vessels are loaded by " + formats::printable(loader.component) +
                      "; lumen reads MeshOBJLoader and MeshSTLLoader");
  if (loader.filename.empty() || loader.filename.starts_with('@'))
    throw unsupported(place + "this loader names no file, but \"" +
                      formats::printable(loader.filename) + "\"; expected a filename");
  return loader;
}

}  // namespace lumen::convert
