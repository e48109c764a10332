// SPDX-License-Identifier: Apache-2.0
#include "converters/steve/export_steve.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <utility>

#include <Eigen/Geometry>

#include "converters/common/error.h"
#include "converters/mesh/plain_names.h"
#include "converters/mesh/write_plain.h"
#include "converters/mesh/write_vtp.h"

namespace lumen::convert {

namespace {

using formats::CenterlineTree;

constexpr double kCentimetres = 0.1;  // of a millimetre

/// Points along a branch, which begins on its parent: stEVE finds branchings where branches come near.
struct Path {
  std::string name;
  std::vector<Eigen::Vector3d> points;  ///< mm
  std::vector<double> radii;            ///< mm
};

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.7g", value == 0 ? 0.0 : value);
  return text.data();
}

/// In lower case, as stEVE makes the names of files.
std::string fileWord(const std::string& label) {
  std::string word = openFoamWord(label);
  for (char& c : word)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return word;
}

Path pathOf(const CenterlineTree& tree, const formats::Branch& branch, std::string name) {
  Path path{std::move(name), {}, {}};
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

std::vector<Path> pathsOf(const CenterlineTree& tree) {
  std::vector<std::string> labels;
  for (const formats::Branch& branch : tree.branches) labels.push_back(branch.label);
  const std::vector<std::string> names = distinct(labels, fileWord);
  std::vector<Path> paths;
  for (std::size_t b = 0; b < names.size(); ++b) {
    Path path = pathOf(tree, tree.branches[b], names[b]);
    if (path.points.size() > 1) paths.push_back(std::move(path));
  }
  if (paths.empty())
    throw invalidInput("this case has no branch with a length, so there is no path");
  return paths;
}

Eigen::Vector3d tangentAt(const Path& path, std::size_t k) {
  const std::size_t last = path.points.size() - 1;
  const Eigen::Vector3d step = path.points[std::min(k + 1, last)] - path.points[k == 0 ? 0 : k - 1];
  return step.norm() > 0 ? Eigen::Vector3d(step.normalized()) : Eigen::Vector3d(1, 0, 0);
}

std::string element(const std::string& name, const Eigen::Vector3d& v) {
  return "<" + name + " x=\"" + number(v.x()) + "\" y=\"" + number(v.y()) + "\" z=\"" +
         number(v.z()) + "\" />\n";
}

/// A path of SimVascular, in cm.
std::string pthOf(const Path& path, std::size_t id) {
  const std::string count = std::to_string(path.points.size());
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n<format version=\"1.0\" />\n<path id=\"" +
      std::to_string(id) + "\" method=\"0\" calculation_number=\"" + count +
      "\" spacing=\"0\">\n<timestep id=\"0\">\n<path_element method=\"0\" calculation_number=\"" +
      count + "\" spacing=\"0\">\n<control_points>\n";
  for (std::size_t k = 0; k < path.points.size(); ++k)
    text += element("point id=\"" + std::to_string(k) + "\"", kCentimetres * path.points[k]);
  text += "</control_points>\n<path_points>\n";
  for (std::size_t k = 0; k < path.points.size(); ++k) {
    const Eigen::Vector3d tangent = tangentAt(path, k);
    text += "<path_point id=\"" + std::to_string(k) + "\">\n";
    text += element("pos", kCentimetres * path.points[k]);
    text += element("tangent", tangent);
    text += element("rotation", tangent.unitOrthogonal());
    text += "</path_point>\n";
  }
  return text + "</path_points>\n</path_element>\n</timestep>\n</path>\n";
}

std::string tuple(const Eigen::Vector3d& v) {
  std::string text = "(";
  text += number(v.x()) + ", " + number(v.y()) + ", " + number(v.z()) + ")";
  return text;
}

std::string moduleOf(const std::vector<Path>& paths) {
  std::string text =
      "# The vessels of a case as a vessel tree of stEVE: mm, patient coordinates, LPS, not "
      "turned.\n"
      "import os\n\n"
      "HERE = os.path.dirname(os.path.abspath(__file__))\n"
      "MESH = os.path.join(HERE, \"vessel.obj\")\n\n"
      "# mm, and a unit vector into the vessels\n";
  text += "INSERTION_POSITION = " + tuple(paths.front().points.front()) + "\n";
  text += "INSERTION_DIRECTION = " + tuple(tangentAt(paths.front(), 0)) + "\n\n";
  text += "# of each branch its name, and x, y, z and radius of its points, mm\nBRANCHES = [\n";
  for (const Path& path : paths) {
    text += "    (\"" + path.name + "\", [\n";
    for (std::size_t k = 0; k < path.points.size(); ++k) {
      const Eigen::Vector3d& p = path.points[k];
      text += "        (" + number(p.x()) + ", " + number(p.y()) + ", " + number(p.z()) + ", " +
              number(path.radii[k]) + "),\n";
    }
    text += "    ]),\n";
  }
  return text +
         "]\n\n\n"
         "def make_vessel_tree():\n"
         "    \"\"\"A FromMesh of stEVE with the radii of the case.\"\"\"\n"
         "    import numpy as np\n"
         "    from eve.intervention.vesseltree import FromMesh\n"
         "    from eve.intervention.vesseltree.util.branch import BranchWithRadii\n\n"
         "    branches = []\n"
         "    for name, points in BRANCHES:\n"
         "        values = np.array(points, dtype=np.float32)\n"
         "        branches.append(BranchWithRadii(name, values[:, :3], values[:, 3]))\n"
         "    # without a rotation stEVE does not take one: [0, 0, 0] is none\n"
         "    return FromMesh(MESH, INSERTION_POSITION, INSERTION_DIRECTION, "
         "branch_list=branches,\n"
         "                    rotation_yzx_deg=[0.0, 0.0, 0.0])\n";
}

SurfaceMesh inCentimetres(SurfaceMesh mesh) {
  for (Float3& p : mesh.position)
    for (float& x : p) x = static_cast<float>(kCentimetres * x);
  for (float& r : mesh.radius) r = static_cast<float>(kCentimetres * r);
  return mesh;
}

SurfaceMesh insideOut(SurfaceMesh mesh) {
  for (Float3& n : mesh.normal)
    for (float& x : n) x = -x;
  for (Triangle& t : mesh.triangle) std::swap(t[1], t[2]);
  return mesh;
}

const char* const kReadme =
    "# Vessels for stEVE\n\n"
    "| file | unit | |\n|---|---|---|\n"
    "| `vessels.py` | mm | `make_vessel_tree()` gives a `FromMesh` with a `BranchWithRadii` for "
    "each "
    "branch and the insertion at the root |\n"
    "| `vessel.obj` | mm | the closed surface of the vessels, its normals into the lumen |\n"
    "| `Paths/*.pth` | cm | paths as of SimVascular, which the class `VMR` reads and scales by ten "
    "|\n"
    "| `Meshes/vessel.vtp` | cm | the same surface, its normals out of the lumen |\n\n"
    "Positions are patient coordinates, LPS, in the order x, y, z. A branch begins on its parent. "
    "The "
    "class `VMR` also\nasks for a volume mesh, `Meshes/*.vtu`, which is not here; `vessels.py` "
    "needs "
    "none.\n";

}  // namespace

SteveExport exportSteve(const formats::Case& source, const ClosedSurfaceOptions& surface,
                        Progress& progress) {
  const std::vector<Path> paths = pathsOf(source.tree);
  ClosedSurface made = closedSurface(source, surface, progress);
  const SurfaceMesh& mesh = made.levels.front();
  SteveExport result;
  result.files = {{"vessels.py", moduleOf(paths)},
                  {"vessel.obj", encodeObj(insideOut(mesh))},
                  {"Meshes/vessel.vtp", encodeVtpIn(inCentimetres(mesh), "cm")},
                  {"README.md", kReadme}};
  for (std::size_t k = 0; k < paths.size(); ++k)
    result.files.push_back({"Paths/" + paths[k].name + ".pth", pthOf(paths[k], k + 1)});
  result.surface = std::move(made.report);
  return result;
}

}  // namespace lumen::convert
