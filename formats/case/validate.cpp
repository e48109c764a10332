// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string_view>
#include <unordered_set>

#include "formats/case/enum_names.h"
#include "formats/case/error_text.h"
#include "formats/case/limits.h"
#include "formats/case/text_rules.h"
#include "formats/case/validate_parts.h"

namespace lumen::formats {
namespace {

constexpr double kDirectionTolerance = 1e-3;

std::string at(const std::string& array, std::size_t index) {
  return array + "/" + std::to_string(index);
}

Problem checkLength(std::size_t found, std::size_t expected, const std::string& place) {
  if (found == expected) return std::nullopt;
  return makeError(
      ErrorCode::ArrayLength, place,
      "found " + std::to_string(found) + " entries, expected " + std::to_string(expected));
}

Problem checkLimit(std::size_t found, std::size_t limit, const std::string& place) {
  if (found <= limit) return std::nullopt;
  return makeError(
      ErrorCode::Limit, place,
      "found " + std::to_string(found) + " entries, the limit is " + std::to_string(limit));
}

template <class Number>
FormatError notFinite(Number value, std::string place) {
  return makeError(ErrorCode::NotFinite, std::move(place),
                   "found " + shortText(value) + ", expected a finite number");
}

Problem checkFinite(const std::vector<Vec3f>& vectors, const std::string& place) {
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const Vec3f& v = vectors[i];
    if (!std::isfinite(v.x)) return notFinite(v.x, at(place, i) + "/0");
    if (!std::isfinite(v.y)) return notFinite(v.y, at(place, i) + "/1");
    if (!std::isfinite(v.z)) return notFinite(v.z, at(place, i) + "/2");
  }
  return std::nullopt;
}

bool isPositive(float value) {
  return value > 0;
}
bool isNotNegative(float value) {
  return value >= 0;
}
bool isRate(float value) {
  return value >= 0 && value <= 1;
}

// What the values of an array must be, beside finite.
struct ValueRule {
  bool (*legal)(float);
  ErrorCode code;
  const char* expected;
};
constexpr ValueRule kRadiusRule{isPositive, ErrorCode::RadiusRange, "more than 0 mm"};
constexpr ValueRule kHeightRule{isNotNegative, ErrorCode::HeightRange, "0 mm or more"};
constexpr ValueRule kRateRule{isRate, ErrorCode::InlierRateRange, "a rate from 0 to 1"};
constexpr ValueRule kWidthRule{isPositive, ErrorCode::WidthRange, "more than 0 mm"};

bool obeys(float value, const ValueRule& rule) {
  return std::isfinite(value) && rule.legal(value);
}

FormatError brokenValue(float value, const ValueRule& rule, std::string place) {
  if (!std::isfinite(value)) return notFinite(value, std::move(place));
  return makeError(rule.code, std::move(place),
                   "found " + shortText(value) + ", expected " + rule.expected);
}

Problem checkValues(const std::vector<float>& values, const std::string& place,
                    const ValueRule& rule) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!obeys(values[i], rule)) return brokenValue(values[i], rule, at(place, i));
  return std::nullopt;
}

Problem checkDirections(const std::vector<Vec3f>& directions) {
  const std::string place = "/tree/direction";
  if (auto problem = checkFinite(directions, place)) return problem;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double x = directions[i].x, y = directions[i].y, z = directions[i].z;
    const double length = std::sqrt(x * x + y * y + z * z);
    if (!(std::abs(length - 1.0) <= kDirectionTolerance))
      return makeError(ErrorCode::DirectionLength, at(place, i),
                       "found length " + shortText(length) + ", expected 1 within 0.001");
  }
  return std::nullopt;
}

Problem checkNodeArrays(const CenterlineTree& tree) {
  const std::size_t count = tree.nodeCount();
  if (count == 0)
    return makeError(ErrorCode::TreeEmpty, "/tree/centre", "found no node, expected at least 1");
  if (auto p = checkLimit(count, kMaxNodes, "/tree/centre")) return p;
  if (auto p = checkLength(tree.direction.size(), count, "/tree/direction")) return p;
  if (auto p = checkLength(tree.radius.size(), count, "/tree/radius")) return p;
  if (auto p = checkLength(tree.height.size(), count, "/tree/height")) return p;
  if (auto p = checkLength(tree.parent.size(), count, "/tree/parent")) return p;
  if (auto p = checkLength(tree.branch.size(), count, "/tree/branch")) return p;
  if (!tree.inlierRate.empty())
    if (auto p = checkLength(tree.inlierRate.size(), count, "/tree/inlierRate")) return p;
  return checkLimit(tree.branches.size(), kMaxBranches, "/tree/branches");
}

Problem checkNodeValues(const CenterlineTree& tree) {
  if (auto p = checkFinite(tree.centre, "/tree/centre")) return p;
  if (auto p = checkDirections(tree.direction)) return p;
  if (auto p = checkValues(tree.radius, "/tree/radius", kRadiusRule)) return p;
  if (auto p = checkValues(tree.height, "/tree/height", kHeightRule)) return p;
  return checkValues(tree.inlierRate, "/tree/inlierRate", kRateRule);
}

Problem checkParents(const std::vector<std::int32_t>& parent) {
  for (std::size_t i = 0; i < parent.size(); ++i)
    if (parent[i] < kNoParent || parent[i] >= static_cast<std::int64_t>(i))
      return makeError(ErrorCode::NodeParent, at("/tree/parent", i),
                       "found " + std::to_string(parent[i]) + ", expected -1 or a node before " +
                           std::to_string(i));
  return std::nullopt;
}

Problem checkBranchValues(const Branch& branch, const std::string& place) {
  if (branch.label.empty())
    return makeError(ErrorCode::LabelEmpty, place + "/label", "the label is empty");
  if (auto p = checkText(branch.label, kMaxNameBytes, place + "/label")) return p;
  if (enumName(kBranchKindNames, branch.kind).empty())
    return makeError(ErrorCode::EnumValue, place + "/kind",
                     "found kind " + std::to_string(static_cast<int>(branch.kind)));
  if (enumName(kStopReasonNames, branch.stopReason).empty())
    return makeError(ErrorCode::EnumValue, place + "/stopReason",
                     "found stop reason " + std::to_string(static_cast<int>(branch.stopReason)));
  if (!branch.meanInlierRate) return std::nullopt;
  if (obeys(*branch.meanInlierRate, kRateRule)) return std::nullopt;
  return brokenValue(*branch.meanInlierRate, kRateRule, place + "/meanInlierRate");
}

// The nodes of branch b: they name it, and each hangs on the one before.
Problem checkBranchNodes(const CenterlineTree& tree, std::size_t b) {
  const Branch& branch = tree.branches[b];
  for (std::size_t k = 0; k < branch.nodeCount; ++k) {
    const std::size_t node = branch.firstNode + k;
    if (tree.branch[node] != b)
      return makeError(ErrorCode::NodeBranch, at("/tree/branch", node),
                       "found branch " + std::to_string(tree.branch[node]) + ", but branch " +
                           std::to_string(b) + " holds the node");
    if (k > 0 && tree.parent[node] != static_cast<std::int64_t>(node) - 1)
      return makeError(ErrorCode::NodeChain, at("/tree/parent", node),
                       "found " + std::to_string(tree.parent[node]) + ", expected " +
                           std::to_string(node - 1) + ", the node before in branch " +
                           std::to_string(b));
  }
  if (branch.parentNode != tree.parent[branch.firstNode])
    return makeError(ErrorCode::BranchParent, at("/tree/branches", b) + "/parentNode",
                     "found " + std::to_string(branch.parentNode) +
                         ", but the first node has parent " +
                         std::to_string(tree.parent[branch.firstNode]));
  return std::nullopt;
}

Problem checkBranches(const CenterlineTree& tree) {
  const std::string array = "/tree/branches";
  std::unordered_set<std::string_view> labels;
  std::size_t next = 0;
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const Branch& branch = tree.branches[b];
    const std::string place = at(array, b);
    if (auto p = checkBranchValues(branch, place)) return p;
    if (!labels.insert(branch.label).second)
      return makeError(ErrorCode::LabelDuplicate, place + "/label",
                       "the label \"" + branch.label + "\" is that of an earlier branch");
    if (branch.firstNode != next || branch.nodeCount == 0 ||
        branch.nodeCount > tree.nodeCount() - next)
      return makeError(ErrorCode::BranchRange, place,
                       "found " + std::to_string(branch.nodeCount) + " nodes from " +
                           std::to_string(branch.firstNode) + ", expected 1 to " +
                           std::to_string(tree.nodeCount() - next) + " from " +
                           std::to_string(next));
    if (auto p = checkBranchNodes(tree, b)) return p;
    next += branch.nodeCount;
  }
  if (next != tree.nodeCount())
    return makeError(ErrorCode::BranchRange, array,
                     "the branches hold " + std::to_string(next) + " of " +
                         std::to_string(tree.nodeCount()) + " nodes");
  return std::nullopt;
}

Problem checkOffsets(const std::vector<std::uint32_t>& offset, std::size_t nodeCount,
                     std::size_t elements, const std::string& place) {
  if (auto p = checkLength(offset.size(), nodeCount + 1, place)) return p;
  if (offset.front() != 0)
    return makeError(ErrorCode::OffsetStart, place + "/0",
                     "found " + std::to_string(offset.front()) + ", expected 0");
  for (std::size_t i = 1; i < offset.size(); ++i)
    if (offset[i] < offset[i - 1])
      return makeError(
          ErrorCode::OffsetOrder, at(place, i),
          "found " + std::to_string(offset[i]) + " after " + std::to_string(offset[i - 1]));
  if (offset.back() != elements)
    return makeError(ErrorCode::OffsetEnd, at(place, nodeCount),
                     "found " + std::to_string(offset.back()) + ", expected " +
                         std::to_string(elements) + ", the number of elements");
  return std::nullopt;
}

Problem checkPositive(double value, const std::string& place, ErrorCode code) {
  if (!std::isfinite(value)) return notFinite(value, place);
  if (value > 0) return std::nullopt;
  return makeError(code, place, "found " + shortText(value) + ", expected more than 0");
}

Problem checkKernel(const BlobbyModels& models) {
  if (enumName(kKernelNames, models.kernel).empty())
    return makeError(ErrorCode::EnumValue, "/models/kernel",
                     "found kernel " + std::to_string(static_cast<int>(models.kernel)));
  const bool hasParameter = models.kernel == Kernel::Cauchy || models.kernel == Kernel::Gaussian;
  const std::string place = "/models/kernelParameter";
  if (hasParameter)
    if (auto p = checkPositive(models.kernelParameter, place, ErrorCode::KernelParameter)) return p;
  if (!std::isfinite(models.kernelParameter)) return notFinite(models.kernelParameter, place);
  return checkPositive(models.isoLevel, "/models/isoLevel", ErrorCode::IsoLevel);
}

}  // namespace

Problem checkTree(const CenterlineTree& tree) {
  if (auto p = checkNodeArrays(tree)) return p;
  if (auto p = checkNodeValues(tree)) return p;
  if (auto p = checkParents(tree.parent)) return p;
  return checkBranches(tree);
}

Problem checkPoints(const PointSets& points, std::size_t nodeCount) {
  if (auto p = checkLimit(points.position.size(), kMaxPoints, "/points/position")) return p;
  if (auto p = checkOffsets(points.offset, nodeCount, points.position.size(), "/points/offset"))
    return p;
  return checkFinite(points.position, "/points/position");
}

Problem checkModels(const BlobbyModels& models, std::size_t nodeCount) {
  if (auto p = checkKernel(models)) return p;
  const std::size_t count = models.centre.size();
  if (auto p = checkLimit(count, kMaxBlobs, "/models/centre")) return p;
  if (auto p = checkLength(models.width.size(), count, "/models/width")) return p;
  if (auto p = checkOffsets(models.offset, nodeCount, count, "/models/offset")) return p;
  if (auto p = checkFinite(models.centre, "/models/centre")) return p;
  return checkValues(models.width, "/models/width", kWidthRule);
}

Result<bool> validate(const Case& value) {
  if (auto p = checkMetadata(value.metadata)) return *std::move(p);
  if (auto p = checkTree(value.tree)) return *std::move(p);
  const std::size_t nodeCount = value.tree.nodeCount();
  if (value.points)
    if (auto p = checkPoints(*value.points, nodeCount)) return *std::move(p);
  if (value.models)
    if (auto p = checkModels(*value.models, nodeCount)) return *std::move(p);
  return true;
}

}  // namespace lumen::formats
