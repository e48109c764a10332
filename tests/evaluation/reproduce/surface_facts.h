// SPDX-License-Identifier: Apache-2.0
// Facts of a written surface, and its distance from the field of its case: measured on the file, without
// the program's knowledge of the surface that it made. Lengths in mm, places in LPS.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/mesh_measures.h"
#include "converters/stages/surface/separated_field.h"
#include "formats/case/case.h"

namespace lumen::reproduce {

/// A VTP file of the program.
struct WrittenSurface {
  convert::TriangleMesh mesh;
  std::vector<std::uint32_t> branch;  ///< of each vertex: index into the tree's branches
  std::vector<std::uint32_t> group;   ///< of each triangle; 0 is the wall
};

/// Throws Error(InvalidInput) for another file than the program writes.
WrittenSurface readSurface(const std::filesystem::path& file);

/// By CGAL, but for `intersections` and the angles.
struct ShapeFacts {
  bool isMesh = false;                ///< a manifold at edges and vertices, and neighbours agree
  bool closed = false;                ///< no boundary edge
  bool outward = false;               ///< each part bounds the volume inside of it
  std::vector<std::ptrdiff_t> euler;  ///< of each connected part
  double volume = 0, area = 0;        ///< mm^3, mm^2
  std::size_t intersections = 0;      ///< pairs of triangles, by selfIntersections()
  std::size_t cgalIntersections = 0;  ///< by CGAL
  double medianAngle = 0, leastAngle = 0;  ///< of the triangles' least angles, degrees
};

ShapeFacts measureShape(const convert::TriangleMesh& mesh);

/// For each tree of the case that has models: 2 less twice the number of loops that its links close.
std::vector<std::ptrdiff_t> eulerOfTrees(const formats::Case& source);

/// A distance as a share of the vessel's radius, and where.
struct Farthest {
  double radii = 0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  std::uint32_t node = 0;
};

struct FieldFacts {
  Farthest vertex;              ///< of the wall's vertices from the field
  Farthest middle;              ///< of the middles of the wall's triangles from the field
  Farthest field;               ///< of the field, where rays from the nodes meet it, from the mesh
  std::size_t vertices = 0;     ///< of the wall
  std::size_t verticesFar = 0;  ///< farther than a thousandth of the radius
  std::size_t rays = 0;         ///< that met the field
};

/// A vertex may lie on any sheet of its branch, and a triangle on any of its vertices'. Rays go twelve ways across the
/// vessel from every node that no end is near.
FieldFacts distanceFrom(const convert::SeparatedField& field, const WrittenSurface& surface);

struct EndFacts {
  std::size_t groups = 0;  ///< of faces besides the wall
  std::size_t flat = 0;    ///< whose vertices lie in a plane, to a thousandth of their size
  double tilt =
      0;  ///< greatest angle of a flat one's normal and the vessel at the nearest node, degrees
};

EndFacts measureEnds(const formats::Case& source, const WrittenSurface& surface);

}  // namespace lumen::reproduce
