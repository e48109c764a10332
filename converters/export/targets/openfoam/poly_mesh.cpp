// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/openfoam/poly_mesh.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "converters/base/number_text.h"

namespace lumen::convert {

namespace {

// Digits of a position: a nanometre in a metre, so that thin cells keep their shape.
constexpr int kPlaceDigits = 12;

ExportFile foamFile(const std::string& object, const std::string& type, const std::string& body,
                    const std::string& about) {
  const std::string name = "constant/polyMesh/" + object;
  return {name,
          "FoamFile\n{\n    version 2.0;\n    format ascii;\n    class " + type +
              ";\n    location \"constant/polyMesh\";\n    object " + object + ";\n}\n\n" + body,
          about, ""};
}

std::string listed(std::size_t count, const std::string& rows) {
  return std::to_string(count) + "\n(\n" + rows + ")\n";
}

std::string facesText(const std::vector<CellFace>& faces) {
  std::string rows;
  for (const CellFace& face : faces) {
    const std::size_t corners = face.corner[3] == kAbsent ? 3 : 4;
    rows += std::to_string(corners) + "(";
    for (std::size_t k = 0; k < corners; ++k)
      rows += (k > 0 ? " " : "") + std::to_string(face.corner[k]);
    rows += ")\n";
  }
  return listed(faces.size(), rows);
}

std::string boundaryText(const std::vector<CellFace>& faces, const VolumeMesh& mesh,
                         const std::vector<FoamPatch>& patches) {
  std::string rows;
  std::size_t count = 0;
  for (std::size_t k = 0; k < faces.size();) {
    const std::size_t begin = k;
    const std::uint32_t group = faces[k].group;
    while (k < faces.size() && faces[k].group == group) ++k;
    if (group == kAbsent) continue;
    const auto patch = std::find_if(patches.begin(), patches.end(), [&](const FoamPatch& p) {
      return p.end == mesh.groups[group].name;
    });
    rows += "    " + patch->name + "\n    {\n        type " +
            (patch->kind == FaceKind::Wall ? "wall" : "patch") + ";\n        nFaces " +
            std::to_string(k - begin) + ";\n        startFace " + std::to_string(begin) +
            ";\n    }\n";
    ++count;
  }
  return listed(count, rows);
}

}  // namespace

std::vector<ExportFile> polyMesh(const VolumeMesh& mesh, const std::vector<FoamPatch>& patches) {
  const std::vector<CellFace> faces = cellFaces(mesh);
  std::string points, owners, neighbours;
  std::size_t inner = 0;
  for (const Eigen::Vector3d& p : mesh.position)
    points += "(" + joinedNumbers(p, " ", kPlaceDigits) + ")\n";
  for (const CellFace& face : faces) {
    owners += std::to_string(face.owner) + "\n";
    if (face.neighbour == kAbsent) continue;
    neighbours += std::to_string(face.neighbour) + "\n";
    ++inner;
  }
  return {foamFile("points", "vectorField", listed(mesh.position.size(), points),
                   "prisms at the wall, tetrahedra within"),
          foamFile("faces", "faceList", facesText(faces), ""),
          foamFile("owner", "labelList", listed(faces.size(), owners), ""),
          foamFile("neighbour", "labelList", listed(inner, neighbours), ""),
          foamFile("boundary", "polyBoundaryMesh", boundaryText(faces, mesh, patches),
                   "a patch for each named end")};
}

}  // namespace lumen::convert
