// SPDX-License-Identifier: Apache-2.0
// VTK lines with VMTK's arrays; declared in write_centerline.h.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/vectors.h"
#include "converters/io/centerline/centerline_file.h"
#include "converters/io/centerline/write_centerline.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

using formats::CenterlineTree;

// Group of the edge that leads to a node.
struct Group {
  std::int32_t id = -1;
  bool isBlanked = false;
  std::int32_t fork = formats::kNoParent;  // fork whose ball contains a blanked edge
};

struct Tract {
  std::vector<std::uint32_t> nodes;
  std::int32_t centerline, tract, group;
  bool isBlanked;
};

class Branching {
public:
  explicit Branching(const CenterlineTree& tree)
      : m_tree(tree), m_group(tree.nodeCount()), m_children(tree.nodeCount(), 0) {
    for (const std::int32_t parent : tree.parent)
      if (parent != formats::kNoParent) ++m_children[static_cast<std::size_t>(parent)];
    std::vector<std::int32_t> atFork(tree.nodeCount(), -1);  // group of the edges that leave it
    for (std::size_t n = 0; n < tree.nodeCount(); ++n) setGroup(n, atFork);
  }

  // All paths from a root to a tip, in the order of the tips.
  [[nodiscard]] std::vector<Tract> tracts() const {
    std::vector<Tract> all;
    std::int32_t centerline = 0;
    for (std::uint32_t n = 0; n < m_tree.nodeCount(); ++n)
      if (m_children[n] == 0) addPath(n, centerline++, all);
    return all;
  }

private:
  [[nodiscard]] bool isFork(std::int32_t node) const {
    return m_children[static_cast<std::size_t>(node)] > 1;
  }

  void setGroup(std::size_t n, std::vector<std::int32_t>& atFork) {
    Group& group = m_group[n];
    const std::int32_t parent = m_tree.parent[n];
    if (parent == formats::kNoParent) return;
    const Group& before = m_group[static_cast<std::size_t>(parent)];
    // a fork within the ball of another one belongs to that one's region
    std::int32_t fork = before.isBlanked ? before.fork : formats::kNoParent;
    if (!isWithin(n, fork) && isFork(parent)) fork = parent;
    if (isWithin(n, fork)) {
      std::int32_t& shared = atFork[static_cast<std::size_t>(fork)];
      if (shared < 0) shared = m_groups++;
      group = {shared, true, fork};
    } else if (!before.isBlanked && before.id >= 0 && !isFork(parent)) {
      group = before;
    } else {
      group = {m_groups++, false, formats::kNoParent};
    }
  }

  [[nodiscard]] bool isWithin(std::size_t node, std::int32_t fork) const {
    if (fork == formats::kNoParent) return false;
    const auto f = static_cast<std::size_t>(fork);
    return (toEigen(m_tree.centre[node]) - toEigen(m_tree.centre[f])).norm() <=
           double{m_tree.radius[f]};
  }

  void addPath(std::uint32_t tip, std::int32_t centerline, std::vector<Tract>& all) const {
    std::vector<std::uint32_t> path;
    for (auto n = static_cast<std::int32_t>(tip); n != formats::kNoParent;
         n = m_tree.parent[static_cast<std::size_t>(n)])
      path.push_back(static_cast<std::uint32_t>(n));
    std::reverse(path.begin(), path.end());
    if (path.size() == 1) {  // a vessel of one node
      all.push_back({path, centerline, 0, m_groups, false});
      return;
    }
    std::int32_t tract = -1;
    for (std::size_t i = 1; i < path.size(); ++i) {
      const Group& group = m_group[path[i]];
      if (tract < 0 || group.id != all.back().group)
        all.push_back({{path[i - 1]}, centerline, ++tract, group.id, group.isBlanked});
      all.back().nodes.push_back(path[i]);
    }
  }

  const CenterlineTree& m_tree;
  std::vector<Group> m_group;
  std::vector<std::uint32_t> m_children;
  std::int32_t m_groups = 0;
};

void openArray(std::string& text, const char* type, const char* name, const char* more = "") {
  text += std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\"" + more +
          " format=\"ascii\">\n";
}

template <class Value>
void appendArray(std::string& text, const char* type, const char* name, std::size_t count,
                 const Value& value) {
  openArray(text, type, name);
  for (std::size_t i = 0; i < count; ++i) text += value(i) + (i % 16 == 15 ? '\n' : ' ');
  text += "\n</DataArray>\n";
}

void appendPoints(std::string& text, const CenterlineTree& tree) {
  const std::size_t count = tree.nodeCount();
  text += "<PointData Scalars=\"MaximumInscribedSphereRadius\">\n";
  appendArray(text, "Float64", "MaximumInscribedSphereRadius", count,
              [&](std::size_t n) { return formats::shortText(tree.radius[n]); });
  appendArray(text, "Int32", "Branch", count,
              [&](std::size_t n) { return std::to_string(tree.branch[n]); });
  text += "</PointData>\n";
}

void appendPositions(std::string& text, const CenterlineTree& tree) {
  text += "<Points>\n";
  openArray(text, "Float32", "Points", " NumberOfComponents=\"3\"");
  for (const formats::Vec3f& p : tree.centre)
    text += formats::shortText(p.x) + ' ' + formats::shortText(p.y) + ' ' +
            formats::shortText(p.z) + '\n';
  text += "</DataArray>\n</Points>\n";
}

void appendLines(std::string& text, const std::vector<Tract>& tracts) {
  text += "<Lines>\n";
  openArray(text, "Int64", "connectivity");
  for (const Tract& tract : tracts) {
    for (const std::uint32_t node : tract.nodes) text += std::to_string(node) + ' ';
    text += '\n';
  }
  text += "</DataArray>\n";
  std::size_t end = 0;
  appendArray(text, "Int64", "offsets", tracts.size(),
              [&](std::size_t i) { return std::to_string(end += tracts[i].nodes.size()); });
  text += "</Lines>\n";
}

void appendCells(std::string& text, const std::vector<Tract>& tracts) {
  text += "<CellData>\n";
  const auto add = [&](const char* name, const auto& value) {
    appendArray(text, "Int32", name, tracts.size(),
                [&](std::size_t i) { return std::to_string(value(tracts[i])); });
  };
  add("CenterlineIds", [](const Tract& tract) { return tract.centerline; });
  add("TractIds", [](const Tract& tract) { return tract.tract; });
  add("GroupIds", [](const Tract& tract) { return tract.group; });
  add("Blanking", [](const Tract& tract) { return tract.isBlanked ? 1 : 0; });
  text += "</CellData>\n";
}

}  // namespace

std::string encodeVtpCenterline(const CenterlineTree& tree) {
  const std::vector<Tract> tracts = Branching(tree).tracts();
  std::string text =
      std::string("<?xml version=\"1.0\"?>\n<!-- ") + kOwnCenterline +
      " -->\n"
      "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n";
  text += "<Piece NumberOfPoints=\"" + std::to_string(tree.nodeCount()) +
          "\" NumberOfVerts=\"0\" NumberOfLines=\"" + std::to_string(tracts.size()) +
          "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n";
  appendPoints(text, tree);
  appendCells(text, tracts);
  appendPositions(text, tree);
  appendLines(text, tracts);
  return text + "</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace lumen::convert
