// SPDX-License-Identifier: Apache-2.0
// A scene of SOFA as a tree: the one description that scene.scn and scene.py are printed from.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace lumen::convert {

/// A datum of a component or node.
struct SceneDatum {
  std::string name, value;
  bool isFile = false;  ///< a file beside the scene
};

/// A node, or a component of one.
struct SceneItem {
  std::string type;     ///< a component's class; "Node" for a node
  std::string comment;  ///< its purpose, with units; may be empty
  std::vector<SceneDatum> data{};
  std::vector<SceneItem> children{};  ///< children of a node, in the order of their creation

  [[nodiscard]] bool isNode() const { return type == "Node"; }
  /// The value of a datum; empty if it is not there.
  [[nodiscard]] std::string value(const std::string& name) const;
  /// Adds a datum; returns the item itself.
  SceneItem& set(const std::string& name, const std::string& value);
  SceneItem& set(const std::string& name, double value);
  SceneItem& set(const std::string& name, int value);
  SceneItem& setFile(const std::string& name, const std::string& file);
  /// Adds a component, or a node, which stays valid until the next is added.
  SceneItem& add(const std::string& component, const std::string& about = {});
  SceneItem& addNode(const std::string& name, const std::string& about = {});
};

/// Numbers with spaces between them.
std::string sceneNumbers(const std::vector<double>& values);

/// The scene as XML, which runSofa reads. `about`: lines of the comment at its head.
std::string printXml(const SceneItem& root, const std::vector<std::string>& about);

/// The scene in Python, for SofaPython3: a module with createScene(root).
std::string printPython(const SceneItem& root, const std::vector<std::string>& about);

// Differences between versions of SOFA, and the plugins of its components.

/// Rewrites a scene for SOFA v23.06, which stEVE uses: components have their old names, and a
/// wire's material is stated at its WireRestShape.
void toV23_06(SceneItem& root);

/// The plugin of a component; empty for those of the core. A component that is not in the table is
/// a mistake of this library.
std::string sofaPlugin(const std::string& type);

}  // namespace lumen::convert
