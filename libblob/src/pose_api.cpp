// SPDX-License-Identifier: Apache-2.0
// The C boundary of poses.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "answer.h"
#include "boundary.h"
#include "formats/field/blend.h"
#include "formats/field/vector.h"
#include "locate.h"
#include "nodes_in_doubles.h"
#include "open_case.h"
#include "posed_model.h"
#include "simd/backend.h"

namespace {

using namespace lumen::blob;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t kPoseCookie = 0x626c6f33U;
constexpr double kFarthestCentre = 1e6;

// The index of the i-th of the nodes that a caller lists; null: all from 0.
std::uint32_t indexAt(const std::uint32_t* nodes, std::size_t i) noexcept {
  return nodes != nullptr ? nodes[i] : static_cast<std::uint32_t>(i);
}

bool areNodes(const blob_pose& pose, std::size_t count, const std::uint32_t* nodes) noexcept {
  if (nodes == nullptr) return count <= pose.pose.size();
  return std::all_of(nodes, nodes + count,
                     [&pose](std::uint32_t i) { return i < pose.pose.size(); });
}

// Moves the nodes that changed, and reports the strain at them.
blob_status finishChange(blob_pose& pose, blob_pose_change* report) noexcept {
  moveNodes(pose);
  blob_pose_change change{strainOfChange(pose), 0, 0};
  change.stale = change.strain > pose.strainLimit;
  blob_status status = BLOB_OK;
  if (change.stale != 0 && pose.renews) {
    status = blob_pose_renew(&pose);
    change.renewed = status == BLOB_OK;
    change.stale = status != BLOB_OK;
  }
  if (report != nullptr) *report = change;
  return status;
}

// The nodes of a list, and, where directions depend on centres, those at the other ends of their edges.
void collectChanged(blob_pose& pose, std::size_t count, const std::uint32_t* nodes,
                    bool withEdges) noexcept {
  pose.changed.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t node = indexAt(nodes, i);
    pose.changed.add(node);
    if (!withEdges) continue;
    for (std::uint32_t e = pose.edges.offset[node]; e < pose.edges.offset[node + 1]; ++e)
      pose.changed.add(pose.edges.node[e]);
  }
}

// A transform as it is stated: its centre keeps all digits.
NodePose exactPoseOf(const blob_transform& transform) noexcept {
  NodePose pose = poseOf(transform);
  pose.centre = {transform.centre[0], transform.centre[1], transform.centre[2]};
  return pose;
}

// A pose between two, whose centre is no float yet.
NodePose between(const NodePose& from, const NodePose& to, double fraction) noexcept {
  const double share = fraction > 0 ? std::min(fraction, 1.0) : 0.0;
  return {(1.0 - share) * from.centre + share * to.centre,
          lumen::field::slerp(from.rotation, to.rotation, share),
          (1.0 - share) * from.factor + share * to.factor};
}

// A pose of a node between two, whose centre is kept as floats.
NodePose nodeBetween(const NodePose& from, const NodePose& to, double fraction) noexcept {
  NodePose pose = between(from, to, fraction);
  for (double* x : {&pose.centre.x, &pose.centre.y, &pose.centre.z}) *x = static_cast<float>(*x);
  return pose;
}

bool areInReach(std::size_t count, const double (*centres)[3]) noexcept {
  for (std::size_t i = 0; i < count; ++i)
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(centres[i][axis]) <= kFarthestCentre)) return false;
  return true;
}

struct NodeWeights {
  unsigned count = 0;
  std::uint32_t node[lumen::field::ActiveNodes::kMostActive];
  double weight[lumen::field::ActiveNodes::kMostActive];  // their sum is 1
};

// The nodes of positive weight at a point for the cursor at `node`; `node` alone where none has.
NodeWeights weighNodes(const blob_model& model, std::uint32_t flags, const double* point,
                       std::uint32_t node) noexcept {
  NodeWeights found;
  double sum = 0;
  if ((flags & BLOB_LOCAL) == 0) {
    const NodesInDoubles nodes(model);
    lumen::field::visitActiveNodes(node, [&](std::uint32_t k, lumen::field::ActiveNodes& active) {
      const double weight = lumen::field::blendWeight<1>(nodes, k, point, active).value;
      if (!(weight > 0)) return false;
      found.node[found.count] = k;
      found.weight[found.count++] = weight;
      sum += weight;
      return true;
    });
  }
  if (found.count == 0) {
    found.count = 1;
    found.node[0] = node;
    found.weight[0] = sum = 1;
  }
  for (unsigned i = 0; i < found.count; ++i) found.weight[i] /= sum;
  return found;
}

// The way of a point, mm, that rides on a node from one pose to another, in which it is given.
lumen::field::Vec displacementOf(const blob_pose& pose, const blob_pose& before, std::uint32_t node,
                                 const double* point) noexcept {
  const NodePose &now = pose.pose[node], &then = before.pose[node];
  const lumen::field::Vec x = lumen::field::Vec{point[0], point[1], point[2]} - now.centre;
  // relative to the centres, so that small steps keep their digits
  const lumen::field::Vec rest = (1.0 / now.factor) * lumen::field::rotatedBack(now.rotation, x);
  const lumen::field::Vec was = then.factor * lumen::field::rotated(then.rotation, rest);
  return (now.centre - then.centre) + (x - was);
}

}  // namespace

extern "C" {

blob_pose_def blob_pose_def_default(void) noexcept {
  return {0.25, 1, kPoseCookie};
}

blob_status blob_pose_create(const blob_model* rest, const blob_pose_def* def,
                             blob_pose** pose) noexcept {
  const blob_pose_def used = def != nullptr ? *def : blob_pose_def_default();
  return construct(pose, [&] {
    if (rest == nullptr || rest->isPosed || used.cookie != kPoseCookie || !(used.strain_limit > 0))
      return BLOB_ERROR_ARGUMENT;
    *pose = makePose(*rest, used).release();
    return BLOB_OK;
  });
}

void blob_pose_close(blob_pose* pose) noexcept {
  delete pose;
}

const blob_model* blob_pose_model(const blob_pose* pose) noexcept {
  BLOB_REQUIRE(pose != nullptr);
  return &pose->model;
}

blob_status blob_pose_set(blob_pose* pose, size_t count, const uint32_t* nodes,
                          const blob_transform* transforms, blob_pose_change* change) noexcept {
  BLOB_REQUIRE(pose != nullptr && (transforms != nullptr || count == 0));
  if (!areNodes(*pose, count, nodes)) return BLOB_ERROR_TOPOLOGY;
  if (!std::all_of(transforms, transforms + count, &isTransform)) return BLOB_ERROR_RANGE;
  for (std::size_t i = 0; i < count; ++i) pose->pose[indexAt(nodes, i)] = poseOf(transforms[i]);
  collectChanged(*pose, count, nodes, false);
  return finishChange(*pose, change);
}

blob_status blob_pose_set_centres(blob_pose* pose, size_t count, const uint32_t* nodes,
                                  const double (*centres)[3], blob_pose_change* change) noexcept {
  BLOB_REQUIRE(pose != nullptr && (centres != nullptr || count == 0));
  if (!areNodes(*pose, count, nodes)) return BLOB_ERROR_TOPOLOGY;
  if (!areInReach(count, centres)) return BLOB_ERROR_RANGE;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t node = indexAt(nodes, i);
    float* place = pose->place[node].number;
    for (int axis = 0; axis < 3; ++axis) place[axis] = static_cast<float>(centres[i][axis]);
    pose->pose[node].centre = {place[0], place[1], place[2]};
  }
  collectChanged(*pose, count, nodes, true);
  for (const std::uint32_t node : pose->changed.list())
    pose->pose[node].rotation = rotationFromCentres(*pose, node);
  return finishChange(*pose, change);
}

blob_transform blob_pose_node(const blob_pose* pose, uint32_t node) noexcept {
  BLOB_REQUIRE(pose != nullptr);
  if (node >= pose->pose.size())
    return {{kUnknown, kUnknown, kUnknown}, {kUnknown, kUnknown, kUnknown, kUnknown}, kUnknown};
  return transformOf(pose->pose[node]);
}

double blob_pose_strain(const blob_pose* pose) noexcept {
  BLOB_REQUIRE(pose != nullptr);
  constexpr std::uint32_t kMaxEdges = 64;
  float greatest = 0;
  std::uint32_t edges[kMaxEdges];
  const std::uint32_t count = static_cast<std::uint32_t>(pose->edgeReference.size());
  for (std::uint32_t first = 0; first < count; first += kMaxEdges) {
    const std::uint32_t most = std::min(kMaxEdges, count - first);
    std::iota(edges, edges + most, first);
    greatest = std::max(greatest, pose->model.backend->greatestStrain(*pose, edges, most));
  }
  return greatest;
}

blob_status blob_pose_renew(blob_pose* pose) noexcept {
  BLOB_REQUIRE(pose != nullptr);
  return withinMemory([pose] {
    renewNeighbours(*pose);
    return BLOB_OK;
  });
}

blob_transform blob_transform_between(const blob_transform* from, const blob_transform* to,
                                      double fraction) noexcept {
  BLOB_REQUIRE(from != nullptr && to != nullptr);
  return transformOf(between(exactPoseOf(*from), exactPoseOf(*to), fraction));
}

blob_status blob_pose_blend(blob_pose* pose, const blob_pose* from, const blob_pose* to,
                            double fraction, blob_pose_change* change) noexcept {
  BLOB_REQUIRE(pose != nullptr && from != nullptr && to != nullptr);
  if (from->rest != pose->rest || to->rest != pose->rest) return BLOB_ERROR_ARGUMENT;
  for (std::size_t i = 0; i < pose->pose.size(); ++i)
    pose->pose[i] = nodeBetween(from->pose[i], to->pose[i], fraction);
  collectChanged(*pose, pose->pose.size(), nullptr, false);
  return finishChange(*pose, change);
}

blob_status blob_motion_open(const char* path, const blob_open_def* def,
                             blob_motion** motion) noexcept {
  const blob_open_def used = def != nullptr ? *def : blob_open_def_default();
  return construct(motion, [&] {
    if (path == nullptr || used.cookie != kOpenCookie) return BLOB_ERROR_ARGUMENT;
    return openMotionFile(path, used, motion);
  });
}

blob_status blob_motion_open_bytes(const void* bytes, size_t size, const blob_open_def* def,
                                   blob_motion** motion) noexcept {
  const blob_open_def used = def != nullptr ? *def : blob_open_def_default();
  return construct(motion, [&] {
    if (bytes == nullptr || used.cookie != kOpenCookie) return BLOB_ERROR_ARGUMENT;
    return openMotionBytes(bytes, size, used, motion);
  });
}

void blob_motion_close(blob_motion* motion) noexcept {
  delete motion;
}

blob_motion_info blob_motion_describe(const blob_motion* motion) noexcept {
  BLOB_REQUIRE(motion != nullptr);
  return {motion->time.size(), motion->node.size(), motion->time.front(), motion->time.back(),
          motion->period};
}

blob_status blob_pose_set_time(blob_pose* pose, const blob_motion* motion, double seconds,
                               blob_pose_change* change) noexcept {
  BLOB_REQUIRE(pose != nullptr && motion != nullptr);
  if (motion->caseNodes != pose->pose.size()) return BLOB_ERROR_ARGUMENT;
  if (!std::isfinite(seconds)) return BLOB_ERROR_RANGE;
  const std::size_t count = motion->node.size();
  const lumen::field::Instant at = lumen::field::instantAt(motion->time, motion->period, seconds);
  for (std::size_t i = 0; i < count; ++i)
    pose->pose[motion->node[i]] =
        nodeBetween(motion->pose[at.from * count + i], motion->pose[at.to * count + i], at.share);
  collectChanged(*pose, count, motion->node.data(), false);
  return finishChange(*pose, change);
}

size_t blob_query_weights(const blob_model* model, uint32_t flags, const double point[3],
                          uint32_t* cursor, uint32_t* nodes, double* weights,
                          size_t capacity) noexcept {
  BLOB_REQUIRE(model != nullptr && point != nullptr);
  BLOB_REQUIRE((nodes != nullptr && weights != nullptr) || capacity == 0);
  std::uint32_t node;
  if (!findQueryNode(*model, flags, point, cursor, node)) return 0;
  const NodeWeights found = weighNodes(*model, flags, point, node);
  for (std::size_t i = 0; i < std::min<std::size_t>(found.count, capacity); ++i) {
    nodes[i] = found.node[i];
    weights[i] = found.weight[i];
  }
  return found.count;
}

void blob_pose_velocity(const blob_pose* pose, const blob_pose* before, double seconds,
                        uint32_t flags, const double point[3], uint32_t* cursor,
                        double velocity[3]) noexcept {
  BLOB_REQUIRE(pose != nullptr && before != nullptr && point != nullptr && velocity != nullptr);
  BLOB_REQUIRE(pose->rest == before->rest);
  std::uint32_t node;
  std::fill_n(velocity, 3, kUnknown);
  if (!isFinitePoint(point)) return;
  std::fill_n(velocity, 3, 0.0);
  if (!findQueryNode(pose->model, flags, point, cursor, node)) return;
  const NodeWeights found = weighNodes(pose->model, flags, point, node);
  for (unsigned i = 0; i < found.count; ++i) {
    const lumen::field::Vec moved = displacementOf(*pose, *before, found.node[i], point);
    const double share = found.weight[i] / seconds;
    velocity[0] += share * moved.x;
    velocity[1] += share * moved.y;
    velocity[2] += share * moved.z;
  }
}

}  // extern "C"
