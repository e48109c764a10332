// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <variant>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/judge/measure/shown_radius.h"
#include "converters/stages/finding/bright_voxels.h"
#include "converters/voxels/image_region.h"
#include "formats/case/case_field.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

// Missing vessels begin two voxels outside of the lumen, which ends up to a radius beyond its node.
constexpr double kNearRadii = 2, kNearVoxels = 3;

std::vector<OpenEnd> listOpenEnds(const formats::CenterlineTree& tree) {
  std::vector<std::uint8_t> joined(tree.nodeCount(), 0);
  for (const formats::Branch& branch : tree.branches)
    if (branch.parentNode >= 0) joined[static_cast<std::size_t>(branch.parentNode)] = 1;
  for (const auto& link : tree.links)
    for (const std::uint32_t node : link) joined[node] = 1;
  std::vector<OpenEnd> ends;
  for (const formats::Branch& branch : tree.branches) {
    if (branch.kind != formats::BranchKind::Vessel) continue;
    const std::uint32_t first = branch.firstNode, last = first + branch.nodeCount - 1;
    if (branch.parentNode < 0 && joined[first] == 0)
      ends.push_back({first, true, -toEigen(tree.direction[first]), 0, {}});
    if (joined[last] == 0) ends.push_back({last, false, toEigen(tree.direction[last]), 0, {}});
  }
  return ends;
}

/// Length, mm, from the node along the vessel to its farther tip; 0 if the vessel does not begin
/// there.
double lengthBeyond(const formats::CenterlineTree& tree, const OpenEnd& end, double voxel,
                    const MissingVessel& vessel) {
  const Vector3d centre = toEigen(tree.centre[end.node]);
  double best = kNearRadii * static_cast<double>(tree.radius[end.node]) + kNearVoxels * voxel;
  std::size_t nearest = vessel.path.size();
  for (std::size_t i = 0; i < vessel.path.size(); ++i) {
    const Vector3d away = vessel.path[i].position - centre;
    // a vessel that only passes by comes near with its middle
    const bool tip = i == 0 || i + 1 == vessel.path.size();
    if (away.norm() > best || away.dot(end.outward) <= 0 ||
        (!tip && tree.branch[vessel.path[i].node] != tree.branch[end.node]))
      continue;
    best = away.norm();
    nearest = i;
  }
  if (nearest == vessel.path.size()) return 0;
  const auto share = static_cast<double>(nearest) /
                     static_cast<double>(std::max<std::size_t>(vessel.path.size() - 1, 1));
  return best + std::max(share, 1 - share) * vessel.length;
}

}  // namespace

std::vector<OpenEnd> findOpenEnds(const formats::CenterlineTree& tree, double voxel,
                                  std::vector<MissingVessel>& vessels) {
  std::vector<OpenEnd> ends = listOpenEnds(tree);
  for (OpenEnd& end : ends)
    for (std::size_t v = 0; v < vessels.size(); ++v) {
      const double beyond = lengthBeyond(tree, end, voxel, vessels[v]);
      vessels[v].atEnd = vessels[v].atEnd || beyond > 0;
      if (beyond <= end.goesOn) continue;
      end.goesOn = beyond;
      end.vessel = v;
    }
  return ends;
}

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kSharedVoxels = 0.5;  // a wall within half a voxel of its edge is good
constexpr double kSameLength = 1e-4;   // voxels: floats of one file and doubles of another

/// Median contrast over the robust standard deviation of the background far from the walls.
double contrastToNoise(std::vector<double> contrasts, std::vector<double> background) {
  if (background.empty()) return kNaN;
  const double middle = upperMedian(background);
  for (double& level : background) level = std::abs(level - middle);
  const double noise = kDeviationOfMedian * upperMedian(background);
  return noise > 0 ? upperMedian(contrasts) / noise : kNaN;
}

Offsets summarise(std::span<const WallOffset> offsets, double voxel) {
  Offsets result;
  std::vector<double> each, absolute, uncorrected, steepest, contrasts, background;
  std::size_t beyond = 0, none = 0, wrong = 0;
  for (const WallOffset& o : offsets) {
    result.beside += o.verdict == Verdict::BesideAnother;
    result.outside += o.verdict == Verdict::OutsideVolume;
    none += o.verdict == Verdict::NoEdge;
    wrong += o.verdict == Verdict::WrongPolarity;
    if (o.verdict != Verdict::Edge) continue;
    each.push_back(o.offset);
    absolute.push_back(std::abs(o.offset));
    uncorrected.push_back(o.offset - o.displaced);
    steepest.push_back(o.fromSteepest);
    contrasts.push_back(o.inside - o.outside);
    background.push_back(o.beyond);
    beyond += std::abs(o.offset) > voxel;
  }
  result.samples = each.size() + none + wrong;
  const auto share = [&](std::size_t n) {
    return result.samples == 0 ? kNaN
                               : static_cast<double>(n) / static_cast<double>(result.samples);
  };
  const auto quantile = [](std::vector<double>& values, double at) {
    return values.empty() ? kNaN : nearestRank(values, at);
  };
  result.median = quantile(each, 0.5);
  result.absoluteMedian = quantile(absolute, 0.5);
  result.absoluteP90 = quantile(absolute, 0.9);
  result.uncorrectedMedian = quantile(uncorrected, 0.5);
  result.steepestMedian = quantile(steepest, 0.5);
  result.contrastToNoise = contrastToNoise(std::move(contrasts), std::move(background));
  result.beyondVoxel = share(beyond);
  result.noEdge = share(none);
  result.wrongPolarity = share(wrong);
  return result;
}

Agreement judgeOffsets(const Offsets& offsets, double voxel) {
  if (offsets.samples == 0) return Agreement::NotJudged;
  if (offsets.noEdge + offsets.wrongPolarity > 0.5 || offsets.absoluteMedian > voxel)
    return Agreement::Poor;
  return offsets.absoluteMedian > 0.5 * voxel ? Agreement::Fair : Agreement::Good;
}

/// The range of the offsets of the nodes [first, end); `offsets` are sorted by node.
std::span<const WallOffset> ofNodes(const std::vector<WallOffset>& offsets, std::uint32_t first,
                                    std::uint32_t end) {
  const auto before = [](const WallOffset& o, std::uint32_t node) { return o.node < node; };
  const auto from = std::lower_bound(offsets.begin(), offsets.end(), first, before);
  return {from, std::lower_bound(from, offsets.end(), end, before)};
}

void summariseAll(const formats::CenterlineTree& tree, const std::vector<WallOffset>& offsets,
                  CheckReport& report) {
  report.offsets = summarise(offsets, report.voxelSize);
  for (const formats::Branch& branch : tree.branches)
    report.branches.push_back({branch.label, summarise(ofNodes(offsets, branch.firstNode,
                                                               branch.firstNode + branch.nodeCount),
                                                       report.voxelSize)});
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    report.nodes.push_back(
        judgeOffsets(summarise(ofNodes(offsets, n, n + 1), report.voxelSize), report.voxelSize));
}

/// The number of nodes outside of the volume if every coordinate is multiplied by a factor.
std::size_t countOutside(const Volume& volume, const formats::CenterlineTree& tree,
                         const Eigen::Vector3d& factor) {
  return static_cast<std::size_t>(
      std::count_if(tree.centre.begin(), tree.centre.end(), [&](const formats::Vec3f& centre) {
        return !volume.geometry.containsWorld(factor.cwiseProduct(toEigen(centre)));
      }));
}

/// The likely reason why a case has no node in the volume.
std::string likelyReason(const Volume& volume, const formats::CenterlineTree& tree) {
  const std::pair<Eigen::Vector3d, std::string> reasons[] = {
      {{-1, -1, 1}, "with x and y negated they do: one of the two is in RAS"},
      {{1000, 1000, 1000}, "times 1000 they do: the case is in metres"},
      {{1e-3, 1e-3, 1e-3},
       "divided by 1000 they do: the volume is in metres; " + kOption.unit.shown() +
           " states that"}};
  for (const auto& [factor, reason] : reasons)
    if (countOutside(volume, tree, factor) < tree.nodeCount() / 2) return reason;
  return "they do not belong together, or one of them has another origin or unit";
}

template <class Values>
std::string listed(const Values& values) {
  std::string text;
  for (const auto value : values)
    text.append(text.empty() ? "" : " ").append(numberText(static_cast<double>(value)));
  return text;
}

template <class Values>
bool alike(const Values& a, const Values& b, double tolerance) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(std::abs(a[i] - b[i]) <= tolerance)) return false;
  return true;
}

/// Voxels of computed tomography that levels of tissue show to be no lumen; empty for other volumes.
std::vector<bool> tissueOf(const Volume& volume, bool dark, const Progress& progress) {
  std::vector<bool> isTissue;
  const auto levels = dark ? std::nullopt : measureCtLevels(volume, progress);
  if (!levels) return isTissue;
  isTissue.resize(volume.geometry.voxelCount(), true);
  for (const std::size_t i :
       findCtLumen(volume, *levels, {}, BesideBone::Refused, progress).indices)
    isTissue[i] = false;
  return isTissue;
}

}  // namespace

EdgeOptions recordedEdgeOptions(const formats::Case& value) {
  EdgeOptions options;
  options.pointSpread = recordedBlur(value.metadata);
  for (const formats::Step& step : value.metadata.steps)
    if (const auto dark = step.parameters.find("dark"); dark != step.parameters.end())
      if (const auto* is = std::get_if<bool>(&dark->second)) options.dark = *is;
  return options;
}

std::optional<SourceDifference> sourceDifference(const formats::SourceVolume& volume,
                                                 const formats::SourceVolume& source) {
  const double voxel = std::cbrt(source.spacing[0] * source.spacing[1] * source.spacing[2]);
  const double length = kSameLength * voxel;
  if (volume.size != source.size)
    return SourceDifference{"size", listed(volume.size), listed(source.size)};
  if (!alike(volume.spacing, source.spacing, length))
    return SourceDifference{"spacing", listed(volume.spacing), listed(source.spacing)};
  if (!alike(volume.origin, source.origin, length))
    return SourceDifference{"origin", listed(volume.origin), listed(source.origin)};
  if (!alike(volume.direction, source.direction, kSameLength))
    return SourceDifference{"direction", listed(volume.direction), listed(source.direction)};
  if (volume.sha256 != source.sha256)
    return SourceDifference{"voxels", "sha256 " + volume.sha256, "sha256 " + source.sha256};
  return std::nullopt;
}

std::size_t requireOverlap(const Volume& volume, const formats::CenterlineTree& tree) {
  const std::size_t outside = countOutside(volume, tree, Eigen::Vector3d::Ones());
  if (outside == tree.nodeCount())
    throw invalidInput("none of the case's " + std::to_string(tree.nodeCount()) +
                       " nodes lies in the volume: " + likelyReason(volume, tree));
  return outside;
}

CheckResult checkCase(const Volume& whole, const formats::Case& value, const EdgeOptions& options,
                      Progress& progress) {
  const std::shared_ptr<const Volume> continued = continueImage(whole, progress);
  const Volume& volume = continued ? *continued : whole;
  const formats::CenterlineTree& tree = value.tree;
  CheckResult result;
  CheckReport& report = result.report;
  report.options = options;
  report.voxelSize = volume.geometry.voxelSize();
  report.nodesOutside = requireOverlap(volume, tree);
  const field::BlendedField surface = formats::caseField(value);

  progress.begin("lumen", tree.nodeCount());
  const LumenVoxels lumen(tree, surface, volume.geometry, progress);
  progress.end();
  progress.begin("wall", tree.nodeCount());
  const BsplineVolume spline(volume);
  const auto offsets = wallOffsets(tree, surface, spline, lumen, options, progress);
  summariseAll(tree, offsets, report);
  progress.end();

  progress.begin("places", 0);
  report.lumenVolume = static_cast<double>(lumen.voxels().size()) * volume.geometry.spacing.prod();
  const std::vector<NodeLevels> ofNodes = nodeLevels(tree, offsets);
  if (!ofNodes.empty()) {
    const Levels levels{volume, options.dark, ofNodes, tissueOf(volume, options.dark, progress)};
    report.dark = darkInside(lumen, levels, progress);
    report.missing = brightOutside(lumen, levels, tree, progress);
    report.shownLength = shownLength(tree, lumen, levels);
  }
  report.ends = findOpenEnds(tree, report.voxelSize, report.missing.vessels);
  report.shared = findSharedLumen(tree, kSharedVoxels * report.voxelSize);
  progress.end();
  result.lumen = lumen.voxels();
  return result;
}

Volume labelVolume(const VolumeGeometry& geometry, const formats::CenterlineTree& tree,
                   const std::vector<LumenVoxel>& lumen) {
  const auto fill = [&](auto labels) {
    labels.resize(geometry.voxelCount());
    for (const LumenVoxel& voxel : lumen)
      labels[voxel.index] =
          static_cast<typename decltype(labels)::value_type>(tree.branch[voxel.node] + 1);
    return Volume{geometry, std::move(labels)};
  };
  const std::size_t branches = tree.branches.size();
  if (branches <= std::numeric_limits<std::uint8_t>::max())
    return fill(std::vector<std::uint8_t>());
  if (branches > std::numeric_limits<std::uint16_t>::max())
    throw unsupported("a label volume holds 65535 branches, and the case has " +
                      std::to_string(branches));
  return fill(std::vector<std::uint16_t>());
}

}  // namespace lumen::convert
