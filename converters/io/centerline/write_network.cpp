// SPDX-License-Identifier: Apache-2.0
// The tree of a case as a network; declared in write_centerline.h.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "converters/io/centerline/centerline_file.h"
#include "converters/io/centerline/write_centerline.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

using formats::CenterlineTree;
using formats::shortText;
using Strand = std::vector<std::uint32_t>;

// Nodes of the pieces between roots, forks, tips and the ends of links; a link is a piece of two.
std::vector<Strand> strandsOf(const CenterlineTree& tree) {
  std::vector<std::uint32_t> children(tree.nodeCount(), 0);
  for (const std::int32_t parent : tree.parent)
    if (parent != formats::kNoParent) ++children[static_cast<std::size_t>(parent)];
  std::vector<bool> isEnd(tree.nodeCount(), false);
  for (std::size_t n = 0; n < tree.nodeCount(); ++n) isEnd[n] = children[n] != 1;
  for (const auto& link : tree.links)
    for (const std::uint32_t node : link) isEnd[node] = true;
  std::vector<Strand> strands;
  for (const formats::Branch& branch : tree.branches) {
    Strand strand;
    if (branch.parentNode != formats::kNoParent)
      strand.push_back(static_cast<std::uint32_t>(branch.parentNode));
    for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n) {
      strand.push_back(n);
      if (!isEnd[n] || strand.size() == 1) continue;
      strands.push_back(strand);
      strand = {n};
    }
    if (strand.size() > 1) strands.push_back(strand);
  }
  for (const auto& link : tree.links) strands.push_back({link[0], link[1]});
  return strands;
}

std::string placeOfNode(const CenterlineTree& tree, std::size_t node, const char* between) {
  const formats::Vec3f& p = tree.centre[node];
  return shortText(p.x) + between + shortText(p.y) + between + shortText(p.z);
}

}  // namespace

std::string encodeVmv(const CenterlineTree& tree) {
  const std::vector<Strand> strands = strandsOf(tree);
  std::string text = std::string("# ") + kOwnCenterline + "\n$PARAM_BEGIN\nNUM_VERTS\t";
  text += std::to_string(tree.nodeCount()) + "\nNUM_STRANDS\t" + std::to_string(strands.size());
  text += "\nNUM_ATTRIB_PER_VERT\t4\n$PARAM_END\n\n$VERT_LIST_BEGIN\n";
  for (std::size_t n = 0; n < tree.nodeCount(); ++n)
    text += std::to_string(n + 1) + '\t' + placeOfNode(tree, n, "\t") + '\t' +
            shortText(tree.radius[n]) + '\n';
  text += "$VERT_LIST_END\n\n$STRANDS_LIST_BEGIN\n";
  for (std::size_t s = 0; s < strands.size(); ++s) {
    text += std::to_string(s + 1);
    for (const std::uint32_t node : strands[s]) text += '\t' + std::to_string(node + 1);
    text += '\n';
  }
  return text + "$STRANDS_LIST_END\n";
}

std::string encodeGraphml(const CenterlineTree& tree) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n";
  for (const char* name : {"unit", "space"})
    text += std::string("  <key id=\"") + name + "\" for=\"graph\" attr.name=\"" + name +
            "\" attr.type=\"string\"/>\n";
  for (const char* name : {"X", "Y", "Z", "radius"})
    text += std::string("  <key id=\"") + name + "\" for=\"node\" attr.name=\"" + name +
            "\" attr.type=\"double\"/>\n";
  text +=
      "  <graph id=\"G\" edgedefault=\"undirected\">\n"
      "    <data key=\"unit\">mm</data>\n    <data key=\"space\">LPS</data>\n";
  for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
    const formats::Vec3f& p = tree.centre[n];
    text += "    <node id=\"n" + std::to_string(n) + "\"><data key=\"X\">" + shortText(p.x) +
            "</data><data key=\"Y\">" + shortText(p.y) + "</data><data key=\"Z\">" +
            shortText(p.z) + "</data><data key=\"radius\">" + shortText(tree.radius[n]) +
            "</data></node>\n";
  }
  const auto addEdge = [&](std::size_t from, std::size_t to) {
    text += "    <edge source=\"n" + std::to_string(from) + "\" target=\"n" + std::to_string(to) +
            "\"/>\n";
  };
  for (std::size_t n = 0; n < tree.nodeCount(); ++n)
    if (tree.parent[n] != formats::kNoParent) addEdge(static_cast<std::size_t>(tree.parent[n]), n);
  for (const auto& link : tree.links) addEdge(link[0], link[1]);
  return text + "  </graph>\n</graphml>\n";
}

std::string encodeSpatialGraph(const CenterlineTree& tree) {
  const std::vector<Strand> strands = strandsOf(tree);
  constexpr std::int64_t kNone = -1;
  std::vector<std::int64_t> vertex(tree.nodeCount(), kNone);
  std::string places, ends, counts, points, radii;
  std::size_t vertices = 0, pointCount = 0;
  const auto vertexOf = [&](std::uint32_t node) {
    if (vertex[node] == kNone) {
      vertex[node] = static_cast<std::int64_t>(vertices++);
      places += placeOfNode(tree, node, " ") + '\n';
    }
    return std::to_string(vertex[node]);
  };
  for (const Strand& strand : strands) {
    ends += vertexOf(strand.front()) + ' ';
    ends += vertexOf(strand.back()) + '\n';
    counts += std::to_string(strand.size()) + '\n';
    pointCount += strand.size();
    for (const std::uint32_t node : strand) {
      points += placeOfNode(tree, node, " ") + '\n';
      radii += shortText(tree.radius[node]) + '\n';
    }
  }
  std::string text = std::string("# AmiraMesh 3D ASCII 2.0\n# ") + kOwnCenterline + "\n\n";
  text += "define VERTEX " + std::to_string(vertices) + "\ndefine EDGE " +
          std::to_string(strands.size()) + "\ndefine POINT " + std::to_string(pointCount);
  text +=
      "\n\nParameters {\n    Units {\n        Coordinates \"mm\"\n    }\n    ContentType "
      "\"HxSpatialGraph\"\n}\n\nVERTEX { float[3] VertexCoordinates } @1\nEDGE { int[2] "
      "EdgeConnectivity } @2\nEDGE { int NumEdgePoints } @3\nPOINT { float[3] "
      "EdgePointCoordinates } @4\nPOINT { float thickness } @5\n\n# Data section follows\n";
  for (const auto& [name, data] :
       std::array<std::pair<const char*, const std::string*>, 5>{{{"@1\n", &places},
                                                                  {"@2\n", &ends},
                                                                  {"@3\n", &counts},
                                                                  {"@4\n", &points},
                                                                  {"@5\n", &radii}}})
    text += name + *data + '\n';
  return text;
}

}  // namespace lumen::convert
