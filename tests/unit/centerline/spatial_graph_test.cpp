// SPDX-License-Identifier: Apache-2.0
// Spatial graphs of Amira: one that it wrote (tests/data/neighbours), and one graph in each encoding.
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "converters/base/error.h"
#include "converters/io/centerline/case_of_centerline.h"
#include "converters/io/centerline/centerline_readers.h"
#include "line_files.h"

namespace lumen::convert {
namespace {

enum class Packing { Text, Raw, Zip, Runs };

template <class T>
std::string stored(const std::vector<T>& values, Packing packing, bool isBig) {
  std::string bytes;
  for (const T value : values) {
    if (packing == Packing::Text) {
      bytes += std::to_string(value) + "\n";
      continue;
    }
    std::string raw(reinterpret_cast<const char*>(&value), sizeof(T));
    if (isBig) std::reverse(raw.begin(), raw.end());
    bytes += raw;
  }
  return bytes;
}

/// Runs of one byte as such a run, all others as they are: HxByteRLE.
std::string inRuns(const std::string& bytes) {
  std::string packed;
  for (std::size_t at = 0; at < bytes.size();) {
    std::size_t count = 1;
    while (count < 127 && at + count < bytes.size() && bytes[at + count] == bytes[at]) ++count;
    if (count > 2) {
      packed += static_cast<char>(count);
      packed += bytes[at];
      at += count;
    } else {
      packed += static_cast<char>(128 | 1);
      packed += bytes[at++];
    }
  }
  return packed;
}

std::string zipped(const std::string& bytes) {
  std::string packed(compressBound(bytes.size()), '\0');
  auto size = static_cast<uLongf>(packed.size());
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  packed.resize(size);
  return packed;
}

/// The fork of tests/data/neighbours as a file of Amira.
std::string forkOf(Packing packing, bool isBig = false, const std::string& parameters = "") {
  const std::vector<std::string> data = {
      stored<float>({0, 0, 0, 0, 0, 20, 0, 12, 36, 0, -12, 36}, packing, isBig),
      stored<std::int32_t>({0, 1, 2, 1, 1, 3}, packing, isBig),
      stored<std::int32_t>({3, 2, 2}, packing, isBig),
      stored<float>({0, 0, 0, 0, 0, 10, 0, 0, 20, 0, 12, 36, 0, 0, 20, 0, 0, 20, 0, -12, 36},
                    packing, isBig),
      stored<float>({2, 2, 2, 1.5F, 1.5F, 1.2F, 1.2F}, packing, isBig)};
  const std::vector<std::string> fields = {
      "VERTEX { float[3] VertexCoordinates }", "EDGE { int[2] EdgeConnectivity }",
      "EDGE { int NumEdgePoints }", "POINT { float[3] EdgePointCoordinates }",
      "POINT { float thickness }"};
  std::string text = packing == Packing::Text ? "# AmiraMesh 3D ASCII 2.0\n"
                     : isBig                  ? "# AmiraMesh BINARY 2.0\n"
                                              : "# AmiraMesh BINARY-LITTLE-ENDIAN 2.1\n";
  text += "\ndefine VERTEX 4\ndefine EDGE 3\ndefine POINT 7\n\nParameters {\n" + parameters +
          "    ContentType \"HxSpatialGraph\"\n}\n\n";
  std::string body;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const std::string at = "@" + std::to_string(f + 1);
    const std::string bytes = packing == Packing::Zip    ? zipped(data[f])
                              : packing == Packing::Runs ? inRuns(data[f])
                                                         : data[f];
    text += fields[f] + " " + at;
    if (packing == Packing::Zip) text += "(HxZip," + std::to_string(bytes.size()) + ")";
    if (packing == Packing::Runs) text += "(HxByteRLE," + std::to_string(bytes.size()) + ")";
    text += "\n";
    body += at + "\n" + bytes + "\n\n";
  }
  return text + "\n# Data section follows\n" + body;
}

std::string amiraRefusal(const std::string& bytes) {
  try {
    parseSpatialGraph(bytes, "a.am");
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(SpatialGraph, IsTheSameInEachEncoding) {
  for (const Packing packing : {Packing::Text, Packing::Raw, Packing::Zip, Packing::Runs})
    for (const bool isBig : {false, true}) {
      const CenterlineFile file = parseSpatialGraph(forkOf(packing, isBig), "a.am");
      EXPECT_EQ(centerlineChains(file).size(), 2U);
      EXPECT_EQ(test::rootsOf(file), std::vector<Eigen::Vector3d>{Eigen::Vector3d::Zero()});
      EXPECT_NEAR(test::lengthOf(file), 60, 1e-5);
      EXPECT_NEAR(measureExtent(file).least, 1.2, 1e-6);
      EXPECT_EQ(file.unit, 0);
    }
}

TEST(SpatialGraph, OfAmiraItselfHasItsLinesAndTexts) {
  const CenterlineFile file = readSpatialGraph(
      std::filesystem::path(LUMEN_TEST_DATA "/neighbours/amira-correlation-lines.am"));
  EXPECT_EQ(file.points.size(), 8U);  // 6 vertices, and 4 points of which 2 repeat others
  EXPECT_EQ(centerlineChains(file).size(), 3U);
  EXPECT_EQ(test::rootsOf(file).size(), 3U);
}

TEST(SpatialGraph, UnitAndTransformAreApplied) {
  CenterlineFile file =
      parseSpatialGraph(forkOf(Packing::Text, false,
                               "    Units {\n        Coordinates \"\xC2\xB5m\"\n    }\n"
                               "    TransformationMatrix 0 2 0 0 -2 0 0 0 0 0 2 0 5 6 7 1,\n"),
                        "a.am");
  EXPECT_EQ(file.unit, 1e-3);
  EXPECT_EQ(test::rootsOf(file), (std::vector<Eigen::Vector3d>{{5, 6, 7}}));
  EXPECT_NEAR(test::lengthOf(file), 120, 1e-5);
  EXPECT_NEAR(measureExtent(file).most, 4, 1e-6);
  EXPECT_EQ(file.remarks.back(), "its TransformationMatrix is applied, as Amira shows the graph");
  file = parseSpatialGraph(
      forkOf(Packing::Text, false, "    Units {\n        Coordinates \"parsec\"\n    }\n"), "a.am");
  EXPECT_EQ(file.remarks.back(), "states the unit \"parsec\", which is unknown");
}

TEST(SpatialGraph, BracesOfTextsAreNoBraces) {
  const CenterlineFile file = parseSpatialGraph(
      forkOf(
          Packing::Text, false,
          "    ModuleState \"create { \\\"a\\\"\nset } } {\",\n    thickness {\n        Unit -1\n"
          "    }\n"),
      "a.am");
  EXPECT_NEAR(test::lengthOf(file), 60, 1e-5);
}

TEST(SpatialGraph, OtherContentIsRefusedWithWhatToSave) {
  EXPECT_EQ(amiraRefusal(
                "# AmiraMesh BINARY-LITTLE-ENDIAN 3.0\ndefine Lattice 4 4 4\nLattice { byte Data "
                "} @1\n@1\n"),
            "a.am: holds a volume of Amira; expected a spatial graph (HxSpatialGraph); Amira saves "
            "volumes as NRRD or DICOM, which lumen reads");
  EXPECT_EQ(amiraRefusal("# HyperSurface 0.1 ASCII Amira\n"),
            "a.am: is a surface of Amira (HyperSurface); Amira saves surfaces as STL or PLY, which "
            "lumen reads");
}

TEST(SpatialGraph, CountsBeyondTheFileAreRefused) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = forkOf(Packing::Text);
    return amiraRefusal(text.replace(text.find(from), from.size(), to));
  };
  EXPECT_EQ(with("define POINT 7", "define POINT 70000000"),
            "a.am: line 48: begins the data @4 of 210000000 numbers, more than the file holds");
  EXPECT_EQ(
      with("@3\n3\n2", "@3\n3\n9"),
      "a.am: edge 1 has 9.000000 points (NumEdgePoints), more than are left; expected 7 points "
      "of all edges");
  EXPECT_EQ(with("@2\n0\n1\n2", "@2\n0\n1\n8"),
            "a.am: EdgeConnectivity has the vertex 8.000000; expected whole numbers below 4, the "
            "number of vertices");
}

}  // namespace
}  // namespace lumen::convert
