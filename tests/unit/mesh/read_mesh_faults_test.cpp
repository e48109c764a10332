// SPDX-License-Identifier: Apache-2.0
// Numbers and first bytes of mesh files that readers have mistaken.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/io/mesh/gltf_content.h"
#include "converters/io/mesh/read_mesh.h"
#include "tests/unit/formats/json_samples.h"

namespace lumen::test {
namespace {

namespace fs = std::filesystem;
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
  const std::string text = start + mesh.before + number + mesh.after;
  return readMesh({"a", text}, mesh.format).mesh.position.at(0).x();
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
  EXPECT_EQ(readMesh({"a", text}, MeshFormat::Stl).mesh.triangle.size(), 1U);
}

TEST(ReadGltf, AFileThatManyBuffersNameIsHeldOnce) {
  const fs::path folder = fs::path(testing::TempDir()) / "lumen-gltf-buffers";
  fs::create_directories(folder);
  std::ofstream(folder / "big.bin", std::ios::binary) << std::string(1000, 'a');
  std::string text = R"({"asset":{"version":"2.0"},"buffers":[)";
  for (int size = 801; size <= 1000; ++size)
    text += (size == 801 ? "" : ",") + std::string(R"({"uri":"big.bin","byteLength":)") +
            std::to_string(size) + "}";
  text += R"(],"bufferViews":[{"buffer":0,"byteLength":801},{"buffer":199,"byteLength":1000}]})";
  const GltfContent content(text, folder / "a.gltf");
  EXPECT_EQ(content.totalBytes(), text.size() + 1000);
  EXPECT_EQ(content.view(0).size(), 801U);
  EXPECT_EQ(content.view(1), std::string(1000, 'a'));
  fs::remove_all(folder);
}

std::string gltfOf(const std::string& node, const std::string& before = "") {
  return before + R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,)" +
         node +
         R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
         R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
         R"("buffers":[{"byteLength":36,"uri":"data:;base64,)"
         R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
}

TEST(ReadGltf, NumbersOfEveryWriterAreTheNearestDouble) {
  for (const auto& [text, value] : jsonSamples(1e8)) {
    const std::string bytes = gltfOf("\"translation\":[" + text + ",0,0]");
    const MeshFile file = readMesh({"a", bytes}, MeshFormat::Gltf);
    EXPECT_EQ(file.mesh.position[0].x(), 1000 * value) << text;
  }
}

TEST(ReadGltf, ExtrasMayHoldNumbersOfAnySize) {
  const auto read = [](const std::string& node) {
    const std::string bytes = gltfOf(node, kMark);
    return readMesh({"a", bytes}, MeshFormat::Gltf).mesh.triangle.size();
  };
  EXPECT_EQ(read("\"extras\":[1e400,-1e999,123456789012345678901234567890]"), 1U);
  EXPECT_THROW(read("\"translation\":[1e400,0,0]"), Error);
}

}  // namespace
}  // namespace lumen::test
