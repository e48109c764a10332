// SPDX-License-Identifier: Apache-2.0
// How well a case agrees with its volume (docs/method.md, section 7).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/judge/check/open_ends.h"
#include "converters/judge/check/places.h"
#include "converters/judge/check/wall_offsets.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Where the wall lies with respect to the edges of the volume. Lengths in mm, positive where the
/// model is too wide; those of no sample are NaN. Shares are of the judged samples, in [0, 1].
struct Offsets {
  std::size_t samples = 0;  ///< judged
  std::size_t beside = 0;   ///< not judged, as another part of the tree begins outside
  std::size_t outside = 0;  ///< not judged, as they lie outside of the volume
  double median = 0;        ///< over the samples with an edge, as the next ones
  double absoluteMedian = 0, absoluteP90 = 0;
  double uncorrectedMedian = 0;  ///< from the edge as it is seen, blur and all
  double steepestMedian = 0;     ///< from where the intensity changes most, blur and all
  double beyondVoxel = 0;        ///< share whose wall is more than a voxel off its edge
  double noEdge = 0;
  double wrongPolarity = 0;
};

struct BranchCheck {
  std::string label;
  Offsets offsets;
};

/// The wall around one node.
enum class Agreement : std::uint8_t {
  NotJudged,
  Good,  ///< at least half of its samples have an edge, half of those within half a voxel
  Fair,  ///< the same within a voxel
  Poor,
};

struct CheckReport {
  EdgeOptions options;
  double voxelSize = 0;          ///< mm
  std::size_t nodesOutside = 0;  ///< nodes outside of the volume
  Offsets offsets;
  std::vector<BranchCheck> branches;
  std::vector<Agreement> nodes;
  double lumenVolume = 0;  ///< mm^3, of the voxels inside
  Regions dark;
  Missing missing;
  std::vector<OpenEnd> ends;
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

/// What the case's tracking recorded; no blur where it recorded none.
EdgeOptions recordedEdgeOptions(const formats::Case& value);

/// How many nodes lie outside of the volume. Throws Error(InvalidInput) if all do, with the likely reason.
std::size_t requireOverlap(const Volume& volume, const formats::CenterlineTree& tree);

/// How the volume differs from the one that the case says that it was made from; nothing if it does
/// not differ.
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

/// The lumen as a label volume of the same geometry: 0 outside, 1 for the first branch, and so on.
Volume labelVolume(const VolumeGeometry& geometry, const formats::CenterlineTree& tree,
                   const std::vector<LumenVoxel>& lumen);

}  // namespace lumen::convert
