// SPDX-License-Identifier: Apache-2.0
// Comparison of a case with the truth (docs/method.md, section 6).
//
// Centerlines. Both trees are sampled at one even step: a quarter of the truth's voxel, at most 0.1
// mm, but no finer than 1/6000 of the longest branch. The centerline of a found branch begins with
// the straight link from its parent node. Measures are those of Schaap et al., "Standardized
// evaluation methodology and reference database for evaluating coronary artery centerline
// extraction algorithms" (2009), with the true radius as the tolerance.
//
// Assignment of found branches to a true branch:
// - the one with the same label, if there is one;
// - otherwise the stretches of other found branches whose samples lie in this true branch's lumen
//   more deeply than in any other's, as far as they answer for no other true branch; a stretch of
//   which more than half lies along another, longer stretch is not used.
//
// Ignored parts:
// - the beginning of a true child, as far as it lies in its parent's lumen;
// - the beginning of the found child, as far as it lies in that lumen too. If that beginning is
//   longer than the true child's by more than two parent radii, the rest is false;
// - samples of a link within any true lumen, which are never false.
//
// The overall score pools all vessels; aneurysms have a centerline by convention only, so they are
// scored among the branches but left out of it. The false length of the overall score holds
// everything found that no true branch was matched with: branches without a counterpart, wrong
// turns, and second copies of a vessel.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct Quantiles {
  double median = 0, p90 = 0, max = 0;
};

/// Lengths in mm. A value without anything to average is NaN.
struct CenterlineScore {
  /// OV = (TPM + TPR) / (TPM + TPR + FN + FP), in [0, 1]. Samples of the two centerlines are paired
  /// by the ordered correspondence of least total distance; a true sample is TPR if one of its
  /// partners is within its radius and FN otherwise, a found sample is TPM if it is within the
  /// radius of one of its partners and FP otherwise.
  double overlap = 0;
  /// OF, in [0, 1]: the share of the true samples that come before the first FN. FN within one
  /// diameter of the start are passed over and not counted (Schaap: within 5 mm, the mean diameter
  /// there).
  double overlapUntilFirstError = 0;
  /// AI: mean distance of the pairs that are closer than the true radius.
  double averageInside = 0;
  /// Mean distance to the other centerline over the samples of both, by the assignment of branches.
  double assd = 0;
  /// Mean distance to the other centerline over the samples of both whose distance is below the
  /// mean true radius of the branch (Yureidini's thesis, eq. 3.9 and 3.10).
  double assdLimited = 0;
  /// Found minus true radius at the nearest true centerline point, mean over the matched found
  /// samples that are not on a link, and its root mean square.
  double radiusBias = 0;
  double radiusRms = 0;
  double missed = 0;  ///< true length without a found centerline of any branch within its radius
  double falseLength = 0;  ///< found length that is not there; see above
};

struct BranchComparison {
  std::string label;
  CenterlineScore score;
  /// Wall distance, mm, over the samples nearest to this branch; absent if there are none.
  std::optional<Quantiles> wallDistance;
};

struct Comparison {
  CenterlineScore score;
  /// Distance, mm, of the case's surface to the wall of the true tree: the union of the round cones
  /// between its nodes. The surface is that of the blended field, as spec/lumen.md defines it:
  /// sampled where wall points project on it along the gradient, or, without points, along rays
  /// from the node's centre. Samples count only within the node's own power cell, that is where
  /// following ends at the node, and away from ends and junctions: not beyond the first or the last
  /// node of their found branch; nearest to a part of the true axis that is farther than the true
  /// radius from both ends of the true branch; and farther than that radius from the wall of every
  /// other true branch that the nearest one is joined to (its parent, its children). The last node
  /// of an aneurysm is the centre of its sac, hence no end. Absent if the case has no models or no
  /// sample is left.
  std::optional<Quantiles> wallDistance;
  std::vector<BranchComparison> branches;  ///< one per true branch, in its order
};

/// Neither case needs more than a tree. Throws Error(InvalidInput) if the truth has no branch, and
/// Error(Cancelled).
Comparison compareCases(const formats::Case& found, const formats::Case& truth, Progress& progress);

// Centerline measures, and the assignment of found branches to true ones.

struct CenterlineComparison {
  CenterlineScore all;                  ///< vessels only
  std::vector<CenterlineScore> branch;  ///< one per true branch
};

/// The scores by the rules of compare.h. `step`: mm between samples.
CenterlineComparison compareCenterlines(const formats::CenterlineTree& found,
                                        const formats::CenterlineTree& truth, double step,
                                        Progress& progress);

// Distance of a case's surface from the true wall.

struct WallComparison {
  std::optional<Quantiles> all;
  std::vector<std::optional<Quantiles>> branch;  ///< one per true branch
};

/// The distances of Comparison::wallDistance. `found` has models.
WallComparison compareWalls(const formats::Case& found, const formats::CenterlineTree& truth,
                            Progress& progress);

}  // namespace lumen::convert
