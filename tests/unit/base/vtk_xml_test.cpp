// SPDX-License-Identifier: Apache-2.0
// Files in tests/data/vtk are of VTK 9.1, one set of data in each encoding.
#include "converters/io/vtk/vtk_xml.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"

namespace {

using lumen::VtkPolyData;

constexpr std::array<std::string_view, 3> kWanted = {"MaximumInscribedSphereRadius", "GroupIds",
                                                     "Absent"};

VtkPolyData parse(const std::string& text) {
  return lumen::parseVtkXml(text, "a.vtp", kWanted);
}

std::string message(const std::string& text) {
  try {
    parse(text);
  } catch (const lumen::Error& error) {
    return error.what();
  }
  return "";
}

std::string bytesOf(const std::string& name) {
  std::ifstream stream(LUMEN_TEST_DATA "/vtk/" + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

class EachEncoding : public testing::TestWithParam<const char*> {};

TEST_P(EachEncoding, GivesTheSameData) {
  const VtkPolyData data = parse(bytesOf(GetParam()));
  ASSERT_EQ(data.position.size(), 5u);
  EXPECT_EQ(data.position[4], Eigen::Vector3d(0, 2, -3e-3));
  EXPECT_EQ(data.lines.point, (std::vector<std::uint32_t>{0, 1, 2, 0, 3, 4}));
  EXPECT_EQ(data.lines.end, (std::vector<std::uint32_t>{3, 6}));
  EXPECT_EQ(data.polys.point, (std::vector<std::uint32_t>{0, 1, 3}));
  ASSERT_NE(data.pointArray("MaximumInscribedSphereRadius"), nullptr);
  EXPECT_EQ(data.pointArray("MaximumInscribedSphereRadius")->values,
            (std::vector<double>{2, 1.75, 1.5, 1.25, 1}));
  ASSERT_NE(data.cellArray("GroupIds"), nullptr);
  EXPECT_EQ(data.cellArray("GroupIds")->values, (std::vector<double>{7, -1, 3}));
  EXPECT_EQ(data.pointData.size(), 1u);  // what nobody asks for is left out
}

// Every file cut anywhere is refused or whole, and says which file.
TEST_P(EachEncoding, IsRefusedWhenCutOff) {
  const std::string whole = bytesOf(GetParam());
  const std::size_t end =
      whole.rfind("</AppendedData") == whole.npos ? whole.rfind("</VTKFile>") : whole.size() / 2;
  for (std::size_t size = 0; size < end; size += 3)
    EXPECT_EQ(message(whole.substr(0, size)).substr(0, 6), "a.vtp:") << size;
}

INSTANTIATE_TEST_SUITE_P(VtkXml, EachEncoding,
                         testing::Values("ascii.vtp", "binary.vtp", "binary-zlib.vtp",
                                         "binary-zlib-big.vtp", "appended-raw.vtp",
                                         "appended-raw-zlib-64.vtp", "appended-base64-zlib.vtp",
                                         "appended-base64-big-64.vtp"));

const char* const kTwoPieces = R"(<VTKFile type="PolyData" byte_order="LittleEndian"><PolyData>
<Piece NumberOfPoints="2" NumberOfLines="1"><Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0</DataArray></Points><Lines><DataArray type="Int32" Name="connectivity" format="ascii">0 1</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">2</DataArray></Lines></Piece>
<Piece NumberOfPoints="2" NumberOfLines="1"><Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">
5 0 0 6 0 0</DataArray></Points><Lines><DataArray type="Int32" Name="connectivity" format="ascii">1 0</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">2</DataArray></Lines></Piece>
</PolyData></VTKFile>)";

TEST(VtkXml, JoinsPieces) {
  const VtkPolyData data = parse(kTwoPieces);
  EXPECT_EQ(data.position.size(), 4u);
  EXPECT_EQ(data.lines.point, (std::vector<std::uint32_t>{0, 1, 3, 2}));
  EXPECT_EQ(data.lines.end, (std::vector<std::uint32_t>{2, 4}));
}

TEST(VtkXml, RefusesIndicesBeyondThePoints) {
  EXPECT_EQ(message(replaced(kTwoPieces, ">0 1<", ">0 2<")),
            "a.vtp: line 3: the array \"connectivity\" has the value 2.000000; expected indices of "
            "the 2 points");
}

TEST(VtkXml, RefusesMoreNumbersThanThereAre) {
  EXPECT_EQ(message(replaced(kTwoPieces, "NumberOfPoints=\"2\"", "NumberOfPoints=\"4000000000\"")),
            "a.vtp: line 2: the array \"\" has 6 numbers; expected 12000000000");
}

TEST(VtkXml, RefusesWordsAmongNumbers) {
  EXPECT_EQ(message(replaced(kTwoPieces, "0 0 0 1", "0 0 x 1")),
            "a.vtp: line 2: the array \"\" has \"x\"; expected a number");
}

TEST(VtkXml, RefusesOffsetsThatFall) {
  EXPECT_NE(message(replaced(kTwoPieces, ">2<", ">-2<")).find("that do not fall"),
            std::string::npos);
}

TEST(VtkXml, RefusesSizesBeyondTheFile) {
  // the size that stands before the positions says four gigabytes
  std::string text = bytesOf("appended-raw.vtp");
  const auto points = text.find("<Points>");
  const auto at = text.find("offset=\"", points) + 8;
  const std::size_t offset = std::stoul(text.substr(at));
  const std::size_t data = text.find('_', text.find("<AppendedData")) + 1 + offset;
  text.replace(data, 4, "\xff\xff\xff\xff");
  EXPECT_NE(message(text).find("states a size of 4294967295 bytes; expected 120"),
            std::string::npos);
  const std::string many = replaced(
      replaced(bytesOf("appended-raw.vtp"), "NumberOfPoints=\"5\"", "NumberOfPoints=\"178956970\""),
      "offset=\"", "offset=\"");
  EXPECT_NE(message(many).find("states "), std::string::npos);
}

TEST(VtkXml, RefusesTwoArraysWithTheSameData) {
  std::string text = bytesOf("appended-raw.vtp");
  const auto second =
      text.find("offset=\"", text.find("Name=\"connectivity\"", text.find("<Lines>")));
  const auto end = text.find('"', second + 8);
  text = text.substr(0, second + 8) + "0" + text.substr(end);
  EXPECT_NE(message(text).find("as another one; expected data of its own"), std::string::npos);
}

TEST(VtkXml, RefusesOtherData) {
  EXPECT_EQ(message("<VTKFile type=\"ImageData\"/>"),
            "a.vtp: line 1: is of the type \"ImageData\"; expected PolyData, as ParaView's filter "
            "Extract Surface makes it");
  EXPECT_EQ(message("<svg/>"), "a.vtp: line 1: begins with \"svg\"; expected <VTKFile>");
  EXPECT_EQ(message("<!DOCTYPE a [<!ENTITY b \"c\">]><VTKFile/>"),
            "a.vtp: line 1: has a document type; expected none");
  EXPECT_NE(message("hello").find("is no XML"), std::string::npos);
  EXPECT_EQ(
      message("<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"/>"),
      "a.vtp: line 1: is packed by \"vtkLZ4DataCompressor\"; lumen reads vtkZLibDataCompressor "
      "and unpacked data, one of which ParaView's Save Data offers");
}

TEST(VtkXml, RefusesDeepNesting) {
  std::string text = "<VTKFile type=\"PolyData\">";
  for (int i = 0; i < 100000; ++i) text += "<a>";
  EXPECT_EQ(message(text), "a.vtp: line 1: has elements more than 16 deep");
}

}  // namespace
