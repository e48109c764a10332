// SPDX-License-Identifier: Apache-2.0
// The functions of lumen/case_edit.h that leave the number of nodes.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "formats/api/edited_case.h"
#include "formats/view/limits.h"
#include "lumen/case_edit.h"

namespace lumen::formats::api {
namespace {

std::vector<Vec3f> copyTriples(const float (*from)[3], std::size_t count) {
  std::vector<Vec3f> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = {from[i][0], from[i][1], from[i][2]};
  return out;
}

template <class T>
std::vector<T> copyValues(const void* from, std::size_t count) {
  const T* first = static_cast<const T*>(from);
  return {first, first + count};
}

/// Lets `change` work on a branch of the copy of a case.
template <class Change>
lumen_case_status editBranch(lumen_case* value, std::size_t branch, lumen_case_fault* fault,
                             Change change) {
  return edit(
      value, fault,
      [&](Case& edited) {
        if (branch >= edited.tree.branches.size())
          return refuseArgument(fault, "there is no such branch");
        change(edited.tree.branches[branch]);
        return LUMEN_CASE_OK;
      },
      Edits::Values);
}

std::vector<Pose> posesOf(const float (*from)[8], std::size_t count) {
  std::vector<Pose> poses(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* p = from[i];
    poses[i] = {{p[0], p[1], p[2]}, {p[3], p[4], p[5], p[6]}, p[7]};
  }
  return poses;
}

NodeArray arrayOf(const lumen_case_array& from, std::size_t nodes) {
  NodeArray array;
  array.name = from.name;
  array.unit = from.unit ? from.unit : "";
  array.components = from.components;
  const std::size_t count = nodes * from.components;
  if (from.type == LUMEN_CASE_F32) array.values = copyValues<float>(from.values, count);
  if (from.type == LUMEN_CASE_I32) array.values = copyValues<std::int32_t>(from.values, count);
  if (from.type == LUMEN_CASE_U32) array.values = copyValues<std::uint32_t>(from.values, count);
  return array;
}

auto findArray(std::vector<NodeArray>& arrays, std::string_view name) {
  return std::find_if(arrays.begin(), arrays.end(),
                      [&](const NodeArray& array) { return array.name == name; });
}

std::string extensionOf(std::string_view name) {
  return std::string(name.substr(0, name.find('.')));
}

}  // namespace
}  // namespace lumen::formats::api

using namespace lumen::formats;
using namespace lumen::formats::api;

extern "C" {

lumen_case_status lumen_case_set_label(lumen_case* value, size_t branch, const char* label,
                                       lumen_case_fault* fault) noexcept {
  if (!label) return refuseArgument(fault, "lumen_case_set_label() was handed a null pointer");
  return editBranch(value, branch, fault, [&](Branch& edited) { edited.label = label; });
}

lumen_case_status lumen_case_set_kind(lumen_case* value, size_t branch, lumen_case_kind kind,
                                      lumen_case_fault* fault) noexcept {
  return editBranch(value, branch, fault,
                    [&](Branch& edited) { edited.kind = static_cast<BranchKind>(kind); });
}

lumen_case_status lumen_case_set_node(lumen_case* value, size_t node, const float centre[3],
                                      float radius, lumen_case_fault* fault) noexcept {
  return edit(value, fault, [&](Case& edited) {
    if (!centre || node >= edited.tree.nodeCount())
      return refuseArgument(fault, "there is no such node, or no centre for it");
    edited.tree.centre[node] = {centre[0], centre[1], centre[2]};
    edited.tree.radius[node] = radius;
    edited.motion.reset();
    return LUMEN_CASE_OK;
  });
}

lumen_case_status lumen_case_set_points(lumen_case* value, const lumen_case_points* points,
                                        lumen_case_fault* fault) noexcept {
  return edit(value, fault, [&](Case& edited) {
    edited.metadata.pointQuantisation.reset();
    edited.points.reset();
    if (!points) return LUMEN_CASE_OK;
    if (!points->offset || (points->count > 0 && !points->position) || points->count > kMaxPoints)
      return refuseArgument(fault, "wall points need offsets and positions, at most 268435456");
    edited.points =
        PointSets{copyValues<std::uint32_t>(points->offset, edited.tree.nodeCount() + 1),
                  copyTriples(points->position, points->count)};
    return LUMEN_CASE_OK;
  });
}

lumen_case_status lumen_case_set_models(lumen_case* value, const lumen_case_models* models,
                                        lumen_case_fault* fault) noexcept {
  return edit(value, fault, [&](Case& edited) {
    edited.models.reset();
    if (!models) return LUMEN_CASE_OK;
    if (!models->offset || (models->count > 0 && (!models->centre || !models->width)) ||
        models->count > kMaxBlobs)
      return refuseArgument(fault, "models need offsets, centres and widths, at most 67108864");
    if (models->kernel < 0 || models->kernel > 255)
      return refuseArgument(fault, "there is no such kernel");
    edited.models =
        BlobbyModels{static_cast<Kernel>(models->kernel),
                     models->kernel_parameter,
                     models->iso_level,
                     copyValues<std::uint32_t>(models->offset, edited.tree.nodeCount() + 1),
                     copyTriples(models->centre, models->count),
                     copyValues<float>(models->width, models->count)};
    return LUMEN_CASE_OK;
  });
}

lumen_case_status lumen_case_set_motion(lumen_case* value, const lumen_case_motion* motion,
                                        lumen_case_fault* fault) noexcept {
  return edit(
      value, fault,
      [&](Case& edited) {
        edited.motion.reset();
        if (!motion) return LUMEN_CASE_OK;
        const std::size_t times = motion->time_count, nodes = motion->node_count;
        if (!motion->time || (nodes > 0 && (!motion->node || !motion->pose)))
          return refuseArgument(fault, "a motion needs times, nodes and poses");
        if (times == 0 || times > kMaxTimes || nodes > kMaxNodes || times * nodes > kMaxPoses)
          return refuseArgument(fault, "a motion has 1 to 4096 times, and at most 67108864 poses");
        edited.motion = Motion{copyValues<double>(motion->time, times), motion->period,
                               copyValues<std::uint32_t>(motion->node, nodes),
                               posesOf(motion->pose, times * nodes)};
        return LUMEN_CASE_OK;
      },
      Edits::Values);
}

lumen_case_status lumen_case_set_array(lumen_case* value, const lumen_case_array* array,
                                       lumen_case_fault* fault) noexcept {
  return edit(
      value, fault,
      [&](Case& edited) {
        if (!array || !array->name || !array->values)
          return refuseArgument(fault, "lumen_case_set_array() was handed a null pointer");
        if (array->type < LUMEN_CASE_F32 || array->type > LUMEN_CASE_U32)
          return refuseArgument(fault, "there is no such type of values");
        if (array->components < 1 || array->components > kMaxComponents)
          return refuseArgument(fault, "a node array has 1 to 16 components");
        NodeArray made = arrayOf(*array, edited.tree.nodeCount());
        auto& used = edited.metadata.extensionsUsed;
        if (const std::string extension = extensionOf(made.name);
            std::find(used.begin(), used.end(), extension) == used.end())
          used.push_back(extension);
        const auto old = findArray(edited.nodeArrays, made.name);
        if (old != edited.nodeArrays.end())
          *old = std::move(made);
        else
          edited.nodeArrays.push_back(std::move(made));
        return LUMEN_CASE_OK;
      },
      Edits::Values);
}

lumen_case_status lumen_case_remove_array(lumen_case* value, const char* name,
                                          lumen_case_fault* fault) noexcept {
  return edit(
      value, fault,
      [&](Case& edited) {
        const auto found = name ? findArray(edited.nodeArrays, name) : edited.nodeArrays.end();
        if (found == edited.nodeArrays.end())
          return refuseArgument(fault, "there is no such node array");
        edited.nodeArrays.erase(found);
        return LUMEN_CASE_OK;
      },
      Edits::Values);
}

lumen_case_status lumen_case_set_note(lumen_case* value, const char* note,
                                      lumen_case_fault* fault) noexcept {
  return edit(
      value, fault,
      [&](Case& edited) {
        edited.metadata.note = note ? note : "";
        return LUMEN_CASE_OK;
      },
      Edits::Values);
}

lumen_case_status lumen_case_add_step(lumen_case* value, const char* name, const char* tool,
                                      lumen_case_fault* fault) noexcept {
  return edit(
      value, fault,
      [&](Case& edited) {
        if (!name || !tool)
          return refuseArgument(fault, "lumen_case_add_step() was handed a null pointer");
        edited.metadata.steps.push_back(Step{name, tool, {}});
        return LUMEN_CASE_OK;
      },
      Edits::Values);
}

}  // extern "C"
