// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/ends_of.h"

#include <algorithm>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "converters/base/warning.h"
#include "converters/stages/editing/further_inlets.h"
#include "converters/stages/editing/inlets.h"
#include "converters/stages/editing/trim.h"
#include "converters/stages/fitting/fit.h"
#include "formats/case/topology.h"

namespace lumen::operations {

namespace {

using formats::CenterlineTree;

class EndFinder {
public:
  explicit EndFinder(const formats::Case& value)
      : m_tree(value.tree),
        m_volume(value.metadata.source ? &*value.metadata.source : nullptr),
        m_isHeld(m_tree.nodeCount(), false) {
    for (std::size_t i = 0; i < m_tree.nodeCount(); ++i)
      if (m_tree.parent[i] != formats::kNoParent)
        m_isHeld[static_cast<std::size_t>(m_tree.parent[i])] = true;
    for (const auto& link : m_tree.links)
      for (const std::uint32_t node : link) m_isHeld[node] = true;
  }

  std::vector<OpenEnd> run() {
    for (std::uint32_t b = 0; b < m_tree.branches.size(); ++b) {
      const formats::Branch& branch = m_tree.branches[b];
      if (branch.kind != formats::BranchKind::Vessel || branch.nodeCount == 0) continue;
      const std::uint32_t last = branch.firstNode + branch.nodeCount - 1;
      if (branch.parentNode == formats::kNoParent) add(b, branch.firstNode, true);
      if (!m_isHeld[last] && last != branch.firstNode) add(b, last, false);
    }
    for (OpenEnd& end : m_ends)
      if (!end.isInlet) end.why = reasonOf(end);
    std::stable_sort(m_ends.begin(), m_ends.end(),
                     [](const OpenEnd& a, const OpenEnd& b) { return a.radius > b.radius; });
    return std::move(m_ends);
  }

private:
  void add(std::uint32_t branch, std::uint32_t node, bool isInlet) {
    OpenEnd& end = m_ends.emplace_back();
    end.branch = branch;
    end.node = node;
    end.isInlet = isInlet;
    end.place = toEigen(m_tree.centre[node]);
    end.radius = calibreAt(branch, isInlet);
    if (m_volume != nullptr) end.leavesVolume = convert::isAtBorder(*m_volume, m_tree, node);
  }

  [[nodiscard]] double calibreAt(std::uint32_t branch, bool isFirst) const {
    const formats::Branch& b = m_tree.branches[branch];
    std::vector<double> radii, steps;
    for (std::uint32_t k = 0; k < b.nodeCount; ++k) {
      const std::uint32_t node = b.firstNode + (isFirst ? k : b.nodeCount - 1 - k);
      if (k > 0)
        steps.push_back((toEigen(m_tree.centre[node]) - toEigen(m_tree.centre[m_before])).norm());
      m_before = node;
      radii.push_back(double{m_tree.radius[node]});
    }
    return convert::calibre(radii, steps);
  }

  /// Why blood may come in at an end that is no root: it leaves the volume, and the root of its tree
  /// does not, or is hardly wider than it.
  [[nodiscard]] std::string reasonOf(const OpenEnd& end) const {
    if (!end.leavesVolume.value_or(false)) return {};
    const std::uint32_t root = convert::rootAbove(m_tree, end.node);
    const auto inlet = std::find_if(m_ends.begin(), m_ends.end(),
                                    [root](const OpenEnd& e) { return e.node == root; });
    if (inlet == m_ends.end()) return {};
    const std::string& name = m_tree.branches[inlet->branch].label;
    if (!inlet->leavesVolume.value_or(true))
      return "leaves the volume, and the root of its tree (" + name + ") begins within it";
    // by Murray's law half of a flow takes this share of the radius or less
    if (end.radius * convert::kHalfFlowRadii < inlet->radius) return {};
    return "leaves the volume, and is too wide for a branch of " + name + " (" +
           fixedText(end.radius, 2) + " of " + fixedText(inlet->radius, 2) + " mm)";
  }

  const CenterlineTree& m_tree;
  const formats::SourceVolume* m_volume;  ///< null if the case states none
  std::vector<bool> m_isHeld;             ///< nodes at which something goes on
  std::vector<OpenEnd> m_ends;
  mutable std::uint32_t m_before = 0;
};

}  // namespace

std::vector<OpenEnd> endsOf(const formats::Case& value) {
  return EndFinder(value).run();
}

RootedCase rootedAt(formats::Case value, std::span<const OpenEnd> inlets, const Context& context) {
  std::vector<Eigen::Vector3d> places;
  for (const OpenEnd& inlet : inlets) places.push_back(inlet.place);
  const std::size_t links = value.tree.links.size();
  convert::FitOptions options;
  const bool isFitted = value.models.has_value();
  if (isFitted) options = convert::recordedFitOptions(value);
  const bool hasPoints = value.points.has_value();
  for (const convert::UnusedPlace& unused : convert::beginAt(value, places))
    warn(context.progress,
         {WarningCode::RootUnused, "no tree begins at " + context.field("root", unused.index) +
                                       ": " + convert::reasonFor(unused.why)});
  const bool isDivided = value.tree.links.size() > links;
  if (!isDivided || !isFitted) return {std::move(value), false};
  if (!hasPoints)
    throw invalidInput(
        "a tree with two inlets is divided between them, which takes wall points to fit its models "
        "again, and the case has none");
  convert::fit(value, options, context.progress);
  return {std::move(value), true};
}

}  // namespace lumen::operations
