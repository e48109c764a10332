// SPDX-License-Identifier: Apache-2.0
// Numbers and first bytes of mesh files that readers have mistaken.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/io/mesh/mesh_file.h"

namespace lumen::test {
namespace {

using namespace lumen::convert;

const std::string kMark = "\xEF\xBB\xBF";

struct TextMesh {
  MeshFormat format;
  std::string before, after;  // around the x of the first point
};

std::vector<TextMesh> textMeshes() {
  const std::string vtp =
      "<VTKFile type=\"PolyData\" version=\"0.1\"><PolyData><Piece NumberOfPoints=\"3\" "
      "NumberOfPolys=\"1\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
      "format=\"ascii\">";
  const std::string vtpEnd =
      " 0 0 1 0 0 0 1 0</DataArray></Points><Polys><DataArray type=\"Int32\" "
      "Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray><DataArray type=\"Int32\" "
      "Name=\"offsets\" format=\"ascii\">3</DataArray></Polys></Piece></PolyData></VTKFile>";
  return {
      {MeshFormat::Obj, "v ", " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {MeshFormat::Stl, "solid a\nfacet normal 0 0 1\nouter loop\nvertex ",
       " 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"},
      {MeshFormat::Ply,
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
       "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
       "end_header\n",
       " 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {MeshFormat::Vtk, "# vtk DataFile Version 3.0\na\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n",
       " 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n"},
      {MeshFormat::Vtp, vtp, vtpEnd}};
}

double firstX(const TextMesh& mesh, const std::string& number, const std::string& start = "") {
  return parseMesh(start + mesh.before + number + mesh.after, "a", mesh.format)
      .mesh.position.at(0)
      .x();
}

TEST(ReadMeshNumbers, ThoseBeyondADoubleAreRefused) {
  for (const TextMesh& mesh : textMeshes())
    for (const char* number : {"1e400", "-1e400", "1e39"})
      EXPECT_THROW(firstX(mesh, number), Error)
          << number << " in format " << static_cast<int>(mesh.format);
}

TEST(ReadMeshNumbers, ThoseTooSmallForADoubleAreZero) {
  for (const TextMesh& mesh : textMeshes())
    EXPECT_EQ(firstX(mesh, "1e-400"), 0) << static_cast<int>(mesh.format);
}

TEST(ReadMeshText, AByteOrderMarkIsNoPartOfIt) {
  for (const TextMesh& mesh : textMeshes())
    EXPECT_EQ(firstX(mesh, "7", kMark), 7) << static_cast<int>(mesh.format);
}

TEST(ReadStl, SolidMayBeInCapitals) {
  const std::string text =
      "SOLID A\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\n"
      "ENDLOOP\nENDFACET\nENDSOLID A\n";
  EXPECT_EQ(parseMesh(text, "a", MeshFormat::Stl).mesh.triangle.size(), 1U);
}

}  // namespace
}  // namespace lumen::test
