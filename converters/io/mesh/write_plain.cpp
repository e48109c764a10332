// SPDX-License-Identifier: Apache-2.0
// OBJ, STL and PLY. OpenMesh's writers take one mesh and no comment: they could neither name groups
// of faces nor state the unit and the frame.
#include "converters/io/mesh/write_plain.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/io/mesh/mesh_parts.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

static_assert(std::endian::native == std::endian::little,
              "numbers are written as they lie in memory");

template <class T>
void put(std::string& out, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  out.append(bytes, sizeof(T));
}

void putVector(std::string& out, const Float3& v) {
  for (std::size_t a = 0; a < 3; ++a) put(out, v[a]);
}

void putLine(std::string& out, const char* keyword, const Float3& v) {
  out += keyword;
  for (std::size_t a = 0; a < 3; ++a) {
    out += ' ';
    formats::appendNumber(out, v[a]);
  }
  out += '\n';
}

// Unit normal; zero for a triangle without area. Edges in floats, the rest in doubles, summed from
// x to z.
Float3 faceNormal(const SurfaceMesh& mesh, const Triangle& t) {
  const auto at = [&](std::size_t i) { return Eigen::Vector3f(mesh.position[t[i]].data()); };
  const Eigen::Vector3d first = (at(1) - at(0)).cast<double>();
  const Eigen::Vector3d second = (at(2) - at(0)).cast<double>();
  const Eigen::Vector3d n = first.cross(second);
  const double length = std::sqrt(n.x() * n.x() + n.y() * n.y() + n.z() * n.z());
  if (!(length > 0)) return {};
  const Eigen::Vector3f unit = (n / length).cast<float>();
  return {unit.x(), unit.y(), unit.z()};
}

void checkCount(std::size_t count, const char* format) {
  if (count <= static_cast<std::size_t>(INT32_MAX)) return;
  throw unsupported("the mesh has " + std::to_string(count) + " vertices or triangles; " + format +
                    " holds at most 2147483647");
}

constexpr const char* kFrame = "millimetres, LPS: +x left, +y posterior, +z superior";

void putCorner(std::string& out, std::size_t vertex, std::size_t normal) {
  out += ' ';
  out += std::to_string(vertex + 1);
  out += "//";
  out += std::to_string(normal + 1);
}

std::string encodeBinaryStl(const SurfaceMesh& surface) {
  const std::size_t faces = surface.triangle.size();
  std::string out = "lumen " LUMEN_VERSION ", binary STL, mm, SPACE=LPS (+x left, +y posterior)";
  out.resize(80, ' ');
  out.reserve(84 + 50 * faces);
  put(out, static_cast<std::uint32_t>(faces));
  for (const Triangle& t : surface.triangle) {
    putVector(out, faceNormal(surface, t));
    for (const std::uint32_t v : t) putVector(out, surface.position[v]);
    put(out, std::uint16_t{0});
  }
  return out;
}

std::string encodeSolids(const SurfaceMesh& surface) {
  const std::vector<std::string> names = distinct(plainGroupNames(surface.groups), openFoamWord);
  std::string out;
  for (const MeshPart& part : splitMesh(surface, MeshPer::Whole)) {
    out += "solid " + names[part.group] + "\n";
    for (const Triangle& local : part.triangle) {
      const Triangle t{part.vertex[local[0]], part.vertex[local[1]], part.vertex[local[2]]};
      putLine(out, "facet normal", faceNormal(surface, t));
      out += "outer loop\n";
      for (const std::uint32_t v : t) putLine(out, "vertex", surface.position[v]);
      out += "endloop\nendfacet\n";
    }
    out += "endsolid " + names[part.group] + "\n";
  }
  return out.empty() ? "solid empty\nendsolid empty\n" : out;
}

std::string plyHeader(const SurfaceMesh& surface) {
  std::string out =
      "ply\nformat binary_little_endian 1.0\ncomment lumen " LUMEN_VERSION "\ncomment ";
  out += kFrame;
  out += "\ncomment SPACE=LPS\n";
  const std::vector<std::string> groups = distinct(plainGroupNames(surface.groups), oneWord);
  const std::vector<std::string> labels = distinct(surface.labels, oneWord);
  for (std::size_t g = 0; g < groups.size(); ++g)
    out += "comment group " + std::to_string(g + 1) + " " + groups[g] + "\n";
  for (std::size_t b = 0; b < labels.size(); ++b)
    out += "comment branch " + std::to_string(b) + " " + labels[b] + "\n";
  const std::vector<std::string> systems = systemNames(surface);
  for (std::size_t b = 0; b < systems.size(); ++b)
    out += "comment system " + std::to_string(b) + " " + systems[b] + "\n";
  out += "element vertex " + std::to_string(surface.position.size()) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "radius"})
    out += std::string("property float ") + name + "\n";
  if (!surface.confidence.empty()) out += "property float confidence\n";
  out += "property int branch\nelement face " + std::to_string(surface.triangle.size()) +
         "\nproperty list uchar int vertex_indices\nproperty int group\nend_header\n";
  return out;
}

}  // namespace

std::string encodeObj(const SurfaceMesh& surface) {
  std::string out = "# lumen " LUMEN_VERSION "\n# ";
  out += kFrame;
  out += "\n# SPACE=LPS\n";
  for (const Float3& p : surface.position) putLine(out, "v", p);
  for (const Float3& n : surface.normal) putLine(out, "vn", n);
  const std::vector<std::string> names = distinct(plainGroupNames(surface.groups), oneWord);
  std::size_t normals = surface.normal.size();
  for (const MeshPart& part : splitMesh(surface, MeshPer::Whole)) {
    out += "g " + names[part.group] + "\n";
    if (part.isFlat)
      for (const Float3& n : part.normal) putLine(out, "vn", n);
    for (const Triangle& t : part.triangle) {
      out += 'f';
      for (const std::uint32_t v : t)
        putCorner(out, part.vertex[v], part.isFlat ? normals + v : part.vertex[v]);
      out += '\n';
    }
    if (part.isFlat) normals += part.normal.size();
  }
  return out;
}

std::string encodeStl(const SurfaceMesh& surface, bool solids) {
  if (solids) return encodeSolids(surface);
  checkCount(surface.triangle.size(), "STL");
  return encodeBinaryStl(surface);
}

std::string encodePly(const SurfaceMesh& surface) {
  const std::size_t vertices = surface.position.size(), faces = surface.triangle.size();
  checkCount(std::max(vertices, faces), "PLY");
  std::string out = plyHeader(surface);
  out.reserve(out.size() + 36 * vertices + 17 * faces);
  for (std::size_t v = 0; v < vertices; ++v) {
    putVector(out, surface.position[v]);
    putVector(out, surface.normal[v]);
    put(out, surface.radius[v]);
    if (!surface.confidence.empty()) put(out, surface.confidence[v]);
    put(out, static_cast<std::int32_t>(surface.branch[v]));
  }
  for (std::size_t f = 0; f < faces; ++f) {
    put(out, std::uint8_t{3});
    for (const std::uint32_t v : surface.triangle[f]) put(out, static_cast<std::int32_t>(v));
    put(out, static_cast<std::int32_t>(surface.group[f]) + 1);
  }
  return out;
}

}  // namespace lumen::convert
