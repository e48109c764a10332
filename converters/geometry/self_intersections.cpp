// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/self_intersections.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/geometry/triangle_pair.h"

namespace lumen::convert {
namespace {

constexpr double kGreatest = 1e50, kLeast = 1e-50;  // what orientation() takes
constexpr std::uint32_t kLeaf = 4;                  // triangles of a leaf of the tree
constexpr std::size_t kBlock = 1 << 14;             // leaves that are asked for at once
constexpr int kMortonBits = 21;                     // of a coordinate, three of which fit 64 bits

// Floats, rounded outwards: half the memory to walk through, and no box gets smaller.
struct Box {
  Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Array3f high = Eigen::Array3f::Constant(-std::numeric_limits<float>::infinity());

  void add(const Eigen::Vector3d& p) {
    for (int k = 0; k < 3; ++k) {
      const auto near = static_cast<float>(p[k]);
      const float infinity = std::numeric_limits<float>::infinity();
      low[k] = std::min(low[k], double{near} > p[k] ? std::nextafter(near, -infinity) : near);
      high[k] = std::max(high[k], double{near} < p[k] ? std::nextafter(near, infinity) : near);
    }
  }
  void add(const Box& other) {
    low = low.min(other.low);
    high = high.max(other.high);
  }
  [[nodiscard]] bool meets(const Box& other) const {
    return (low <= other.high).all() && (other.low <= high).all();
  }
};

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
    return (size <= kGreatest && (size == 0 || size >= kLeast)).all();
  };
  return isInRange(t[0]) && isInRange(t[1]) && isInRange(t[2]) && hasArea(mesh, t);
}

// The triangles that can intersect, along a Morton curve through their middles.
std::vector<std::uint32_t> inOrder(const TriangleMesh& mesh) {
  std::vector<std::uint8_t> usable(mesh.triangle.size());
  tbb::parallel_for(std::size_t{0}, usable.size(),
                    [&](std::size_t t) { usable[t] = isUsable(mesh, mesh.triangle[t]) ? 1 : 0; });
  Eigen::Array3d low = Eigen::Array3d::Constant(kGreatest), high = -low;
  const auto middle = [&mesh](std::size_t t) -> Eigen::Array3d {
    const Triangle& corner = mesh.triangle[t];
    return mesh.position[corner[0]] / 3 + mesh.position[corner[1]] / 3 +
           mesh.position[corner[2]] / 3;
  };
  for (std::size_t t = 0; t < usable.size(); ++t) {
    if (usable[t] == 0) continue;
    low = low.min(middle(t));
    high = high.max(middle(t));
  }
  // a side of no length must not make the scale infinite, and zero times that no number
  const Eigen::Array3d scale = ((1 << kMortonBits) - 1) / (high - low).max(1e-280);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> code;
  for (std::size_t t = 0; t < usable.size(); ++t) {
    if (usable[t] == 0) continue;
    const Eigen::Array3d at = (middle(t) - low) * scale;
    const auto bits = [&at](int k) { return spread(static_cast<std::uint64_t>(at[k])); };
    code.emplace_back(bits(0) | bits(1) << 1 | bits(2) << 2, static_cast<std::uint32_t>(t));
  }
  std::sort(code.begin(), code.end());
  std::vector<std::uint32_t> order;
  order.reserve(code.size());
  for (const auto& entry : code) order.push_back(entry.second);
  return order;
}

// Boxes over runs of triangles of `order`: a binary tree whose leaves are runs of kLeaf. Level 0
// are the leaves; box i of a level holds boxes 2 i and 2 i + 1 of the one below.
class BoxTree {
public:
  explicit BoxTree(const TriangleMesh& mesh) : m_mesh(mesh), m_order(inOrder(mesh)) {
    m_box.resize(m_order.size());
    tbb::parallel_for(std::size_t{0}, m_order.size(), [&](std::size_t i) {
      for (const std::uint32_t v : mesh.triangle[m_order[i]]) m_box[i].add(mesh.position[v]);
    });
    std::span<const Box> below = m_box;
    for (std::size_t width = kLeaf; !below.empty(); width = 2) {
      std::vector<Box> level((below.size() + width - 1) / width);
      for (std::size_t i = 0; i < below.size(); ++i) level[i / width].add(below[i]);
      m_level.push_back(std::move(level));
      below = m_level.back();
      if (below.size() == 1) break;
    }
  }

  /// Of leaves.
  [[nodiscard]] std::size_t size() const { return m_level.empty() ? 0 : m_level.front().size(); }

  /// Adds the pairs of a triangle of the leaf and one of it or behind it, until there are more than
  /// `most`.
  void findBehind(std::size_t leaf, std::size_t most,
                  std::vector<std::array<std::uint32_t, 2>>& pairs) const {
    visit(m_level.size() - 1, 0, leaf, most, pairs);
  }

private:
  void visit(std::size_t level, std::size_t index, std::size_t leaf, std::size_t most,
             std::vector<std::array<std::uint32_t, 2>>& pairs) const {
    const std::size_t end = (index + 1) << level;
    if (end <= leaf || pairs.size() > most || !m_level[level][index].meets(m_level[0][leaf]))
      return;
    if (level > 0) {
      visit(level - 1, 2 * index, leaf, most, pairs);
      if (2 * index + 1 < m_level[level - 1].size())
        visit(level - 1, 2 * index + 1, leaf, most, pairs);
      return;
    }
    for (std::size_t i = leaf * kLeaf; i < std::min((leaf + 1) * kLeaf, m_order.size()); ++i)
      for (std::size_t k = std::max(i + 1, index * kLeaf);
           k < std::min(end * kLeaf, m_order.size()); ++k) {
        if (!m_box[k].meets(m_box[i])) continue;
        const std::uint32_t one = m_order[i], other = m_order[k];
        if (intersect(m_mesh, m_mesh.triangle[one], m_mesh.triangle[other]))
          pairs.push_back({std::min(one, other), std::max(one, other)});
      }
  }

  const TriangleMesh& m_mesh;
  std::vector<std::uint32_t> m_order;
  std::vector<Box> m_box;
  std::vector<std::vector<Box>> m_level;
};

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

// The pairs of leaves first .. last - 1, in that order. Where there are more than `most`, threads
// may find different ones of them: then it is done again, one after the other.
Pairs pairsOf(const BoxTree& tree, std::size_t first, std::size_t last, std::size_t most) {
  std::vector<Pairs> found(last - first);
  std::atomic<std::size_t> count{0};
  tbb::parallel_for(first, last, [&](std::size_t i) {
    if (count.load(std::memory_order_relaxed) > most) return;
    tree.findBehind(i, most, found[i - first]);
    count.fetch_add(found[i - first].size(), std::memory_order_relaxed);
  });
  Pairs all;
  if (count <= most)
    for (const Pairs& some : found) all.insert(all.end(), some.begin(), some.end());
  else
    for (std::size_t i = first; i < last && all.size() <= most; ++i) tree.findBehind(i, most, all);
  return all;
}

}  // namespace

SelfIntersections selfIntersections(const TriangleMesh& mesh, std::size_t limit) {
  SelfIntersections result;
  const BoxTree tree(mesh);
  for (std::size_t first = 0; first < tree.size() && result.pairs.size() <= limit;
       first += kBlock) {
    const Pairs more =
        pairsOf(tree, first, std::min(tree.size(), first + kBlock), limit - result.pairs.size());
    result.pairs.insert(result.pairs.end(), more.begin(), more.end());
  }
  result.isComplete = result.pairs.size() <= limit;
  if (!result.isComplete) result.pairs.resize(limit);
  std::sort(result.pairs.begin(), result.pairs.end());
  return result;
}

}  // namespace lumen::convert
