// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/corrections.h"

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/stages/editing/edit_request.h"

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
    if (name == "radius") edit.radius = request.number("radius");
    if (name == "reach") edit.reach = request.number("reach");
  }
  return edit;
}

/// A vessel's label before and after; both empty if none is renamed.
struct Renaming {
  std::string from, to;
};

std::set<std::string> labelsOf(const formats::Case& value) {
  std::set<std::string> labels;
  for (const formats::Branch& branch : value.tree.branches) labels.insert(branch.label);
  return labels;
}

/// The seeds after a correction. The seed of a vessel follows it: the seed has the vessel's new
/// name, and is removed with a vessel that is deleted or merged.
std::shared_ptr<const Seeds> seedsAfter(const Document& before, const formats::Case& after,
                                        const Renaming& renaming) {
  const std::set<std::string> had = labelsOf(*before.value), has = labelsOf(after);
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
  const std::set<std::string> vessels = labelsOf(*document.value);
  for (const convert::SeedBranch& seed : *document.seeds)
    if (seed.label == renaming.to && !vessels.contains(seed.label))
      throw Error(ErrorKind::Usage, "a seed has the name \"" + seed.label + "\"");
  return renaming;
}

}  // namespace

std::optional<Correction> correct(const std::string& op, const Arguments& request,
                                  const Document& document) {
  const std::vector<std::string>* const arguments = convert::editArguments(op);
  if (arguments == nullptr) return std::nullopt;
  if (!document.value) throw Error(ErrorKind::Usage, "there is no case to correct");
  const Renaming renaming = op == "rename" ? renamingBy(request, document) : Renaming{};
  const convert::EditRequest edit = editRequest(op, *arguments, request, document.value->tree);
  Correction correction;
  correction.value = std::make_shared<formats::Case>(*document.value);
  correction.change = convert::applyEdit(*correction.value, edit);
  correction.document = document;
  correction.document.seeds = seedsAfter(document, *correction.value, renaming);
  correction.document.value = correction.value;
  return correction;
}

}  // namespace lumen::viewer
