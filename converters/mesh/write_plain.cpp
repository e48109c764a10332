// SPDX-License-Identifier: Apache-2.0
// OBJ, STL and PLY. OpenMesh's writers take one mesh and no comment: they could not name the
// branches, nor say the unit and the frame.
#include "converters/mesh/write_plain.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <set>

#include <Eigen/Geometry>

#include "converters/common/error.h"

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

// The shortest decimal that reads back as the same number.
template <class T>
void putNumber(std::string& out, T value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  out.append(digits, static_cast<std::size_t>(end - digits));
}

void putLine(std::string& out, const char* keyword, const Float3& v) {
  out += keyword;
  for (std::size_t a = 0; a < 3; ++a) {
    out += ' ';
    putNumber(out, v[a]);
  }
  out += '\n';
}

std::string objName(const std::string& label, std::set<std::string>& taken) {
  std::string name = label.empty() ? "branch" : label;
  for (char& c : name)
    if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f) c = '_';
  const std::string stem = name;
  for (int n = 2; !taken.insert(name).second; ++n) name = stem + "_" + std::to_string(n);
  return name;
}

std::size_t countVertices(const std::vector<BranchMesh>& meshes) {
  std::size_t count = 0;
  for (const BranchMesh& m : meshes) count += m.position.size();
  return count;
}

std::size_t countFaces(const std::vector<BranchMesh>& meshes) {
  std::size_t count = 0;
  for (const BranchMesh& m : meshes) count += m.triangle.size();
  return count;
}

// Unit; zero for a triangle without area. Edges in floats, the rest in doubles, summed from x to z.
Float3 faceNormal(const BranchMesh& mesh, const Triangle& t) {
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

}  // namespace

std::string encodeObj(const std::vector<BranchMesh>& meshes) {
  std::string out =
      "# lumen " LUMEN_VERSION "\n# millimetres, LPS: +x left, +y posterior, +z superior\n";
  std::set<std::string> taken;
  std::size_t base = 1;
  for (const BranchMesh& branch : meshes) {
    if (branch.triangle.empty()) continue;
    out += "o " + objName(branch.label, taken) + "\n";
    for (const Float3& p : branch.position) putLine(out, "v", p);
    for (const Float3& n : branch.normal) putLine(out, "vn", n);
    for (const Triangle& t : branch.triangle) {
      out += 'f';
      for (const std::uint32_t v : t) {
        out += ' ';
        putNumber(out, base + v);
        out += "//";
        putNumber(out, base + v);
      }
      out += '\n';
    }
    base += branch.position.size();
  }
  return out;
}

std::string encodeStl(const std::vector<BranchMesh>& meshes) {
  const std::size_t faces = countFaces(meshes);
  checkCount(faces, "STL");
  std::string out =
      "lumen " LUMEN_VERSION ", binary STL, mm, LPS (+x left, +y posterior, +z superior)";
  out.resize(80, ' ');
  out.reserve(84 + 50 * faces);
  put(out, static_cast<std::uint32_t>(faces));
  for (const BranchMesh& branch : meshes) {
    for (const Triangle& t : branch.triangle) {
      putVector(out, faceNormal(branch, t));
      for (const std::uint32_t v : t) putVector(out, branch.position[v]);
      put(out, std::uint16_t{0});
    }
  }
  return out;
}

std::string encodePly(const std::vector<BranchMesh>& meshes) {
  const std::size_t vertices = countVertices(meshes), faces = countFaces(meshes);
  checkCount(std::max(vertices, faces), "PLY");
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment lumen " LUMEN_VERSION
                    "\ncomment millimetres, LPS: +x left, +y posterior, +z superior\n";
  for (std::size_t b = 0; b < meshes.size(); ++b) {
    std::set<std::string> taken;
    out += "comment branch " + std::to_string(b) + " " + objName(meshes[b].label, taken) + "\n";
  }
  out += "element vertex " + std::to_string(vertices) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
    out += std::string("property float ") + name + "\n";
  out += "element face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nproperty int branch\nend_header\n";
  out.reserve(out.size() + 24 * vertices + 17 * faces);
  for (const BranchMesh& branch : meshes)
    for (std::size_t v = 0; v < branch.position.size(); ++v) {
      putVector(out, branch.position[v]);
      putVector(out, branch.normal[v]);
    }
  std::int32_t base = 0;
  for (std::size_t b = 0; b < meshes.size(); ++b) {
    for (const Triangle& t : meshes[b].triangle) {
      put(out, std::uint8_t{3});
      for (const std::uint32_t v : t) put(out, base + static_cast<std::int32_t>(v));
      put(out, static_cast<std::int32_t>(b));
    }
    base += static_cast<std::int32_t>(meshes[b].position.size());
  }
  return out;
}

}  // namespace lumen::convert
