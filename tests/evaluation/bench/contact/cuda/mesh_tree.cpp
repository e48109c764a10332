// SPDX-License-Identifier: Apache-2.0
#include "mesh_tree.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>

namespace lumen::bench {
namespace {

struct Bounds {
  std::array<float, 3> low, high;
  Bounds() {
    low.fill(std::numeric_limits<float>::max());
    high.fill(std::numeric_limits<float>::lowest());
  }
  void add(const std::array<float, 3>& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  void add(const Bounds& other) {
    add(other.low);
    add(other.high);
  }
  [[nodiscard]] float area() const {
    const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
  }
};

constexpr std::size_t kMostOfLeaf = 4, kBins = 16;

struct Item {
  std::uint32_t face;
  Bounds bounds;
  std::array<float, 3> middle;
};

using Items = std::span<Item>;

// The axis and the value of the middle that divide items with the least area; no value that divides
// them: count / 2.
struct Split {
  std::size_t axis = 0, firstOfSecond = 0;
};

Split cheapestSplit(Items items) {
  Bounds middles;
  for (const Item& item : items) middles.add(item.middle);
  float least = std::numeric_limits<float>::max(), bestAt = 0;
  Split best{0, items.size() / 2};
  bool found = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float low = middles.low[axis], width = middles.high[axis] - low;
    if (!(width > 0)) continue;
    std::array<Bounds, kBins> bounds;
    std::array<std::size_t, kBins> count{};
    const auto binOf = [&](const Item& item) {
      const float bin = static_cast<float>(kBins) * (item.middle[axis] - low) / width;
      return std::min(static_cast<std::size_t>(bin), kBins - 1);
    };
    for (const Item& item : items) {
      bounds[binOf(item)].add(item.bounds);
      ++count[binOf(item)];
    }
    std::array<float, kBins> after{};
    Bounds sum;
    std::size_t number = 0;
    for (std::size_t b = kBins - 1; b > 0; --b) {
      sum.add(bounds[b]);
      number += count[b];
      after[b] = number > 0 ? sum.area() * static_cast<float>(number) : 0;
    }
    sum = Bounds();
    number = 0;
    for (std::size_t b = 1; b < kBins; ++b) {
      if (count[b - 1] > 0) sum.add(bounds[b - 1]);
      number += count[b - 1];
      const float cost = (number > 0 ? sum.area() * static_cast<float>(number) : 0) + after[b];
      if (number == 0 || number == items.size() || !(cost < least)) continue;
      least = cost;
      best.axis = axis;
      bestAt = low + width * static_cast<float>(b) / static_cast<float>(kBins);
      found = true;
    }
  }
  if (!found) return best;
  const auto second = std::partition(items.begin(), items.end(), [&](const Item& item) {
    return item.middle[best.axis] < bestAt;
  });
  best.firstOfSecond = static_cast<std::size_t>(second - items.begin());
  if (best.firstOfSecond == 0 || best.firstOfSecond == items.size())
    best.firstOfSecond = items.size() / 2;
  return best;
}

class Builder {
public:
  explicit Builder(std::vector<Item>& items, std::vector<Float4>& node)
      : m_all(items), m_node(node) {}

  // The code of the child that holds items.
  std::int32_t build(Items items) {
    if (items.size() <= kMostOfLeaf) {
      const auto first = static_cast<std::int32_t>(items.data() - m_all.data());
      return ~(8 * first + static_cast<std::int32_t>(items.size()));
    }
    const std::size_t at = m_node.size() / 4, second = cheapestSplit(items).firstOfSecond;
    m_node.resize(m_node.size() + 4);
    const Items halves[2] = {items.first(second), items.subspan(second)};
    Bounds bounds[2];
    Float4 children{};
    for (std::size_t i = 0; i < 2; ++i) {
      for (const Item& item : halves[i]) bounds[i].add(item.bounds);
      children[i] = std::bit_cast<float>(build(halves[i]));
    }
    for (std::size_t i = 0; i < 2; ++i)
      m_node[4 * at + i] = {bounds[i].low[0], bounds[i].high[0], bounds[i].low[1],
                            bounds[i].high[1]};
    m_node[4 * at + 2] = {bounds[0].low[2], bounds[0].high[2], bounds[1].low[2], bounds[1].high[2]};
    m_node[4 * at + 3] = children;
    return static_cast<std::int32_t>(at);
  }

private:
  std::vector<Item>& m_all;
  std::vector<Float4>& m_node;
};

}  // namespace

MeshTree::MeshTree(const Triangles& mesh, const SignedMesh& normals) {
  std::vector<Item> items(mesh.face.size());
  for (std::uint32_t f = 0; f < items.size(); ++f) {
    items[f].face = f;
    for (const std::uint32_t v : mesh.face[f]) items[f].bounds.add(mesh.vertex[v]);
    for (std::size_t i = 0; i < 3; ++i)
      items[f].middle[i] = 0.5f * (items[f].bounds.low[i] + items[f].bounds.high[i]);
  }
  Builder(items, node).build(items);
  constexpr std::size_t kFeatures = 7;
  for (const Item& item : items) {
    for (const std::uint32_t v : mesh.face[item.face])
      corner.push_back({mesh.vertex[v][0], mesh.vertex[v][1], mesh.vertex[v][2], 0});
    for (std::size_t i = 0; i < kFeatures; ++i) {
      const SignedMesh::Vector& n = normals.normalOf(item.face, static_cast<Feature>(i));
      normal.push_back({n[0], n[1], n[2], 0});
    }
  }
}

double MeshTree::megabytes() const {
  return static_cast<double>((node.size() + corner.size() + normal.size()) * sizeof(Float4)) * 1e-6;
}

}  // namespace lumen::bench
