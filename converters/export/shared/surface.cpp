// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/surface.h"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/number_text.h"
#include "converters/base/run_program.h"
#include "converters/base/vectors.h"
#include "converters/geometry/disjoint_sets.h"

namespace lumen::convert {

namespace {

ExportedSurface surfaceWith(const ExportInput& input, const ClosedSurfaceOptions& options) {
  ClosedSurface made = closedSurface(input.source, options, input.progress);
  ExportedSurface result;
  result.ends = findEnds(made.levels.front());
  result.mesh = input.frame.of(std::move(made.levels.front()));
  for (std::size_t level = 1; level < made.levels.size(); ++level)
    result.coarser.push_back(input.frame.of(std::move(made.levels[level])));
  result.report = std::move(made.report);
  return result;
}

}  // namespace

ExportedSurface lumenSurface(const ExportInput& input, std::optional<double> gap) {
  ClosedSurfaceOptions options = input.options.surface;
  if (gap) options.gap = gap;
  options.thickness.reset();
  return surfaceWith(input, options);
}

ExportedSurface wallSurface(const ExportInput& input, const Length& usual) {
  ClosedSurfaceOptions options = input.options.surface;
  if (!options.thickness) options.thickness = usual;
  return surfaceWith(input, options);
}

Box3d boundingBox(const SurfaceMesh& mesh) {
  Box3d box;
  for (const Float3& p : mesh.position) box.add(toEigen(p));
  return box;
}

namespace {

// A surface of 200,000 triangles takes it a minute.
constexpr unsigned kMostSeconds = 900;

using Corners = std::array<std::uint32_t, 3>;

/// A piecewise linear complex as TetGen reads it, counted from 0.
void writeComplex(const SurfaceMesh& surface, const std::filesystem::path& path) {
  std::string text = std::to_string(surface.position.size()) + " 3 0 0\n";
  for (std::size_t v = 0; v < surface.position.size(); ++v) {
    const Float3& p = surface.position[v];
    text += std::to_string(v);
    for (const float coordinate : p) text.append(" ").append(numberText(double{coordinate}));
    text += '\n';
  }
  text += std::to_string(surface.triangle.size()) + " 0\n";
  for (const Triangle& t : surface.triangle)
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) +
            "\n";
  text += "0\n0\n";
  writeNewFile(text, path, "temporary file for TetGen, in the folder of TMPDIR");
}

/// Rows of numbers behind a header that counts them; false if the file is something else.
template <class VisitRow>
bool readRows(const std::filesystem::path& path, const VisitRow& row) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(path, error);
  std::ifstream file(path);
  std::size_t count = 0;
  std::string rest;
  // each row takes two bytes at least
  if (error || !(file >> count) || !std::getline(file, rest) || count > bytes / 2) return false;
  for (std::size_t k = 0; k < count; ++k) {
    std::size_t number = 0;
    if (!(file >> number) || number != k || !row(file) || !std::getline(file, rest)) return false;
  }
  return true;
}

std::optional<VolumeMesh> readMesh(const std::filesystem::path& folder) {
  VolumeMesh mesh;
  const bool read = readRows(folder / "surface.1.node",
                             [&](std::istream& in) {
                               auto& p = mesh.position.emplace_back();
                               return static_cast<bool>(in >> p[0] >> p[1] >> p[2]);
                             }) &&
                    readRows(folder / "surface.1.ele", [&](std::istream& in) {
                      auto& t = mesh.tetrahedron.emplace_back();
                      return static_cast<bool>(in >> t[0] >> t[1] >> t[2] >> t[3]) &&
                             *std::max_element(t.begin(), t.end()) < mesh.position.size();
                    });
  if (!read || mesh.tetrahedron.empty()) return {};
  return mesh;
}

void orient(VolumeMesh& mesh) {
  const auto at = [&mesh](std::uint32_t v) {
    return Eigen::Vector3d(mesh.position[v][0], mesh.position[v][1], mesh.position[v][2]);
  };
  for (auto& t : mesh.tetrahedron) {
    const Eigen::Vector3d a = at(t[0]);
    if ((at(t[1]) - a).cross(at(t[2]) - a).dot(at(t[3]) - a) < 0) std::swap(t[2], t[3]);
  }
}

void findRegions(VolumeMesh& mesh) {
  DisjointSets sets(mesh.position.size());
  for (const auto& t : mesh.tetrahedron)
    for (const std::uint32_t v : t) sets.join(t[0], v);
  std::map<std::uint32_t, std::uint32_t> numbers;
  for (const auto& t : mesh.tetrahedron)
    mesh.region.push_back(
        numbers.emplace(sets.find(t[0]), static_cast<std::uint32_t>(numbers.size() + 1))
            .first->second);
}

Corners sorted(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  Corners corners{a, b, c};
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// False if a triangle of the surface is not a face of a tetrahedron.
bool findElements(const SurfaceMesh& surface, VolumeMesh& mesh) {
  std::vector<std::pair<Corners, std::uint32_t>> faces;
  const auto inSurface = [&](std::uint32_t v) { return v < surface.position.size(); };
  for (std::uint32_t e = 0; e < mesh.tetrahedron.size(); ++e)
    for (std::size_t left = 0; left < 4; ++left) {
      const auto& t = mesh.tetrahedron[e];
      const Corners face = sorted(t[(left + 1) % 4], t[(left + 2) % 4], t[(left + 3) % 4]);
      if (std::all_of(face.begin(), face.end(), inSurface)) faces.emplace_back(face, e);
    }
  std::sort(faces.begin(), faces.end());
  for (const Triangle& t : surface.triangle) {
    const std::pair<Corners, std::uint32_t> wanted{sorted(t[0], t[1], t[2]), 0};
    const auto found = std::lower_bound(faces.begin(), faces.end(), wanted);
    if (found == faces.end() || found->first != wanted.first) return false;
    mesh.elementOf.push_back(found->second);
  }
  return true;
}

bool keepsSurface(const SurfaceMesh& surface, const VolumeMesh& mesh) {
  if (mesh.position.size() < surface.position.size()) return false;
  for (std::size_t v = 0; v < surface.position.size(); ++v)
    for (std::size_t a = 0; a < 3; ++a)
      if (static_cast<float>(mesh.position[v][a]) != surface.position[v][a]) return false;
  return true;
}

}  // namespace

std::optional<VolumeMesh> volumeMesh(const SurfaceMesh& surface, const FieldWord& word,
                                     Progress& progress, std::string& why) {
  const auto program = installedProgram("tetgen");
  if (!program) {
    why = "TetGen is not installed, so there is no volume mesh";
    return {};
  }
  const PrivateFolder folder;
  progress.begin("volume mesh", 0);
  writeComplex(surface, folder.path() / "surface.smesh");
  // a complex whose faces stay; ratio of radius to edge 1.4 at most; from 0; quiet; without faces
  ProgramCall call;
  call.program = *program;
  call.arguments = {"-pYq1.4zQF", "surface.smesh"};
  call.folder = folder.path();
  call.seconds = kMostSeconds;
  const ProgramEnd end = runProgram(call, progress).end;
  progress.end();
  if (end == ProgramEnd::TookTooLong) {
    why = "TetGen was not done in " + std::to_string(kMostSeconds / 60) +
          " minutes, so there is no volume mesh; a larger " + word("edge") + " helps";
    return {};
  }
  std::optional<VolumeMesh> mesh;
  if (end == ProgramEnd::Done) mesh = readMesh(folder.path());
  if (!mesh || !keepsSurface(surface, *mesh) || !findElements(surface, *mesh)) {
    why = "TetGen could not fill this surface, so there is no volume mesh; another " +
          word("edge") + " may help";
    return {};
  }
  orient(*mesh);
  findRegions(*mesh);
  return mesh;
}

}  // namespace lumen::convert
