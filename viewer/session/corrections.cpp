// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/corrections.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <set>
#include <utility>

#include "converters/base/error.h"
#include "converters/stages/editing/wall_edits.h"
#include "formats/case/enum_names.h"

namespace lumen::viewer {

namespace {

using Edit = std::function<convert::Change(formats::Case&)>;

template <class Choice>
Choice chosen(const Arguments& request, const char* name, const std::string& second,
              Choice otherwise, Choice ifSecond) {
  return request.text(name, "") == second ? ifSecond : otherwise;
}

convert::Change setKind(formats::Case& value, std::uint32_t branch, const std::string& name) {
  const auto kind = formats::enumFromName<formats::BranchKind>(formats::kBranchKindNames, name);
  if (!kind) throw Error(ErrorKind::Usage, "\"kind\" must be vessel or aneurysm");
  return convert::setKind(value, branch, *kind);
}

struct NamedEdit {
  const char* name;
  /// The correction with checked arguments.
  Edit (*edit)(const Arguments& request, const formats::CenterlineTree& tree);
};

std::uint32_t branchIn(const Arguments& request, const formats::CenterlineTree& tree) {
  return request.index("branch", tree.branches.size());
}

std::uint32_t nodeIn(const Arguments& request, const formats::CenterlineTree& tree) {
  return request.index("node", tree.nodeCount());
}

/// A correction of one branch that needs nothing else.
template <auto function>
Edit editOfBranch(const Arguments& request, const formats::CenterlineTree& tree) {
  return [b = branchIn(request, tree)](formats::Case& value) { return function(value, b); };
}

using Tree = formats::CenterlineTree;

constexpr NamedEdit kEdits[] = {
    {"delete",
     [](const Arguments& request, const Tree& tree) -> Edit {
       return [b = branchIn(request, tree),
               h = chosen(request, "hanging", "go", convert::Hanging::Stay, convert::Hanging::Go)](
                  formats::Case& value) { return convert::deleteBranch(value, b, h); };
     }},
    {"cut",
     [](const Arguments& request, const Tree& tree) -> Edit {
       return [n = nodeIn(request, tree),
               r = chosen(request, "rest", "child", convert::Rest::OwnTree, convert::Rest::Child)](
                  formats::Case& value) { return convert::cutBefore(value, n, r); };
     }},
    {"join",
     [](const Arguments& request, const Tree& tree) -> Edit {
       return [b = branchIn(request, tree), n = nodeIn(request, tree)](formats::Case& value) {
         return convert::joinBranch(value, b, n);
       };
     }},
    {"merge", editOfBranch<convert::mergeIntoParent>},
    {"reverse", editOfBranch<convert::reverseBranch>},
    {"root", editOfBranch<convert::makeRoot>},
    {"rename",
     [](const Arguments& request, const Tree& tree) -> Edit {
       return [b = branchIn(request, tree), label = request.text("label")](formats::Case& value) {
         return convert::renameBranch(value, b, label);
       };
     }},
    {"move",
     [](const Arguments& request, const Tree& tree) -> Edit {
       return [n = nodeIn(request, tree), p = request.position("position"),
               r = request.number("radius")](formats::Case& value) {
         return convert::moveNode(value, n, p, r);
       };
     }},
    {"widen",
     [](const Arguments& request, const Tree& tree) -> Edit {
       return [n = nodeIn(request, tree), radius = request.number("radius"),
               reach = request.number("reach")](formats::Case& value) {
         return convert::widenAround(value, n, radius, reach);
       };
     }},
    {"push",
     [](const Arguments& request, const Tree& tree) -> Edit {
       return [n = nodeIn(request, tree),
               stroke = convert::Stroke{request.position("at"), request.position("by"),
                                        request.number("radius")}](formats::Case& value) {
         return convert::pushWall(value, n, stroke);
       };
     }},
    {"nodeAdd",
     [](const Arguments& request, const Tree& tree) -> Edit {
       return [n = nodeIn(request, tree)](formats::Case& value) {
         return convert::addNodeBehind(value, n);
       };
     }},
    {"nodeDelete",
     [](const Arguments& request, const Tree& tree) -> Edit {
       return [n = nodeIn(request, tree)](formats::Case& value) {
         return convert::deleteNode(value, n);
       };
     }},
    {"kind",
     [](const Arguments& request, const Tree& tree) -> Edit {
       return [b = branchIn(request, tree), kind = request.text("kind")](formats::Case& value) {
         return setKind(value, b, kind);
       };
     }},
};

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
  const auto named = std::find_if(std::begin(kEdits), std::end(kEdits),
                                  [&op](const NamedEdit& edit) { return edit.name == op; });
  if (named == std::end(kEdits)) return std::nullopt;
  if (!document.value) throw Error(ErrorKind::Usage, "there is no case to correct");
  const Renaming renaming = op == "rename" ? renamingBy(request, document) : Renaming{};
  const Edit edit = named->edit(request, document.value->tree);
  Correction correction;
  correction.value = std::make_shared<formats::Case>(*document.value);
  correction.change = edit(*correction.value);
  correction.document = document;
  correction.document.seeds = seedsAfter(document, *correction.value, renaming);
  correction.document.value = correction.value;
  return correction;
}

}  // namespace lumen::viewer
