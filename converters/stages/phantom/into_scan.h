// SPDX-License-Identifier: Apache-2.0
// Trees from files, drawn into a real scan: everything around the vessels is the scan's own.
//
// The scan's tissue gives way to lumen by the share a of each voxel that lies in a vessel, blurred by
// the point spread that is measured in the scan (scan_look.h). A voxel of value g becomes
// g + a (t - g) + c + n s sqrt(a (2 - a)), where t is the level of soft tissue, c the blurred contrast,
// s the noise of soft tissue and n noise of standard deviation 1 whose neighbours are as alike as the
// scan's. So a voxel whose own noise is lost by a gets as much again. Where a is less than that of a
// flat wall three spreads away, the voxel stays as it is.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "converters/base/options/option_table.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/phantom/scan_look.h"

namespace lumen::convert {

struct IntoOptions {
  std::filesystem::path
      veins;              ///< an SWC file in mm, in the frame of the tree; empty: arteries only
  double contrast = 300;  ///< of arteries over soft tissue, in the scan's units
  double veinContrast = 180;
  std::optional<Eigen::Vector3d> move;             ///< mm; empty: found (placing.h)
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  ///< degrees about x, y and z

  /// Adds the rows of both contrasts, stored in this object.
  void addRows(OptionTable& table);
};

struct IntoResult {
  Phantom phantom;  ///< the scan with its vessels, in its own type of voxels
  ScanLook look;
  Eigen::Vector3d move = Eigen::Vector3d::Zero();  ///< mm, as it was used
  double lost = 0;  ///< mm of vessel outside of the body, which are not drawn
};

/// Draws the trees of `options.tree` and `into.veins` into `scan`. Branches are b000, b001 and so on;
/// with veins artery-000 and so on, and vein-000. Vessels end where they leave the volume or the body.
/// Takes `seed`, `fade` and the clicks of `options`. Throws as makePhantom() and measureScan() do, and
/// Error(InvalidInput) if no vessel lies in the body.
IntoResult drawIntoScan(const PhantomOptions& options, const IntoOptions& into, Volume scan,
                        Progress& progress);

}  // namespace lumen::convert
