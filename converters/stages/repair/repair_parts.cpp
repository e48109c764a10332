// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "converters/io/mesh/mesh_builder.h"
#include "converters/stages/repair/repair_steps.h"

namespace lumen::convert {
namespace {

// Share of the box's diagonal: debris of a segmentation, far below any vessel of the mesh.
constexpr double kTinyPart = 0.01;
// 36 pi V^2 / A^3 is 1 of a sphere and 4.5 r / l of a tube; sheets have rounding.
constexpr double kEnclosesNothing = 1e-6;

struct Part {
  double area = 0, volume = 0;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  std::size_t triangles = 0;

  [[nodiscard]] bool isSheet() const {
    return !(36 * std::numbers::pi * volume * volume > kEnclosesNothing * area * area * area);
  }
};

/// The parts' sizes; volumes with the openings closed by fans.
std::vector<Part> measured(const MeshInRepair& work, const std::vector<std::uint32_t>& part,
                           std::size_t count) {
  std::vector<Part> parts(count);
  const std::vector<Eigen::Vector3d>& position = work.mesh.position;
  std::vector<std::uint32_t> partOfPoint(position.size(), 0);
  const Eigen::Vector3d origin = boundingBox(work.mesh).low;
  for (std::size_t t = 0; t < work.mesh.triangle.size(); ++t) {
    Part& p = parts[part[t]];
    const Triangle& corner = work.mesh.triangle[t];
    p.area += vectorArea(work.mesh, corner).norm();
    p.volume += tetrahedronVolume(position[corner[0]] - origin, position[corner[1]] - origin,
                                  position[corner[2]] - origin);
    for (const std::uint32_t v : corner) {
      partOfPoint[v] = part[t];
      p.low = p.low.cwiseMin(position[v]);
      p.high = p.high.cwiseMax(position[v]);
    }
    ++p.triangles;
  }
  for (const BoundaryLoop& loop : findBoundaryLoops(work)) {
    const std::size_t n = loop.vertex.size();
    for (std::size_t i = 0; i < n; ++i)
      parts[partOfPoint[loop.vertex[0]]].volume +=
          tetrahedronVolume(position[loop.vertex[(i + 1) % n]] - origin,
                            position[loop.vertex[i]] - origin, loop.centre - origin);
  }
  return parts;
}

}  // namespace

std::vector<std::uint32_t> labelParts(const MeshInRepair& work, std::size_t& count) {
  std::vector<std::uint32_t> part(work.mesh.triangle.size(), kNoSide), open;
  count = 0;
  for (std::uint32_t seed = 0; seed < part.size(); ++seed) {
    if (part[seed] != kNoSide) continue;
    const auto index = static_cast<std::uint32_t>(count++);
    open.assign(1, seed);
    part[seed] = index;
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      for (std::uint32_t s = 3 * t; s < 3 * t + 3; ++s) {
        const std::uint32_t o = work.opposite[s];
        if (o == kNoSide || part[o / 3] != kNoSide) continue;
        part[o / 3] = index;
        open.push_back(o / 3);
      }
    }
  }
  return part;
}

std::size_t settleParts(MeshInRepair& work, const std::string& name) {
  std::size_t count = 0;
  const std::vector<std::uint32_t> part = labelParts(work, count);
  const std::vector<Part> parts = measured(work, part, count);
  const double tiny = kTinyPart * boundingBox(work.mesh).size().norm();
  std::size_t sheets = 0, small = 0, turned = 0;
  std::vector<bool> dropPart(count, false);
  for (std::size_t p = 0; p < count; ++p) {
    const bool isSmall = (parts[p].high - parts[p].low).norm() < tiny;
    dropPart[p] = parts[p].isSheet() || isSmall;
    ++(parts[p].isSheet() ? sheets : isSmall ? small : turned);
  }
  const std::size_t kept = turned;
  const std::size_t n = work.mesh.triangle.size();
  if (kept == 0)
    refuseMesh(name, "",
               (n == 1 ? std::string("its one triangle encloses")
                       : "its " + std::to_string(n) + " triangles enclose") +
                   " no volume; expected a surface that is closed, or open at vessels' ends");
  turned = 0;
  for (std::size_t p = 0; p < count; ++p)
    if (!dropPart[p] && parts[p].volume < 0) ++turned;
  std::vector<bool> drop(n, false);
  for (std::size_t t = 0; t < n; ++t) {
    drop[t] = dropPart[part[t]];
    if (parts[part[t]].volume < 0) std::swap(work.mesh.triangle[t][1], work.mesh.triangle[t][2]);
  }
  work.dropTriangles(drop);
  work.record("dropped", sheets, "part that encloses nothing", "parts that enclose nothing");
  work.record("dropped", small, "part smaller than a hundredth of the mesh",
              "parts smaller than a hundredth of the mesh");
  work.record("turned", turned, "part, which was inside out", "parts, which were inside out");
  dropUnusedPoints(work);
  work.opposite = oppositeSides(work.mesh.triangle);
  return kept;
}

}  // namespace lumen::convert
