// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/flow_inlets.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include <Eigen/Core>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/text.h"
#include "converters/base/vectors.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/stages/editing/selection.h"
#include "converters/stages/editing/trim.h"
#include "formats/case/topology.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

using formats::Branch;
using formats::CenterlineTree;

constexpr double kMillilitre = 1e-6;   // m^3
constexpr double kFragment = 0.1;      // of the length of the longest part
constexpr std::size_t kMostNamed = 3;  // parts that messages name one by one
// A length of the tip has four times the resistance or more of one of the vessel.
constexpr double kTaper = 0.7;
constexpr double kStub = 1;  // diameters: nobody sees which way it would run on

/// A connected part of a case.
struct Part {
  double length = 0;  ///< mm
  std::vector<std::uint32_t> branches;
  bool hasInlet = false;
};

bool isRoot(const Branch& branch) {
  return branch.parentNode < 0 && branch.kind == formats::BranchKind::Vessel;
}

/// The connected parts, by their first branch.
std::vector<Part> findParts(const CenterlineTree& tree) {
  DisjointSets sets(tree.branches.size());
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b)
    if (const std::int32_t parent = tree.branches[b].parentNode; parent >= 0)
      sets.join(tree.branch[static_cast<std::size_t>(parent)], b);
  for (const auto& [a, b] : tree.links) sets.join(tree.branch[a], tree.branch[b]);
  std::map<std::uint32_t, std::size_t> numbers;
  std::vector<Part> parts;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) {
    const auto [at, isNew] = numbers.emplace(sets.find(b), parts.size());
    if (isNew) parts.emplace_back();
    Part& part = parts[at->second];
    part.branches.push_back(b);
    part.length += formats::branchLength(tree, tree.branches[b]);
  }
  return parts;
}

void markStated(const CenterlineTree& tree, const std::vector<StatedInlet>& inlets,
                const FieldWord& word, std::vector<Part>& parts) {
  std::string roots;
  for (const Branch& branch : tree.branches)
    if (isRoot(branch)) roots += (roots.empty() ? "" : ", ") + formats::printable(branch.label);
  for (const StatedInlet& inlet : inlets) {
    bool isFound = false;
    for (Part& part : parts)
      for (const std::uint32_t b : part.branches)
        if (isRoot(tree.branches[b]) && tree.branches[b].label == inlet.label)
          part.hasInlet = isFound = true;
    if (!isFound)
      throw Error(ErrorKind::Usage, word("inlets") + ": found " + formats::printable(inlet.label) +
                                        ", expected the branch of a root: " + roots);
  }
}

void markUsual(const formats::Case& source, std::vector<Part>& parts) {
  const CenterlineTree& tree = source.tree;
  const auto longest = std::max_element(
      parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.length < b.length; });
  for (Part& part : parts) {
    const bool begins = std::any_of(part.branches.begin(), part.branches.end(), [&](auto b) {
      const std::uint32_t node = tree.branches[b].firstNode;
      return isRoot(tree.branches[b]) &&
             (!source.metadata.source || isAtBorder(*source.metadata.source, tree, node));
    });
    part.hasInlet = &part == &*longest || (begins && part.length >= kFragment * longest->length);
  }
}

std::vector<std::string> lossesOf(const CenterlineTree& tree, const std::vector<Part>& parts,
                                  const FieldWord& word) {
  std::vector<std::string> losses;
  std::size_t others = 0;
  double length = 0;
  for (const Part& part : parts) {
    if (part.hasInlet) continue;
    if (losses.size() == kMostNamed) {
      ++others;
      length += part.length;
      continue;
    }
    losses.push_back(
        tree.branches[part.branches.front()].label + ": this part, of " +
        counted(part.branches.size(), "branch", "branches") + " and " + shownFigure(part.length) +
        " mm, has no path from an inlet, so it is left out; " + word("inlets") + " states inlets");
  }
  if (others > 0)
    losses.push_back(counted(others, "more part", "more parts") + " of " + shownFigure(length) +
                     " mm together have no path from an inlet either");
  return losses;
}

}  // namespace

std::vector<StatedInlet> statedInlets(const std::vector<std::string>& words,
                                      const FieldWord& word) {
  std::vector<StatedInlet> inlets;
  for (const std::string& text : words) {
    const std::size_t sign = text.rfind('=');
    StatedInlet inlet{text.substr(0, sign), 0};
    if (sign != std::string::npos) {
      const auto flow = parsedNumber(text.substr(sign + 1));
      if (!flow || !(*flow > 0))
        throw Error(ErrorKind::Usage, word("inlets") + ": found " + formats::printable(text) +
                                          ", expected a label, or LABEL=FLOW with a positive flow "
                                          "in ml/s");
      inlet.flow = kMillilitre * *flow;
    }
    inlets.push_back(std::move(inlet));
  }
  return inlets;
}

namespace {

// Flow goes by r^4 through an end and by r^3 out of it: its tip must not decide.
void trimTips(FlowCase& made, const FieldWord& word) {
  constexpr std::size_t kMostShown = 10;
  std::vector<TrimmedEnd> ends;
  try {
    ends = trimEnds(made.value, {.taper = kTaper, .stub = kStub}).ends;
  } catch (const Error& error) {
    made.losses.push_back(std::string("ends stay as they are: ") + error.what());
    return;
  }
  for (std::size_t k = 0; k < ends.size() && k < kMostShown; ++k)
    made.losses.push_back(trimmedText(ends[k]) + ": left out as a " +
                          (ends[k].isWhole ? "stub" : "taper, or a stub") + "; " +
                          word("keep-ends") + " keeps it");
  if (ends.size() > kMostShown)
    made.losses.push_back(counted(ends.size() - kMostShown, "more end", "more ends") +
                          " left out as tapers and stubs");
}

}  // namespace

FlowCase flowCase(const formats::Case& source, const std::vector<StatedInlet>& inlets,
                  const FieldWord& word, bool keepEnds) {
  FlowCase made{source, {}};
  std::vector<Part> parts = findParts(source.tree);
  if (inlets.empty())
    markUsual(source, parts);
  else
    markStated(source.tree, inlets, word, parts);
  std::vector<bool> goes(source.tree.branches.size(), false);
  for (const Part& part : parts)
    for (const std::uint32_t b : part.branches) goes[b] = !part.hasInlet;
  made.losses = lossesOf(source.tree, parts, word);
  leaveOutBranches(made.value, goes);
  if (!keepEnds) trimTips(made, word);
  return made;
}

}  // namespace lumen::convert
