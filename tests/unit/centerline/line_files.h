// SPDX-License-Identifier: Apache-2.0
// Small VTK files of lines, made in tests.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/io/centerline/centerline_file.h"

namespace lumen::convert::test {

struct LineFile {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> radii;
  std::vector<std::vector<int>> lines;

  int add(const Eigen::Vector3d& point, double radius) {
    points.push_back(point);
    radii.push_back(radius);
    return static_cast<int>(points.size()) - 1;
  }
};

/// A fork of cells of two points, a step of 1 apart: a trunk of 20 with radius 2 along z, and two arms
/// of 15 with radii 1.5 and 1.2. Its length is 50.
inline LineFile fork() {
  LineFile file;
  int last = file.add({0, 0, 0}, 2);
  const auto go = [&](const Eigen::Vector3d& step, int count, double radius) {
    for (int i = 0; i < count; ++i) {
      const int next = file.add(file.points[std::size_t(last)] + step, radius);
      file.lines.push_back({last, next});
      last = next;
    }
  };
  go({0, 0, 1}, 20, 2);
  const int tip = last;
  go({0.6, 0, 0.8}, 15, 1.5);
  last = tip;
  go({-0.6, 0, 0.8}, 15, 1.2);
  return file;
}

/// The same, with points of its own for each line.
inline LineFile unshared(const LineFile& file) {
  LineFile apart;
  for (const std::vector<int>& line : file.lines) {
    std::vector<int>& own = apart.lines.emplace_back();
    for (const int point : line)
      own.push_back(apart.add(file.points[std::size_t(point)], file.radii[std::size_t(point)]));
  }
  return apart;
}

inline std::string array(const std::string& type, const std::string& name, int components,
                         const std::string& text) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"ascii\">" + text + "</DataArray>";
}

/// A VTP file; `field` goes before its piece, `arrays` among those of points, `cells` among those of
/// cells.
inline std::string vtpOf(const LineFile& file, const std::string& field = "",
                         const std::string& arrays = "", const std::string& cells = "") {
  std::string points, radii, ends, indices;
  int end = 0;
  for (std::size_t i = 0; i < file.points.size(); ++i) {
    for (int a = 0; a < 3; ++a) points += std::to_string(file.points[i][a]) + " ";
    radii += std::to_string(file.radii[i]) + " ";
  }
  for (const std::vector<int>& line : file.lines) {
    for (const int point : line) indices += std::to_string(point) + " ";
    ends += std::to_string(end += static_cast<int>(line.size())) + " ";
  }
  return "<VTKFile type=\"PolyData\"><PolyData>" + field + "<Piece NumberOfPoints=\"" +
         std::to_string(file.points.size()) + "\" NumberOfLines=\"" +
         std::to_string(file.lines.size()) + "\"><PointData>" +
         array("Float64", "Radius", 1, radii) + arrays + "</PointData><CellData>" + cells +
         "</CellData><Points>" + array("Float64", "", 3, points) + "</Points><Lines>" +
         array("Int64", "connectivity", 1, indices) + array("Int64", "offsets", 1, ends) +
         "</Lines></Piece></PolyData></VTKFile>";
}

template <class T>
void appendBig(std::string& bytes, T value) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes.append(raw.rbegin(), raw.rend());
}

/// A legacy VTK file: text or big-endian bytes; lines with their sizes, or offsets since version 5.1.
inline std::string legacyOf(const LineFile& file, bool isBinary, bool hasOffsets,
                            const std::string& title = "t") {
  std::string text = std::string("# vtk DataFile Version ") + (hasOffsets ? "5.1" : "3.0") + "\n" +
                     title + "\n" + (isBinary ? "BINARY" : "ASCII") + "\nDATASET POLYDATA\n";
  const auto number = [&](auto value) {
    if (isBinary)
      appendBig(text, value);
    else
      text += std::to_string(value) + " ";
  };
  text += "POINTS " + std::to_string(file.points.size()) + " double\n";
  for (const Eigen::Vector3d& p : file.points)
    for (int a = 0; a < 3; ++a) number(p[a]);
  std::int64_t count = 0;
  for (const std::vector<int>& line : file.lines) count += static_cast<std::int64_t>(line.size());
  if (hasOffsets) {
    text += "\nLINES " + std::to_string(file.lines.size() + 1) + " " + std::to_string(count) +
            "\nOFFSETS vtktypeint64\n";
    std::int64_t end = 0;
    number(end);
    for (const std::vector<int>& line : file.lines)
      number(end += static_cast<std::int64_t>(line.size()));
    text += "\nCONNECTIVITY vtktypeint64\n";
    for (const std::vector<int>& line : file.lines)
      for (const int point : line) number(std::int64_t{point});
  } else {
    text += "\nLINES " + std::to_string(file.lines.size()) + " " +
            std::to_string(count + static_cast<std::int64_t>(file.lines.size())) + "\n";
    for (const std::vector<int>& line : file.lines) {
      number(std::int32_t(line.size()));
      for (const int point : line) number(std::int32_t{point});
    }
  }
  text += "\nPOINT_DATA " + std::to_string(file.points.size()) +
          "\nFIELD FieldData 1\nMaximumInscribedSphereRadius 1 " +
          std::to_string(file.radii.size()) + " double\n";
  for (const double radius : file.radii) number(radius);
  return text + "\n";
}

inline std::vector<Eigen::Vector3d> rootsOf(const CenterlineFile& file) {
  std::vector<Eigen::Vector3d> roots;
  for (const CenterlinePoint& point : file.points)
    if (point.parent == kNoPoint) roots.push_back(point.position);
  return roots;
}

inline double lengthOf(const CenterlineFile& file) {
  double length = 0;
  for (const CenterlinePoint& point : file.points)
    if (point.parent != kNoPoint)
      length += (point.position - file.points[std::size_t(point.parent)].position).norm();
  return length;
}

}  // namespace lumen::convert::test
