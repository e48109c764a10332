// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/steve/steve.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/export/shared/paths.h"
#include "converters/export/shared/surface.h"
#include "converters/export/shared/tree_losses.h"
#include "converters/io/mesh/write_plain.h"
#include "converters/io/mesh/write_vtp.h"

namespace lumen::convert {

namespace {

std::string tuple(const Eigen::Vector3d& v) {
  std::string text = "(";
  text += numberText(v.x()) + ", " + numberText(v.y()) + ", " + numberText(v.z()) + ")";
  return text;
}

std::string moduleOf(const std::vector<BranchPath>& paths) {
  std::string text =
      "# The vessels of a case as a vessel tree of stEVE: mm, patient coordinates, LPS, not "
      "turned.\n"
      "import os\n\n"
      "HERE = os.path.dirname(os.path.abspath(__file__))\n"
      "MESH = os.path.join(HERE, \"vessel.obj\")\n\n"
      "# mm, and a unit vector into the vessels\n";
  text += "INSERTION_POSITION = " + tuple(paths.front().points.front()) + "\n";
  text += "INSERTION_DIRECTION = " + tuple(paths.front().tangent(0)) + "\n\n";
  text += "# of each branch its name, and x, y, z and radius of its points, mm\nBRANCHES = [\n";
  for (const BranchPath& path : paths) {
    text += "    (\"" + path.name + "\", [\n";
    for (std::size_t k = 0; k < path.points.size(); ++k) {
      const Eigen::Vector3d& p = path.points[k];
      text += "        (" + numberText(p.x()) + ", " + numberText(p.y()) + ", " +
              numberText(p.z()) + ", " + numberText(path.radii[k]) + "),\n";
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

const char* const kStart =
    "`vessels.py` has `make_vessel_tree()`, which gives a `FromMesh` with a `BranchWithRadii` for "
    "each branch and "
    "the\ninsertion at the root. The class `VMR` reads `Paths` and `Meshes`, which it scales by "
    "ten; it also asks "
    "for a volume\nmesh, `Meshes/*.vtu`, which is not here: `vessels.py` needs none. A branch "
    "begins on its "
    "parent.\n";

}  // namespace

ExportResult exportSteve(const ExportInput& input) {
  const std::vector<BranchPath> paths = branchPaths(input.source.tree);
  ExportedSurface made = lumenSurface(input);
  const ExportFrame centimetres{LengthUnit::Centimetre, Axes::Lps};
  ExportResult result;
  result.start = kStart;
  result.files = {{"vessels.py", moduleOf(paths),
                   "branches with their radii, insertion, mesh as a vessel tree", ""},
                  {"vessel.obj", encodeObj(turnedOver(made.mesh)),
                   "the closed surface of the vessels, its normals into the lumen", ""},
                  {"Meshes/vessel.vtp", encodeVtpIn(centimetres.of(made.mesh), "cm"),
                   "the same surface in cm, its normals out of the lumen", "cm"}};
  for (std::size_t k = 0; k < paths.size(); ++k)
    result.files.push_back(
        {"Paths/" + paths[k].name + ".pth", encodePth(paths[k], k + 1), "", "cm"});
  result.others.push_back({"Paths/*.pth", "paths as of SimVascular, in cm"});
  result.losses = treeLosses(input.source.tree);
  result.ends = std::move(made.ends);
  result.surface = std::move(made.report);
  return result;
}

}  // namespace lumen::convert
