// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/write_centerline.h"

#include <cstdint>
#include <vector>

#include "converters/io/centerline/centerline_file.h"
#include "formats/json/json_writer.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

using formats::CenterlineTree;
using formats::shortText;

std::vector<std::uint32_t> childCounts(const CenterlineTree& tree) {
  std::vector<std::uint32_t> counts(tree.nodeCount(), 0);
  for (const std::int32_t parent : tree.parent)
    if (parent != formats::kNoParent) ++counts[static_cast<std::size_t>(parent)];
  return counts;
}

void appendPlace(std::string& text, const formats::Vec3f& p, float radius) {
  for (const float value : {p.x, p.y, p.z}) {
    text += shortText(value);
    text += ' ';
  }
  text += shortText(radius);
}

// A label on one line of text: case labels have no control characters.
void appendTube(std::string& text, const CenterlineTree& tree, std::size_t index) {
  const formats::Branch& branch = tree.branches[index];
  std::int64_t parent = -1, point = -1;
  if (branch.parentNode != formats::kNoParent) {
    parent = tree.branch[static_cast<std::size_t>(branch.parentNode)];
    point = branch.parentNode - std::int64_t{tree.branches[std::size_t(parent)].firstNode};
  }
  text += "ObjectType = Tube\nObjectSubType = Vessel\nNDims = 3\nID = " + std::to_string(index);
  text += "\nParentID = " + std::to_string(parent);
  text += "\nName = " + branch.label;
  text += "\nBinaryData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\n";
  text +=
      "CenterOfRotation = 0 0 0\nElementSpacing = 1 1 1\nParentPoint = " + std::to_string(point);
  text += std::string("\nRoot = ") + (parent < 0 ? "True" : "False");
  text += "\nArtery = True\nPointDim = x y z r t1x t1y t1z\nNPoints = ";
  text += std::to_string(branch.nodeCount) + "\nPoints = \n";
  for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n) {
    appendPlace(text, tree.centre[n], tree.radius[n]);
    for (const float value : {tree.direction[n].x, tree.direction[n].y, tree.direction[n].z})
      text += ' ' + shortText(value);
    text += '\n';
  }
}

struct ControlPoints {
  std::vector<formats::Vec3f> position;
  std::vector<float> radius;
};

ControlPoints chooseControlPoints(const CenterlineTree& tree, const formats::Branch& branch) {
  ControlPoints points;
  const auto add = [&](std::size_t place, std::size_t width) {
    points.position.push_back(tree.centre[place]);
    points.radius.push_back(tree.radius[width]);
  };
  if (branch.parentNode != formats::kNoParent)
    add(static_cast<std::size_t>(branch.parentNode), branch.firstNode);
  for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n) add(n, n);
  return points;
}

void writeCurve(formats::JsonWriter& json, const CenterlineTree& tree,
                const formats::Branch& branch) {
  const ControlPoints points = chooseControlPoints(tree, branch);
  json.beginObject();
  json.key("type");
  json.text("Curve");
  json.key("name");
  json.text(branch.label);
  json.key("coordinateSystem");
  json.text("LPS");
  json.key("coordinateUnits");
  json.text("mm");
  json.key("measurements");
  json.beginArray();
  json.beginObject();
  json.key("name");
  json.text("Radius");
  json.key("enabled");
  json.boolean(true);
  json.key("units");
  json.text("mm");
  json.key("controlPointValues");
  json.array(points.radius);
  json.end();
  json.end();
  json.key("controlPoints");
  json.beginArray();
  for (std::size_t i = 0; i < points.position.size(); ++i) {
    const formats::Vec3f& p = points.position[i];
    json.beginObject(true);
    json.key("id");
    json.text(std::to_string(i + 1));
    json.key("position");
    json.beginArray(true);
    for (const float value : {p.x, p.y, p.z}) json.real(value);
    json.end();
    json.key("positionStatus");
    json.text("defined");
    json.end();
  }
  json.end();
  json.end();
}

template <class Write>
std::string markupsFile(Write write) {
  formats::JsonWriter json(formats::JsonStyle::Readable);
  json.beginObject();
  json.key("@schema");
  json.text(kMarkupsSchema);
  json.key("markups");
  json.beginArray();
  write(json);
  json.end();
  json.end();
  return json.take() + '\n';
}

}  // namespace

std::string encodeSwc(const CenterlineTree& tree) {
  const std::vector<std::uint32_t> children = childCounts(tree);
  std::string text = std::string("# ") + kOwnCenterline + "\n# id type x y z radius parent\n";
  for (const formats::Branch& branch : tree.branches) {
    if (branch.nodeCount == 0) continue;
    text += "# vessel " + std::to_string(branch.firstNode + 1) + ' ';
    text += branch.label;
    text += '\n';
  }
  for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
    const int type = children[n] > 1 ? 5 : children[n] == 0 ? 6 : 0;
    text += std::to_string(n + 1) + ' ' + std::to_string(type) + ' ';
    appendPlace(text, tree.centre[n], tree.radius[n]);
    const std::int64_t parent = tree.parent[n];
    text += ' ' + std::to_string(parent == formats::kNoParent ? -1 : parent + 1) + '\n';
  }
  return text;
}

std::string encodeTre(const CenterlineTree& tree) {
  std::string text =
      std::string("ObjectType = Scene\nComment = ") + kOwnCenterline + "\nNDims = 3\nNObjects = ";
  text += std::to_string(tree.branches.size()) + '\n';
  for (std::size_t b = 0; b < tree.branches.size(); ++b) appendTube(text, tree, b);
  return text;
}

std::string encodeCurves(const CenterlineTree& tree) {
  return markupsFile([&tree](formats::JsonWriter& json) {
    for (const formats::Branch& branch : tree.branches)
      if (branch.nodeCount > 0) writeCurve(json, tree, branch);
  });
}

std::string encodeCurve(const CenterlineTree& tree, const formats::Branch& branch) {
  return markupsFile([&](formats::JsonWriter& json) { writeCurve(json, tree, branch); });
}

}  // namespace lumen::convert
