// SPDX-License-Identifier: Apache-2.0
// Agreement of a case with its volume (docs/method.md, section 7).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/judge/check/places.h"
#include "converters/judge/check/shared_lumen.h"
#include "converters/judge/check/wall_offsets.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

// Ends of branches of a case, and whether the volume shows that the vessel continues.

/// The first node of a root or the last one of a branch, where nothing of the case is joined to it.
struct OpenEnd {
  std::uint32_t node = 0;
  bool first = false;                                 ///< the branch begins here
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();  ///< unit, along the vessel
  double goesOn = 0;                                  ///< mm of visible vessel beyond it; 0 if none
  std::optional<std::size_t> vessel;  ///< number of the missing vessel that goes on the farthest
};

/// The open ends of all vessels, branch by branch. An end continues in a missing vessel that comes
/// within two radii and three voxels of the node, ahead of it, with its own tip or the place where
/// it was reached from that branch; that vessel gets `atEnd`.
std::vector<OpenEnd> findOpenEnds(const formats::CenterlineTree& tree, double voxel,
                                  std::vector<MissingVessel>& vessels);

/// Position of the wall with respect to the edges of the volume. Lengths in mm, positive where the
/// model is too wide; NaN without samples. Shares refer to the judged samples, in [0, 1].
struct Offsets {
  std::size_t samples = 0;  ///< judged
  std::size_t beside = 0;   ///< not judged, as another part of the tree begins outside
  std::size_t outside = 0;  ///< not judged, as they lie outside of the volume
  double median = 0;        ///< over the samples with an edge, as the following fields
  double absoluteMedian = 0, absoluteP90 = 0;
  double uncorrectedMedian = 0;  ///< from the visible edge, including its blur
  double steepestMedian = 0;     ///< from the steepest change of intensity, including its blur
  /// Contrast of the edges over the standard deviation of the background beyond them, medians; NaN if that is 0.
  double contrastToNoise = 0;
  double beyondVoxel = 0;  ///< share of samples whose wall is over a voxel off its edge
  double noEdge = 0;
  double wrongPolarity = 0;
};

struct BranchCheck {
  std::string label;
  Offsets offsets;
};

/// Verdict on the wall around one node.
enum class Agreement : std::uint8_t {
  NotJudged,
  Good,  ///< at least half of its samples have an edge, half of those within half a voxel
  Fair,  ///< at least half of its samples have an edge, half of those within a voxel
  Poor,
};

struct CheckReport {
  EdgeOptions options;
  double voxelSize = 0;          ///< mm
  std::size_t nodesOutside = 0;  ///< nodes outside of the volume
  Offsets offsets;
  std::vector<BranchCheck> branches;
  std::vector<Agreement> nodes;
  double lumenVolume = 0;  ///< mm^3; volume of the voxels inside
  Regions dark;
  Missing missing;
  std::vector<OpenEnd> ends;
  std::vector<SharedLumen> shared;              ///< overlaps of more than half a voxel
  double shownLength = 0;                       ///< mm of the case's vessels that the volume shows
  [[nodiscard]] double missingLength() const {  ///< mm
    double sum = 0;
    for (const MissingVessel& vessel : missing.vessels) sum += vessel.length;
    return sum;
  }
};

struct CheckResult {
  CheckReport report;
  std::vector<LumenVoxel> lumen;  ///< by index
};

/// The options that the case's tracking recorded; no blur where it recorded none.
EdgeOptions recordedEdgeOptions(const formats::Case& value);

/// The number of nodes outside of the volume. Throws Error(InvalidInput) with the likely reason if
/// all nodes are outside.
std::size_t requireOverlap(const Volume& volume, const formats::CenterlineTree& tree);

/// The difference of the volume from the one from which the case states that it was made; empty if
/// there is none.
struct SourceDifference {
  std::string what;  ///< "size", "spacing", "origin", "direction" or "voxels"
  std::string found, expected;
};
std::optional<SourceDifference> sourceDifference(const formats::SourceVolume& volume,
                                                 const formats::SourceVolume& source);

/// `value` has models. Throws Error(InvalidInput) if none of its nodes lies in the volume, and
/// Error(Cancelled).
CheckResult checkCase(const Volume& volume, const formats::Case& value, const EdgeOptions& options,
                      Progress& progress);

/// The lumen as a label volume with the volume's geometry: 0 outside, 1 for the first branch, and
/// so on.
Volume labelVolume(const VolumeGeometry& geometry, const formats::CenterlineTree& tree,
                   const std::vector<LumenVoxel>& lumen);

}  // namespace lumen::convert
