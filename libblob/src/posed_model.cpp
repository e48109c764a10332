// SPDX-License-Identifier: Apache-2.0
#include "posed_model.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "build_model.h"
#include "locate.h"
#include "neighbours.h"
#include "simd/backend.h"

namespace lumen::blob {
namespace {

using field::Neighbourhood;
using field::Vec;

Vec vectorOf(const double* v) noexcept {
  return {v[0], v[1], v[2]};
}

// The places of all nodes, as a tree whose arrays live as long as this.
class PosedTree {
public:
  explicit PosedTree(const blob_pose& pose) : m_pose(pose) {
    for (const PosedPlace& place : pose.place) {
      m_centre.push_back({place.number[0], place.number[1], place.number[2]});
      m_radius.push_back(place.number[3]);
    }
  }
  [[nodiscard]] field::TreeView view() const {
    const auto& links = m_pose.rest->links;
    return {m_radius.size(), reinterpret_cast<const float(*)[3]>(m_centre.data()),
            m_radius.data(), m_pose.rest->parent.data(),
            links.size(),    reinterpret_cast<const std::uint32_t(*)[2]>(links.data())};
  }

private:
  const blob_pose& m_pose;
  std::vector<std::array<float, 3>> m_centre;
  std::vector<float> m_radius;
};

bool joins(const Neighbourhood& edges, std::uint32_t i, std::uint32_t k) {
  const auto at = [&edges](std::uint32_t e) {
    return edges.node.begin() + static_cast<std::ptrdiff_t>(e);
  };
  return std::binary_search(at(edges.offset[i]), at(edges.offset[i + 1]), k);
}

std::vector<LaneKinds> findLaneKinds(const std::vector<NodeRecord>& nodes,
                                     const std::vector<NeighbourBlock>& blocks,
                                     const Neighbourhood& edges) {
  std::vector<LaneKinds> kinds(blocks.size());
  for (std::uint32_t i = 0; i < nodes.size(); ++i)
    for (std::size_t b = 0; b < nodes[i].neighbourBlocks; ++b)
      for (int lane = 0; lane < kLanes; ++lane) {
        const NeighbourBlock& block = blocks[nodes[i].firstNeighbours + b];
        float& kind = kinds[nodes[i].firstNeighbours + b].kind[lane];
        kind = isPadding(block, lane) ? -1.0f : joins(edges, i, block.node[lane]) ? 1.0f : 0.0f;
      }
  return kinds;
}

float squareOfEdge(const blob_pose& pose, std::uint32_t i, std::uint32_t k) noexcept {
  const float *a = pose.place[i].number, *b = pose.place[k].number;
  const float x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
  return (x * x + y * y) + z * z;
}

template <class Visit>
void eachEdge(const blob_pose& pose, std::uint32_t node, Visit visit) {
  for (std::uint32_t e = pose.edges.offset[node]; e < pose.edges.offset[node + 1]; ++e)
    visit(pose.edges.node[e]);
}

void measureSpacing(blob_pose& pose, std::uint32_t node) noexcept {
  float greatest = 0;
  eachEdge(pose, node,
           [&](std::uint32_t k) { greatest = std::max(greatest, squareOfEdge(pose, node, k)); });
  pose.spacing[node] = greatest;
}

void addNeighboursTo(const blob_pose& pose, std::uint32_t node, IndexSet& set) noexcept {
  const NodeRecord& record = pose.model.nodes[node];
  set.add(node);
  for (std::size_t b = 0; b < record.neighbourBlocks; ++b)
    for (const std::uint32_t k : pose.model.neighbours[record.firstNeighbours + b].node)
      if (k != BLOB_NOWHERE) set.add(k);
}

// The nodes whose tables depend on the nodes that changed: their neighbours, and, as a width depends
// on the edges at both ends, the neighbours of the nodes at the other ends of their edges.
void findDirty(blob_pose& pose) noexcept {
  pose.dirty.clear();
  const std::vector<std::uint32_t>& changed = pose.changed.list();
  if (2 * changed.size() > pose.pose.size()) {
    for (std::uint32_t i = 0; i < pose.pose.size(); ++i) pose.dirty.add(i);
    for (std::uint32_t i = 0; i < pose.pose.size(); ++i) measureSpacing(pose, i);
    return;
  }
  for (const std::uint32_t i : changed) {
    measureSpacing(pose, i);
    addNeighboursTo(pose, i, pose.dirty);
    eachEdge(pose, i, [&pose](std::uint32_t k) {
      measureSpacing(pose, k);
      addNeighboursTo(pose, k, pose.dirty);
    });
  }
}

// Nodes that borrow blobs refer to their lender's centre.
void placeBorrowers(blob_pose& pose) noexcept {
  for (const auto& [lender, borrower] : pose.borrowers) {
    const double *from = pose.model.nodes[lender].centre, *to = pose.model.nodes[borrower].centre;
    for (int axis = 0; axis < 3; ++axis)
      pose.model.nodes[borrower].field.place[axis] = static_cast<float>(to[axis] - from[axis]);
  }
}

// Boxes only grow, unless all nodes changed.
void boundNodes(blob_pose& pose) noexcept {
  blob_model& model = pose.model;
  if (pose.changed.list().size() == pose.pose.size())
    for (int axis = 0; axis < 3; ++axis) {
      model.low[axis] = model.reachLow[axis] = std::numeric_limits<double>::infinity();
      model.high[axis] = model.reachHigh[axis] = -model.low[axis];
    }
  for (const std::uint32_t i : pose.changed.list()) {
    const double radius = pose.place[i].number[3];
    const double reach = std::max(radius, pose.pose[i].factor * double{pose.reach[i]});
    for (int axis = 0; axis < 3; ++axis) {
      const double x = model.nodes[i].centre[axis];
      model.low[axis] = std::min(model.low[axis], x - radius);
      model.high[axis] = std::max(model.high[axis], x + radius);
      model.reachLow[axis] = std::min(model.reachLow[axis], x - reach);
      model.reachHigh[axis] = std::max(model.reachHigh[axis], x + reach);
    }
  }
}

void refitLocateTree(blob_pose& pose) noexcept {
  LocateTree& tree = pose.model.locate;
  for (IndexSet& set : pose.children) set.clear();
  for (const std::uint32_t i : pose.changed.list()) {
    const std::uint32_t slot = pose.leafSlot[i];
    LocateLeaf& leaf = tree.leaves[slot / kLanes];
    for (int axis = 0; axis < 3; ++axis)
      leaf.centre[axis][slot % kLanes] = pose.place[i].number[axis];
    leaf.radius[slot % kLanes] = pose.place[i].number[3];
    pose.children[0].add(slot / kLanes);
  }
  for (std::size_t level = 0; level < tree.levels.size(); ++level)
    for (const std::uint32_t child : pose.children[level].list()) {
      refitChild(tree, level, child);
      if (level + 1 < tree.levels.size()) pose.children[level + 1].add(child / kLanes);
    }
}

// The radius around each node's centre at rest beyond which its own blobs stay below T.
std::vector<float> measureReach(const blob_model& rest) {
  std::vector<float> reach(rest.nodes.size(), 0.0f);
  for (std::size_t i = 0; i < reach.size(); ++i) {
    const FieldNode& field = rest.nodes[i].field;
    const double count = double{kLanes} * field.blockCount;
    for (std::uint32_t b = field.block; b < field.block + field.blockCount; ++b)
      for (int lane = 0; lane < kLanes; ++lane) {
        const BlobBlock& block = rest.field.blocks[b];
        if (!(block.w[lane] > 0)) continue;
        const double beyond = reachOfBlob(rest.field, block.w[lane], block.a[lane], count);
        const double at = std::hypot(block.x[lane], block.y[lane], block.z[lane]);
        reach[i] = std::max(reach[i], static_cast<float>((at + beyond) * (1.0 + 1e-6)));
      }
  }
  return reach;
}

void makeWorkingMemory(blob_pose& pose) {
  const std::size_t count = pose.pose.size();
  pose.changed = IndexSet(count);
  pose.dirty = IndexSet(count);
  pose.strained = IndexSet(pose.edgeReference.size());
  std::size_t children = pose.model.locate.leaves.size();
  for (const std::vector<LocateBlock>& level : pose.model.locate.levels) {
    pose.children.emplace_back(children);
    children = level.size();
  }
}

void readRest(blob_pose& pose) {
  const blob_model& model = pose.model;
  for (std::uint32_t i = 0; i < model.nodes.size(); ++i) {
    const double* centre = model.nodes[i].centre;
    pose.pose.push_back({vectorOf(centre), {0, 0, 0, 1}, 1.0});
    pose.place.push_back({{static_cast<float>(centre[0]), static_cast<float>(centre[1]),
                           static_cast<float>(centre[2]), model.nodes[i].radius()}});
    if (model.lender[i] != i && model.lender[i] != BLOB_NOWHERE)
      pose.borrowers.push_back({model.lender[i], i});
  }
  pose.rotation.assign(pose.pose.size(), {{0, 0, 0, 1}});
  pose.inverseFactor.assign(pose.pose.size(), 1.0f);
}

EdgeReference edgeAtRest(const blob_model& rest, std::uint32_t from, std::uint32_t to) noexcept {
  EdgeReference edge{};
  edge.node[0] = from;
  edge.node[1] = to;
  edge.radius = std::max(rest.nodes[from].radius(), rest.nodes[to].radius());
  const double length =
      field::norm(vectorOf(rest.nodes[to].centre) - vectorOf(rest.nodes[from].centre));
  edge.inverseLength = length > 0 ? static_cast<float>(1.0 / length) : 0.0f;
  return edge;
}

// The edges from all nodes to their parents, in the order of the nodes, then the links; and their
// places in the lists of edges of both ends.
void listEdges(blob_pose& pose) {
  const blob_model& rest = *pose.rest;
  std::vector<std::array<std::uint32_t, 2>> ends;
  for (std::uint32_t i = 0; i < rest.nodes.size(); ++i)
    if (rest.parent[i] >= 0) ends.push_back({i, static_cast<std::uint32_t>(rest.parent[i])});
  for (const auto& link : rest.links) ends.push_back({link[1], link[0]});
  pose.edgeAt.assign(pose.edges.node.size(), 0);
  for (const auto& [i, k] : ends) {
    const auto id = static_cast<std::uint32_t>(pose.edgeReference.size());
    pose.edgeReference.push_back(edgeAtRest(rest, i, k));
    for (const auto& [from, to] : {std::array{i, k}, std::array{k, i}})
      for (std::uint32_t e = pose.edges.offset[from]; e < pose.edges.offset[from + 1]; ++e)
        if (pose.edges.node[e] == to) pose.edgeAt[e] = id;
  }
}

void copyTo(const Vec& v, float* numbers) noexcept {
  numbers[0] = static_cast<float>(v.x);
  numbers[1] = static_cast<float>(v.y);
  numbers[2] = static_cast<float>(v.z);
}

// Strains are measured from now on against the pose as it is.
void referToPose(blob_pose& pose) noexcept {
  for (EdgeReference& edge : pose.edgeReference) {
    const NodePose &a = pose.pose[edge.node[0]], &b = pose.pose[edge.node[1]];
    const Vec vector = b.centre - a.centre;
    copyTo((1.0 / a.factor) * field::rotatedBack(a.rotation, vector), edge.from);
    copyTo((1.0 / b.factor) * field::rotatedBack(b.rotation, vector), edge.to);
    const Quaternion turn = product(field::conjugate(a.rotation), b.rotation);
    for (std::size_t i = 0; i < 4; ++i) edge.turn[i] = static_cast<float>(turn[i]);
  }
}

}  // namespace

std::unique_ptr<blob_pose> makePose(const blob_model& rest, const blob_pose_def& def) {
  auto pose = std::make_unique<blob_pose>();
  pose->rest = &rest;
  pose->model = rest;
  pose->model.isPosed = true;
  pose->strainLimit = def.strain_limit;
  pose->renews = def.renew != 0;
  readRest(*pose);
  const PosedTree tree(*pose);
  pose->edges = field::findEdges(tree.view());
  pose->laneKinds = findLaneKinds(pose->model.nodes, pose->model.neighbours, pose->edges);
  pose->spacing.resize(pose->pose.size());
  for (std::uint32_t i = 0; i < pose->pose.size(); ++i) measureSpacing(*pose, i);
  pose->reach = measureReach(rest);
  pose->leafSlot = findLeafSlots(rest.locate, rest.nodes.size());
  listEdges(*pose);
  referToPose(*pose);
  makeWorkingMemory(*pose);
  return pose;
}

void moveNodes(blob_pose& pose) noexcept {
  const Backend& backend = *pose.model.backend;
  const std::vector<std::uint32_t>& changed = pose.changed.list();
  backend.placeBlobs(pose, changed.data(), changed.size());
  findDirty(pose);
  backend.placeNeighbours(pose, pose.dirty.list().data(), pose.dirty.list().size());
  placeBorrowers(pose);
  boundNodes(pose);
  refitLocateTree(pose);
}

bool isTransform(const blob_transform& transform) noexcept {
  constexpr double kFarthest = 1e6, kLeastFactor = 1e-3, kGreatestFactor = 1e3;
  const double *c = transform.centre, *q = transform.rotation;
  const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  return std::abs(c[0]) <= kFarthest && std::abs(c[1]) <= kFarthest &&
         std::abs(c[2]) <= kFarthest && square > 1e-200 && square < 1e200 &&
         transform.factor >= kLeastFactor && transform.factor <= kGreatestFactor;
}

NodePose poseOf(const blob_transform& transform) noexcept {
  const double *c = transform.centre, *q = transform.rotation;
  const double scale = 1.0 / std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {{static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])},
          {scale * q[0], scale * q[1], scale * q[2], scale * q[3]},
          transform.factor};
}

blob_transform transformOf(const NodePose& pose) noexcept {
  const Quaternion& q = pose.rotation;
  return {{pose.centre.x, pose.centre.y, pose.centre.z}, {q[0], q[1], q[2], q[3]}, pose.factor};
}

double strainOfChange(blob_pose& pose) noexcept {
  pose.strained.clear();
  for (const std::uint32_t i : pose.changed.list())
    for (std::uint32_t e = pose.edges.offset[i]; e < pose.edges.offset[i + 1]; ++e)
      pose.strained.add(pose.edgeAt[e]);
  const std::vector<std::uint32_t>& edges = pose.strained.list();
  return pose.model.backend->greatestStrain(pose, edges.data(), edges.size());
}

void renewNeighbours(blob_pose& pose) {
  const PosedTree tree(pose);
  const Neighbourhood around = field::findNeighbourhood(tree.view(), pose.edges);
  const std::vector<double> spacing = field::measureSpacings(tree.view(), pose.edges);
  std::vector<NodeRecord> nodes = pose.model.nodes;
  std::vector<NeighbourBlock> blocks;
  addNeighbours(tree.view(), around, spacing, nodes, blocks);
  std::vector<LaneKinds> kinds = findLaneKinds(nodes, blocks, pose.edges);
  pose.model.nodes.swap(nodes);
  pose.model.neighbours.swap(blocks);
  pose.laneKinds.swap(kinds);
  referToPose(pose);
}

Quaternion rotationFromCentres(const blob_pose& pose, std::uint32_t node) noexcept {
  // from the parent, or the node itself, to the child that goes on straightest, or the node itself
  const blob_model& rest = *pose.rest;
  const std::int32_t parent = rest.parent[node];
  const std::uint32_t before = parent < 0 ? node : static_cast<std::uint32_t>(parent);
  const Vec here = vectorOf(rest.nodes[node].centre);
  const Vec incoming = here - vectorOf(rest.nodes[before].centre);
  std::uint32_t after = node;
  double straightest = -2;
  eachEdge(pose, node, [&](std::uint32_t k) {
    if (rest.parent[k] != static_cast<std::int32_t>(node)) return;
    const Vec outgoing = vectorOf(rest.nodes[k].centre) - here;
    const double size = field::norm(incoming) * field::norm(outgoing);
    const double cosine = size > 0 ? field::dot(incoming, outgoing) / size : -1;
    if (cosine <= straightest) return;
    straightest = cosine;
    after = k;
  });
  const auto posed = [&pose](std::uint32_t k) {
    const float* at = pose.place[k].number;
    return Vec{at[0], at[1], at[2]};
  };
  return turnBetween(vectorOf(rest.nodes[after].centre) - vectorOf(rest.nodes[before].centre),
                     posed(after) - posed(before));
}

}  // namespace lumen::blob
