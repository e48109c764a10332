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

  // The bounds of child c of the level to be added.
  static Bounds childBounds(const LocateTree& tree, std::size_t c) {
    Bounds bounds;
    for (int lane = 0; lane < kLanes; ++lane) {
      float low[3], high[3];
      if (tree.levels.empty()) {
        const LocateLeaf& leaf = tree.leaves[c];
        if (leaf.node[lane] == BLOB_NOWHERE) continue;
        for (int axis = 0; axis < 3; ++axis) low[axis] = high[axis] = leaf.centre[axis][lane];
        bounds.add(low, high, leaf.radius[lane]);
        continue;
      }
      const LocateBlock& block = tree.levels.back()[c];
      if (block.radius[lane] == kNoChild) continue;
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = block.low[axis][lane];
        high[axis] = block.high[axis][lane];
      }
      bounds.add(low, high, block.radius[lane]);
    }
    return bounds;
  }

  static void addLevel(LocateTree& tree, std::size_t children) {
    std::vector<LocateBlock> level((children + kLanes - 1) / kLanes);
    for (std::size_t c = 0; c < level.size() * kLanes; ++c) {
      const Bounds bounds = c < children ? childBounds(tree, c) : Bounds{};
      LocateBlock& block = level[c / kLanes];
      const std::size_t lane = c % kLanes;
      for (int axis = 0; axis < 3; ++axis) {
        block.low[axis][lane] = bounds.low[axis];
        block.high[axis][lane] = bounds.high[axis];
      }
      block.radius[lane] = bounds.radius;
    }
    tree.levels.push_back(std::move(level));
  }

  const std::vector<NodeRecord>& m_nodes;
  std::vector<std::uint32_t> m_order;
};

}  // namespace

LocateTree buildLocateTree(const std::vector<NodeRecord>& nodes) {
  return LocateTreeBuilder(nodes).build();
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

}  // namespace lumen::blob
