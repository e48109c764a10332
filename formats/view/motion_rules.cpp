// SPDX-License-Identifier: Apache-2.0
// Times, moving nodes and poses of a motion.
#include <cmath>

#include "formats/view/limits.h"
#include "formats/view/model_rules.h"
#include "formats/view/text_rules.h"

namespace lumen::formats {
namespace {

constexpr double kRotationTolerance = 1e-3;
constexpr std::size_t kRotationAt = 3, kFactorAt = 7;  // in a pose's record

void checkTimes(const MotionView& motion, IssueList& issues) {
  const std::string pointer = "/motion/time";
  if (motion.time.empty())
    issues.add(foundIssue(ErrorCode::MotionTime, pointer, "no time", "at least 1"));
  for (std::size_t i = 0; i < motion.time.size() && !issues.done(); ++i) {
    checkFinite(motion.time[i], at(pointer, i), issues);
    if (i > 0 && motion.time[i] <= motion.time[i - 1])
      issues.add(ErrorCode::MotionTime, [&] {
        return foundIssue(ErrorCode::MotionTime, at(pointer, i), shortText(motion.time[i]),
                          "more than " + shortText(motion.time[i - 1]));
      });
  }
}

void checkPeriod(const MotionView& motion, IssueList& issues) {
  const std::string pointer = "/motion/period";
  checkFinite(motion.period, pointer, issues);
  if (motion.period == 0 || !std::isfinite(motion.period) || motion.time.empty()) return;
  const double least = motion.time.back() - motion.time.front();
  if (motion.period < 0 || motion.period <= least)
    issues.add(foundIssue(ErrorCode::MotionPeriod, pointer, shortText(motion.period),
                          "more than " + shortText(least) + ", from the first time to the last"));
}

void checkMovingNodes(const MotionView& motion, std::size_t nodeCount, IssueList& issues) {
  const std::string pointer = "/motion/node";
  for (std::size_t i = 0; i < motion.node.size() && !issues.done(); ++i) {
    const std::uint32_t node = motion.node[i];
    if (node >= nodeCount)
      issues.add(ErrorCode::MotionNode, [&] {
        return foundIssue(ErrorCode::MotionNode, at(pointer, i), std::to_string(node),
                          "at most " + std::to_string(nodeCount - 1) + ", the last node");
      });
    else if (i > 0 && node <= motion.node[i - 1])
      issues.add(ErrorCode::MotionNode, [&] {
        return foundIssue(ErrorCode::MotionNode, at(pointer, i), std::to_string(node),
                          "more than " + std::to_string(motion.node[i - 1]));
      });
  }
}

// The pointer to a component of a record.
std::string componentPointer(std::size_t time, std::size_t node, std::size_t component) {
  const auto place = [&](const char* key) { return at(at(key, time), node); };
  if (component < kRotationAt) return at(place("/motion/centre"), component);
  if (component < kFactorAt) return at(place("/motion/rotation"), component - kRotationAt);
  return place("/motion/factor");
}

bool isFinite(const PoseRecord& pose, std::size_t time, std::size_t node, IssueList& issues) {
  bool finite = true;
  for (std::size_t c = 0; c < pose.size(); ++c) {
    if (std::isfinite(pose[c])) continue;
    finite = false;
    issues.add(ErrorCode::NotFinite, [&] {
      return foundIssue(ErrorCode::NotFinite, componentPointer(time, node, c), shortText(pose[c]),
                        "a finite number");
    });
  }
  return finite;
}

void checkPose(const PoseRecord& pose, std::size_t time, std::size_t node, IssueList& issues) {
  if (!isFinite(pose, time, node, issues)) return;
  double square = 0;
  for (std::size_t c = kRotationAt; c < kFactorAt; ++c) square += double{pose[c]} * double{pose[c]};
  const double length = std::sqrt(square);
  if (!(std::abs(length - 1.0) <= kRotationTolerance))
    issues.add(ErrorCode::MotionRotation, [&] {
      return foundIssue(ErrorCode::MotionRotation, at(at("/motion/rotation", time), node),
                        "length " + shortText(length), "1 within 0.001");
    });
  if (!(pose[kFactorAt] > 0))
    issues.add(ErrorCode::MotionFactor, [&] {
      return foundIssue(ErrorCode::MotionFactor, componentPointer(time, node, kFactorAt),
                        shortText(pose[kFactorAt]), "more than 0");
    });
}

}  // namespace

void checkMotionRules(const CaseView& view, IssueList& issues) {
  const MotionView& motion = *view.motion;
  const std::size_t times = motion.time.size(), nodes = motion.node.size();
  if (!checkLimit(times, kMaxTimes, "/motion/time", issues)) return;
  if (!checkLimit(times * nodes, kMaxPoses, "/motion/centre", issues)) return;
  checkTimes(motion, issues);
  checkPeriod(motion, issues);
  checkMovingNodes(motion, view.nodeCount(), issues);
  if (!checkLength(motion.pose.size(), times * nodes, "/motion/centre", issues)) return;
  for (std::size_t i = 0; i < motion.pose.size() && !issues.done(); ++i)
    checkPose(motion.pose[i], i / nodes, i % nodes, issues);
}

}  // namespace lumen::formats
