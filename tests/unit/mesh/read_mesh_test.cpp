// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/read_mesh.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "mesh_shapes.h"

namespace lumen::test {
namespace {

using namespace lumen::convert;

MeshFile parsed(const std::string& text, MeshFormat format) {
  return readMesh({"a", text}, format);
}

std::string refusal(const std::string& text, MeshFormat format) {
  try {
    parsed(text, format);
  } catch (const Error& error) {
    return std::to_string(static_cast<int>(error.kind())) + ": " + error.what();
  }
  return "none";
}

// STL

TEST(ReadStl, BinaryTrianglesShareTheirEqualPoints) {
  const MeshFile file = parsed(binaryStl(tetrahedron(), 4), MeshFormat::Stl);
  EXPECT_EQ(file.mesh.position.size(), 4U);
  ASSERT_EQ(file.mesh.triangle.size(), 4U);
  EXPECT_EQ(file.mesh.position[file.mesh.triangle[1][1]], Eigen::Vector3d(1, 0, 0));
  EXPECT_TRUE(file.groups.empty());
  EXPECT_EQ(file.unitMm, 0);
}

TEST(ReadStl, ABinaryFileMayBeginWithSolid) {
  std::string bytes = binaryStl(tetrahedron(), 4);
  bytes.replace(0, 5, "solid");
  EXPECT_EQ(parsed(bytes, MeshFormat::Stl).mesh.triangle.size(), 4U);
}

TEST(ReadStl, SolidsOfATextAreGroups) {
  const auto solid = [](const std::string& name, int z) {
    const std::string height = std::to_string(z);
    return "solid " + name + "\n facet normal nan 0 0\n outer loop\nvertex 0 0 " + height +
           "\nvertex +1e0 0 " + height + "\nvertex 0 1 " + height +
           "\nendloop\nendfacet\nendsolid " + name + "\n";
  };
  const MeshFile file = parsed(solid("wall", 0) + solid("inlet", 1), MeshFormat::Stl);
  EXPECT_EQ(file.groups, (std::vector<std::string>{"wall", "inlet"}));
  EXPECT_EQ(file.group, (std::vector<std::uint32_t>{0, 1}));
}

TEST(ReadStl, ACountBeyondTheBytesIsRefusedAtOnce) {
  EXPECT_EQ(refusal(binaryStl({}, 0xFFFFFFFF), MeshFormat::Stl),
            "3: a: byte 80: the count is 4294967295 triangles; expected at most 0, for which there "
            "are bytes");
}

TEST(ReadStl, WhatIsNoNumberIsRefusedWithItsPlace) {
  for (int axis = 0; axis < 3; ++axis) {
    TriangleMesh mesh = tetrahedron();
    mesh.position[1][axis] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(refusal(binaryStl(mesh, 4), MeshFormat::Stl),
              "3: a: byte 120: the " + std::string(1, "xyz"[axis]) +
                  " of a point is nan; expected a finite number, at most 1e12");
  }
  EXPECT_EQ(refusal("solid\nfacet\nouter loop\nvertex 0 zero 0\n", MeshFormat::Stl),
            "3: a: line 4: a coordinate is \"zero\"; expected a number");
  EXPECT_EQ(refusal("solid\nfacet\nouter loop\nvertex 0 inf 0\n", MeshFormat::Stl),
            "3: a: line 4: the y of a point is inf; expected a finite number, at most 1e12");
}

TEST(ReadStl, ATextThatEndsTooSoonIsRefused) {
  EXPECT_EQ(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", MeshFormat::Stl),
            "3: a: line 5: the file ends; expected \"vertex\"");
  EXPECT_EQ(refusal("solid a\nendsolid a\n", MeshFormat::Stl),
            "3: a: has no triangles; expected a surface of at least one");
}

TEST(ReadStl, AFileOfSlicerInRasIsTurned) {
  std::string bytes = binaryStl(tetrahedron(), 4);
  bytes.replace(0, 31, "3D Slicer output. SPACE=RAS    ");
  const MeshFile file = parsed(bytes, MeshFormat::Stl);
  EXPECT_TRUE(file.frameStated);
  EXPECT_EQ(file.mesh.position[file.mesh.triangle[1][1]], Eigen::Vector3d(-1, 0, 0));
  EXPECT_EQ(file.notes.size(), 1U);
}

TEST(ReadStl, TwoMillionTrianglesAreRead) {
  const TriangleMesh tube = openTube(1, 1000, 1000, 1000);
  const std::string bytes = binaryStl(tube, 2000000);
  const MeshFile file = parsed(bytes, MeshFormat::Stl);
  EXPECT_EQ(file.mesh.triangle.size(), 2000000U);
  EXPECT_EQ(file.mesh.position.size(), 1001000U);
}

// OBJ

TEST(ReadObj, PolygonsNegativeIndicesAndGroups) {
  const MeshFile file = parsed(
      "# a comment\no body\nv 0 0 0\nv 1 0 0\nv 1 1 0 1.0\nv 0 1 0 0.5 0.5 0.5\nvn 0 0 1\n"
      "g wall\nf 1/1/1 2//1 3/1 4\r\ng cap\nf -1 \\\n -2 -4 # end\nl 1 2\n",
      MeshFormat::Obj);
  EXPECT_EQ(file.mesh.triangle, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {3, 2, 0}}));
  EXPECT_EQ(file.groups, (std::vector<std::string>{"wall", "cap"}));
  EXPECT_EQ(file.group, (std::vector<std::uint32_t>{0, 0, 1}));
}

TEST(ReadObj, FacesMayComeBeforeTheirPoints) {
  EXPECT_EQ(parsed("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", MeshFormat::Obj).mesh.triangle.size(),
            1U);
  EXPECT_EQ(refusal("f 1 2 4\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", MeshFormat::Obj),
            "3: a: line 1: a corner of a face is point 4; expected at most 3, the number of points "
            "in the file");
}

TEST(ReadObj, WrongIndicesAreRefusedWithTheirLine) {
  for (const char* corner : {"0", "-4", "1.5", "x", "4294967297", "9999999999999999999999"})
    EXPECT_TRUE(
        refusal(std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 ") + corner + "\n", MeshFormat::Obj)
            .starts_with("3: a: line 4: a corner of a face is \""))
        << corner;
  EXPECT_EQ(refusal("v 0 0 0\nv 1 0 0\nf 1 2\n", MeshFormat::Obj),
            "3: a: line 3: a face has 2 corners; expected at least 3");
}

TEST(ReadObj, ATextThatIsNoMeshIsRefused) {
  EXPECT_EQ(refusal("hello world\n", MeshFormat::Obj),
            "3: a: has no triangles; expected a surface of at least one");
  EXPECT_EQ(refusal("v 1 2\nf 1 1 1\n", MeshFormat::Obj),
            "3: a: line 1: a coordinate is missing; expected a number");
}

TEST(ReadObj, MessagesAreFitToPrint) {
  EXPECT_EQ(refusal("v \x1b[2K 0 0\n", MeshFormat::Obj),
            "3: a: line 1: a coordinate is \"\\u001b[2K\"; expected a number");
}

// PLY

std::string plyHead(const std::string& format, const std::string& vertices,
                    const std::string& faces) {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\nelement vertex " + vertices +
         "\nproperty double x\nproperty float y\nproperty short z\nproperty uchar red\nelement "
         "face " +
         faces + "\nproperty list uchar uint vertex_indices\nproperty int mark\nend_header\n";
}

template <class T>
void appendAs(std::string& bytes, T value, bool big) {
  std::string raw;
  append(raw, value);
  bytes.append(big ? std::string(raw.rbegin(), raw.rend()) : raw);
}

TEST(ReadPly, AsciiAndBothByteOrdersAreTheSame) {
  std::vector<MeshFile> files = {
      parsed(plyHead("ascii", "4", "1") + "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 -2 9\n4 0 1 2 3 7\n",
             MeshFormat::Ply)};
  for (const bool big : {false, true}) {
    std::string bytes = plyHead(big ? "binary_big_endian" : "binary_little_endian", "4", "1");
    const std::vector<std::vector<double>> points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, -2}};
    for (const auto& p : points) {
      appendAs(bytes, p[0], big);
      appendAs(bytes, static_cast<float>(p[1]), big);
      appendAs(bytes, static_cast<std::int16_t>(p[2]), big);
      bytes += '\x09';
    }
    bytes += '\x04';
    for (std::uint32_t i = 0; i < 4; ++i) appendAs(bytes, i, big);
    appendAs(bytes, std::int32_t{7}, big);
    files.push_back(parsed(bytes, MeshFormat::Ply));
  }
  for (const MeshFile& file : files) {
    EXPECT_EQ(file.mesh.triangle, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    ASSERT_EQ(file.mesh.position.size(), 4U);
    EXPECT_EQ(file.mesh.position[3], Eigen::Vector3d(0, 1, -2));
  }
}

TEST(ReadPly, CountsBeyondTheBytesAreRefusedAtOnce) {
  EXPECT_EQ(refusal(plyHead("binary_little_endian", "4000000000", "1"), MeshFormat::Ply),
            "3: a: line 12: the header announces 4000000000 of \"vertex\"; expected at most 0, for "
            "which there are bytes");
  std::string list = plyHead("ascii", "3", "1") + "0 0 0 0 1 0 0 0 0 1 0 0 200 0 1 2 0\n";
  EXPECT_EQ(refusal(list, MeshFormat::Ply),
            "3: a: before line 13: the count of a list is 200; expected at most 9, for which there "
            "are bytes");
}

TEST(ReadPly, IndicesOutOfRangeAreRefused) {
  EXPECT_EQ(
      refusal(plyHead("ascii", "3", "1") + "0 0 0 0 1 0 0 0 0 1 0 0\n3 0 1 3 0\n", MeshFormat::Ply),
      "3: a: before line 14: a corner of a face is vertex 3; expected less than 3, the number "
      "of vertices");
}

TEST(ReadPly, WhatLacksCoordinatesOrFacesIsRefused) {
  EXPECT_EQ(refusal("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
                    MeshFormat::Ply),
            "3: a: its vertices lack x, y or z; expected all three");
  EXPECT_EQ(refusal("plain\n", MeshFormat::Ply),
            "3: a: line 2: does not begin with \"ply\"; expected PLY");
}

// glTF

std::string gltf(const std::string& nodes, const std::string& uri = "") {
  const std::string data = uri.empty() ? "data:application/octet-stream;base64,"
                                         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAECAA=="
                                       : uri;
  return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":)" + nodes +
         R"(,"meshes":[{"name":"m","primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
         R"({"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}],)"
         R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],)"
         R"("buffers":[{"byteLength":39,"uri":")" +
         data + "\"}]}";
}

TEST(ReadGltf, MetresWithYUpBecomeLpsMillimetres) {
  const MeshFile file = parsed(gltf(R"([{"mesh":0}])"), MeshFormat::Gltf);
  ASSERT_EQ(file.mesh.position.size(), 3U);
  EXPECT_EQ(file.mesh.position[1], Eigen::Vector3d(1000, 0, 0));
  EXPECT_EQ(file.mesh.position[2], Eigen::Vector3d(0, 0, 1000));
  EXPECT_EQ(file.unitMm, 1);
  EXPECT_EQ(file.standardMm, 1000);
  EXPECT_EQ(file.scaleFor(1), 1e-3);  // --unit mm: its numbers are mm
  EXPECT_TRUE(file.frameStated);
  EXPECT_EQ(file.groups, std::vector<std::string>{"m"});
}

TEST(ReadGltf, NodesPlaceMeshesAndMirroredOnesAreTurned) {
  const MeshFile file =
      parsed(gltf(R"([{"children":[1,2],"translation":[0,0,1]},{"mesh":0,"scale":[2,1,1]},)"
                  R"({"mesh":0,"matrix":[-1,0,0,0,0,1,0,0,0,0,1,0,5,0,0,1]}])"),
             MeshFormat::Gltf);
  ASSERT_EQ(file.mesh.position.size(), 6U);
  EXPECT_EQ(file.mesh.position[1], Eigen::Vector3d(2000, -1000, 0));
  EXPECT_EQ(file.mesh.position[4], Eigen::Vector3d(4000, -1000, 0));
  EXPECT_EQ(file.mesh.triangle, (std::vector<Triangle>{{0, 1, 2}, {3, 5, 4}}));
}

TEST(ReadGltf, NodesThatLeadInACircleAreRefused) {
  EXPECT_EQ(refusal(gltf(R"([{"children":[1]},{"children":[0],"mesh":0}])"), MeshFormat::Gltf),
            "3: a: /nodes/0 has two parents; expected one, as in a tree");
}

TEST(ReadGltf, NoFileOutsideOfItsFolderIsOpened) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "lumen-read-gltf";
  std::filesystem::create_directories(folder / "inside");
  const auto write = [&](const std::string& name, const std::string& bytes) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  };
  const std::string triangle(
      "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\1\2", 39);
  write("outside.bin", triangle);
  write("inside/a b.bin", triangle);
  write("inside/far.gltf", gltf(R"([{"mesh":0}])", "../outside.bin"));
  write("inside/near.gltf", gltf(R"([{"mesh":0}])", "a%20b.bin"));
  EXPECT_EQ(readMesh(folder / "inside/near.gltf", MeshFormat::Gltf).mesh.triangle.size(), 1U);
  for (const std::string& uri : {std::string("../outside.bin"), (folder / "outside.bin").string(),
                                 std::string("http://example.org/a.bin")}) {
    write("inside/far.gltf", gltf(R"([{"mesh":0}])", uri));
    EXPECT_THROW(readMesh(folder / "inside/far.gltf", MeshFormat::Gltf), Error) << uri;
  }
  // nor any file at all, of bytes in memory
  const std::string bytes = gltf(R"([{"mesh":0}])", "a%20b.bin");
  EXPECT_THROW(readMesh({folder / "inside/near.gltf", bytes}, MeshFormat::Gltf), Error);
  std::filesystem::remove_all(folder);
}

TEST(ReadGltf, ClaimsBeyondTheBytesAreRefused) {
  std::string text = gltf(R"([{"mesh":0}])");
  text.replace(text.find("\"count\":3"), 9, "\"count\":4000000000");
  EXPECT_EQ(
      refusal(text, MeshFormat::Gltf),
      "3: a: /accessors/0/count is 4000000000; expected at most 3, for which there are bytes");
  EXPECT_EQ(refusal(R"({"asset":{"version":"2.0"},"extras":)" + std::string(100000, '['),
                    MeshFormat::Gltf),
            "3: a: its JSON is more than 64 levels deep; expected fewer");
}

// VTK

const std::string kVtkHead = "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET POLYDATA\n";
const std::string kVtkPoints = "POINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n";

TEST(ReadVtk, PolygonsStripsAndFaceNumbers) {
  const MeshFile file = parsed(kVtkHead + kVtkPoints +
                                   "LINES 1 3\n2 0 1\nPOLYGONS 1 5\n4 0 1 2 3\n"
                                   "TRIANGLE_STRIPS 1 5\n4 0 1 2 3\nCELL_DATA 3\n"
                                   "SCALARS ModelFaceID int 1\nLOOKUP_TABLE default\n5 1 2\n",
                               MeshFormat::Vtk);
  EXPECT_EQ(file.mesh.triangle,
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {2, 1, 3}}));
  EXPECT_EQ(file.groups, (std::vector<std::string>{"1", "2"}));
  EXPECT_EQ(file.notes, std::vector<std::string>{"1 lines were passed over"});
}

TEST(ReadVtk, BinaryOfVersion5IsRead) {
  std::string bytes =
      "# vtk DataFile Version 5.1\nSPACE=LPS\nBINARY\nDATASET POLYDATA\nPOINTS 3 double\n";
  for (const double x : {0, 0, 0, 1, 0, 0, 0, 1, 0}) appendAs(bytes, x, true);
  bytes += "\nPOLYGONS 2 3\nOFFSETS vtktypeint64\n";
  for (const std::int64_t x : {0, 3}) appendAs(bytes, x, true);
  bytes += "\nCONNECTIVITY vtktypeint64\n";
  for (const std::int64_t x : {0, 1, 2}) appendAs(bytes, x, true);
  const MeshFile file = parsed(bytes + "\n", MeshFormat::Vtk);
  EXPECT_EQ(file.mesh.triangle, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_TRUE(file.frameStated);
}

TEST(ReadVtk, WrongCountsAndIndicesAreRefused) {
  EXPECT_EQ(refusal(kVtkHead + "POINTS 4000000000 double\n", MeshFormat::Vtk),
            "3: a: line 5: 12000000000 numbers of points are announced; expected at most 0, for "
            "which there are bytes");
  EXPECT_EQ(refusal(kVtkHead + kVtkPoints + "POLYGONS 1 4\n3 0 1 9\n", MeshFormat::Vtk),
            "3: a: corner 2 of the polygons: is point 9; expected less than 4, the number of "
            "points");
  EXPECT_EQ(
      refusal("# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_GRID\n", MeshFormat::Vtk),
      "4: a: line 4: the data set is \"STRUCTURED_GRID\"; lumen reads POLYDATA, as ParaView's "
      "filter "
      "Extract Surface makes it");
}

/// A triangle with field data of ASCII codes.
std::string vtpWithField(const std::string& field) {
  return "<VTKFile type=\"PolyData\"><PolyData><FieldData>" + field +
         "</FieldData><Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points><DataArray "
         "type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray>"
         "</Points><Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2"
         "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray>"
         "</Polys></Piece></PolyData></VTKFile>";
}

std::string fieldText(const char* name, const char* codes) {
  return std::string("<DataArray type=\"String\" Name=\"") + name + "\" format=\"ascii\">" + codes +
         "</DataArray>";
}

TEST(ReadVtp, UnitAndAxesAreThoseOfTheFieldData) {
  const MeshFile file =
      parsed(vtpWithField(fieldText("Unit", "109 109 0") + fieldText("SPACE", "82 65 83 0")),
             MeshFormat::Vtp);
  EXPECT_EQ(file.unitMm, 1);
  EXPECT_TRUE(file.frameStated);
  EXPECT_EQ(file.mesh.position[1], Eigen::Vector3d(-1, 0, 0));
}

TEST(ReadVtp, OtherFieldDataStateNothing) {
  const MeshFile file =
      parsed(vtpWithField(fieldText("Unit", "112 120 0") + fieldText("SPACE", "76") +
                          fieldText("Note", "no numbers")),
             MeshFormat::Vtp);
  EXPECT_EQ(file.unitMm, 0);
  EXPECT_FALSE(file.frameStated);
}

TEST(ReadVtp, EveryEncodingOfVtkIsTheSameMesh) {
  const std::filesystem::path folder = std::filesystem::path(LUMEN_TEST_DATA) / "vtk";
  const MeshFile text = readMesh(folder / "ascii.vtp", MeshFormat::Vtp);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".vtp") continue;
    const MeshFile file = readMesh(entry.path(), MeshFormat::Vtp);
    EXPECT_EQ(file.mesh.triangle, text.mesh.triangle) << entry.path();
    EXPECT_EQ(file.mesh.position, text.mesh.position) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 8U);
}

TEST(ReadMesh, AFileThatIsNotThereIsNamed) {
  try {
    readMesh("no/such.stl", MeshFormat::Stl);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("no/such.stl: there is no such mesh"));
  }
}

}  // namespace
}  // namespace lumen::test
