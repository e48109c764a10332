// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/volume_mesh/fill_tetrahedra.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/run_program.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/io/mesh/volume_mesh.h"
#include "converters/stages/volume_mesh/netgen/exchange.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

// Netgen makes 5,000 to 10,000 tetrahedra a second.
constexpr unsigned kMostSeconds = 3600;
constexpr const char* kProgram = "lumen-netgen";

std::filesystem::path netgenProgram() {
  std::error_code error;
  const std::filesystem::path beside =
      std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / kProgram;
  if (!error && std::filesystem::is_regular_file(beside, error)) return beside;
  if (const auto installed = installedProgram(kProgram)) return *installed;
  throw unsupported(
      "a volume mesh needs the program lumen-netgen, which lumen builds where Netgen "
      "(libnglib-dev) is, beside lumen or in PATH");
}

/// A connected surface, with the numbers of its vertices in the whole one.
struct Part {
  Exchange<3> surface;
  std::vector<std::uint32_t> vertex;
};

std::vector<Part> connectedParts(const TriangleMesh& surface) {
  DisjointSets sets(surface.position.size());
  for (const Triangle& t : surface.triangle)
    for (const std::uint32_t v : t) sets.join(t[0], v);
  std::vector<Part> parts;
  std::vector<std::uint32_t> partOf(surface.position.size(), kAbsent), local(partOf);
  for (const Triangle& t : surface.triangle) {
    std::uint32_t& number = partOf[sets.find(t[0])];
    if (number == kAbsent) {
      number = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    Part& part = parts[number];
    Triangle& triangle = part.surface.cell.emplace_back(t);
    for (std::uint32_t& v : triangle) {
      if (local[v] == kAbsent) {
        local[v] = static_cast<std::uint32_t>(part.vertex.size());
        part.vertex.push_back(v);
        const Vector3d& p = surface.position[v];
        part.surface.point.push_back({p.x(), p.y(), p.z()});
      }
      v = local[v];
    }
  }
  return parts;
}

bool keepsPoints(const Exchange<3>& surface, const Exchange<4>& volume) {
  if (volume.point.size() < surface.point.size()) return false;
  for (const auto& cell : volume.cell)
    if (*std::max_element(cell.begin(), cell.end()) >= volume.point.size()) return false;
  return std::equal(surface.point.begin(), surface.point.end(), volume.point.begin());
}

void orient(Exchange<4>& volume) {
  const auto at = [&volume](std::uint32_t v) {
    return Vector3d(volume.point[v][0], volume.point[v][1], volume.point[v][2]);
  };
  for (auto& t : volume.cell) {
    const Vector3d a = at(t[0]);
    if ((at(t[1]) - a).cross(at(t[2]) - a).dot(at(t[3]) - a) < 0) std::swap(t[2], t[3]);
  }
}

/// Nothing if Netgen could not fill the part.
std::optional<Exchange<4>> filled(const Part& part, const std::filesystem::path& program,
                                  const Progress& progress) {
  const PrivateFolder folder;
  if (!part.surface.write(folder.path() / "surface"))
    throw failed("temporary file for Netgen, in the folder of TMPDIR: it cannot be written");
  ProgramCall call;
  call.program = program;
  call.arguments = {"surface", "volume"};
  call.folder = folder.path();
  call.seconds = kMostSeconds;
  Exchange<4> volume;
  if (runProgram(call, progress).end != ProgramEnd::Done) return {};
  if (!volume.read(folder.path() / "volume") || !keepsPoints(part.surface, volume)) return {};
  orient(volume);
  return volume;
}

void append(const Part& part, const Exchange<4>& volume, std::size_t points, Tetrahedra& result) {
  const std::size_t kept = part.vertex.size(), first = points + result.added.size();
  for (std::size_t k = kept; k < volume.point.size(); ++k)
    result.added.emplace_back(volume.point[k][0], volume.point[k][1], volume.point[k][2]);
  for (auto cell : volume.cell) {
    for (std::uint32_t& v : cell)
      v = v < kept ? part.vertex[v] : static_cast<std::uint32_t>(first + v - kept);
    result.cell.push_back(cell);
  }
}

}  // namespace

Tetrahedra fillTetrahedra(const TriangleMesh& surface, const FieldWord& word, Progress& progress) {
  const std::filesystem::path program = netgenProgram();
  const std::vector<Part> parts = connectedParts(surface);
  std::vector<std::optional<Exchange<4>>> volumes(parts.size());
  progress.begin("tetrahedra", parts.size());
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t k) {
    volumes[k] = filled(parts[k], program, progress);
    progress.advance();
  });
  progress.end();
  Tetrahedra result;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (!volumes[k])
      throw failed("Netgen could not fill the surface with tetrahedra; another " + word("edge") +
                   ", or fewer " + word("layers") + ", may help");
    append(parts[k], *volumes[k], surface.position.size(), result);
  }
  return result;
}

}  // namespace lumen::convert
