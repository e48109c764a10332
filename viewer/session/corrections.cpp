// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/corrections.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/options/edit_steps.h"
#include "converters/stages/editing/edit_request.h"
#include "formats/case/enum_names.h"

namespace lumen::viewer {

namespace {

/// The name in a request of the argument that a correction calls "word", and the word that differs
/// from its usual treatment; empty: all words count.
struct WordArgument {
  const char* op;
  const char* name;
  const char* other;
};
constexpr WordArgument kWords[] = {{"delete", "hanging", "go"},
                                   {"cut", "rest", "child"},
                                   {"rename", "label", ""},
                                   {"kind", "kind", ""}};

std::string wordIn(const std::string& op, const Arguments& request) {
  for (const WordArgument& word : kWords) {
    if (op != word.op) continue;
    if (*word.other == '\0') return request.text(word.name);
    return request.text(word.name, "") == word.other ? word.other : "";
  }
  return {};
}

/// The correction with checked arguments.
convert::EditRequest editRequest(const std::string& op, const std::vector<std::string>& arguments,
                                 const Arguments& request, const formats::CenterlineTree& tree) {
  convert::EditRequest edit;
  edit.op = op;
  for (const std::string& name : arguments) {
    if (name == "branch") edit.branch = request.index("branch", tree.branches.size());
    if (name == "node") edit.node = request.index("node", tree.nodeCount());
    if (name.starts_with("word")) edit.word = wordIn(op, request);
    if (name == "position") edit.position = request.position(op == "push" ? "at" : "position");
    if (name == "by") edit.by = request.position("by");
    if (name == "radius") edit.radius = request.number("radius_mm");
    if (name == "reach") edit.reach = request.number("reach_mm");
  }
  return edit;
}

/// Deletes the vessels of these labels, each given once, as one change; what hangs on them stays. The case keeps a
/// sentence and a request for each, as if they had been deleted one after the other. Throws Error(Usage) for a
/// label that the case does not have, and where nothing would be left.
convert::Change deleteLabels(formats::Case& target, const std::vector<std::string>& labels) {
  const auto& branches = target.tree.branches;
  std::vector<bool> goes(branches.size(), false);
  std::vector<std::pair<std::string, std::string>> deletions;  // sentences and requests
  for (const std::string& label : labels) {
    const auto found = std::find_if(branches.begin(), branches.end(),
                                    [&label](const auto& each) { return each.label == label; });
    if (found == branches.end()) refuse("there is no vessel \"" + label + "\"");
    convert::EditRequest edit;
    edit.op = "delete";
    edit.branch = static_cast<std::uint32_t>(found - branches.begin());
    if (goes[*edit.branch]) refuse("\"labels\" has \"" + label + "\" twice");
    goes[*edit.branch] = true;
    deletions.emplace_back("deleted \"" + label + "\"", convert::textOfRequest(edit, target.tree));
  }
  if (deletions.empty()) refuse("\"labels\" is empty, but must name a vessel");
  if (deletions.size() == branches.size())
    refuse("nothing would be left; expected a case that keeps at least one vessel");
  convert::Change change = convert::deleteBranches(target, goes, deletions.front().first);
  for (std::size_t i = 0; i < deletions.size(); ++i) {
    if (i > 0) recordEdit(target.metadata, deletions[i].first);
    recordRequest(target.metadata, deletions[i].second);
  }
  if (deletions.size() > 1)
    change.sentence = "deleted " + std::to_string(deletions.size()) + " vessels";
  return change;
}

/// A vessel's label before and after; both empty if none is renamed.
struct Renaming {
  std::string from, to;
};

/// The seeds after a correction. The seed of a vessel follows it: the seed has the vessel's new
/// name, and is removed with a vessel that is deleted or merged.
std::shared_ptr<const Seeds> seedsAfter(const Document& before,
                                        const std::shared_ptr<const formats::Case>& after,
                                        const Renaming& renaming) {
  const auto had = vesselLabels(before.value), has = vesselLabels(after);
  if (had == has) return before.seeds;
  const auto isGone = [&](const std::string& label) {
    return had.contains(label) && !has.contains(label);
  };
  auto seeds = std::make_shared<Seeds>(*before.seeds);
  for (convert::SeedBranch& seed : *seeds) {
    if (seed.label == renaming.from) seed.label = renaming.to;
    if (seed.parent == renaming.from) seed.parent = renaming.to;
  }
  std::erase_if(*seeds, [&](const convert::SeedBranch& seed) { return isGone(seed.label); });
  for (convert::SeedBranch& seed : *seeds)
    if (seed.parent && isGone(*seed.parent)) seed.parent.reset();
  return seeds;
}

/// Refuses the name of a seed that is not tracked yet: that seed would count as tracked.
Renaming renamingBy(const Arguments& request, const Document& document) {
  const auto& branches = document.value->tree.branches;
  Renaming renaming{branches[request.index("branch", branches.size())].label,
                    request.text("label")};
  const auto vessels = vesselLabels(document.value);
  for (const convert::SeedBranch& seed : *document.seeds)
    if (seed.label == renaming.to && !vessels.contains(seed.label))
      refuse("a seed has the name \"" + seed.label + "\"");
  return renaming;
}

constexpr std::size_t kMostSeeds = 10000;

convert::SeedBranch& findSeed(Seeds& seeds, const std::string& label) {
  const auto found = std::find_if(seeds.begin(), seeds.end(),
                                  [&label](const auto& seed) { return seed.label == label; });
  if (found == seeds.end()) refuse("there is no seed \"" + label + "\"");
  return *found;
}

std::string addSeed(Seeds& seeds, const Document& document, const Arguments& request) {
  if (seeds.size() >= kMostSeeds)
    refuse("there may be at most " + std::to_string(kMostSeeds) + " seeds");
  std::set<std::string> taken = takenLabels(document);
  for (const std::string_view label : vesselLabels(document.proposals)) taken.emplace(label);
  convert::SeedBranch seed;
  const auto kind = formats::enumFromName<formats::BranchKind>(formats::kBranchKindNames,
                                                               request.text("kind", "vessel"));
  if (!kind) refuse("\"kind\" must be vessel or aneurysm");
  seed.kind = *kind;
  seed.label = request.text("label", "");
  if (seed.label.empty()) seed.label = numberedLabel(request.text("kind", "vessel"), taken);
  if (taken.contains(seed.label)) refuse("\"" + seed.label + "\" is taken");
  if (request.has("parent")) {
    seed.parent = request.text("parent");
    if (!taken.contains(*seed.parent)) refuse("there is no vessel \"" + *seed.parent + "\"");
  }
  seed.points = request.points("points");
  seeds.push_back(seed);
  return seed.label;
}

std::string moveSeed(Seeds& seeds, const Document&, const Arguments& request) {
  const std::string label = request.text("label");
  convert::SeedBranch& seed = findSeed(seeds, label);
  convert::SeedPoint& point = seed.points[request.index("point", seed.points.size())];
  point.position = request.position("position");
  if (request.has("radius_mm")) point.radius = request.number("radius_mm");
  if (point.radius && !(*point.radius > 0)) refuse("\"radius_mm\" must be above 0");
  return label;
}

std::string deleteSeed(Seeds& seeds, const Document&, const Arguments& request) {
  const std::string label = request.text("label");
  findSeed(seeds, label);
  std::erase_if(seeds, [&label](const auto& seed) { return seed.label == label; });
  for (convert::SeedBranch& seed : seeds)
    if (seed.parent == label) seed.parent.reset();
  return label;
}

struct NamedChange {
  const char *name, *title;
  /// Changes the seeds and returns the label of the seed.
  std::string (*change)(Seeds& seeds, const Document& document, const Arguments& request);
};

constexpr NamedChange kChanges[] = {{"seed_add", "place seed ", addSeed},
                                    {"seed_move", "move seed ", moveSeed},
                                    {"seed_delete", "delete seed ", deleteSeed}};

}  // namespace

std::optional<Correction> correct(const std::string& op, const Arguments& request,
                                  const Document& document) {
  const std::vector<std::string>* const arguments = convert::editArguments(op);
  if (arguments == nullptr) return std::nullopt;
  if (!document.value) refuse("there is no case to correct");
  const Renaming renaming = op == "rename" ? renamingBy(request, document) : Renaming{};
  Correction correction;
  correction.value = std::make_shared<formats::Case>(*document.value);
  if (op == "delete" && request.has("labels")) {
    if (request.has("branch") || request.has("hanging"))
      refuse("\"labels\" stands alone: neither \"branch\" nor \"hanging\" goes with it");
    correction.change = deleteLabels(*correction.value, request.texts("labels"));
  } else {
    correction.change = convert::applyEdit(
        *correction.value, editRequest(op, *arguments, request, document.value->tree));
  }
  correction.document = document;
  correction.document.seeds = seedsAfter(document, correction.value, renaming);
  correction.document.value = correction.value;
  return correction;
}

std::optional<SeedChange> changeSeeds(const std::string& op, const Arguments& request,
                                      const Document& document) {
  const auto named = std::find_if(std::begin(kChanges), std::end(kChanges),
                                  [&op](const NamedChange& change) { return change.name == op; });
  if (named == std::end(kChanges)) return std::nullopt;
  auto seeds = std::make_shared<Seeds>(*document.seeds);
  SeedChange change;
  change.label = named->change(*seeds, document, request);
  change.title = named->title + change.label;
  change.document = document;
  change.document.seeds = std::move(seeds);
  return change;
}

}  // namespace lumen::viewer
