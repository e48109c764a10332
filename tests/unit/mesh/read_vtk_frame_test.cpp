// SPDX-License-Identifier: Apache-2.0
// Unit and axes in the field data of VTK's surfaces.
#include <gtest/gtest.h>

#include "converters/io/mesh/read_mesh.h"

namespace lumen::convert {
namespace {

/// A triangle, before and behind its field data.
const std::string kBegin = "<VTKFile type=\"PolyData\"><PolyData><FieldData>";
const std::string kEnd =
    "</FieldData><Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points><DataArray "
    "type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray>"
    "</Points><Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2"
    "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray>"
    "</Polys></Piece></PolyData></VTKFile>";
const std::string kLegacyHead = "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET POLYDATA\n";
const std::string kLegacyPoints = "POINTS 3 float\n0 0 0 1 0 0 0 1 0\n";

TEST(ReadVtp, ArraysOfTextsAsVtkWritesThemStateUnitAndAxes) {
  const auto read = [](const std::string& field) { return parseVtp(kBegin + field + kEnd, "a"); };
  const std::string begin = "<Array type=\"String\" NumberOfTuples=\"1\" Name=\"";
  for (const MeshFile& file : {read(begin + "SPACE\" format=\"ascii\">82 65 83 0</Array>" + begin +
                                    "Unit\" format=\"ascii\">99 109 0</Array>"),
                               read(begin + "SPACE\" format=\"binary\">BAAAAFJBUwA=</Array>" +
                                    begin + "Unit\" format=\"binary\">AwAAAGNtAA==</Array>")}) {
    EXPECT_EQ(file.unitMm, 10);
    EXPECT_TRUE(file.frameStated);
    EXPECT_TRUE(file.isTurned);
    EXPECT_EQ(file.mesh.position[1], Eigen::Vector3d(-1, 0, 0));
    EXPECT_EQ(file.notes,
              std::vector<std::string>{"the file states RAS: x and y were negated, to LPS"});
  }
}

TEST(ReadVtk, FieldDataStateUnitAndAxes) {
  const std::string text = kLegacyHead +
                           "FIELD FieldData 2\nSPACE 1 1 string\nRAS\nUnit 1 1 string\num\n" +
                           kLegacyPoints + "POLYGONS 1 4\n3 0 1 2\n";
  const MeshFile file = parseVtk(text, "a");
  EXPECT_TRUE(file.isTurned);
  EXPECT_EQ(file.unitMm, 1e-3);
}

}  // namespace
}  // namespace lumen::convert
