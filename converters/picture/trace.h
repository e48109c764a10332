// SPDX-License-Identifier: Apache-2.0
// The blended surface of a case as rays meet it.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/common/progress.h"
#include "converters/picture/camera.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// What each pixel of a camera shows; rows from the top.
struct TracedSurface {
  static constexpr float kNothing = -std::numeric_limits<float>::infinity();
  int width = 0, height = 0;
  std::vector<float> depth;             ///< mm towards the viewer; kNothing where no vessel is
  std::vector<Eigen::Vector3f> normal;  ///< unit, out of the lumen, in the camera's axes
  std::vector<std::uint32_t> node;      ///< at which a cursor on the surface is

  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] bool isHit(std::size_t pixel) const { return depth[pixel] > kNothing; }
};

/// Sphere tracing (J. C. Hart, 1996) of libblob's distance, along the tree: a ray enters the ball around a node with
/// that node's cursor, so vessels that touch stay apart. Balls go from front to back, and end where something nearer
/// was met. `file`: the bytes of the case, which has models. On all cores; the same bits on any number of them.
/// Throws Error(Cancelled), and Error(Failed) if libblob does not take the file.
TracedSurface traceSurface(const formats::CenterlineTree& tree, std::span<const std::byte> file,
                           const Camera& camera, Progress& progress);

}  // namespace lumen::convert
