// SPDX-License-Identifier: Apache-2.0
// The functions of lumen/case.h that read and validate.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <variant>

#include "formats/api/handle.h"
#include "formats/case/case_file.h"
#include "formats/case/motion.h"

namespace lumen::formats::api {
namespace {

using Triple = const float (*)[3];
using Pair = const std::uint32_t (*)[2];
using PoseRow = const float (*)[8];

static_assert(sizeof(Vec3f) == 3 * sizeof(float));
static_assert(sizeof(std::array<std::uint32_t, 2>) == 2 * sizeof(std::uint32_t));
static_assert(sizeof(Pose) == 8 * sizeof(float));

Triple triples(const std::vector<Vec3f>& values) {
  return reinterpret_cast<Triple>(values.data());
}

std::span<const std::byte> bytesAt(const void* bytes, std::size_t size) {
  return {static_cast<const std::byte*>(bytes), size};
}

/// A path in UTF-8.
std::filesystem::path pathOf(const char* text) {
  return {text};
}

lumen_case_status keep(Expected<Case>&& read, lumen_case** out, lumen_case_fault* fault) {
  if (!read) return refuse(fault, read.error());
  *out = new lumen_case{*std::move(read)};
  return LUMEN_CASE_OK;
}

lumen_case_status hand(const ValidationReport& report, lumen_case_receive receive, void* user,
                       lumen_case_counts* counts) {
  if (counts) *counts = {report.counts.errors, report.counts.warnings, report.counts.information};
  for (const Issue& issue : report.issues) {
    const lumen_case_fault fault = faultOf(issue);
    if (receive) receive(&fault, user);
  }
  return report.valid() ? LUMEN_CASE_OK : LUMEN_CASE_ERROR_RULE;
}

}  // namespace
}  // namespace lumen::formats::api

using namespace lumen::formats;
using namespace lumen::formats::api;

extern "C" {

const char* lumen_case_version(void) noexcept {
  return LUMEN_VERSION;
}

const char* lumen_case_status_text(lumen_case_status status) noexcept {
  switch (status) {
    case LUMEN_CASE_OK:
      return "success";
    case LUMEN_CASE_ERROR_MEMORY:
      return "the system has no more memory";
    case LUMEN_CASE_ERROR_ARGUMENT:
      return "an argument is null, or no index, label or option";
    case LUMEN_CASE_ERROR_FILE:
      return "the file cannot be read, or is empty";
    case LUMEN_CASE_ERROR_RULE:
      return "the case breaks a rule of the format";
    case LUMEN_CASE_ERROR_WRITE:
      return "the file cannot be written";
  }
  return "unknown status";
}

lumen_case_status lumen_case_open(const char* path, lumen_case** out,
                                  lumen_case_fault* fault) noexcept {
  if (out) *out = nullptr;
  return guarded(fault, [&] {
    if (!path || !out) return refuseArgument(fault, "lumen_case_open() was handed a null pointer");
    return keep(readCaseFile(pathOf(path)), out, fault);
  });
}

lumen_case_status lumen_case_open_bytes(const void* bytes, size_t size, lumen_case** out,
                                        lumen_case_fault* fault) noexcept {
  if (out) *out = nullptr;
  return guarded(fault, [&] {
    if ((!bytes && size > 0) || !out)
      return refuseArgument(fault, "lumen_case_open_bytes() was handed a null pointer");
    return keep(decodeCase(bytesAt(bytes, size)), out, fault);
  });
}

lumen_case_status lumen_case_copy(const lumen_case* from, lumen_case** out) noexcept {
  if (out) *out = nullptr;
  return guarded(nullptr, [&] {
    if (!from || !out) return LUMEN_CASE_ERROR_ARGUMENT;
    *out = new lumen_case(*from);
    return LUMEN_CASE_OK;
  });
}

void lumen_case_close(lumen_case* value) noexcept {
  delete value;
}

lumen_case_nodes lumen_case_get_nodes(const lumen_case* value) noexcept {
  if (!value) return {};
  const CenterlineTree& tree = value->value.tree;
  return {tree.nodeCount(),        triples(tree.centre),
          triples(tree.direction), tree.radius.data(),
          tree.height.data(),      tree.parent.data(),
          tree.branch.data(),      tree.inlierRate.empty() ? nullptr : tree.inlierRate.data(),
          tree.links.size(),       reinterpret_cast<Pair>(tree.links.data())};
}

size_t lumen_case_branch_count(const lumen_case* value) noexcept {
  return value ? value->value.tree.branches.size() : 0;
}

lumen_case_branch lumen_case_get_branch(const lumen_case* value, size_t index) noexcept {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  if (index >= lumen_case_branch_count(value))
    return {nullptr, LUMEN_CASE_VESSEL, kNoParent, 0, 0, LUMEN_CASE_STOP_UNKNOWN, kUnknown};
  const Branch& branch = value->value.tree.branches[index];
  return {branch.label.c_str(),
          static_cast<lumen_case_kind>(branch.kind),
          branch.parentNode,
          branch.firstNode,
          branch.nodeCount,
          static_cast<lumen_case_stop>(branch.stopReason),
          branch.meanInlierRate.value_or(kUnknown)};
}

size_t lumen_case_find_branch(const lumen_case* value, const char* label) noexcept {
  for (size_t i = 0; label && i < lumen_case_branch_count(value); ++i)
    if (value->value.tree.branches[i].label == label) return i;
  return SIZE_MAX;
}

lumen_case_points lumen_case_get_points(const lumen_case* value) noexcept {
  if (!value || !value->value.points) return {};
  const PointSets& points = *value->value.points;
  return {points.position.size(), points.offset.data(), triples(points.position)};
}

lumen_case_models lumen_case_get_models(const lumen_case* value) noexcept {
  if (!value || !value->value.models) return {};
  const BlobbyModels& models = *value->value.models;
  return {static_cast<int32_t>(models.kernel),
          models.kernelParameter,
          models.isoLevel,
          models.centre.size(),
          models.offset.data(),
          triples(models.centre),
          models.width.data()};
}

lumen_case_motion lumen_case_get_motion(const lumen_case* value) noexcept {
  if (!value || !value->value.motion) return {};
  const Motion& motion = *value->value.motion;
  return {motion.time.size(), motion.time.data(), motion.period,
          motion.node.size(), motion.node.data(), reinterpret_cast<PoseRow>(motion.pose.data())};
}

lumen_case_status lumen_case_poses_at(const lumen_case* value, double time, size_t count,
                                      double (*pose)[8]) noexcept {
  return guarded(nullptr, [&] {
    if (!value || (count > 0 && !pose) || count != value->value.tree.nodeCount() ||
        !std::isfinite(time))
      return LUMEN_CASE_ERROR_ARGUMENT;
    const std::optional<Motion>& motion = value->value.motion;
    const Motion still{{0.0}, 0, {}, {}};
    const auto poses = posesAt(value->value.tree, motion ? *motion : still, time);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [centre, rotation, factor] = poses[i];
      const double row[8] = {centre.x,    centre.y,    centre.z,    rotation[0],
                             rotation[1], rotation[2], rotation[3], factor};
      std::copy(row, row + 8, pose[i]);
    }
    return LUMEN_CASE_OK;
  });
}

lumen_case_source lumen_case_get_source(const lumen_case* value) noexcept {
  lumen_case_source out{};
  if (!value || !value->value.metadata.source) return out;
  const SourceVolume& source = *value->value.metadata.source;
  std::copy(source.size.begin(), source.size.end(), out.size);
  std::copy(source.spacing.begin(), source.spacing.end(), out.spacing);
  std::copy(source.origin.begin(), source.origin.end(), out.origin);
  std::copy(source.direction.begin(), source.direction.end(), out.direction);
  out.sha256 = source.sha256.c_str();
  return out;
}

double lumen_case_voxel_size(const lumen_case* value) noexcept {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  return value ? value->value.metadata.voxelSize.value_or(kUnknown) : kUnknown;
}

const char* lumen_case_note(const lumen_case* value) noexcept {
  return value ? value->value.metadata.note.c_str() : "";
}

size_t lumen_case_step_count(const lumen_case* value) noexcept {
  return value ? value->value.metadata.steps.size() : 0;
}

lumen_case_step lumen_case_get_step(const lumen_case* value, size_t index) noexcept {
  if (index >= lumen_case_step_count(value)) return {};
  const Step& step = value->value.metadata.steps[index];
  return {step.name.c_str(), step.tool.c_str()};
}

size_t lumen_case_array_count(const lumen_case* value) noexcept {
  return value ? value->value.nodeArrays.size() : 0;
}

lumen_case_array lumen_case_get_array(const lumen_case* value, size_t index) noexcept {
  if (index >= lumen_case_array_count(value)) return {};
  const NodeArray& array = value->value.nodeArrays[index];
  const void* values =
      std::visit([](const auto& list) -> const void* { return list.data(); }, array.values);
  return {array.name.c_str(), array.unit.c_str(), array.components,
          static_cast<lumen_case_type>(array.values.index()), values};
}

lumen_case_status lumen_case_validate_bytes(const void* bytes, size_t size, size_t at_most,
                                            lumen_case_receive receive, void* user,
                                            lumen_case_counts* counts) noexcept {
  if (counts) *counts = {};
  return guarded(nullptr, [&] {
    if (!bytes && size > 0) return LUMEN_CASE_ERROR_ARGUMENT;
    // a list of no faults cannot keep its errors apart, so one is kept and not handed on
    const ValidationReport report =
        validateBytes(bytesAt(bytes, size), std::max<size_t>(at_most, 1));
    return hand(report, at_most > 0 ? receive : nullptr, user, counts);
  });
}

lumen_case_status lumen_case_validate_file(const char* path, size_t at_most,
                                           lumen_case_receive receive, void* user,
                                           lumen_case_counts* counts) noexcept {
  if (counts) *counts = {};
  return guarded(nullptr, [&] {
    if (!path) return LUMEN_CASE_ERROR_ARGUMENT;
    const auto bytes = readFileBytes(pathOf(path));
    if (bytes)
      return lumen_case_validate_bytes(bytes->data(), bytes->size(), at_most, receive, user,
                                       counts);
    lumen_case_fault fault{};
    const lumen_case_status status = refuse(&fault, bytes.error());
    if (counts) counts->errors = 1;
    if (receive && at_most > 0) receive(&fault, user);
    return status;
  });
}

}  // extern "C"
