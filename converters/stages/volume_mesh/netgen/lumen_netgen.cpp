// SPDX-License-Identifier: Apache-2.0
// lumen-netgen SURFACE VOLUME: fills a closed surface with tetrahedra by Netgen's nglib. It is a program of its own,
// since Netgen prints, writes into the working folder, cannot be cancelled, and brings
// libraries that nothing else in lumen needs. Exit status: 0 done, 1 Netgen could not, 2 a file
// cannot be read or written.
#include <array>
#include <cstdint>

#include "converters/stages/volume_mesh/netgen/exchange.h"

namespace nglib {
#include <nglib.h>
}

namespace {

// Edges may be as long as the gradation from the surface's own allows.
constexpr double kAnyLength = 1e9;
// Growth of edges away from the surface: Netgen's own value.
constexpr double kGrading = 0.3;
// Rounds of optimisation; the second and third raise the least quality by little.
constexpr int kRounds = 2;

nglib::Ng_Mesh* meshOf(const lumen::convert::Exchange<3>& surface) {
  nglib::Ng_Mesh* const mesh = nglib::Ng_NewMesh();
  for (auto point : surface.point) nglib::Ng_AddPoint(mesh, point.data());
  for (const auto& triangle : surface.cell) {
    std::array<int, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) corner[k] = static_cast<int>(triangle[k]) + 1;
    nglib::Ng_AddSurfaceElement(mesh, nglib::NG_TRIG, corner.data());
  }
  return mesh;
}

lumen::convert::Exchange<4> cellsOf(nglib::Ng_Mesh* mesh) {
  lumen::convert::Exchange<4> volume;
  for (int k = 1; k <= nglib::Ng_GetNP(mesh); ++k)
    nglib::Ng_GetPoint(mesh, k, volume.point.emplace_back().data());
  std::array<int, NG_VOLUME_ELEMENT_MAXPOINTS> corner{};
  for (int k = 1; k <= nglib::Ng_GetNE(mesh); ++k) {
    if (nglib::Ng_GetVolumeElement(mesh, k, corner.data()) != nglib::NG_TET) return {};
    auto& cell = volume.cell.emplace_back();
    for (std::size_t c = 0; c < 4; ++c) cell[c] = static_cast<std::uint32_t>(corner[c] - 1);
  }
  return volume;
}

}  // namespace

int main(int count, char** words) {
  lumen::convert::Exchange<3> surface;
  if (count != 3 || !surface.read(words[1])) return 2;
  nglib::Ng_Init();
  nglib::Ng_Mesh* const mesh = meshOf(surface);
  nglib::Ng_Meshing_Parameters options;
  options.maxh = kAnyLength;
  options.grading = kGrading;
  options.optsteps_3d = kRounds;
  if (nglib::Ng_GenerateVolumeMesh(mesh, &options) != nglib::NG_OK) return 1;
  const lumen::convert::Exchange<4> volume = cellsOf(mesh);
  if (volume.cell.empty()) return 1;
  return volume.write(words[2]) ? 0 : 2;
}
