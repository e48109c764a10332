// SPDX-License-Identifier: Apache-2.0
#include "vessel_score.h"

#include <algorithm>
#include <cmath>

#include "converters/base/vectors.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/judge/compare/compare.h"
#include "converters/judge/compare/sampled_path.h"
#include "formats/case/case_field.h"
#include "formats/case/reachability.h"

namespace lumen::reproduce {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.1;       // mm
constexpr double kTolerance = 0.5;  // voxels
constexpr double kThin = 1.5;       // voxels
constexpr double kShortest = 0.5;   // mm of a piece that is listed

void addLine(formats::CenterlineTree& lines, const formats::Vec3f& a, const formats::Vec3f& b) {
  formats::Branch branch;
  branch.firstNode = static_cast<std::uint32_t>(lines.centre.size());
  branch.nodeCount = 2;
  for (const formats::Vec3f& end : {a, b}) {
    lines.centre.push_back(end);
    lines.radius.push_back(0);
  }
  lines.branches.push_back(branch);
}

/// Every edge and every link as a line without thickness.
TubeTreeDistance axesOf(const formats::CenterlineTree& tree) {
  formats::CenterlineTree lines;
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    const std::int32_t parent = tree.parent[n];
    addLine(lines, tree.centre[n],
            tree.centre[parent == formats::kNoParent ? n : static_cast<std::size_t>(parent)]);
  }
  for (const auto& [a, b] : tree.links) addLine(lines, tree.centre[a], tree.centre[b]);
  return TubeTreeDistance(lines);
}

/// Gathers what lies side by side along one branch into pieces.
class Pieces {
public:
  void add(const std::string& branch, double along, double step, const Vector3d& place,
           double radius) {
    if (m_open && along > m_piece.to + 1.5 * step) close();
    if (!m_open) m_piece = {branch, along, along, 0, place, 0};
    m_open = true;
    m_piece.to = along;
    m_piece.length += step;
    m_piece.radius += step * radius;
  }
  void close() {
    if (m_open && m_piece.length >= kShortest) {
      m_piece.radius /= m_piece.length;
      m_all.push_back(m_piece);
    }
    m_open = false;
  }
  std::vector<AxisPiece> longestFirst() {
    std::stable_sort(m_all.begin(), m_all.end(),
                     [](const AxisPiece& p, const AxisPiece& q) { return p.length > q.length; });
    return std::move(m_all);
  }

private:
  std::vector<AxisPiece> m_all;
  AxisPiece m_piece;
  bool m_open = false;
};

void scoreTruth(const formats::CenterlineTree& found, const formats::CenterlineTree& truth,
                const std::set<std::string>& clicked, double voxel, VesselScore& score) {
  const TubeTreeDistance axes = axesOf(found);
  Pieces pieces;
  for (std::uint32_t b = 0; b < truth.branches.size(); ++b) {
    const formats::Branch& branch = truth.branches[b];
    if (branch.kind != formats::BranchKind::Vessel || !clicked.contains(branch.label)) continue;
    const convert::SampledPath path = convert::samplePath(truth, b, kStep, false);
    for (std::size_t i = 0; i < path.samples.size(); ++i) {
      const auto& [place, radius, onLink] = path.samples[i];
      score.clicked += path.spacing;
      if (axes.nearest(place).distance <= radius) {
        score.covered += path.spacing;
        continue;
      }
      score.thin += radius < kThin * voxel ? path.spacing : 0;
      pieces.add(branch.label, static_cast<double>(i) * path.spacing, path.spacing, place, radius);
    }
    pieces.close();
  }
  score.uncovered = pieces.longestFirst();
}

void scoreFound(const formats::CenterlineTree& found, const formats::CenterlineTree& truth,
                double voxel, VesselScore& score) {
  const TubeTreeDistance wall(truth);
  Pieces pieces;
  for (std::uint32_t b = 0; b < found.branches.size(); ++b) {
    if (found.branches[b].kind != formats::BranchKind::Vessel) continue;
    const convert::SampledPath path = convert::samplePath(found, b, kStep, true);
    for (std::size_t i = 0; i < path.samples.size(); ++i) {
      const auto& [place, radius, onLink] = path.samples[i];
      score.length += path.spacing;
      if (wall.nearest(place).distance <= kTolerance * voxel) continue;
      score.falseLength += path.spacing;
      pieces.add(found.branches[b].label, static_cast<double>(i) * path.spacing, path.spacing,
                 place, radius);
    }
    pieces.close();
  }
  score.wrong = pieces.longestFirst();
}

}  // namespace

VesselScore scoreVessels(const formats::Case& found, const formats::Case& truth,
                         const std::set<std::string>& clicked, Progress& progress) {
  const double voxel = truth.metadata.voxelSize.value();
  VesselScore score;
  scoreTruth(found.tree, truth.tree, clicked, voxel, score);
  scoreFound(found.tree, truth.tree, voxel, score);
  if (found.models) {
    const auto reach = formats::measureReachability(found.tree, formats::caseField(found));
    score.reachable = reach.reachable;
    score.reachableOf = reach.total;
  }
  const convert::Comparison comparison = convert::compareCases(found, truth, progress);
  score.radiusBias = comparison.score.radiusBias;
  score.wallMedian = comparison.wallDistance ? comparison.wallDistance->median : std::nan("");
  return score;
}

}  // namespace lumen::reproduce
