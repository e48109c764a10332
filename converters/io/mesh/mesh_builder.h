// SPDX-License-Identifier: Apache-2.0
// Checks that the readers of meshes share while they build a MeshFile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/io/mesh/read_mesh.h"

namespace lumen::convert {

/// Bound beyond any plausible unit, and far below overflow of squares and cubes.
constexpr double kLargestCoordinate = 1e12;

/// "name: place: what", as Error(InvalidInput).
[[noreturn]] void refuseMesh(const std::string& name, const std::string& place,
                             const std::string& what);

inline std::string quotedText(std::string_view text) {
  return quotedText(std::string(text));
}

/// A mesh under construction. Names of groups are looked up, so the cost does not grow with their
/// number.
class MeshBuilder {
public:
  explicit MeshBuilder(std::string name) : m_name(std::move(name)) {}

  MeshFile file;

  /// The file's name, printable.
  [[nodiscard]] const std::string& name() const { return m_name; }
  [[nodiscard]] std::size_t points() const { return file.mesh.position.size(); }

  /// Appends a point. `place` returns its position in the file, such as "line 7", and is only
  /// called for a coordinate that is no finite number below 1e12.
  template <class Place>
  void addPoint(const Eigen::Vector3d& point, Place place) {
    if (!isSound(point)) refusePoint(point, place());
    file.mesh.position.push_back(point);
  }

  /// The index of the given point, appended if no equal one exists.
  template <class Place>
  std::uint32_t addShared(const Eigen::Vector3d& point, Place place) {
    if (!isSound(point)) refusePoint(point, place());
    return sharedIndex(point);
  }

  /// Appends a polygon as a fan of triangles around its first corner.
  void addPolygon(const std::uint32_t* corner, std::size_t count);
  void addTriangle(const Triangle& t) { addPolygon(t.data(), 3); }

  /// Sets the group of all triangles that follow; an empty name means no group.
  void beginGroup(std::string_view group);

  /// The mesh, with group names if the file has any. Refuses one without triangles.
  MeshFile finish(bool flipXy = false);

private:
  static bool isSound(const Eigen::Vector3d& point) { return isWithin(point, kLargestCoordinate); }
  [[noreturn]] void refusePoint(const Eigen::Vector3d& point, const std::string& place) const;
  std::uint32_t sharedIndex(const Eigen::Vector3d& point);
  void growTable();

  std::string m_name;
  std::unordered_map<std::string, std::uint32_t> m_groupIndex;
  std::uint32_t m_current = 0;
  std::vector<std::uint32_t> m_table;  // hash table of shared points: index plus one; 0 is free
};

/// Axes and unit as a file states them.
struct StatedFrame {
  bool ras = false, lps = false;
  double unit = 0;  ///< mm; 0: not stated
  std::vector<std::string> notes;

  /// Reads them from a comment: SPACE=LPS or SPACE=RAS as 3D Slicer writes it, lumen's own words, and
  /// units (stated_unit.h).
  void look(std::string_view comment);
};

/// Stores the axes and the unit that the file states in `builder`'s file and finishes it: RAS is
/// turned to LPS.
MeshFile finishStated(MeshBuilder& builder, const StatedFrame& frame);

}  // namespace lumen::convert
