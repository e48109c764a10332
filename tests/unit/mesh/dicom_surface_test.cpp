// SPDX-License-Identifier: Apache-2.0
// Surface segmentations of DICOM, as pydicom 3.0.2 writes them: a tetrahedron in each encoding.
#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/io/content/file_content.h"
#include "converters/io/mesh/read_mesh.h"

namespace lumen::convert {
namespace {

std::string fileOf(const std::string& name) {
  return LUMEN_TEST_DATA "/../fuzz/corpus/dicom_surface/" + name;
}

TEST(DicomSurface, TrianglesAreThoseOfTheirSegment) {
  for (const char* name : {"long", "short", "implicit", "deflated", "facets"}) {
    const MeshFile file = readMesh(fileOf(name), MeshFormat::DicomSurface);
    EXPECT_EQ(file.mesh.position.size(), 4U) << name;
    ASSERT_EQ(file.mesh.triangle.size(), 4U) << name;
    EXPECT_EQ(file.mesh.triangle[0], (Triangle{0, 2, 1}));
    EXPECT_EQ(file.mesh.position[3], Eigen::Vector3d(0, 0, 10));
    EXPECT_EQ(file.groups, std::vector<std::string>{"Aorta"});
    EXPECT_EQ(file.unitMm, 1);
    EXPECT_TRUE(file.frameStated);
    EXPECT_EQ(detectContent(fileOf(name)).kind, ContentKind::Mesh);
  }
}

TEST(DicomSurface, StripsTurnEverySecondTriangle) {
  const MeshFile file = readMesh(fileOf("strip"), MeshFormat::DicomSurface);
  ASSERT_EQ(file.mesh.triangle.size(), 4U);
  EXPECT_EQ(file.mesh.triangle[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(file.mesh.triangle[1], (Triangle{2, 1, 3}));
}

TEST(DicomSurface, AnIndexOfNoPointIsNamed) {
  std::string bytes = readWholeFile(fileOf("short"), "surface", kAnySize);
  const std::size_t at = bytes.find(std::string("\1\0\3\0\2\0", 6));
  ASSERT_NE(at, std::string::npos);
  for (const char bad : {'\0', '\5'}) {
    bytes[at] = bad;
    try {
      (void)readMesh({"a.dcm", bytes}, MeshFormat::DicomSurface);
      FAIL() << "an index of no point is read";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
      for (const char* part : {"a.dcm", "surface 1", "(0066,0023)", "expected 1 to 4"})
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace lumen::convert
