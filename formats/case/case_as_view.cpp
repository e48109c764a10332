// SPDX-License-Identifier: Apache-2.0
#include "formats/case/case_as_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/container/bytes.h"

namespace lumen::formats {
namespace {

static_assert(sizeof(Vec3f) == sizeof(Float3) && alignof(Vec3f) == alignof(Float3));

std::span<const Float3> vectors(const std::vector<Vec3f>& values) {
  return {reinterpret_cast<const Float3*>(values.data()), values.size()};
}

// A rate of exactly -1 is illegal, but in a record it means "no rate". It is moved to the next
// lower float, which is illegal too, so that the check finds it.
float storedRate(const Branch& branch) {
  const float rate = branch.meanInlierRate.value_or(kNoRate) + 0.0f;
  return branch.meanInlierRate && rate == kNoRate ? std::nextafter(rate, -2.0f) : rate;
}

static_assert(sizeof(Pose) == sizeof(PoseRecord) && alignof(Pose) == alignof(PoseRecord));

MotionView motionView(const Motion& motion) {
  return {motion.period,
          motion.time,
          motion.node,
          {reinterpret_cast<const PoseRecord*>(motion.pose.data()), motion.pose.size()}};
}

ModelView modelView(const BlobbyModels& models) {
  return {static_cast<std::uint8_t>(models.kernel),
          models.kernelParameter,
          models.isoLevel,
          models.offset,
          vectors(models.centre),
          models.width};
}

}  // namespace

std::vector<std::byte> branchRecords(const std::vector<Branch>& branches) {
  std::vector<std::byte> bytes;
  bytes.reserve(branches.size() * kBranchRecordSize);
  std::uint32_t labelOffset = 0;
  for (const Branch& branch : branches) {
    // a label too long for its field is refused, whatever is left of its length
    const auto labelSize = static_cast<std::uint16_t>(
        std::min<std::size_t>(branch.label.size(), std::numeric_limits<std::uint16_t>::max()));
    appendLittle(bytes, branch.firstNode);
    appendLittle(bytes, branch.nodeCount);
    appendLittle(bytes, branch.parentNode);
    appendLittle(bytes, labelOffset);
    appendLittle(bytes, labelSize);
    appendLittle(bytes, static_cast<std::uint8_t>(branch.kind));
    appendLittle(bytes, static_cast<std::uint8_t>(branch.stopReason));
    appendLittle(bytes, storedRate(branch));
    labelOffset += static_cast<std::uint32_t>(branch.label.size());
  }
  return bytes;
}

std::string joinedLabels(const std::vector<Branch>& branches) {
  std::string labels;
  for (const Branch& branch : branches) labels += branch.label;
  return labels;
}

CaseAsView::CaseAsView(const Case& value)
    : m_records(branchRecords(value.tree.branches)), m_labels(joinedLabels(value.tree.branches)) {
  const CenterlineTree& tree = value.tree;
  m_view.version = kFormatVersion;
  m_view.nodeCentre = vectors(tree.centre);
  m_view.nodeDirection = vectors(tree.direction);
  m_view.nodeRadius = tree.radius;
  m_view.nodeHeight = tree.height;
  m_view.nodeInlierRate = tree.inlierRate;
  m_view.nodeParent = tree.parent;
  m_view.nodeBranch = tree.branch;
  m_view.links = tree.links;
  m_view.branchRecords = m_records;
  m_view.branchLabels = m_labels;
  m_view.hasPoints = value.points.has_value();
  if (value.points) {
    m_view.pointOffset = value.points->offset;
    m_view.pointPosition = vectors(value.points->position);
  }
  if (value.models) m_view.models = modelView(*value.models);
  if (value.motion) m_view.motion = motionView(*value.motion);
}

}  // namespace lumen::formats
