// SPDX-License-Identifier: Apache-2.0
// Parallel views of a case.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "formats/case/case.h"

namespace lumen::convert {

/// From which side of the patient; Best: along the direction in which the vessels extend least.
enum class View : std::uint8_t { Best, Anterior, Posterior, Left, Right, Superior, Inferior };

/// A parallel projection. Rows of `axes` are unit vectors in LPS: to the right of the picture, up, and towards the
/// viewer; they are a right-handed frame.
struct Camera {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< mm, LPS: in the middle of the picture
  double scale = 1;                                  ///< pixels for a millimetre
  int width = 0, height = 0;                         ///< pixels

  /// Pixels from the upper left corner, and mm towards the viewer.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& lps) const;
  /// The place at a pixel, `depth` mm towards the viewer.
  [[nodiscard]] Eigen::Vector3d place(double x, double y, double depth) const;
};

/// The view of all vessels with a margin. `turn`: radians about the axis from foot to head, to the patient's left,
/// for views from the side. The tree has a node.
Camera cameraFor(const formats::CenterlineTree& tree, View view, double turn, int width,
                 int height);

}  // namespace lumen::convert
