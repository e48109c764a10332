// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/case_pack.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "converters/judge/facts/case_info.h"
#include "converters/judge/facts/reachable.h"
#include "converters/stages/fitting/error_of_fit.h"
#include "formats/case/edited_walls.h"
#include "formats/case/enum_names.h"
#include "formats/case/node_origin.h"
#include "formats/case/topology.h"
#include "formats/field/pose.h"
#include "viewer/session/pack.h"

namespace lumen::viewer {

namespace {

Json branchesJson(const formats::CenterlineTree& tree) {
  Json list = Json::array();
  for (const formats::Branch& branch : tree.branches) {
    const auto mean = branch.meanInlierRate;
    list.push_back({{"label", branch.label},
                    {"kind", formats::enumName(formats::kBranchKindNames, branch.kind)},
                    {"parentNode", branch.parentNode},
                    {"firstNode", branch.firstNode},
                    {"nodeCount", branch.nodeCount},
                    {"stopReason", formats::enumName(formats::kStopReasonNames, branch.stopReason)},
                    {"confidence", mean ? engine::jsonNumber(*mean) : Json(nullptr)},
                    {"length", engine::jsonNumber(formats::branchLength(tree, branch))}});
  }
  return list;
}

Json stepsJson(const formats::Metadata& metadata) {
  Json list = Json::array();
  for (const formats::Step& step : metadata.steps) {
    Json parameters = Json::object();
    for (const auto& [name, value] : step.parameters)
      std::visit([&parameter = parameters[name]](const auto& v) { parameter = v; }, value);
    list.push_back(
        {{"name", step.name}, {"tool", step.tool}, {"parameters", std::move(parameters)}});
  }
  return list;
}

/// mm along the tree from each node's root; a node's parent has a smaller index.
std::vector<float> rootDistances(const formats::CenterlineTree& tree) {
  std::vector<double> distance(tree.nodeCount(), 0);
  for (std::uint32_t node = 0; node < tree.nodeCount(); ++node)
    if (const std::int32_t parent = tree.parent[node]; parent >= 0)
      distance[node] = distance[static_cast<std::size_t>(parent)] + formats::edgeLength(tree, node);
  return {distance.begin(), distance.end()};
}

Json reachableJson(const formats::Case& value, const Progress& progress) {
  const auto reach = convert::measureReach(value, progress);
  if (!reach) return nullptr;
  Json closed = Json::array();
  for (const convert::ClosedPath& path : reach->closed)
    closed.push_back({{"node", path.node},
                      {"position", {path.position.x, path.position.y, path.position.z}},
                      {"beyond", path.beyond}});
  return {{"reached", reach->length},
          {"total", reach->of},
          {"trees", reach->trees},
          {"closed", std::move(closed)}};
}

void addNodes(PackWriter& pack, const formats::CenterlineTree& tree) {
  pack.add("centre", std::span(tree.centre));
  pack.add("direction", std::span(tree.direction));
  pack.add("radius", tree.radius);
  pack.add("height", tree.height);
  pack.add("parent", tree.parent);
  pack.add("branch", tree.branch);
  if (!tree.inlierRate.empty()) pack.add("inlierRate", tree.inlierRate);
  pack.add("rootDistance", rootDistances(tree));
  pack.add("links", std::span(tree.links));
}

void addOrigins(PackWriter& pack, const formats::Case& value) {
  const bool stated = std::any_of(value.nodeArrays.begin(), value.nodeArrays.end(),
                                  [](const auto& a) { return a.name == formats::kOriginArray; });
  if (!stated) return;
  std::vector<std::uint8_t> origins;
  for (const formats::NodeOrigin origin : formats::readNodeOrigins(value))
    origins.push_back(static_cast<std::uint8_t>(origin));
  pack.add("origin", origins);
}

void addEdited(PackWriter& pack, const formats::Case& value) {
  const std::vector<bool> edited = formats::readEditedWalls(value);
  if (std::find(edited.begin(), edited.end(), true) != edited.end())
    pack.add("edited", std::vector<std::uint8_t>(edited.begin(), edited.end()));
}

/// Poses of the moving nodes, time by time; the rotations have the length 1.
void addMotion(PackWriter& pack, const std::optional<formats::Motion>& motion) {
  if (!motion) {
    pack.set("motion", nullptr);
    return;
  }
  std::vector<formats::Vec3f> centre;
  std::vector<float> rotation, factor;
  for (const formats::Pose& pose : motion->pose) {
    const auto& [x, y, z, w] = pose.rotation;
    for (const double part : field::unit({x, y, z, w}))
      rotation.push_back(static_cast<float>(part));
    centre.push_back(pose.centre);
    factor.push_back(pose.factor);
  }
  pack.set("motion", {{"times", motion->time},
                      {"period", motion->period > 0 ? Json(motion->period) : Json(nullptr)}});
  pack.add("motionNode", motion->node);
  pack.add("motionCentre", std::span(std::as_const(centre)));
  pack.add("motionRotation", std::span(std::as_const(rotation)), {motion->pose.size(), 4});
  pack.add("motionFactor", factor);
}

}  // namespace

std::string casePack(const formats::Case& value, bool withPoints, Progress& progress) {
  PackWriter pack;
  addNodes(pack, value.tree);
  addOrigins(pack, value);
  addEdited(pack, value);
  if (value.points && value.models)
    pack.add("error",
             convert::errorOfFit(value, convert::fittedNeighbourhood(value.metadata), progress));
  if (value.points && withPoints) {
    pack.add("pointOffset", value.points->offset);
    pack.add("point", std::span(value.points->position));
  }
  addMotion(pack, value.motion);
  pack.set("branches", branchesJson(value.tree));
  const auto& voxel = value.metadata.voxelSize;
  pack.set("voxelSize", voxel ? engine::jsonNumber(*voxel) : Json(nullptr));
  pack.set("hasModels", value.models.has_value());
  pack.set("reachable", reachableJson(value, progress));
  pack.set("steps", stepsJson(value.metadata));
  return pack.bytes();
}

}  // namespace lumen::viewer
