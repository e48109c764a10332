// SPDX-License-Identifier: Apache-2.0
// The geometry of a C-arm: a point source, and a flat detector behind the patient.
#pragma once

#include <Eigen/Core>

#include "formats/case/case.h"

namespace lumen::convert {

/// Lengths in mm, places in LPS, the patient on the back. The detector's angles are DICOM's
/// positioner angles (PS3.3, C.8.7.5), so that 0, 0 looks from in front, with the patient's left on
/// the right of the picture.
struct XrayView {
  Eigen::Vector3d isocentre = Eigen::Vector3d::Zero();
  double primary = 0;    ///< degrees towards the patient's left (LAO); negative: right (RAO)
  double secondary = 0;  ///< degrees towards the head (CRA); negative: towards the feet (CAU)
  double sourceToIsocentre = 750, sourceToDetector = 1200;
  int width = 512, height = 512;  ///< pixels
  double pixel = 0;               ///< of the detector; square

  /// Unit: from the source to the middle of the detector, to the picture's right, up in it.
  [[nodiscard]] Eigen::Vector3d towards() const;
  [[nodiscard]] Eigen::Vector3d right() const;
  [[nodiscard]] Eigen::Vector3d up() const;
  [[nodiscard]] Eigen::Vector3d source() const;
  /// The middle of a pixel on the detector, from the upper left one.
  [[nodiscard]] Eigen::Vector3d pixelPlace(int x, int y) const;
  /// The solid angle of a pixel as the source sees it.
  [[nodiscard]] double solidAngle(int x, int y) const;
};

/// The isocentre in the middle of the box of all nodes with their radii.
Eigen::Vector3d middleOf(const formats::CenterlineTree& tree);

/// The least size of pixels with which all nodes are in the picture at any angles, with a margin of
/// 3 %.
double pixelFor(const formats::CenterlineTree& tree, const XrayView& view);

/// Throws Error(InvalidInput) where a node's ball of two radii reaches the source or the detector.
void requireBetween(const formats::CenterlineTree& tree, const XrayView& view);

}  // namespace lumen::convert
