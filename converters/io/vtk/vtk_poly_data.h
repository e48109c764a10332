// SPDX-License-Identifier: Apache-2.0
// Points, cells and arrays of VTK's files of polygonal data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lumen {

/// Cells of one kind. Indices of points are below the number of points.
struct VtkCells {
  std::vector<std::uint32_t> point;  ///< points of all cells, one cell after the other
  std::vector<std::uint32_t> end;    ///< end of each cell in `point`; ascending

  [[nodiscard]] std::size_t size() const { return end.size(); }
  [[nodiscard]] std::uint32_t begin(std::size_t cell) const { return cell ? end[cell - 1] : 0; }
};

/// Numbers for each point, or for each cell.
struct VtkArray {
  std::string name;
  std::uint32_t components = 1;
  std::vector<double> values;  ///< tuple after tuple; may hold non-finite values
};

/// The way from other data sets, as the end of a sentence.
constexpr const char* kMakePolyData = ", as ParaView's filter Extract Surface makes it";

// Texts of field data that state unit and axes, in a few bytes.
constexpr std::size_t kLongestVtkText = 32;

/// Whether a name of field data is that of the unit, "Unit" as lumen writes it, or of the axes, "SPACE" as
/// 3D Slicer does; in letters of any case, as are "Units" and "LengthUnit" of others.
bool isVtkUnit(std::string_view name);
bool isVtkSpace(std::string_view name);

/// Lengths and axes are the file's; `unit` and `space` hold its words for them, empty if it has
/// none, `title` that of a legacy file. Values may be infinite or NaN. Values of cells are in the order verts, lines, polys,
/// strips.
struct VtkPolyData {
  std::vector<Eigen::Vector3d> position;
  VtkCells verts, lines, polys, strips;
  std::vector<VtkArray> pointData, cellData;
  std::string unit, space, title;

  [[nodiscard]] const VtkArray* pointArray(std::string_view name) const;
  [[nodiscard]] const VtkArray* cellArray(std::string_view name) const;
  /// A sentence on a unit or on axes that the file states in words that lumen does not know; or none.
  [[nodiscard]] std::vector<std::string> unknownWords() const;
};

}  // namespace lumen
