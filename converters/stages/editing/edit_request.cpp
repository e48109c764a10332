// SPDX-License-Identifier: Apache-2.0
// edit_request.h: making a correction, and keeping its request.
#include "converters/stages/editing/edit_request.h"

#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include <nlohmann/json.hpp>

#include "converters/base/error.h"
#include "converters/base/json_place.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/stages/editing/edit.h"
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
    {"node_add", {{"node"}, [](Case& c, const R& r) { return addNodeBehind(c, *r.node); }}},
    {"node_delete", {{"node"}, [](Case& c, const R& r) { return deleteNode(c, *r.node); }}}};

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

namespace {

using formats::CenterlineTree;
using Json = nlohmann::ordered_json;
using Eigen::Vector3d;

// A vessel is found again within this multiple of its radius: rerun tracks differ by less, and the
// next vessel is farther away.
constexpr double kSearchRadii = 2;

/// To a tenth of a micrometre, which no volume resolves.
double rounded(double mm) {
  return std::round(mm * 1e4) / 1e4;
}

Json vectorJson(const Vector3d& v) {
  return {rounded(v.x()), rounded(v.y()), rounded(v.z())};
}

Json anchorOf(std::uint32_t node, const CenterlineTree& tree) {
  return {{"label", tree.branches[tree.branch[node]].label},
          {"at", vectorJson(toEigen(tree.centre[node]))},
          {"radius", rounded(static_cast<double>(tree.radius[node]))}};
}

struct Anchor {
  std::string label;
  Vector3d at = Vector3d::Zero();
  double radius = 0;
};

Anchor anchorIn(const JsonPlace& json) {
  Anchor anchor{json.at("label").text(), json.at("at").vector(), json.at("radius").number()};
  if (!(anchor.radius > 0)) json.at("radius").refuse("a number above 0");
  return anchor;
}

/// The nearest node within reach of the anchor, of its label if there is one.
std::uint32_t nodeAt(const Anchor& anchor, const CenterlineTree& tree) {
  const double most = kSearchRadii * anchor.radius;
  std::uint32_t best = 0, bestNamed = 0;
  double least = std::numeric_limits<double>::infinity(), leastNamed = least;
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
    const double distance = (toEigen(tree.centre[i]) - anchor.at).norm();
    if (distance < least) least = distance, best = i;
    const bool isNamed = tree.branches[tree.branch[i]].label == anchor.label;
    if (isNamed && distance < leastNamed) leastNamed = distance, bestNamed = i;
  }
  if (leastNamed <= most) return bestNamed;
  if (least <= most) return best;
  throw invalidInput("no vessel lies within " + fixedText(most, 1) + " mm of " +
                     placeText(anchor.at));
}

std::uint32_t middleNode(const formats::Branch& branch) {
  return branch.firstNode + branch.nodeCount / 2;
}

/// The name today of a correction that a released file may have.
std::string nameToday(std::string op) {
  if (op == "nodeAdd") return "node_add";
  if (op == "nodeDelete") return "node_delete";
  return op;
}

}  // namespace

std::string textOfRequest(const EditRequest& request, const CenterlineTree& tree) {
  Json json{{"op", request.op}};
  if (request.branch)
    json["branch"] = anchorOf(middleNode(tree.branches.at(*request.branch)), tree);
  if (request.node && *request.node < tree.nodeCount())
    json["node"] = anchorOf(*request.node, tree);
  if (!request.word.empty()) json["word"] = request.word;
  if (request.position) json["position"] = vectorJson(*request.position);
  if (request.by) json["by"] = vectorJson(*request.by);
  if (request.radius) json["radius"] = rounded(*request.radius);
  if (request.reach) json["reach"] = rounded(*request.reach);
  return json.dump();
}

EditRequest requestInTree(const std::string& text, const CenterlineTree& tree) {
  JsonFile file(text, "correction");
  const JsonPlace json(file);
  json.onlyKeys({"op", "branch", "node", "word", "position", "by", "radius", "reach"});
  EditRequest request;
  request.op = nameToday(json.at("op").text());
  if (json.has("branch")) request.branch = tree.branch[nodeAt(anchorIn(json.at("branch")), tree)];
  if (json.has("node")) request.node = nodeAt(anchorIn(json.at("node")), tree);
  if (json.has("word")) request.word = json.at("word").text();
  if (json.has("position")) request.position = json.at("position").vector();
  if (json.has("by")) request.by = json.at("by").vector();
  if (json.has("radius")) request.radius = json.at("radius").number();
  if (json.has("reach")) request.reach = json.at("reach").number();
  return request;
}

}  // namespace lumen::convert
