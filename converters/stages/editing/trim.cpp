// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/trim.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include <Eigen/LU>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "converters/base/vectors.h"
#include "converters/stages/editing/editable_case.h"
#include "formats/case/topology.h"

namespace lumen::convert {

namespace {

using formats::Branch;
using formats::CenterlineTree;

/// The median by length; `weight`: of each value.
double medianOf(std::vector<std::pair<double, double>> values) {
  std::sort(values.begin(), values.end());
  double all = 0, sum = 0;
  for (const auto& [value, weight] : values) all += weight;
  for (const auto& [value, weight] : values)
    if ((sum += weight) >= 0.5 * all) return value;
  return values.back().first;
}

/// The median over the first `reach` mm.
double medianWithin(std::span<const double> radius, std::span<const double> step, double reach) {
  std::vector<std::pair<double, double>> values;
  double way = 0;
  for (std::size_t i = 0; i < radius.size() && way <= reach; ++i) {
    const double before = i > 0 ? step[i - 1] : 0, after = i < step.size() ? step[i] : 0;
    values.emplace_back(radius[i], std::max(0.5 * (before + after), 1e-12));
    way += after;
  }
  return medianOf(std::move(values));
}

/// The nodes of each branch that are left.
class Trimmer {
public:
  Trimmer(const formats::Case& value, const TrimLimits& limits)
      : m_tree(value.tree),
        m_limits(limits),
        m_volume(value.metadata.source ? &*value.metadata.source : nullptr),
        m_origins(formats::readNodeOrigins(value)),
        m_holds(m_tree.nodeCount(), 0) {
    for (const Branch& branch : m_tree.branches) {
      m_left.push_back(branch.nodeCount);
      if (branch.parentNode >= 0) ++m_holds[static_cast<std::size_t>(branch.parentNode)];
    }
    for (const auto& link : m_tree.links)
      for (const std::uint32_t node : link) ++m_holds[node];
  }

  /// Number of nodes left in each branch when no end is too thin or too short.
  std::vector<std::uint32_t> trim() {
    for (bool isMore = true; isMore;) {
      isMore = false;
      for (auto b = static_cast<std::uint32_t>(m_left.size()); b-- > 0;)
        if (trimBranch(b)) isMore = true;
    }
    return m_left;
  }

private:
  [[nodiscard]] double radius(std::uint32_t node) const {
    return static_cast<double>(m_tree.radius[node]);
  }

  /// Removes what is too thin or too short of the end of a branch; false if it stays as it is.
  bool trimBranch(std::uint32_t b) {
    const Branch& branch = m_tree.branches[b];
    if (branch.kind == formats::BranchKind::Aneurysm || m_left[b] == 0) return false;
    std::uint32_t held = m_left[b];  // nodes up to the last one that holds something
    while (held > 0 && m_holds[branch.firstNode + held - 1] == 0) --held;
    const std::uint32_t left = lengthOfEnd(branch, held, withoutThin(branch, held, m_left[b]));
    if (left == m_left[b]) return false;
    m_left[b] = left;
    if (left == 0 && branch.parentNode >= 0) --m_holds[static_cast<std::size_t>(branch.parentNode)];
    return true;
  }

  /// Nodes left of a branch whose tip is as wide as it must be.
  [[nodiscard]] std::uint32_t withoutThin(const Branch& branch, std::uint32_t held,
                                          std::uint32_t left) const {
    double least = m_limits.minRadius;
    if (m_limits.taper > 0 && left > held)
      least = std::max(least, m_limits.taper * calibreOf(branch, held, left));
    while (left > held && radius(branch.firstNode + left - 1) < least) --left;
    return left;
  }

  [[nodiscard]] double calibreOf(const Branch& branch, std::uint32_t held,
                                 std::uint32_t left) const {
    std::vector<double> radii, steps;
    for (std::uint32_t k = left; k-- > held;) {
      radii.push_back(radius(branch.firstNode + k));
      if (k > held) steps.push_back(formats::edgeLength(m_tree, branch.firstNode + k));
    }
    return calibre(radii, steps);
  }

  [[nodiscard]] bool leavesVolume(std::uint32_t node) const {
    return m_volume != nullptr && isAtBorder(*m_volume, m_tree, node);
  }

  /// Nodes left of a branch whose end is as long as it must be, and lies outside of its parent.
  [[nodiscard]] std::uint32_t lengthOfEnd(const Branch& branch, std::uint32_t held,
                                          std::uint32_t left) const {
    if (left == held) return left;
    double length = 0;
    bool isBridged = branch.parentNode >= 0 && held == 0;
    for (std::uint32_t node = branch.firstNode + held; node < branch.firstNode + left; ++node) {
      length += formats::edgeLength(m_tree, node);
      isBridged = isBridged && m_origins[node] == formats::NodeOrigin::Bridged;
    }
    if (held > 0) length -= radius(branch.firstNode + held - 1);
    if (length < m_limits.minLength) return held;
    if (m_limits.stub > 0 && length < 2 * m_limits.stub * calibreOf(branch, held, left) &&
        !leavesVolume(branch.firstNode + left - 1))
      return held;
    // of a vessel whose end went, neither a part within its parent nor a single root stays
    const bool isNothing = isBridged || (branch.parentNode < 0 && held == 0 && left < 2);
    return isNothing && left < branch.nodeCount ? held : left;
  }

  const CenterlineTree& m_tree;
  const TrimLimits& m_limits;
  const formats::SourceVolume* m_volume;  ///< null if the case states none
  std::vector<formats::NodeOrigin> m_origins;
  std::vector<std::uint32_t> m_holds;  ///< branches and links at each node
  std::vector<std::uint32_t> m_left;   ///< nodes left of each branch
};

TrimmedEnd describe(const CenterlineTree& tree, const Branch& branch, std::uint32_t left) {
  TrimmedEnd end{branch.label, left == 0, branch.nodeCount - left, 0, 0};
  for (std::uint32_t n = branch.firstNode + left; n < branch.firstNode + branch.nodeCount; ++n) {
    end.length += formats::edgeLength(tree, n);
    const auto radius = static_cast<double>(tree.radius[n]);
    end.radius = n == branch.firstNode + left ? radius : std::min(end.radius, radius);
  }
  return end;
}

std::string limitsText(const TrimLimits& limits) {
  std::string text;
  if (limits.minRadius > 0) text = "thinner than " + shownNumber(limits.minRadius) + " mm";
  if (limits.minLength > 0)
    text +=
        (text.empty() ? "" : " or ") + ("shorter than " + shownNumber(limits.minLength)) + " mm";
  if (limits.taper > 0)
    text += (text.empty() ? "" : " or ") + ("thinner than " + shownNumber(limits.taper)) +
            " of their vessel's radius";
  if (limits.stub > 0)
    text +=
        (text.empty() ? "" : " or ") + ("shorter than " + shownNumber(limits.stub)) + " diameters";
  return text;
}

}  // namespace

double calibre(std::span<const double> radius, std::span<const double> step) {
  constexpr double kStretch = 10;  // radii
  const double all = medianWithin(radius, step, std::numeric_limits<double>::infinity());
  return medianWithin(radius, step, kStretch * all);
}

bool isAtBorder(const formats::SourceVolume& volume, const CenterlineTree& tree,
                std::uint32_t node) {
  constexpr double kAtBorder = 1.5;  // radii
  const double reach = kAtBorder * double{tree.radius[node]};
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> direction(
      volume.direction.data());
  const Eigen::Vector3d along =
      direction.inverse() * (toEigen(tree.centre[node]) - Eigen::Vector3d(volume.origin.data()));
  for (std::size_t a = 0; a < 3; ++a) {
    const double at = along[static_cast<Eigen::Index>(a)];
    const double far = (static_cast<double>(volume.size[a]) - 1) * volume.spacing[a] - at;
    if (std::min(at, far) <= reach) return true;
  }
  return false;
}

TrimResult trimEnds(formats::Case& target, const TrimLimits& limits) {
  TrimResult result;
  const std::vector<std::uint32_t> left = Trimmer(target, limits).trim();
  EditableCase edited(target);
  std::vector<EditableBranch> kept;
  for (std::uint32_t b = 0; b < left.size(); ++b) {
    const Branch& branch = target.tree.branches[b];
    if (left[b] < branch.nodeCount) result.ends.push_back(describe(target.tree, branch, left[b]));
    if (left[b] == 0) continue;
    EditableBranch& one = edited.branches[b];
    if (left[b] < branch.nodeCount) {
      one.nodes.resize(left[b]);
      one.record.stopReason = formats::StopReason::Unknown;
      one.isOther = true;
    }
    kept.push_back(std::move(one));
  }
  if (result.ends.empty()) return result;
  const bool hasVessel = std::any_of(kept.begin(), kept.end(), [](const EditableBranch& branch) {
    return branch.record.kind == formats::BranchKind::Vessel;
  });
  if (!hasVessel)
    throw invalidInput("all vessels are " + limitsText(limits) +
                       ", so nothing would be left; expected lesser limits");
  edited.branches = std::move(kept);
  result.change = edited.finish(
      target, "trimmed " + counted(result.ends.size(), "end", "ends") + " " + limitsText(limits));
  return result;
}

std::string trimmedText(const TrimmedEnd& end) {
  return end.label + ": " + shownFigure(end.length) + " mm" +
         (end.isWhole ? ", the whole branch" : " of its end") + ", down to a radius of " +
         shownFigure(end.radius) + " mm";
}

}  // namespace lumen::convert
