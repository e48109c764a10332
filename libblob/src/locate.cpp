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
    } while (count > 1);
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
      for (int axis = 0; axis < 3; ++axis)
        leaf.centre[axis][lane] = real ? m_nodes[node].centre[axis] : 0.0;
      const double radius = real ? m_nodes[node].radius() : 0.0;
      leaf.radius2[lane] = real ? radius * radius : -kInfinity;
      leaf.node[lane] = node;
    }
    tree.leaves.push_back(leaf);
  }

  // The box and the greatest r^2 of child c of the level to be added.
  static void childBounds(const LocateTree& tree, std::size_t c, double* low, double* high,
                          double& radius2) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const bool leaf = tree.levels.empty();
      const double r2 = leaf ? tree.leaves[c].radius2[lane] : tree.levels.back()[c].radius2[lane];
      if (r2 == -kInfinity) continue;
      radius2 = std::max(radius2, r2);
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], leaf ? tree.leaves[c].centre[axis][lane]
                                             : tree.levels.back()[c].low[axis][lane]);
        high[axis] = std::max(high[axis], leaf ? tree.leaves[c].centre[axis][lane]
                                               : tree.levels.back()[c].high[axis][lane]);
      }
    }
  }

  static void addLevel(LocateTree& tree, std::size_t children) {
    std::vector<LocateBlock> level((children + kLanes - 1) / kLanes);
    for (std::size_t c = 0; c < level.size() * kLanes; ++c) {
      double low[3] = {kInfinity, kInfinity, kInfinity};
      double high[3] = {-kInfinity, -kInfinity, -kInfinity};
      double radius2 = -kInfinity;
      if (c < children) childBounds(tree, c, low, high, radius2);
      LocateBlock& block = level[c / kLanes];
      const std::size_t lane = c % kLanes;
      for (int axis = 0; axis < 3; ++axis) {
        block.low[axis][lane] = radius2 == -kInfinity ? 0.0 : low[axis];
        block.high[axis][lane] = radius2 == -kInfinity ? 0.0 : high[axis];
      }
      block.radius2[lane] = radius2;
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
