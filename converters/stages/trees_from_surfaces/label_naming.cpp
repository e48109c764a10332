// SPDX-License-Identifier: Apache-2.0
// Declared in label_mesh.h.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/vectors.h"
#include "converters/geometry/automatic_names.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Nodes of one label, one after another: [first, end).
struct Run {
  std::uint8_t label = 0;  ///< place of the label, counted from 1; 0: none
  std::uint32_t first = 0, end = 0;
};

/// Width of a vessel over that of one of two equal ones that it divides into, whose cubes have its
/// sum (Murray, The physiological principle of minimum work, 1926).
const double kParentWidth = std::cbrt(2.0);

/// Labels of the nodes of a branch, and what they need to be judged.
class Branches {
public:
  Branches(const LabelMask& mask, const formats::CenterlineTree& tree)
      : m_tree(tree), m_label(tree.nodeCount(), 0) {
    for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
      m_label[n] = labelAt(mask, toEigen(tree.centre[n]));
  }

  /// The stretches of a branch that deserve a name each; one that covers it if there are none, or one.
  /// An end of the branch that is on no label, and another vessel than the one before it, is one.
  [[nodiscard]] std::vector<Run> stretches(const formats::Branch& branch) const {
    std::vector<Run> runs = findRuns(branch);
    while (runs.size() > 1) {
      const auto shortest =
          std::min_element(runs.begin(), runs.end(), [this](const Run& a, const Run& b) {
            return length(a) / width(a) < length(b) / width(b);
          });
      if (length(*shortest) > width(*shortest)) break;
      absorb(runs, static_cast<std::size_t>(shortest - runs.begin()));
    }
    divideTail(runs);
    divideHead(runs);
    return runs;
  }

  /// The place of the label after which a stretch is named; 0 for none.
  [[nodiscard]] std::uint8_t chooseLabel(const Run& run, std::size_t labels) const {
    std::vector<double> lengths(labels + 1, 0.0);
    const std::uint32_t from = firstOwn(run);
    for (std::uint32_t n = from; n < run.end; ++n) lengths[m_label[n]] += share(n, from, run.end);
    const auto most = std::max_element(lengths.begin() + 1, lengths.end());
    const double whole = length({0, from, run.end});
    const bool isEnough = *most > 0 && (*most > width({0, from, run.end}) || 2 * *most >= whole);
    return isEnough ? static_cast<std::uint8_t>(most - lengths.begin()) : std::uint8_t{0};
  }

  /// The part of a run without the nodes on no label at its ends, and without those in the parent's
  /// ball; empty if no node is left.
  [[nodiscard]] Run labelledPart(const Run& run) const {
    Run part{run.label, firstOwn(run), run.end};
    while (part.first < part.end && m_label[part.first] == 0) ++part.first;
    while (part.first < part.end && m_label[part.end - 1] == 0) --part.end;
    return part;
  }

private:
  [[nodiscard]] double edge(std::uint32_t n) const {  ///< from the node before, mm
    return (toEigen(m_tree.centre[n]) - toEigen(m_tree.centre[n - 1])).norm();
  }
  /// Half of the edges to both neighbours within [from, end), mm; a lone node has its diameter.
  [[nodiscard]] double share(std::uint32_t n, std::uint32_t from, std::uint32_t end) const {
    if (end - from == 1) return 2 * static_cast<double>(m_tree.radius[n]);
    return 0.5 * ((n > from ? edge(n) : 0) + (n + 1 < end ? edge(n + 1) : 0));
  }
  [[nodiscard]] double length(const Run& run) const {
    double sum = 0;
    for (std::uint32_t n = run.first; n < run.end; ++n) sum += share(n, run.first, run.end);
    return sum;
  }
  /// Mean diameter, mm.
  [[nodiscard]] double width(const Run& run) const {
    double sum = 0;
    for (std::uint32_t n = run.first; n < run.end; ++n)
      sum += 2 * static_cast<double>(m_tree.radius[n]);
    return sum / (run.end - run.first);
  }

  /// An end on no label is another vessel than the labelled part beside it if it is longer than it is
  /// wide, and wider than a vessel whose half the part is.
  [[nodiscard]] bool isWiderVessel(const Run& end, const Run& part) const {
    return end.first < end.end && length(end) > width(end) && length(part) > width(part) &&
           width(end) > kParentWidth * width(part);
  }

  void divideTail(std::vector<Run>& runs) const {
    const Run part = labelledPart(runs.back());
    const Run tail{0, part.end, runs.back().end};
    if (part.first == part.end || !isWiderVessel(tail, part)) return;
    runs.back().end = tail.first;
    runs.push_back(tail);
  }
  /// A vessel that is labelled runs on from where its label ends, and does not begin long before it.
  void divideHead(std::vector<Run>& runs) const {
    const Run part = labelledPart(runs.front());
    const Run head{0, firstOwn(runs.front()), part.first};
    if (part.first == part.end || head.first == head.end) return;
    const bool isLonger =
        length(head) > width(head) && length(part) > width(part) && length(head) > length(part);
    if (!isLonger && !isWiderVessel(head, part)) return;
    const Run before{0, runs.front().first, head.end};
    runs.front().first = head.end;
    runs.insert(runs.begin(), before);
  }

  /// The first node outside of the parent's ball; the first of all if there is none.
  [[nodiscard]] std::uint32_t firstOwn(const Run& run) const {
    const std::int32_t parent = m_tree.parent[run.first];
    if (parent < 0 || isContinued(run)) return run.first;
    const auto fork = static_cast<std::uint32_t>(parent);
    for (std::uint32_t n = run.first; n < run.end; ++n)
      if ((toEigen(m_tree.centre[n]) - toEigen(m_tree.centre[fork])).norm() >
          static_cast<double>(m_tree.radius[fork]))
        return n;
    return run.first;
  }
  /// A stretch that goes on from another of its branch.
  [[nodiscard]] bool isContinued(const Run& run) const {
    return run.first > 0 && m_tree.branch[run.first] == m_tree.branch[run.first - 1];
  }

  [[nodiscard]] std::vector<Run> findRuns(const formats::Branch& branch) const {
    const std::uint32_t end = branch.firstNode + branch.nodeCount;
    std::vector<Run> runs{{0, branch.firstNode, end}};
    for (std::uint32_t n = firstOwn(runs[0]); n < end; ++n) {
      if (m_label[n] == 0 || m_label[n] == runs.back().label) continue;
      if (runs.back().label == 0) {
        runs.back().label = m_label[n];
        continue;
      }
      runs.back().end = n;
      runs.push_back({m_label[n], n, end});
    }
    return runs;
  }

  /// Gives a run to its longer neighbour, and joins neighbours of one label.
  void absorb(std::vector<Run>& runs, std::size_t at) const {
    const bool toLeft =
        at > 0 && (at + 1 == runs.size() || length(runs[at - 1]) >= length(runs[at + 1]));
    const std::size_t left = toLeft ? at - 1 : at;
    if (!toLeft) runs[at].label = runs[at + 1].label;
    runs[left].end = runs[left + 1].end;
    runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(left) + 1);
    for (std::size_t i = 1; i < runs.size();) {
      if (runs[i - 1].label != runs[i].label) {
        ++i;
        continue;
      }
      runs[i - 1].end = runs[i].end;
      runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  const formats::CenterlineTree& m_tree;
  std::vector<std::uint8_t> m_label;
};

std::optional<float> meanRate(const formats::CenterlineTree& tree, const formats::Branch& branch) {
  if (tree.inlierRate.empty()) return std::nullopt;
  double sum = 0;
  for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
    sum += static_cast<double>(tree.inlierRate[n]);
  return static_cast<float>(sum / branch.nodeCount);
}

}  // namespace

std::uint8_t labelAt(const LabelMask& mask, const Vector3d& place) {
  const Vector3d at = mask.geometry.indexFromWorld(place).array().round();
  if (!mask.geometry.containsIndex(at)) return 0;
  return mask.label[mask.geometry.index(at.cast<int>())];
}

Naming nameBranches(const LabelMask& mask, formats::Case& value) {
  formats::CenterlineTree& tree = value.tree;
  const Branches labelled(mask, tree);
  Naming done;
  std::vector<formats::Branch> branches;
  std::vector<std::string> wanted;  // for each of them; empty: none
  for (const formats::Branch& branch : tree.branches) {
    const std::vector<Run> runs =
        branch.kind == formats::BranchKind::Vessel
            ? labelled.stretches(branch)
            : std::vector<Run>{{0, branch.firstNode, branch.firstNode + branch.nodeCount}};
    done.divided += runs.size() > 1 ? 1 : 0;
    for (const Run& run : runs) {
      formats::Branch part = branch;
      part.firstNode = run.first;
      part.nodeCount = run.end - run.first;
      part.parentNode = tree.parent[run.first];
      if (run.end != branch.firstNode + branch.nodeCount)
        part.stopReason = formats::StopReason::Unknown;
      if (runs.size() > 1) part.meanInlierRate = meanRate(tree, part);
      branches.push_back(part);
      const std::uint8_t label = labelled.chooseLabel(run, mask.names.size());
      wanted.push_back(label == 0 ? "" : mask.names[label - 1u]);
    }
  }
  tree.branches = std::move(branches);
  std::set<std::string> taken;
  for (std::size_t b = 0; b < wanted.size(); ++b) {
    formats::Branch& branch = tree.branches[b];
    for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
      tree.branch[n] = static_cast<std::uint32_t>(b);
    if (wanted[b].empty()) taken.insert(branch.label = freeName(branch.label, taken));
  }
  for (std::size_t b = 0; b < wanted.size(); ++b) {
    if (!wanted[b].empty()) taken.insert(tree.branches[b].label = freeName(wanted[b], taken));
    ++(wanted[b].empty() ? done.bare : done.named);
  }
  return done;
}

std::vector<NamedStretch> labelsAlong(const LabelMask& mask, const formats::CenterlineTree& tree) {
  const Branches labelled(mask, tree);
  std::vector<NamedStretch> stretches;
  for (const formats::Branch& branch : tree.branches) {
    const Run whole{0, branch.firstNode, branch.firstNode + branch.nodeCount};
    const Run part = labelled.labelledPart(whole);
    stretches.push_back({labelled.chooseLabel(whole, mask.names.size()), part.first, part.end});
  }
  return stretches;
}

std::size_t labelledWithin(const LabelMask& mask, const VolumeGeometry& geometry) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < mask.label.size(); ++i)
    if (mask.label[i] != 0 && geometry.containsWorld(mask.geometry.position(mask.geometry.cell(i))))
      ++count;
  return count;
}

}  // namespace lumen::convert
