// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/self_intersections.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include "converters/geometry/box_tree.h"

namespace lumen::convert {
namespace {

constexpr double kGreatestCoordinate = 1e50, kLeastCoordinate = 1e-50;  // range of orientation()
constexpr std::uint32_t kTaskNodes = 512;      // nodes of a subtree that is searched at once
constexpr std::size_t kTasksAtOnce = 1 << 10;  // between two looks at the progress
constexpr int kMortonBits = 21;                // bits per coordinate, three of which fit 64 bits
constexpr std::uint64_t kUnusable = ~std::uint64_t{0};  // no code along the curve has 64 bits

// The box, rounded outwards: floats halve the memory to traverse.
Box3f roundedOutwards(const Box3d& exact) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box3f box;
  for (int k = 0; k < 3; ++k) {
    const auto low = static_cast<float>(exact.low[k]), high = static_cast<float>(exact.high[k]);
    box.low[k] = double{low} > exact.low[k] ? std::nextafter(low, -kInfinity) : low;
    box.high[k] = double{high} < exact.high[k] ? std::nextafter(high, kInfinity) : high;
  }
  return box;
}

std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x1f00000000ffffULL;
  bits = (bits | bits << 16) & 0x1f0000ff0000ffULL;
  bits = (bits | bits << 8) & 0x100f00f00f00f00fULL;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3ULL;
  return (bits | bits << 2) & 0x1249249249249249ULL;
}

bool isUsable(const TriangleMesh& mesh, const Triangle& t) {
  const auto isInRange = [&mesh](std::uint32_t v) {
    const auto size = mesh.position[v].array().abs();
    return (size <= kGreatestCoordinate && (size == 0 || size >= kLeastCoordinate)).all();
  };
  return isInRange(t[0]) && isInRange(t[1]) && isInRange(t[2]) && hasArea(mesh, t);
}

Eigen::Array3d middleOf(const TriangleMesh& mesh, const Triangle& corner) {
  return mesh.position[corner[0]] / 3 + mesh.position[corner[1]] / 3 + mesh.position[corner[2]] / 3;
}

// The box of the middles of the triangles that can intersect.
Box3d boxOfMiddles(const TriangleMesh& mesh, const std::vector<std::uint8_t>& usable) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, usable.size()), Box3d(),
      [&](const tbb::blocked_range<std::size_t>& range, Box3d box) {
        for (std::size_t t = range.begin(); t < range.end(); ++t)
          if (usable[t] != 0) box.add(middleOf(mesh, mesh.triangle[t]).matrix().eval());
        return box;
      },
      [](Box3d one, const Box3d& other) {
        one.add(other);
        return one;
      });
}

// The triangles that can intersect, along a Morton curve through their middles.
std::vector<std::uint32_t> inOrder(const TriangleMesh& mesh) {
  std::vector<std::uint8_t> usable(mesh.triangle.size());
  tbb::parallel_for(std::size_t{0}, usable.size(),
                    [&](std::size_t t) { usable[t] = isUsable(mesh, mesh.triangle[t]) ? 1 : 0; });
  const Box3d box = boxOfMiddles(mesh, usable);
  const Eigen::Array3d low = box.low;
  // a side of no length must not make the scale infinite, as zero times infinity is NaN
  const Eigen::Array3d scale = ((1 << kMortonBits) - 1) / (box.high - box.low).array().max(1e-280);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> code(usable.size());
  tbb::parallel_for(std::size_t{0}, usable.size(), [&](std::size_t t) {
    code[t] = {kUnusable, static_cast<std::uint32_t>(t)};
    if (usable[t] == 0) return;
    const Eigen::Array3d at = (middleOf(mesh, mesh.triangle[t]) - low) * scale;
    const auto bits = [&at](int k) { return spread(static_cast<std::uint64_t>(at[k])); };
    code[t].first = bits(0) | bits(1) << 1 | bits(2) << 2;
  });
  tbb::parallel_sort(code.begin(), code.end());
  std::vector<std::uint32_t> order;
  order.reserve(code.size());
  for (const auto& [place, triangle] : code)
    if (place != kUnusable) order.push_back(triangle);
  return order;
}

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

// The triangles that can intersect, in a bounding-volume hierarchy along the Morton curve.
class TriangleLeaves {
public:
  explicit TriangleLeaves(const TriangleMesh& mesh) : m_mesh(mesh), m_order(inOrder(mesh)) {
    m_box.resize(m_order.size());
    tbb::parallel_for(std::size_t{0}, m_order.size(), [&](std::size_t i) {
      Box3d exact;
      for (const std::uint32_t v : mesh.triangle[m_order[i]]) exact.add(mesh.position[v]);
      m_box[i] = roundedOutwards(exact);
    });
    m_tree = BoxTree<float>(m_box);
    if (!m_order.empty()) divide(whole());
  }

  /// Number of parts of the search.
  [[nodiscard]] std::size_t size() const { return m_tasks.size(); }

  /// Adds the intersecting pairs of one part of the search, until there are more than `most`.
  void find(std::size_t part, std::size_t most, Pairs& pairs) const {
    const auto& [one, other] = m_tasks[part];
    if (one.first == other.first)
      findWithin(one, most, pairs);
    else
      findBetween(one, other, most, pairs);
  }

private:
  // The nodes from `first` to before `end`, which are a node and all below it.
  struct Subtree {
    std::uint32_t first, end;
    [[nodiscard]] std::uint32_t size() const { return end - first; }
  };

  [[nodiscard]] Subtree whole() const {
    return {0, static_cast<std::uint32_t>(m_tree.nodes().size())};
  }
  [[nodiscard]] bool isLeaf(Subtree tree) const { return m_tree.node(tree.first).count > 0; }
  [[nodiscard]] Subtree left(Subtree tree) const {
    return {tree.first + 1, m_tree.node(tree.first).at};
  }
  [[nodiscard]] Subtree right(Subtree tree) const { return {m_tree.node(tree.first).at, tree.end}; }
  [[nodiscard]] bool meet(Subtree one, Subtree other) const {
    return m_tree.node(one.first).box.meets(m_tree.node(other.first).box);
  }

  // Lists the parts of the search within a subtree.
  void divide(Subtree tree) {
    if (tree.size() <= kTaskNodes) return m_tasks.push_back({tree, tree});
    divide(left(tree));
    divide(right(tree));
    divide(left(tree), right(tree));
  }
  void divide(Subtree one, Subtree other) {
    if (!meet(one, other)) return;
    if (std::max(one.size(), other.size()) <= kTaskNodes) return m_tasks.push_back({one, other});
    eachHalf(one, other, [this](Subtree a, Subtree b) { divide(a, b); });
  }

  // Divides the larger of two subtrees, one of which is larger than a leaf.
  template <class Use>
  void eachHalf(Subtree one, Subtree other, const Use& use) const {
    if (one.size() >= other.size()) {
      use(left(one), other);
      use(right(one), other);
    } else {
      use(one, left(other));
      use(one, right(other));
    }
  }

  void findWithin(Subtree tree, std::size_t most, Pairs& pairs) const {
    if (pairs.size() > most) return;
    if (isLeaf(tree)) {
      const auto& own = m_tree.node(tree.first);
      for (std::uint32_t i = own.at; i < own.at + own.count; ++i)
        for (std::uint32_t k = i + 1; k < own.at + own.count; ++k) test(i, k, pairs);
      return;
    }
    findWithin(left(tree), most, pairs);
    findWithin(right(tree), most, pairs);
    findBetween(left(tree), right(tree), most, pairs);
  }

  void findBetween(Subtree one, Subtree other, std::size_t most, Pairs& pairs) const {
    if (pairs.size() > most || !meet(one, other)) return;
    if (!isLeaf(one) || !isLeaf(other))
      return eachHalf(one, other, [&](Subtree a, Subtree b) { findBetween(a, b, most, pairs); });
    const auto &a = m_tree.node(one.first), &b = m_tree.node(other.first);
    for (std::uint32_t i = a.at; i < a.at + a.count; ++i) {
      if (!m_box[i].meets(b.box)) continue;
      for (std::uint32_t k = b.at; k < b.at + b.count; ++k) test(i, k, pairs);
    }
  }

  void test(std::uint32_t i, std::uint32_t k, Pairs& pairs) const {
    if (!m_box[k].meets(m_box[i])) return;
    const std::uint32_t one = m_order[i], other = m_order[k];
    if (intersect(m_mesh, m_mesh.triangle[one], m_mesh.triangle[other]))
      pairs.push_back({std::min(one, other), std::max(one, other)});
  }

  const TriangleMesh& m_mesh;
  std::vector<std::uint32_t> m_order;
  std::vector<Box3f> m_box;
  BoxTree<float> m_tree;
  std::vector<std::pair<Subtree, Subtree>> m_tasks;  // a subtree with itself, or with another
};

// The pairs of parts first .. last - 1, in that order. Where there are more than `most`, threads
// may find different subsets: then one thread repeats the search in order.
Pairs findPairs(const TriangleLeaves& tree, std::size_t first, std::size_t last, std::size_t most) {
  std::vector<Pairs> found(last - first);
  std::atomic<std::size_t> count{0};
  tbb::parallel_for(first, last, [&](std::size_t i) {
    if (count.load(std::memory_order_relaxed) > most) return;
    tree.find(i, most, found[i - first]);
    count.fetch_add(found[i - first].size(), std::memory_order_relaxed);
  });
  Pairs all;
  if (count <= most)
    for (const Pairs& some : found) all.insert(all.end(), some.begin(), some.end());
  else
    for (std::size_t i = first; i < last && all.size() <= most; ++i) tree.find(i, most, all);
  return all;
}

}  // namespace

SelfIntersections selfIntersections(const TriangleMesh& mesh, std::size_t limit,
                                    const Progress* progress) {
  SelfIntersections result;
  const TriangleLeaves tree(mesh);
  for (std::size_t first = 0; first < tree.size() && result.pairs.size() <= limit;
       first += kTasksAtOnce) {
    if (progress != nullptr) progress->check();
    const Pairs more = findPairs(tree, first, std::min(tree.size(), first + kTasksAtOnce),
                                 limit - result.pairs.size());
    result.pairs.insert(result.pairs.end(), more.begin(), more.end());
  }
  result.isComplete = result.pairs.size() <= limit;
  if (!result.isComplete) result.pairs.resize(limit);
  std::sort(result.pairs.begin(), result.pairs.end());
  return result;
}

}  // namespace lumen::convert
