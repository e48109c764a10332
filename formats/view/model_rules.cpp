// SPDX-License-Identifier: Apache-2.0
#include "formats/view/model_rules.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "formats/container/bytes.h"
#include "formats/field/kernel.h"
#include "formats/view/limits.h"
#include "formats/view/text_rules.h"

namespace lumen::formats {
namespace {

constexpr std::uint32_t kExponentBits = 0x7f800000u;
constexpr std::uint32_t kNegativeZero = 0x80000000u;

// Whether all values are finite. This pass has no branch: with the one that finds the place, it is
// faster than one pass that may stop.
bool allFinite(std::span<const float> values) {
  std::uint32_t greatest = 0;
  for (const float value : values)
    greatest = std::max(greatest, std::bit_cast<std::uint32_t>(value) & ~kNegativeZero);
  return greatest < kExponentBits;
}

std::span<const float> flat(std::span<const Float3> vectors) {
  return {vectors.empty() ? nullptr : vectors.front().data(), 3 * vectors.size()};
}

// Warns once for an array, at the first negative zero.
void warnNegativeZero(std::span<const float> values, std::size_t components,
                      const std::string& pointer, IssueList& issues) {
  if (!issues.keepsWarnings()) return;
  const auto found = std::find_if(values.begin(), values.end(), [](float value) {
    return std::bit_cast<std::uint32_t>(value) == kNegativeZero;
  });
  if (found == values.end()) return;
  const auto index = static_cast<std::size_t>(found - values.begin());
  std::string place = at(pointer, index / components);
  if (components > 1) place = at(place, index % components);
  issues.add({ErrorCode::NegativeZero,
              std::nullopt,
              "found a negative zero, which a writer should write as zero",
              {},
              std::move(place)});
}

template <class Number>
Issue notFinite(Number value, const std::string& pointer) {
  return foundIssue(ErrorCode::NotFinite, pointer, shortText(value), "a finite number");
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
constexpr ValueRule kRadiusRule{isPositive, ErrorCode::RadiusRange, "more than 0 mm"};
constexpr ValueRule kHeightRule{isNotNegative, ErrorCode::HeightRange, "0 mm or more"};
constexpr ValueRule kRateRule{isRate, ErrorCode::InlierRateRange, "a rate from 0 to 1"};
constexpr ValueRule kWidthRule{isPositive, ErrorCode::WidthRange, "more than 0 mm"};

constexpr double kDirectionTolerance = 1e-3;

void checkDirections(std::span<const Float3> directions, IssueList& issues) {
  const std::string pointer = "/tree/direction";
  checkFinite(directions, pointer, issues);
  for (std::size_t i = 0; i < directions.size() && !issues.done(); ++i) {
    const double x = directions[i][0], y = directions[i][1], z = directions[i][2];
    const double length = std::sqrt(x * x + y * y + z * z);
    if (!std::isfinite(length)) continue;  // reported above
    if (!(std::abs(length - 1.0) <= kDirectionTolerance))
      issues.add(ErrorCode::DirectionLength, [&] {
        return foundIssue(ErrorCode::DirectionLength, at(pointer, i), "length " + shortText(length),
                          "1 within 0.001");
      });
  }
}

bool checkNodeArrays(const CaseView& view, IssueList& issues) {
  const std::size_t count = view.nodeCount();
  if (count == 0) {
    issues.add({ErrorCode::TreeEmpty,
                std::nullopt,
                "found no node, expected at least 1",
                {},
                "/tree/centre"});
    return false;
  }
  bool right = checkLimit(count, kMaxNodes, "/tree/centre", issues);
  right &= checkLength(view.nodeDirection.size(), count, "/tree/direction", issues);
  right &= checkLength(view.nodeRadius.size(), count, "/tree/radius", issues);
  right &= checkLength(view.nodeHeight.size(), count, "/tree/height", issues);
  right &= checkLength(view.nodeParent.size(), count, "/tree/parent", issues);
  right &= checkLength(view.nodeBranch.size(), count, "/tree/branch", issues);
  if (!view.nodeInlierRate.empty())
    right &= checkLength(view.nodeInlierRate.size(), count, "/tree/inlierRate", issues);
  right &= checkLimit(view.branchCount(), kMaxBranches, "/tree/branches", issues);
  return right;
}

void checkPointRules(const CaseView& view, IssueList& issues) {
  checkLimit(view.pointPosition.size(), kMaxPoints, "/points/position", issues);
  checkOffsets(view.pointOffset, view.nodeCount(), view.pointPosition.size(), "/points/offset",
               issues);
  checkFinite(view.pointPosition, "/points/position", issues);
}

void checkBlobRules(const ModelView& model, std::size_t nodeCount, IssueList& issues) {
  const std::size_t count = model.centre.size();
  checkLimit(count, kMaxBlobs, "/models/centre", issues);
  checkLength(model.width.size(), count, "/models/width", issues);
  checkOffsets(model.offset, nodeCount, count, "/models/offset", issues);
  checkFinite(model.centre, "/models/centre", issues);
  checkValues(model.width, "/models/width", kWidthRule, issues);
}

void checkKernel(const ModelView& model, IssueList& issues) {
  if (model.kernel >= field::kKernelCount)
    return issues.add(foundIssue(ErrorCode::EnumValue, "/models/kernel",
                                 std::to_string(model.kernel),
                                 "a kernel from 0 to " + std::to_string(field::kKernelCount - 1)));
  const std::string parameter = "/models/kernelParameter";
  if (field::hasParameter(static_cast<field::Kernel>(model.kernel)))
    checkPositive(model.kernelParameter, parameter, ErrorCode::KernelParameter, issues);
  else
    checkFinite(model.kernelParameter, parameter, issues);
  checkPositive(model.isoLevel, "/models/isoLevel", ErrorCode::IsoLevel, issues);
}

}  // namespace

void checkFinite(double value, const std::string& pointer, IssueList& issues) {
  if (!std::isfinite(value)) issues.add(notFinite(value, pointer));
}

void checkPositive(double value, const std::string& pointer, ErrorCode code, IssueList& issues) {
  checkFinite(value, pointer, issues);
  if (std::isfinite(value) && !(value > 0))
    issues.add(foundIssue(code, pointer, shortText(value), "more than 0"));
}

void checkFinite(std::span<const Float3> vectors, const std::string& pointer, IssueList& issues) {
  warnNegativeZero(flat(vectors), 3, pointer, issues);
  if (allFinite(flat(vectors))) return;
  for (std::size_t i = 0; i < vectors.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      if (std::isfinite(vectors[i][c])) continue;
      if (issues.done()) return;
      issues.add(ErrorCode::NotFinite,
                 [&] { return notFinite(vectors[i][c], at(at(pointer, i), c)); });
    }
}

void checkValues(std::span<const float> values, const std::string& pointer, const ValueRule& rule,
                 IssueList& issues) {
  warnNegativeZero(values, 1, pointer, issues);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float value = values[i];
    if (std::isfinite(value) && rule.legal(value)) continue;
    if (issues.done()) return;
    const ErrorCode code = std::isfinite(value) ? rule.code : ErrorCode::NotFinite;
    issues.add(code, [&] {
      return code == ErrorCode::NotFinite
                 ? notFinite(value, at(pointer, i))
                 : foundIssue(code, at(pointer, i), shortText(value), rule.expected);
    });
  }
}

bool checkLength(std::size_t found, std::size_t expected, const std::string& pointer,
                 IssueList& issues) {
  if (found == expected) return true;
  issues.add(foundIssue(ErrorCode::ArrayLength, pointer, std::to_string(found) + " entries",
                        std::to_string(expected)));
  return false;
}

bool checkLimit(std::size_t found, std::size_t limit, const std::string& pointer,
                IssueList& issues) {
  if (found <= limit) return true;
  issues.add(limitIssue(ErrorCode::Limit, pointer, found, limit));
  return false;
}

void checkOffsets(std::span<const std::uint32_t> offset, std::size_t nodeCount,
                  std::size_t elements, const std::string& pointer, IssueList& issues) {
  if (!checkLength(offset.size(), nodeCount + 1, pointer, issues)) return;
  if (offset.front() != 0)
    issues.add(
        foundIssue(ErrorCode::OffsetStart, at(pointer, 0), std::to_string(offset.front()), "0"));
  for (std::size_t i = 1; i < offset.size() && !issues.done(); ++i)
    if (offset[i] < offset[i - 1])
      issues.add(ErrorCode::OffsetOrder, [&] {
        return foundIssue(ErrorCode::OffsetOrder, at(pointer, i), std::to_string(offset[i]),
                          std::to_string(offset[i - 1]) + " or more");
      });
  if (offset.back() != elements)
    issues.add(foundIssue(ErrorCode::OffsetEnd, at(pointer, nodeCount),
                          std::to_string(offset.back()),
                          std::to_string(elements) + ", the number of elements"));
}

void readKernelRecord(std::span<const std::byte> record, ModelView& model) {
  ByteCursor cursor(record);
  model.kernel = cursor.read<std::uint8_t>();
  cursor.take(7);
  model.kernelParameter = cursor.read<double>();
  model.isoLevel = cursor.read<double>();
}

void checkKernels(const CaseView& view, IssueList& issues) {
  if (view.models) checkKernel(*view.models, issues);
}

void checkTreeRules(const CaseView& view, IssueList& issues) {
  checkFinite(view.nodeCentre, "/tree/centre", issues);
  checkDirections(view.nodeDirection, issues);
  checkValues(view.nodeRadius, "/tree/radius", kRadiusRule, issues);
  checkValues(view.nodeHeight, "/tree/height", kHeightRule, issues);
  checkValues(view.nodeInlierRate, "/tree/inlierRate", kRateRule, issues);
}

void checkModelRules(const CaseView& view, IssueList& issues) {
  if (!checkNodeArrays(view, issues)) return;
  checkTreeRules(view, issues);
  checkBranchRules(view, issues);
  checkLinkRules(view, issues);
  if (view.hasPoints) checkPointRules(view, issues);
  if (view.models) checkBlobRules(*view.models, view.nodeCount(), issues);
  if (view.motion) checkMotionRules(view, issues);
}

}  // namespace lumen::formats
