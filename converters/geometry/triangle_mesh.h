// SPDX-License-Identifier: Apache-2.0
// Triangle mesh for algorithms: doubles and indices only.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace lumen::convert {

using Triangle = std::array<std::uint32_t, 3>;

/// An indexed triangle mesh, mm, LPS; triangles counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> position;
  std::vector<Triangle> triangle;
};

}  // namespace lumen::convert
