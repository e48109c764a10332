// SPDX-License-Identifier: Apache-2.0
#include "formats/case/motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "formats/case/chunk_codec.h"
#include "formats/view/text_rules.h"

namespace lumen::formats {

using field::NodePose;

namespace {

field::Vec exact(const Vec3f& v) {
  return {v.x, v.y, v.z};
}

Vec3f rounded(const field::Vec& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

NodePose nodePoseOf(const Pose& pose) {
  const auto& q = pose.rotation;
  return {exact(pose.centre), field::unit({q[0], q[1], q[2], q[3]}), pose.factor};
}

void carryTree(const std::vector<NodePose>& poses, CenterlineTree& tree) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    tree.centre[i] = rounded(poses[i].centre);
    tree.direction[i] = rounded(rotated(poses[i].rotation, exact(tree.direction[i])));
    tree.radius[i] = static_cast<float>(poses[i].factor * tree.radius[i]);
    tree.height[i] = static_cast<float>(poses[i].factor * tree.height[i]);
  }
}

void carryOwned(const CenterlineTree& rest, const std::vector<NodePose>& poses,
                const std::vector<std::uint32_t>& offset, std::vector<Vec3f>& positions) {
  for (std::size_t i = 0; i < poses.size(); ++i)
    for (std::uint32_t k = offset[i]; k < offset[i + 1]; ++k)
      positions[k] = rounded(carried(poses[i], exact(rest.centre[i]), exact(positions[k])));
}

using field::NodePose;

namespace {

field::Vec vec(const Vec3f& v) {
  return {v.x, v.y, v.z};
}

// The motion of a chunk in version 1, or nothing.
std::optional<Motion> motionOfChunk(const OtherChunk& other, IssueList& faults) {
  if (other.version != 1) return std::nullopt;
  Chunk chunk;
  chunk.type = chunk::kMotion;
  chunk.encoding = other.encoding;
  chunk.rawSize = other.rawSize;
  chunk.stored = other.bytes;
  std::vector<std::byte> raw = other.bytes;
  if (other.encoding != 0) {
    if (other.rawSize > kMaxExpansion * other.bytes.size()) return std::nullopt;
    auto decoded = decodeChunk(chunk, faults);
    if (!decoded) return std::nullopt;
    raw = *std::move(decoded);
  }
  chunk.stored = raw;
  const MotionView view = viewMotion(chunk, faults);
  return faults.failed() ? std::nullopt : std::optional(motionOf(view));
}

double between(double a, double b, double u) {
  return (1.0 - u) * a + u * b;
}

NodePose interpolated(const Pose& from, const Pose& to, double u) {
  const NodePose a = nodePoseOf(from), b = nodePoseOf(to);
  return {(1.0 - u) * a.centre + u * b.centre, field::slerp(a.rotation, b.rotation, u),
          between(a.factor, b.factor, u)};
}

std::vector<NodePose> posesOf(const CenterlineTree& tree, const Motion& motion,
                              const field::Instant& instant) {
  std::vector<NodePose> poses(tree.nodeCount());
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].centre = vec(tree.centre[i]);
  const std::size_t nodes = motion.node.size();
  for (std::size_t n = 0; n < nodes; ++n)
    poses[motion.node[n]] = interpolated(motion.pose[instant.from * nodes + n],
                                         motion.pose[instant.to * nodes + n], instant.share);
  return poses;
}

// Strain of the edge from `i` to `k`, from the frame of `i`.
double strainOf(const CenterlineTree& tree, const std::vector<NodePose>& poses, std::size_t i,
                std::size_t k) {
  const field::Vec rest = vec(tree.centre[k]) - vec(tree.centre[i]);
  const double length = field::norm(rest);
  if (!(length > 0)) return 0;
  const field::Vec moved =
      (1.0 / poses[i].factor) * rotatedBack(poses[i].rotation, poses[k].centre - poses[i].centre);
  const double angle = field::angleBetween(poses[i].rotation, poses[k].rotation);
  const double radius = std::max(tree.radius[i], tree.radius[k]);
  return (field::norm(moved - rest) + radius * angle) / length;
}

double greatestStrain(const CenterlineTree& tree, const std::vector<NodePose>& poses) {
  double greatest = 0;
  const auto add = [&](std::size_t i, std::size_t k) {
    greatest = std::max({greatest, strainOf(tree, poses, i, k), strainOf(tree, poses, k, i)});
  };
  for (std::size_t i = 0; i < tree.nodeCount(); ++i)
    if (tree.parent[i] >= 0) add(static_cast<std::size_t>(tree.parent[i]), i);
  for (const auto& [a, b] : tree.links) add(a, b);
  return greatest;
}

}  // namespace

FormatVersion versionOf(const Case& value) {
  return value.motion ? kMotionVersion : kPlainVersion;
}

Motion motionOf(const MotionView& view) {
  Motion motion{
      {view.time.begin(), view.time.end()}, view.period, {view.node.begin(), view.node.end()}, {}};
  motion.pose.reserve(view.pose.size());
  for (const PoseRecord& p : view.pose)
    motion.pose.push_back({{p[0], p[1], p[2]}, {p[3], p[4], p[5], p[6]}, p[7]});
  return motion;
}

void takeMotion(Case& value, IssueList& issues) {
  const auto found =
      std::find_if(value.otherChunks.begin(), value.otherChunks.end(),
                   [](const OtherChunk& other) { return other.type == chunkName(chunk::kMotion); });
  if (found == value.otherChunks.end() || value.motion) return;
  IssueList faults(1, IssueList::Keep::Errors);
  value.motion = motionOfChunk(*found, faults);
  if (!value.motion) {
    const auto index = static_cast<std::size_t>(found - value.otherChunks.begin());
    return issues.add(pointerIssue(ErrorCode::JsonChunkData, at("/otherChunks", index),
                                   "the motion cannot be read",
                                   {{"chunk", chunkName(chunk::kMotion)}}));
  }
  value.otherChunks.erase(found);
}

std::vector<NodePose> posesAt(const CenterlineTree& tree, const Motion& motion, double time) {
  return posesOf(tree, motion, field::instantAt(motion.time, motion.period, time));
}

MotionFigures motionFigures(const CenterlineTree& tree, const Motion& motion) {
  MotionFigures figures;
  const std::size_t times = motion.time.size();
  for (std::size_t t = 0; t < times; ++t) {
    const std::size_t next = t + 1 < times ? t + 1 : motion.period > 0 ? 0 : t;
    const double pause = motion.time[next] - motion.time[t] + (next <= t ? motion.period : 0);
    const std::vector<NodePose> poses = posesOf(tree, motion, {t, t, 0});
    const std::vector<NodePose> later = posesOf(tree, motion, {next, next, 0});
    for (const std::uint32_t node : motion.node) {
      const auto way = [&](const field::Vec& from) {
        return field::norm(poses[node].centre - from);
      };
      figures.displacement = std::max(figures.displacement, way(vec(tree.centre[node])));
      if (pause > 0) figures.speed = std::max(figures.speed, way(later[node].centre) / pause);
    }
    figures.strain = std::max(figures.strain, greatestStrain(tree, poses));
  }
  return figures;
}

void keepMotionOf(std::optional<Motion>& motion, const std::vector<bool>& stays,
                  const std::vector<std::uint32_t>& newIndex) {
  if (!motion) return;
  std::vector<std::size_t> kept;
  for (std::size_t n = 0; n < motion->node.size(); ++n)
    if (stays[motion->node[n]]) kept.push_back(n);
  std::sort(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) {
    return newIndex[motion->node[a]] < newIndex[motion->node[b]];
  });
  if (kept.empty()) return motion.reset();
  Motion out{motion->time, motion->period, {}, {}};
  for (const std::size_t n : kept) out.node.push_back(newIndex[motion->node[n]]);
  for (std::size_t t = 0; t < motion->time.size(); ++t)
    for (const std::size_t n : kept) out.pose.push_back(motion->pose[t * motion->node.size() + n]);
  *motion = std::move(out);
}

}  // namespace lumen::formats
