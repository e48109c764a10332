// SPDX-License-Identifier: Apache-2.0
// Session: corrections by hand. What moves a wall is fitted anew before anybody sees it.
#include <functional>
#include <utility>

#include "converters/common/error.h"
#include "converters/editing/edit.h"
#include "converters/fitting/refit.h"
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

Document withCase(const Document& document, std::shared_ptr<const formats::Case> value) {
  Document result = document;
  result.value = std::move(value);
  return result;
}

}  // namespace

Json Session::editOperation(const std::string& op, const Arguments& request, const Moment& from) {
  if (!from.document.value) throw Error(ErrorKind::Usage, "there is no case to correct");
  const Edit edit = editFor(op, request, from.document.value->tree);
  const auto value = std::make_shared<formats::Case>(*from.document.value);
  const convert::Change change = edit(*value);
  tellDropped(change.droppedArrays);
  if (change.stale.empty()) {
    commit(change.sentence, from, withCase(from.document, value));
    return {{"revision", m_history.now().revision}};
  }
  return startJob("fitting what changed", true, [this, from, value, change](Progress& progress) {
    convert::refit(*value, change.stale, convert::recordedFitOptions(*value), progress);
    commit(change.sentence, from, withCase(from.document, value));
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
