// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/volume_mesh.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/base/number_text.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

constexpr std::array<FaceCorners, 5> kPrismFaces{
    {{0, 1, 2, kAbsent}, {3, 5, 4, kAbsent}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}}};
constexpr std::array<FaceCorners, 4> kTetrahedronFaces{
    {{0, 2, 1, kAbsent}, {0, 1, 3, kAbsent}, {1, 2, 3, kAbsent}, {0, 3, 2, kAbsent}}};

template <std::size_t faces, std::size_t corners>
void addFaces(const std::array<FaceCorners, faces>& table,
              const std::array<std::uint32_t, corners>& cell, std::vector<FaceCorners>& out) {
  for (FaceCorners face : table) {
    for (std::uint32_t& corner : face)
      if (corner != kAbsent) corner = cell[corner];
    out.push_back(face);
  }
}

/// Six times the volume between a face and a point.
double pyramid(const VolumeMesh& mesh, const FaceCorners& face, const Vector3d& origin) {
  const auto at = [&](std::size_t k) -> Vector3d { return mesh.position[face[k]] - origin; };
  if (face[3] == kAbsent) return at(0).dot(at(1).cross(at(2)));
  const Vector3d middle = 0.25 * (at(0) + at(1) + at(2) + at(3));
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += middle.dot(at(k).cross(at((k + 1) % 4)));
  return sum;
}

/// The volume of three edges over the product of their lengths.
double scaled(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double lengths = a.norm() * b.norm() * c.norm();
  return lengths > 0 ? a.cross(b).dot(c) / lengths : 0;
}

/// A face by its corners in ascending order.
struct KeyedFace {
  FaceCorners key{};
  FaceCorners corner{};
  std::uint32_t cell = 0;   // or kAbsent: of the boundary
  std::uint32_t group = 0;  // of one of the boundary
};

FaceCorners sortedCorners(FaceCorners corner) {
  std::sort(corner.begin(), corner.end());
  return corner;
}

/// True if both run round the same corners in the same sense.
bool runAlike(const FaceCorners& one, const FaceCorners& other) {
  const std::size_t count = one[3] == kAbsent ? 3 : 4;
  const auto begin = other.begin(), end = begin + static_cast<std::ptrdiff_t>(count);
  const auto at = static_cast<std::size_t>(std::find(begin, end, one[0]) - begin);
  for (std::size_t k = 0; k < count; ++k)
    if (one[k] != other[(at + k) % count]) return false;
  return true;
}

FaceCorners reversed(FaceCorners corner) {
  std::reverse(corner.begin(), corner.begin() + (corner[3] == kAbsent ? 3 : 4));
  return corner;
}

std::vector<KeyedFace> keyedFaces(const VolumeMesh& mesh) {
  std::vector<KeyedFace> faces;
  faces.reserve(5 * mesh.prism.size() + 4 * mesh.tetrahedron.size() + mesh.boundary.size());
  for (std::uint32_t cell = 0; cell < mesh.cells(); ++cell)
    for (const FaceCorners& corner : facesOf(mesh, cell))
      faces.push_back({sortedCorners(corner), corner, cell, 0});
  for (const BoundaryFace& face : mesh.boundary)
    faces.push_back({sortedCorners(face.corner), face.corner, kAbsent, face.group});
  std::sort(faces.begin(), faces.end(), [](const KeyedFace& a, const KeyedFace& b) {
    return std::tie(a.key, a.cell) < std::tie(b.key, b.cell);
  });
  return faces;
}

[[noreturn]] void refuse(const VolumeMesh& mesh, const KeyedFace& face) {
  const Vector3d& at = mesh.position[face.corner[0]];
  throw failed(
      "the volume mesh has a face that is neither shared by two cells nor part of the surface, "
      "at " +
      joinedNumbers(at, ", ", 6) + " mm");
}

}  // namespace

std::vector<FaceCorners> facesOf(const VolumeMesh& mesh, std::size_t cell) {
  std::vector<FaceCorners> faces;
  if (cell < mesh.prism.size())
    addFaces(kPrismFaces, mesh.prism[cell], faces);
  else
    addFaces(kTetrahedronFaces, mesh.tetrahedron[cell - mesh.prism.size()], faces);
  return faces;
}

std::vector<CellFace> cellFaces(const VolumeMesh& mesh) {
  const std::vector<KeyedFace> keyed = keyedFaces(mesh);
  std::vector<CellFace> faces;
  faces.reserve(keyed.size() / 2);
  for (std::size_t k = 0; k < keyed.size(); k += 2) {
    const KeyedFace& one = keyed[k];
    if (k + 1 == keyed.size() || keyed[k + 1].key != one.key || one.cell == kAbsent)
      refuse(mesh, one);
    const KeyedFace& other = keyed[k + 1];
    const bool isInner = other.cell != kAbsent;
    if (k + 2 < keyed.size() && keyed[k + 2].key == one.key) refuse(mesh, one);
    if (!runAlike(one.corner, isInner ? reversed(other.corner) : other.corner)) refuse(mesh, one);
    faces.push_back({one.corner, one.cell, other.cell, isInner ? kAbsent : other.group});
  }
  std::sort(faces.begin(), faces.end(), [](const CellFace& a, const CellFace& b) {
    const auto key = [](const CellFace& f) {
      return std::make_tuple(f.neighbour == kAbsent, f.group, f.owner, f.neighbour, f.corner);
    };
    return key(a) < key(b);
  });
  return faces;
}

double cellVolume(const VolumeMesh& mesh, std::size_t cell) {
  const std::vector<FaceCorners> faces = facesOf(mesh, cell);
  const Vector3d& origin = mesh.position[faces[0][0]];
  double sum = 0;
  for (const FaceCorners& face : faces) sum += pyramid(mesh, face, origin);
  return sum / 6;
}

double cellQuality(const VolumeMesh& mesh, std::size_t cell) {
  const auto edge = [&](std::uint32_t from, std::uint32_t to) -> Vector3d {
    return mesh.position[to] - mesh.position[from];
  };
  double least = INFINITY;
  if (cell < mesh.prism.size()) {
    const auto& p = mesh.prism[cell];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
      least = std::min(
          {least, scaled(edge(p[k], p[last]), edge(p[k], p[next]), edge(p[k], p[k + 3])),
           scaled(edge(p[k + 3], p[last + 3]), edge(p[k + 3], p[next + 3]), edge(p[k], p[k + 3]))});
    }
    return least * 2 / std::sqrt(3.0);
  }
  const auto& t = mesh.tetrahedron[cell - mesh.prism.size()];
  constexpr std::array<std::array<std::size_t, 4>, 4> kCorners{
      {{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 2, 1, 0}}};
  for (const auto& c : kCorners)
    least = std::min(
        least, scaled(edge(t[c[0]], t[c[1]]), edge(t[c[0]], t[c[2]]), edge(t[c[0]], t[c[3]])));
  return least * std::sqrt(2.0);
}

}  // namespace lumen::convert
