// SPDX-License-Identifier: Apache-2.0
// Parallel views of a case.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "formats/case/case.h"

namespace lumen::convert {

/// Side of the patient; Best: along the direction in which the vessels extend least.
enum class View : std::uint8_t { Best, Anterior, Posterior, Left, Right, Superior, Inferior };

/// A parallel projection. Rows of `axes` are unit vectors in LPS: to the right of the picture, up,
/// and towards the viewer; they are a right-handed frame. From in front, the patient's left is on
/// the right.
struct Camera {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< mm, LPS: in the middle of the picture
  double scale = 1;                                  ///< pixels for a millimetre
  int width = 0, height = 0;                         ///< pixels

  /// Pixels from the upper left corner, and mm towards the viewer.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& lps) const;
  /// The place at a pixel, `depth` mm towards the viewer.
  [[nodiscard]] Eigen::Vector3d place(double x, double y, double depth) const;
  /// The view with N times the pixels each way; 1/N: with an Nth of them.
  [[nodiscard]] Camera scaled(double times) const;
};

/// The vessels and the place for them in a picture.
struct Framing {
  View view = View::Best;
  /// Radians about the upright axis of the unturned picture, which from the sides is that from foot
  /// to head: from in front to the patient's left.
  double turn = 0;
  /// Centre and scale are those at which the vessels are in the picture at any turn.
  bool allTurns = false;
  int width = 0, height = 0;
  double margin = 0;  ///< pixels that at least stay free above and below
};

/// The view of all vessels with a margin of 6 % on each side, or more. The tree has a node.
Camera cameraFor(const formats::CenterlineTree& tree, const Framing& framing);

}  // namespace lumen::convert
