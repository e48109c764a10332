// SPDX-License-Identifier: Apache-2.0
// The place of trees from files in a scan.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/io/centerline/centerline_file.h"
#include "converters/stages/phantom/design.h"
#include "converters/stages/phantom/scan_look.h"
#include "converters/stages/phantom/smooth_chain.h"

namespace lumen::convert {

/// A turn about `middle`, then a displacement.
struct Placement {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< mm
  Eigen::Vector3d move = Eigen::Vector3d::Zero();    ///< mm
  void apply(CenterlineFile& file) const;
};

/// The placement of trees that lie in one frame: turned by `degrees` about x, y and z, one after the
/// other, about the middle of the box around them; moved by `move`, or, if it is empty, so that the
/// greatest length lies in soft tissue, to a millimetre.
Placement placeTrees(const std::vector<CenterlineFile>& files, const Eigen::Vector3d& degrees,
                     const std::optional<Eigen::Vector3d>& move, const Volume& scan,
                     const ScanLook& look, const Progress& progress);

/// The stretches of vessels that lie in a body.
struct BodyVessels {
  struct Stretch {
    std::int32_t vessel;  ///< index of the vessel it is of
    bool isFirst;         ///< it begins where the vessel does
    Path path;
  };
  std::vector<Stretch> stretches;  ///< in the order of the vessels
  double lost = 0;                 ///< mm of vessel that lie elsewhere
};

/// Cuts vessels where they leave the volume or run into the air around the body.
BodyVessels cutToBody(const std::vector<SmoothVessel>& vessels, const VolumeGeometry& geometry,
                      const std::vector<std::uint8_t>& outerAir);

}  // namespace lumen::convert
