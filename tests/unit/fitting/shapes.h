// SPDX-License-Identifier: Apache-2.0
// Synthetic vessels with known walls, as the tracker would hand them to the fit: nodes along the
// centerlines, and the points where rays from each node meet the wall.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/case/blobby.h"
#include "formats/case/case.h"

namespace lumen::test {

using formats::Vec3d;

/// All points within `radius` of a polyline.
struct Tube {
  std::vector<Vec3d> line;
  double radius = 1;
};

struct Shape {
  std::vector<Tube> tubes;
  [[nodiscard]] double signedDistance(const Vec3d& p) const;  ///< mm, negative inside
  [[nodiscard]] Vec3d normal(const Vec3d& p) const;           ///< gradient of the distance
};

struct TrackedShape {
  Shape shape;
  formats::Case value;  ///< tree and points; voxel size 0.2 mm
};

struct TrackingOptions {
  double noise = 0;      ///< standard deviation along the wall's normal, mm
  double spacing = 0.5;  ///< of the nodes, in radii
  int rays = 162;
  std::uint64_t seed = 1;
};

/// "tube": straight, 8 radii long, and the vessel goes on beyond both ends; "bend": the same on a
/// circle of 3 radii; "bifurcation": a child of 0.7 radii at 60 degrees; "capsule": closed by half
/// spheres.
TrackedShape trackShape(const std::string& name, double radius, const TrackingOptions& options);

/// `nodes` nodes in branches of 200, tubes of radii from 0.4 to 2.2 mm: a load for timing.
formats::Case manyNodes(std::size_t nodes, double noise);

/// Distances, mm, from the true wall to the fitted one along the wall's normal, at samples of the
/// true wall whose node (by power distance) is at least `fromEnd` nodes away from its branch's
/// ends.
std::vector<double> wallDistances(const TrackedShape& tracked, std::uint32_t fromEnd);

/// For the names of tests.
std::string kernelName(formats::Kernel kernel);

double percentile(std::vector<double> values, double share);

/// Centre and width of each blob of a node's model, mm.
inline std::vector<std::array<float, 4>> blobsOf(const formats::Case& value, std::uint32_t node) {
  std::vector<std::array<float, 4>> blobs;
  for (std::uint32_t k = value.models->offset[node]; k < value.models->offset[node + 1]; ++k) {
    const auto& c = value.models->centre[k];
    blobs.push_back({c.x, c.y, c.z, value.models->width[k]});
  }
  return blobs;
}

}  // namespace lumen::test
