// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/sofa/scene_tree.h"

#include <algorithm>

#include "converters/base/number_text.h"
#include "converters/base/xml_text.h"

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

}  // namespace lumen::convert
