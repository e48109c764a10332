// SPDX-License-Identifier: Apache-2.0
// edit_request.h: making a correction, and keeping its request.
#include "converters/stages/editing/edit_request.h"

#include <functional>
#include <map>

#include <nlohmann/json.hpp>

#include "converters/base/edit_steps.h"
#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/stages/editing/edit.h"
#include "converters/stages/editing/edit_request_text.h"
#include "converters/stages/editing/wall_edits.h"
#include "formats/case/enum_names.h"

namespace lumen::convert {

namespace {

using formats::Case;

Change setNamedKind(Case& target, std::uint32_t branch, const std::string& word) {
  const auto kind = formats::enumFromName<formats::BranchKind>(formats::kBranchKindNames, word);
  if (!kind) throw invalidInput("\"kind\" must be vessel or aneurysm");
  return setKind(target, branch, *kind);
}

struct NamedEdit {
  std::vector<std::string> arguments;
  Change (*make)(Case&, const EditRequest&);
};

using R = EditRequest;
/// By name. Each is handed a request whose arguments are there.
const std::map<std::string, NamedEdit, std::less<>> kEdits = {
    {"delete",
     {{"branch", "word?"},
      [](Case& c, const R& r) {
        return deleteBranch(c, *r.branch, r.word == "go" ? Hanging::Go : Hanging::Stay);
      }}},
    {"cut",
     {{"node", "word?"},
      [](Case& c, const R& r) {
        return cutBefore(c, *r.node, r.word == "child" ? Rest::Child : Rest::OwnTree);
      }}},
    {"join",
     {{"branch", "node"}, [](Case& c, const R& r) { return joinBranch(c, *r.branch, *r.node); }}},
    {"merge", {{"branch"}, [](Case& c, const R& r) { return mergeIntoParent(c, *r.branch); }}},
    {"reverse", {{"branch"}, [](Case& c, const R& r) { return reverseBranch(c, *r.branch); }}},
    {"root", {{"branch"}, [](Case& c, const R& r) { return makeRoot(c, *r.branch); }}},
    {"rename",
     {{"branch", "word"}, [](Case& c, const R& r) { return renameBranch(c, *r.branch, r.word); }}},
    {"kind",
     {{"branch", "word"}, [](Case& c, const R& r) { return setNamedKind(c, *r.branch, r.word); }}},
    {"move",
     {{"node", "position", "radius"},
      [](Case& c, const R& r) { return moveNode(c, *r.node, *r.position, *r.radius); }}},
    {"widen",
     {{"node", "radius", "reach"},
      [](Case& c, const R& r) { return widenAround(c, *r.node, *r.radius, *r.reach); }}},
    {"push",
     {{"node", "position", "by", "radius"},
      [](Case& c, const R& r) {
        return pushWall(c, *r.node, {*r.position, *r.by, *r.radius});
      }}},
    {"nodeAdd", {{"node"}, [](Case& c, const R& r) { return addNodeBehind(c, *r.node); }}},
    {"nodeDelete", {{"node"}, [](Case& c, const R& r) { return deleteNode(c, *r.node); }}}};

bool isGiven(const EditRequest& request, const std::string& name) {
  if (name == "branch") return request.branch.has_value();
  if (name == "node") return request.node.has_value();
  if (name == "position") return request.position.has_value();
  if (name == "by") return request.by.has_value();
  if (name == "radius") return request.radius.has_value();
  if (name == "reach") return request.reach.has_value();
  return true;  // a word may be empty, which the correction itself refuses
}

}  // namespace

const std::vector<std::string>* editArguments(const std::string& op) {
  const auto found = kEdits.find(op);
  return found == kEdits.end() ? nullptr : &found->second.arguments;
}

Change applyEdit(Case& target, const EditRequest& request) {
  const auto found = kEdits.find(request.op);
  if (found == kEdits.end()) throw invalidInput("there is no correction \"" + request.op + "\"");
  for (const std::string& name : found->second.arguments)
    if (!isGiven(request, name))
      throw invalidInput("the correction \"" + request.op + "\" lacks \"" + name + "\"");
  const std::string text = textOfRequest(request, target.tree);
  Change change = found->second.make(target, request);
  recordRequest(target.metadata, text);
  return change;
}

bool hasEdits(const formats::Metadata& metadata) {
  return !recordedEdits(metadata).empty();
}

}  // namespace lumen::convert
