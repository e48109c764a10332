// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/wall_offsets.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/judge/check/wall_samples.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

// Contrast thresholds: an edge counts with a quarter of its branch's contrast, and with a sixth of
// the tree's: a dark branch has no edges, one with thin contrast agent still has. The tree's
// contrast is that of its better quarter, which is robust when half of the tree is dark.
constexpr double kShareOfBranch = 0.25, kShareOfTree = 1.0 / 6, kBetterQuarter = 0.75;

// Distance, voxels, within which another lumen hides the wall's edge.
constexpr double kClearOf[] = {0.5, 1.0, 1.5};

constexpr std::uint32_t kNodesAround = 4;  // per side; their edges determine a node's half level
constexpr std::size_t kLeastEdges = 8;     // minimum for a median that no single edge decides

constexpr double kTexture = 3 * 1.4826;  // median deviations: three standard deviations

/// The mean over the last voxel of a profile that lies in the volume.
double farEnd(const std::vector<float>& values) {
  auto end = values.end();
  while (end != values.begin() && std::isnan(*(end - 1))) --end;
  const auto count = std::min<std::ptrdiff_t>(kSamplesPerVoxel, end - values.begin());
  double sum = 0;
  for (auto value = end - count; value != end; ++value) sum += static_cast<double>(*value);
  return sum / static_cast<double>(count);
}

/// Buffers of one thread.
struct Scratch {
  std::vector<WallSample> samples;
  std::vector<float> values;
};

class OffsetMeter {
public:
  OffsetMeter(const formats::CenterlineTree& tree, const BsplineVolume& volume,
              const LumenVoxels& lumen, const EdgeOptions& options)
      : m_tree(tree),
        m_volume(volume),
        m_lumen(lumen),
        m_voxel(volume.geometry().voxelSize()),
        m_step(m_voxel / kSamplesPerVoxel),
        m_sign(options.dark ? -1.0F : 1.0F),
        m_ideal(options.pointSpread, m_voxel) {}

  [[nodiscard]] WallOffset measure(const WallSample& sample, std::vector<float>& values) const {
    WallOffset result;
    result.node = sample.node;
    for (const double clear : kClearOf)
      if (m_lumen.isInAnother(sample.position + clear * m_voxel * sample.outward, sample.node)) {
        result.verdict = Verdict::BesideAnother;
        return result;
      }
    const ProfileReach reach = profileReach(sample.radius, m_voxel);
    const auto wall = static_cast<std::size_t>(reach.inward / m_step);
    values.resize(wall + static_cast<std::size_t>(reach.outward / m_step) + 1);
    profile(sample, wall, values);
    if (std::isnan(values[wall])) {
      result.verdict = Verdict::OutsideVolume;
      return result;
    }
    result.beyond = farEnd(values);
    const ProfileEdge edge = findEdge(values, wall);
    if (edge.kind == EdgeKind::None) return result;
    result.verdict = edge.kind == EdgeKind::Falls ? Verdict::Edge : Verdict::WrongPolarity;
    const auto kind = m_tree.branches[m_tree.branch[sample.node]].kind;
    const double at = edge.at * m_step, seen = std::max(sample.radius + at, 0.0);
    result.displaced =
        kind == formats::BranchKind::Aneurysm ? m_ideal.ofBall(seen) : m_ideal.ofCylinder(seen);
    result.offset = result.displaced - at;
    result.fromSteepest = -edge.steepest * m_step;
    result.inside = edge.inside;
    result.outside = edge.outside;
    return result;
  }

private:
  void profile(const WallSample& sample, std::size_t wall, std::span<float> values) const {
    const VolumeGeometry& geometry = m_volume.geometry();
    const Vector3d start = sample.position - static_cast<double>(wall) * m_step * sample.outward;
    const Vector3d step =
        (geometry.direction.transpose() * sample.outward * m_step).cwiseQuotient(geometry.spacing);
    m_volume.sampleLine(geometry.indexFromWorld(start), step, values);
    for (float& value : values) value *= m_sign;
  }

  const formats::CenterlineTree& m_tree;
  const BsplineVolume& m_volume;
  const LumenVoxels& m_lumen;
  double m_voxel, m_step;
  float m_sign;
  IdealEdge m_ideal;
};

double contrastOf(const WallOffset& o) {
  return std::abs(o.inside - o.outside);
}

bool hasEdge(const WallOffset& o) {
  return o.verdict == Verdict::Edge;
}

/// Discards edges with too little contrast.
void dropFaintEdges(const formats::CenterlineTree& tree, std::vector<WallOffset>& offsets) {
  std::vector<double> all;
  std::vector<std::vector<double>> each(tree.branches.size());
  for (const WallOffset& o : offsets) {
    if (!hasEdge(o)) continue;
    all.push_back(contrastOf(o));
    each[tree.branch[o.node]].push_back(contrastOf(o));
  }
  if (all.empty()) return;
  const double least = kShareOfTree * lowerQuantile(all, kBetterQuarter);
  std::vector<double> leastOfBranch;
  for (auto& some : each)
    leastOfBranch.push_back(some.empty() ? least
                                         : std::max(least, kShareOfBranch * upperMedian(some)));
  for (WallOffset& o : offsets)
    if ((hasEdge(o) || o.verdict == Verdict::WrongPolarity) &&
        contrastOf(o) < leastOfBranch[tree.branch[o.node]])
      o.verdict = Verdict::NoEdge;
}

/// The level that the background around some samples seldom exceeds. Where most of them have the
/// lumen beyond as well, as their wall lies inside of it, samples with an edge represent the
/// background.
double textureTop(std::span<const WallOffset> offsets, double lumen) {
  std::vector<double> beyond, beyondEdges;
  for (const WallOffset& o : offsets) {
    if (o.verdict == Verdict::BesideAnother || o.verdict == Verdict::OutsideVolume) continue;
    beyond.push_back(o.beyond);
    if (hasEdge(o)) beyondEdges.push_back(o.beyond);
  }
  if (upperMedian(beyond) > lumen) beyond = beyondEdges;
  const double middle = upperMedian(beyond);
  for (double& value : beyond) value = std::abs(value - middle);
  return middle + kTexture * upperMedian(beyond);
}

/// The medians over the edges in a range; empty if there are too few.
std::optional<NodeLevels> measureLevels(std::span<const WallOffset> offsets, std::size_t least) {
  std::vector<double> halves, faints, lumens;
  for (const WallOffset& o : offsets) {
    if (!hasEdge(o)) continue;
    halves.push_back(0.5 * (o.inside + o.outside));
    faints.push_back(o.outside + kShareOfBranch * (o.inside - o.outside));
    lumens.push_back(o.inside - kShareOfBranch * (o.inside - o.outside));
  }
  if (halves.size() < least) return std::nullopt;
  const double faint = std::max(upperMedian(faints), textureTop(offsets, upperMedian(lumens)));
  return NodeLevels{static_cast<float>(upperMedian(halves)), static_cast<float>(faint)};
}

}  // namespace

std::vector<WallOffset> wallOffsets(const formats::CenterlineTree& tree,
                                    const field::BlendedField& surface, const BsplineVolume& volume,
                                    const LumenVoxels& lumen, const EdgeOptions& options,
                                    Progress& progress) {
  const WallSampler sampler(tree, surface, volume.geometry().voxelSize());
  const OffsetMeter meter(tree, volume, lumen, options);
  std::vector<std::vector<WallOffset>> each(tree.nodeCount());
  tbb::enumerable_thread_specific<Scratch> scratch;
  tbb::parallel_for(std::size_t{0}, tree.nodeCount(), [&](std::size_t n) {
    progress.check();
    Scratch& mine = scratch.local();
    mine.samples.clear();
    sampler.sample(static_cast<std::uint32_t>(n), mine.samples);
    each[n].reserve(mine.samples.size());
    for (const WallSample& sample : mine.samples)
      each[n].push_back(meter.measure(sample, mine.values));
    progress.advance();
  });
  std::vector<WallOffset> all;
  for (const auto& some : each) all.insert(all.end(), some.begin(), some.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const WallOffset& a, const WallOffset& b) { return a.node < b.node; });
  dropFaintEdges(tree, all);
  return all;
}

std::vector<NodeLevels> nodeLevels(const formats::CenterlineTree& tree,
                                   const std::vector<WallOffset>& offsets) {
  const auto ofNodes = [&](std::uint32_t first, std::uint32_t end, std::size_t least) {
    const auto before = [](const WallOffset& o, std::uint32_t node) { return o.node < node; };
    const auto from = std::lower_bound(offsets.begin(), offsets.end(), first, before);
    return measureLevels({from, std::lower_bound(from, offsets.end(), end, before)}, least);
  };
  const auto count = static_cast<std::uint32_t>(tree.nodeCount());
  const auto ofTree = ofNodes(0, count, 1);
  if (!ofTree) return {};
  std::vector<NodeLevels> levels(count);
  for (const formats::Branch& branch : tree.branches) {
    const std::uint32_t end = branch.firstNode + branch.nodeCount;
    const NodeLevels fallback = ofNodes(branch.firstNode, end, kLeastEdges).value_or(*ofTree);
    for (std::uint32_t n = branch.firstNode; n < end; ++n) {
      const std::uint32_t first = n - std::min(n - branch.firstNode, kNodesAround);
      levels[n] =
          ofNodes(first, std::min(end, n + kNodesAround + 1), kLeastEdges).value_or(fallback);
    }
  }
  return levels;
}

}  // namespace lumen::convert
