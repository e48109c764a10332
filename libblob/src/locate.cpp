// SPDX-License-Identifier: Apache-2.0
#include "locate.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "answer.h"
#include "simd/backend.h"

namespace lumen::blob {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Bounds {
  float low[3] = {kFarAway, kFarAway, kFarAway}, high[3] = {-kFarAway, -kFarAway, -kFarAway};
  float radius = kNoChild;

  void add(const float* from, const float* to, float greatest) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], from[axis]);
      high[axis] = std::max(high[axis], to[axis]);
    }
    radius = std::max(radius, greatest);
  }
};

Bounds boundsOf(const LocateLeaf& leaf) {
  Bounds bounds;
  for (int lane = 0; lane < kLanes; ++lane) {
    if (leaf.node[lane] == BLOB_NOWHERE) continue;
    const float at[3] = {leaf.centre[0][lane], leaf.centre[1][lane], leaf.centre[2][lane]};
    bounds.add(at, at, leaf.radius[lane]);
  }
  return bounds;
}

Bounds boundsOf(const LocateBlock& block) {
  Bounds bounds;
  for (int lane = 0; lane < kLanes; ++lane) {
    if (block.radius[lane] == kNoChild) continue;
    const float low[3] = {block.low[0][lane], block.low[1][lane], block.low[2][lane]};
    const float high[3] = {block.high[0][lane], block.high[1][lane], block.high[2][lane]};
    bounds.add(low, high, block.radius[lane]);
  }
  return bounds;
}

// The bounds of child c of a level.
Bounds childBounds(const LocateTree& tree, std::size_t level, std::size_t c) {
  return level == 0 ? boundsOf(tree.leaves[c]) : boundsOf(tree.levels[level - 1][c]);
}

void setChild(const Bounds& bounds, std::size_t c, std::vector<LocateBlock>& level) {
  LocateBlock& block = level[c / kLanes];
  const std::size_t lane = c % kLanes;
  for (int axis = 0; axis < 3; ++axis) {
    block.low[axis][lane] = bounds.low[axis];
    block.high[axis][lane] = bounds.high[axis];
  }
  block.radius[lane] = bounds.radius;
}

class LocateTreeBuilder {
public:
  explicit LocateTreeBuilder(const std::vector<NodeRecord>& nodes)
      : m_nodes(nodes), m_order(nodes.size()) {
    std::iota(m_order.begin(), m_order.end(), 0U);
  }

  LocateTree build() {
    sort(0, m_order.size());
    LocateTree tree;
    for (std::size_t i = 0; i < m_order.size(); i += kLanes) addLeaf(tree, i);
    std::size_t count = tree.leaves.size();
    do {
      addLevel(tree, count);
      count = tree.levels.back().size();
    } while (count > LocateTree::kMostRoots);
    return tree;
  }

private:
  // Halves at multiples of the greatest power of eight below the size, so that the boxes of an
  // implicit 8-ary tree are compact.
  void sort(std::size_t begin, std::size_t end) {
    if (end - begin <= kLanes) return;
    std::size_t chunk = kLanes;
    while (chunk * kLanes < end - begin) chunk *= kLanes;
    const std::size_t chunks = (end - begin + chunk - 1) / chunk;
    const std::size_t middle = begin + chunks / 2 * chunk;
    const int axis = widestAxis(begin, end);
    const auto at = [this](std::size_t i) {
      return m_order.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
      const double xa = m_nodes[a].centre[axis], xb = m_nodes[b].centre[axis];
      return xa != xb ? xa < xb : a < b;
    });
    sort(begin, middle);
    sort(middle, end);
  }

  [[nodiscard]] int widestAxis(std::size_t begin, std::size_t end) const {
    int widest = 0;
    double width = -1;
    for (int axis = 0; axis < 3; ++axis) {
      double low = kInfinity, high = -kInfinity;
      for (std::size_t i = begin; i < end; ++i) {
        low = std::min(low, m_nodes[m_order[i]].centre[axis]);
        high = std::max(high, m_nodes[m_order[i]].centre[axis]);
      }
      if (high - low > width) {
        width = high - low;
        widest = axis;
      }
    }
    return widest;
  }

  void addLeaf(LocateTree& tree, std::size_t first) const {
    LocateLeaf leaf;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const bool real = first + lane < m_order.size();
      const std::uint32_t node = real ? m_order[first + lane] : BLOB_NOWHERE;
      for (int axis = 0; axis < 3; ++axis)  // centres are floats, stored as doubles
        leaf.centre[axis][lane] = real ? static_cast<float>(m_nodes[node].centre[axis]) : kFarAway;
      leaf.radius[lane] = real ? m_nodes[node].radius() : 0.0f;
      leaf.node[lane] = node;
    }
    tree.leaves.push_back(leaf);
  }

  static void addLevel(LocateTree& tree, std::size_t children) {
    std::vector<LocateBlock> level((children + kLanes - 1) / kLanes);
    for (std::size_t c = 0; c < level.size() * kLanes; ++c)
      setChild(c < children ? childBounds(tree, tree.levels.size(), c) : Bounds{}, c, level);
    tree.levels.push_back(std::move(level));
  }

  const std::vector<NodeRecord>& m_nodes;
  std::vector<std::uint32_t> m_order;
};

}  // namespace

LocateTree buildLocateTree(const std::vector<NodeRecord>& nodes) {
  return LocateTreeBuilder(nodes).build();
}

std::vector<std::uint32_t> findLeafSlots(const LocateTree& tree, std::size_t nodeCount) {
  std::vector<std::uint32_t> slot(nodeCount);
  for (std::size_t leaf = 0; leaf < tree.leaves.size(); ++leaf)
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      if (const std::uint32_t node = tree.leaves[leaf].node[lane]; node != BLOB_NOWHERE)
        slot[node] = static_cast<std::uint32_t>(leaf * kLanes + lane);
  return slot;
}

void refitChild(LocateTree& tree, std::size_t level, std::size_t child) noexcept {
  setChild(childBounds(tree, level, child), child, tree.levels[level]);
}

std::uint32_t locateNode(const blob_model& model, const double* point) noexcept {
  return model.backend->locate(model, point);
}

std::uint32_t nodeFor(const blob_model& model, std::uint32_t flags, const double* point,
                      std::uint32_t cursor) noexcept {
  const std::uint32_t node = cursor < model.nodes.size() ? cursor : locateNode(model, point);
  if ((flags & BLOB_HOLD) != 0 || !isInRange(model.nodes[node], point)) return node;
  return model.backend->follow(model, point, node);
}

bool findQueryNode(const blob_model& model, std::uint32_t flags, const double* point,
                   std::uint32_t* cursor, std::uint32_t& node) noexcept {
  node = cursor != nullptr ? *cursor : BLOB_NOWHERE;
  if (!isFinitePoint(point)) return false;
  node = nodeFor(model, flags, point, node);
  if (cursor != nullptr) *cursor = node;
  return isInRange(model.nodes[node], point);
}

}  // namespace lumen::blob
