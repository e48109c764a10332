// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/changing_triangles.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include "converters/geometry/triangle_pair.h"

namespace lumen::convert {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;
constexpr std::size_t kDeepest = 64;  // of a tree that is split in halves
constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

ChangingTriangles::ChangingTriangles(TriangleMesh mesh)
    : m_mesh(std::move(mesh)),
      m_isRemoved(m_mesh.triangle.size(), false),
      m_order(m_mesh.triangle.size()),
      m_leafOf(m_mesh.triangle.size()) {
  std::iota(m_order.begin(), m_order.end(), 0U);
  std::vector<Eigen::Vector3d> centre;
  for (const Triangle& t : m_mesh.triangle)
    centre.emplace_back((m_mesh.position[t[0]] + m_mesh.position[t[1]] + m_mesh.position[t[2]]) /
                        3);
  build(0, static_cast<std::uint32_t>(m_order.size()), kNone, centre);
}

std::uint32_t ChangingTriangles::build(std::uint32_t first, std::uint32_t last,
                                       std::uint32_t parent,
                                       const std::vector<Eigen::Vector3d>& centre) {
  const auto self = static_cast<std::uint32_t>(m_boxes.size());
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kFar), high = -low;
  for (std::uint32_t k = first; k < last; ++k) {
    low = low.cwiseMin(centre[m_order[k]]);
    high = high.cwiseMax(centre[m_order[k]]);
  }
  m_boxes.push_back({low, high, first, last, 0, parent});
  if (last - first <= kLeafTriangles) {
    for (std::uint32_t k = first; k < last; ++k) m_leafOf[m_order[k]] = self;
    fit(m_boxes[self], self);
    return self;
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::uint32_t middle = first + (last - first) / 2;
  std::nth_element(m_order.begin() + first, m_order.begin() + middle, m_order.begin() + last,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double at = centre[a][axis], other = centre[b][axis];
                     return at < other || (at == other && a < b);
                   });
  build(first, middle, self, centre);
  const std::uint32_t right = build(middle, last, self, centre);
  m_boxes[self].right = right;
  fit(m_boxes[self], self);
  return self;
}

void ChangingTriangles::fit(Box& box, std::uint32_t self) const {
  box.low.setConstant(kFar);
  box.high.setConstant(-kFar);
  if (box.right != 0) {
    for (const std::uint32_t child : {self + 1, box.right}) {
      box.low = box.low.cwiseMin(m_boxes[child].low);
      box.high = box.high.cwiseMax(m_boxes[child].high);
    }
    return;
  }
  for (std::uint32_t k = box.first; k < box.last; ++k) {
    if (m_isRemoved[m_order[k]]) continue;
    for (const std::uint32_t v : m_mesh.triangle[m_order[k]]) {
      box.low = box.low.cwiseMin(m_mesh.position[v]);
      box.high = box.high.cwiseMax(m_mesh.position[v]);
    }
  }
}

void ChangingTriangles::refit(std::uint32_t leaf) {
  for (std::uint32_t i = leaf; i != kNone; i = m_boxes[i].parent) {
    const Eigen::Vector3d low = m_boxes[i].low, high = m_boxes[i].high;
    fit(m_boxes[i], i);
    if (m_boxes[i].low == low && m_boxes[i].high == high) return;
  }
}

void ChangingTriangles::change(std::uint32_t triangle, const Triangle& corners) {
  m_mesh.triangle[triangle] = corners;
  refit(m_leafOf[triangle]);
}

void ChangingTriangles::remove(std::uint32_t triangle) {
  m_isRemoved[triangle] = true;
  refit(m_leafOf[triangle]);
}

bool ChangingTriangles::meets(const Triangle& corners,
                              std::span<const std::uint32_t> without) const {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kFar), high = -low;
  for (const std::uint32_t v : corners) {
    low = low.cwiseMin(m_mesh.position[v]);
    high = high.cwiseMax(m_mesh.position[v]);
  }
  const auto isApart = [&](const Box& box) {
    return (box.low.array() > high.array()).any() || (low.array() > box.high.array()).any();
  };
  std::array<std::uint32_t, kDeepest> stack{};
  std::size_t depth = 1;
  while (depth > 0) {
    const std::uint32_t i = stack[--depth];
    const Box& box = m_boxes[i];
    if (isApart(box)) continue;
    if (box.right != 0) {
      stack[depth++] = box.right;
      stack[depth++] = i + 1;
      continue;
    }
    for (std::uint32_t k = box.first; k < box.last; ++k) {
      const std::uint32_t t = m_order[k];
      if (m_isRemoved[t] || std::find(without.begin(), without.end(), t) != without.end()) continue;
      if (intersect(m_mesh, corners, m_mesh.triangle[t])) return true;
    }
  }
  return false;
}

}  // namespace lumen::convert
