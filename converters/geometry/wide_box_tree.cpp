// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/wide_box_tree.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "converters/base/simd.h"

namespace lumen::convert {
namespace {

constexpr float kEmpty = std::numeric_limits<float>::infinity();
constexpr double kLargest = std::numeric_limits<double>::max();  // empty boxes are farther
constexpr double kSteep = 1e30;  // reciprocal of a component that is almost 0

using KeyLanes [[gnu::vector_size(32)]] = double;
using KeyBits [[gnu::vector_size(32)]] = std::int64_t;

/// Bits of the lanes in which `one` is at most `other`. Keys lie at any multiple of 8 bytes: gcc 12
/// compares through pointers to lanes as if these were aligned, whatever their type states.
inline std::uint32_t bitsOf(const double* one, const double* other) {
  KeyLanes a[2], b[2];
  std::memcpy(a, one, sizeof a);
  std::memcpy(b, other, sizeof b);
  const KeyBits bits = (KeyBits(a[0] <= b[0]) & KeyBits{1, 2, 4, 8}) |
                       (KeyBits(a[1] <= b[1]) & KeyBits{16, 32, 64, 128});
  return static_cast<std::uint32_t>((bits[0] | bits[1]) | (bits[2] | bits[3]));
}

LUMEN_SIMD_CLONES std::uint32_t enterBoxes(const float* __restrict planes,
                                           const std::uint32_t* __restrict near,
                                           const double* __restrict origin,
                                           const double* __restrict inverse, double most,
                                           double* __restrict out) {
  constexpr std::size_t kWidth = WideNode::kWidth;
  const float* nearX = planes + near[0] * kWidth;
  const float* farX = planes + (near[0] ^ 1U) * kWidth;
  const float* nearY = planes + near[1] * kWidth;
  const float* farY = planes + (near[1] ^ 1U) * kWidth;
  const float* nearZ = planes + near[2] * kWidth;
  const float* farZ = planes + (near[2] ^ 1U) * kWidth;
  std::array<double, kWidth> to;
  for (std::size_t k = 0; k < kWidth; ++k) {
    const double inX = (double{nearX[k]} - origin[0]) * inverse[0],
                 inY = (double{nearY[k]} - origin[1]) * inverse[1],
                 inZ = (double{nearZ[k]} - origin[2]) * inverse[2];
    const double outX = (double{farX[k]} - origin[0]) * inverse[0],
                 outY = (double{farY[k]} - origin[1]) * inverse[1],
                 outZ = (double{farZ[k]} - origin[2]) * inverse[2];
    double first = inX > 0 ? inX : 0;
    first = inY > first ? inY : first;
    out[k] = inZ > first ? inZ : first;
    double last = outY < outX ? outY : outX;
    last = outZ < last ? outZ : last;
    to[k] = most < last ? most : last;
  }
  return bitsOf(out, to.data());
}

LUMEN_SIMD_CLONES std::uint32_t nearBoxes(const float* __restrict plane, double x, double y,
                                          double z, double limit, double* __restrict out) {
  constexpr std::size_t kWidth = WideNode::kWidth;
  std::array<double, kWidth> limits;
  for (std::size_t k = 0; k < kWidth; ++k) {
    const double lowX = double{plane[k]} - x, highX = x - double{plane[kWidth + k]};
    const double lowY = double{plane[2 * kWidth + k]} - y,
                 highY = y - double{plane[3 * kWidth + k]};
    const double lowZ = double{plane[4 * kWidth + k]} - z,
                 highZ = z - double{plane[5 * kWidth + k]};
    double awayX = lowX > highX ? lowX : highX;
    double awayY = lowY > highY ? lowY : highY;
    double awayZ = lowZ > highZ ? lowZ : highZ;
    awayX = awayX > 0 ? awayX : 0;
    awayY = awayY > 0 ? awayY : 0;
    awayZ = awayZ > 0 ? awayZ : 0;
    const double squared = awayX * awayX + awayY * awayY + awayZ * awayZ;
    out[k] = squared;
    limits[k] = limit;
  }
  return bitsOf(out, limits.data());
}

/// The surface of a box that can be opened; less than that of any other for a leaf.
double openingGain(const BoxTree<float>& tree, std::uint32_t i) {
  const auto& node = tree.node(i);
  if (node.count > 0) return -1;
  const Eigen::Vector3d size = node.box.size().cast<double>();
  return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
}

}  // namespace

BoxRay::BoxRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  for (std::uint32_t a = 0; a < 3; ++a) {
    m_origin[a] = origin[a];
    const double along = direction[a];
    m_inverse[a] = std::abs(along) > 1 / kSteep ? 1 / along : std::copysign(kSteep, along);
    m_near[a] = 2 * a + (m_inverse[a] > 0 ? 0 : 1);
  }
}

std::uint32_t BoxRay::entries(const WideNode& node, double most, WideNode::Keys& out) const {
  return enterBoxes(node.plane[0].data(), m_near.data(), m_origin.data(), m_inverse.data(), most,
                    out.data());
}

std::uint32_t boxesNear(const WideNode& node, const Eigen::Vector3d& point, double most,
                        WideNode::Keys& out) {
  return nearBoxes(node.plane[0].data(), point.x(), point.y(), point.z(), std::min(most, kLargest),
                   out.data());
}

WideBoxTree::WideBoxTree(const BoxTree<float>& tree) {
  if (tree.nodes().empty()) return;
  for (const auto& node : tree.nodes())
    if (node.count > 0) m_leaf.push_back(node.at);
  m_leaf.push_back(static_cast<std::uint32_t>(tree.items().size()));
  m_nodes.emplace_back();
  build(tree, 0, 0);
}

void WideBoxTree::build(const BoxTree<float>& tree, std::uint32_t from, std::uint32_t self) {
  // the largest box that is no leaf is opened, until there are eight
  std::vector<std::uint32_t> chosen{from};
  while (chosen.size() < WideNode::kWidth) {
    const auto largest =
        std::max_element(chosen.begin(), chosen.end(), [&](std::uint32_t a, std::uint32_t b) {
          return openingGain(tree, a) < openingGain(tree, b);
        });
    if (tree.node(*largest).count > 0) break;
    const std::uint32_t second = tree.node(*largest).at;
    ++*largest;
    chosen.push_back(second);
  }
  for (std::size_t k = 0; k < WideNode::kWidth; ++k) {
    const bool isUsed = k < chosen.size();
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<Eigen::Index>(a);
      m_nodes[self].plane[2 * a][k] = isUsed ? tree.node(chosen[k]).box.low[axis] : kEmpty;
      m_nodes[self].plane[2 * a + 1][k] = isUsed ? tree.node(chosen[k]).box.high[axis] : -kEmpty;
    }
    if (!isUsed) continue;
    const auto& node = tree.node(chosen[k]);
    if (node.count > 0) {
      m_nodes[self].leaves |= 1U << k;
      m_nodes[self].at[k] = static_cast<std::uint32_t>(
          std::lower_bound(m_leaf.begin(), m_leaf.end(), node.at) - m_leaf.begin());
      continue;
    }
    const auto child = static_cast<std::uint32_t>(m_nodes.size());
    m_nodes[self].at[k] = child;
    m_nodes.emplace_back();
    build(tree, chosen[k], child);
  }
}

}  // namespace lumen::convert
