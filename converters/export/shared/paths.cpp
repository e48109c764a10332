// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/paths.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "converters/export/shared/frame.h"
#include "converters/io/mesh/mesh_parts.h"

namespace lumen::convert {

namespace {

using formats::CenterlineTree;

BranchPath makePath(const CenterlineTree& tree, std::uint32_t index, std::string name) {
  const formats::Branch& branch = tree.branches[index];
  BranchPath path{index, std::move(name), {}, {}};
  const auto add = [&](std::size_t node, double radius) {
    const formats::Vec3f& c = tree.centre[node];
    path.points.emplace_back(c.x, c.y, c.z);
    path.radii.push_back(radius);
  };
  if (branch.parentNode >= 0)
    add(static_cast<std::size_t>(branch.parentNode), tree.radius[branch.firstNode]);
  for (std::size_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
    add(n, tree.radius[n]);
  return path;
}

}  // namespace

std::string pointElement(const std::string& name, const Eigen::Vector3d& v) {
  return "<" + name + " x=\"" + numberText(v.x()) + "\" y=\"" + numberText(v.y()) + "\" z=\"" +
         numberText(v.z()) + "\" />\n";
}

std::string fileWord(const std::string& label) {
  std::string word = lowerCase(openFoamWord(label));  // as stEVE makes the names of files
  // programs take a name that begins with "-" for an option
  if (word.front() == '-') word.front() = '_';
  return word;
}

Eigen::Vector3d BranchPath::tangent(std::size_t k) const {
  const std::size_t last = points.size() - 1;
  const Eigen::Vector3d step = points[std::min(k + 1, last)] - points[k == 0 ? 0 : k - 1];
  return step.norm() > 0 ? Eigen::Vector3d(step.normalized()) : Eigen::Vector3d(1, 0, 0);
}

std::vector<BranchPath> branchPaths(const CenterlineTree& tree) {
  std::vector<std::string> labels;
  for (const formats::Branch& branch : tree.branches) labels.push_back(branch.label);
  const std::vector<std::string> names = distinct(labels, fileWord);
  std::vector<BranchPath> paths;
  for (std::size_t b = 0; b < names.size(); ++b) {
    BranchPath path = makePath(tree, static_cast<std::uint32_t>(b), names[b]);
    if (path.points.size() > 1) paths.push_back(std::move(path));
  }
  if (paths.empty())
    throw invalidInput("this case has no branch with a length, so there is no path");
  return paths;
}

std::string encodePth(const BranchPath& path, std::size_t id) {
  const std::string count = std::to_string(path.points.size());
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n<format version=\"1.0\" />\n<path id=\"" +
      std::to_string(id) + "\" method=\"0\" calculation_number=\"" + count +
      "\" spacing=\"0\">\n<timestep id=\"0\">\n<path_element method=\"0\" calculation_number=\"" +
      count + "\" spacing=\"0\">\n<control_points>\n";
  for (std::size_t k = 0; k < path.points.size(); ++k)
    text += pointElement("point id=\"" + std::to_string(k) + "\"", kCentimetres * path.points[k]);
  text += "</control_points>\n<path_points>\n";
  for (std::size_t k = 0; k < path.points.size(); ++k) {
    const Eigen::Vector3d tangent = path.tangent(k);
    text += "<path_point id=\"" + std::to_string(k) + "\">\n";
    text += pointElement("pos", kCentimetres * path.points[k]);
    text += pointElement("tangent", tangent);
    text += pointElement("rotation", tangent.unitOrthogonal());
    text += "</path_point>\n";
  }
  return text + "</path_points>\n</path_element>\n</timestep>\n</path>\n";
}

}  // namespace lumen::convert

namespace lumen {

std::vector<std::string> treeLosses(const formats::CenterlineTree& tree, const std::string& lines,
                                    bool isNetwork) {
  const auto sacs = static_cast<std::size_t>(std::count_if(
      tree.branches.begin(), tree.branches.end(),
      [](const formats::Branch& branch) { return branch.kind == formats::BranchKind::Aneurysm; }));
  std::vector<std::string> losses;
  if (!tree.links.empty() && !isNetwork)
    losses.push_back(
        lines + " holds trees, so " +
        counted(tree.links.size(), "link that closes a loop is", "links that close loops are") +
        " left out");
  if (sacs > 0)
    losses.push_back(lines + " holds vessels, so " +
                     counted(sacs, "aneurysm becomes one", "aneurysms become vessels"));
  return losses;
}

}  // namespace lumen
