// SPDX-License-Identifier: Apache-2.0
// Session: corrections by hand. What moves a wall is fitted anew before anybody sees it.
#include <functional>
#include <set>
#include <utility>

#include "converters/base/error.h"
#include "converters/stages/editing/edit.h"
#include "converters/stages/fitting/refit.h"
#include "formats/case/enum_names.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

namespace {

using Edit = std::function<convert::Change(formats::Case&)>;

template <class Choice>
Choice chosen(const Arguments& request, const char* name, const std::string& second,
              Choice otherwise, Choice ifSecond) {
  return request.text(name, "") == second ? ifSecond : otherwise;
}

/// The correction that is asked for; what it needs is checked.
Edit editFor(const std::string& op, const Arguments& request, const formats::CenterlineTree& tree) {
  const auto branch = [&] { return request.index("branch", tree.branches.size()); };
  const auto node = [&] { return request.index("node", tree.nodeCount()); };
  if (op == "delete")
    return [b = branch(),
            h = chosen(request, "hanging", "go", convert::Hanging::Stay, convert::Hanging::Go)](
               formats::Case& value) { return convert::deleteBranch(value, b, h); };
  if (op == "cut")
    return [n = node(),
            r = chosen(request, "rest", "child", convert::Rest::OwnTree, convert::Rest::Child)](
               formats::Case& value) { return convert::cutBefore(value, n, r); };
  if (op == "join")
    return [b = branch(), n = node()](formats::Case& value) {
      return convert::joinBranch(value, b, n);
    };
  if (op == "merge")
    return [b = branch()](formats::Case& value) { return convert::mergeIntoParent(value, b); };
  if (op == "reverse")
    return [b = branch()](formats::Case& value) { return convert::reverseBranch(value, b); };
  if (op == "root")
    return [b = branch()](formats::Case& value) { return convert::makeRoot(value, b); };
  if (op == "rename")
    return [b = branch(), label = request.text("label")](formats::Case& value) {
      return convert::renameBranch(value, b, label);
    };
  if (op == "move")
    return [n = node(), p = request.position("position"), r = request.number("radius")](
               formats::Case& value) { return convert::moveNode(value, n, p, r); };
  if (op != "kind") throw Error(ErrorKind::Usage, "there is no operation \"" + op + "\"");
  const auto kind =
      formats::enumFromName<formats::BranchKind>(formats::kBranchKindNames, request.text("kind"));
  if (!kind) throw Error(ErrorKind::Usage, "\"kind\" must be vessel or aneurysm");
  return [b = branch(), k = *kind](formats::Case& value) { return convert::setKind(value, b, k); };
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

/// The seeds after a correction. That of a vessel goes with it: it has the vessel's new name, and
/// none is left to wait for tracking again when the vessel is deleted or merged.
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

/// The document with the case that a correction left.
Document corrected(const Document& document, std::shared_ptr<const formats::Case> value,
                   const Renaming& renaming) {
  Document result = document;
  result.seeds = seedsAfter(document, *value, renaming);
  result.value = std::move(value);
  return result;
}

/// Refuses the name of a seed that waits: it would count as tracked.
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

Json Session::editOperation(const std::string& op, const Arguments& request, const Moment& from) {
  if (!from.document.value) throw Error(ErrorKind::Usage, "there is no case to correct");
  const Renaming renaming = op == "rename" ? renamingBy(request, from.document) : Renaming{};
  const Edit edit = editFor(op, request, from.document.value->tree);
  const auto value = std::make_shared<formats::Case>(*from.document.value);
  const convert::Change change = edit(*value);
  tellDropped(change.droppedArrays);
  if (change.stale.empty()) {
    commit(change.sentence, from, corrected(from.document, value, renaming));
    return {{"revision", m_history.now().revision}};
  }
  return startJob(
      "fitting what changed", true, [this, from, value, change, renaming](Progress& progress) {
        convert::refit(*value, change.stale, convert::recordedFitOptions(*value), progress);
        commit(change.sentence, from, corrected(from.document, value, renaming));
        return change.sentence;
      });
}

void Session::tellDropped(const std::vector<std::string>& arrays) {
  for (const std::string& name : arrays)
    m_events.tell("message",
                  {{"severity", "warning"},
                   {"text", shownText("the node array " + name +
                                      " is dropped: nobody knows its values at new nodes")}});
}

}  // namespace lumen::viewer
