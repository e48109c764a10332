// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/self_intersections.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/geometry/box_tree.h"
#include "converters/geometry/triangle_pair.h"

namespace lumen::convert {
namespace {

constexpr double kGreatestCoordinate = 1e50, kLeastCoordinate = 1e-50;  // range of orientation()
constexpr std::size_t kBlock = 1 << 14;                                 // leaves per block of work
constexpr int kMortonBits = 21;  // bits per coordinate, three of which fit 64 bits

// Adds a point, rounded outwards: floats halve the memory to traverse.
void addOutwards(Box3f& box, const Eigen::Vector3d& p) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3; ++k) {
    const auto near = static_cast<float>(p[k]);
    box.low[k] =
        std::min(box.low[k], double{near} > p[k] ? std::nextafter(near, -kInfinity) : near);
    box.high[k] =
        std::max(box.high[k], double{near} < p[k] ? std::nextafter(near, kInfinity) : near);
  }
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

// The triangles that can intersect, along a Morton curve through their middles.
std::vector<std::uint32_t> inOrder(const TriangleMesh& mesh) {
  std::vector<std::uint8_t> usable(mesh.triangle.size());
  tbb::parallel_for(std::size_t{0}, usable.size(),
                    [&](std::size_t t) { usable[t] = isUsable(mesh, mesh.triangle[t]) ? 1 : 0; });
  Eigen::Array3d low = Eigen::Array3d::Constant(kGreatestCoordinate), high = -low;
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
  // a side of no length must not make the scale infinite, as zero times infinity is NaN
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

// The triangles that can intersect, in a bounding-volume hierarchy along the Morton curve.
class TriangleLeaves {
public:
  explicit TriangleLeaves(const TriangleMesh& mesh) : m_mesh(mesh), m_order(inOrder(mesh)) {
    m_box.resize(m_order.size());
    tbb::parallel_for(std::size_t{0}, m_order.size(), [&](std::size_t i) {
      for (const std::uint32_t v : mesh.triangle[m_order[i]])
        addOutwards(m_box[i], mesh.position[v]);
    });
    m_tree = BoxTree<float>(m_box);
    for (std::uint32_t i = 0; i < m_tree.nodes().size(); ++i)
      if (m_tree.node(i).count > 0) m_leaf.push_back(i);
  }

  /// Number of leaves.
  [[nodiscard]] std::size_t size() const { return m_leaf.size(); }

  /// Adds the intersecting pairs of a triangle of the leaf and one of the same or a later leaf,
  /// until there are more than `most`.
  void findBehind(std::size_t leaf, std::size_t most,
                  std::vector<std::array<std::uint32_t, 2>>& pairs) const {
    visit(0, static_cast<std::uint32_t>(m_tree.nodes().size()), m_leaf[leaf], most, pairs);
  }

private:
  // Nodes from `index` to before `end` form one subtree.
  void visit(std::uint32_t index, std::uint32_t end, std::uint32_t leaf, std::size_t most,
             std::vector<std::array<std::uint32_t, 2>>& pairs) const {
    const auto &node = m_tree.node(index), &own = m_tree.node(leaf);
    if (end <= leaf || pairs.size() > most || !node.box.meets(own.box)) return;
    if (node.count == 0) {
      visit(index + 1, node.at, leaf, most, pairs);
      visit(node.at, end, leaf, most, pairs);
      return;
    }
    for (std::uint32_t i = own.at; i < own.at + own.count; ++i)
      for (std::uint32_t k = std::max(i + 1, node.at); k < node.at + node.count; ++k) {
        if (!m_box[k].meets(m_box[i])) continue;
        const std::uint32_t one = m_order[i], other = m_order[k];
        if (intersect(m_mesh, m_mesh.triangle[one], m_mesh.triangle[other]))
          pairs.push_back({std::min(one, other), std::max(one, other)});
      }
  }

  const TriangleMesh& m_mesh;
  std::vector<std::uint32_t> m_order;
  std::vector<Box3f> m_box;
  BoxTree<float> m_tree;
  std::vector<std::uint32_t> m_leaf;  // nodes without children
};

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

// The pairs of leaves first .. last - 1, in that order. Where there are more than `most`, threads
// may find different subsets: then one thread repeats the search in order.
Pairs findPairs(const TriangleLeaves& tree, std::size_t first, std::size_t last, std::size_t most) {
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

SelfIntersections selfIntersections(const TriangleMesh& mesh, std::size_t limit,
                                    const Progress* progress) {
  SelfIntersections result;
  const TriangleLeaves tree(mesh);
  for (std::size_t first = 0; first < tree.size() && result.pairs.size() <= limit;
       first += kBlock) {
    if (progress != nullptr) progress->check();
    const Pairs more =
        findPairs(tree, first, std::min(tree.size(), first + kBlock), limit - result.pairs.size());
    result.pairs.insert(result.pairs.end(), more.begin(), more.end());
  }
  result.isComplete = result.pairs.size() <= limit;
  if (!result.isComplete) result.pairs.resize(limit);
  std::sort(result.pairs.begin(), result.pairs.end());
  return result;
}

}  // namespace lumen::convert
