// SPDX-License-Identifier: Apache-2.0
#include "formats/field/radical_disc.h"

#include <algorithm>
#include <cmath>

namespace lumen::field {
namespace {

Vec centreOf(const TreeView& tree, std::uint32_t node) {
  return {tree.centre[node][0], tree.centre[node][1], tree.centre[node][2]};
}

}  // namespace

RadicalDisc::RadicalDisc(const TreeView& tree, std::uint32_t a, std::uint32_t b)
    : m_origin(centreOf(tree, a)), m_radius(tree.radius[a]) {
  const Vec axis = centreOf(tree, b) - m_origin;
  const double square = dot(axis, axis), ra = tree.radius[a], rb = tree.radius[b];
  if (!(square > 0)) {
    // both nodes in one place: equal radii tie everywhere, unequal ones nowhere
    if (ra == rb) m_count = kEverywhere;
    return;
  }
  const double share = 0.5 * (1.0 + (ra * ra - rb * rb) / square), length = std::sqrt(square);
  // the plane's distance from either centre, and the radius that a reach leaves on the plane
  const auto left = [](double reach, double height) { return reach * reach - height * height; };
  const double rest = std::max(left(kReachRadii * ra, share * length),
                               left(kReachRadii * rb, (1.0 - share) * length));
  if (!(rest > 0)) return;
  const Vec middle = share * axis, u = std::sqrt(rest) * perpendicular(axis);
  const Vec v = (1.0 / length) * cross(axis, u);
  m_corner[0] = middle + u + v;
  m_corner[1] = middle - u + v;
  m_corner[2] = middle - u - v;
  m_corner[3] = middle + u - v;
  m_count = 4;
}

void RadicalDisc::cut(const TreeView& tree, std::uint32_t node, double slack) {
  if (m_count == 0 || m_count == kEverywhere) return;
  // p_node - p_a, which is linear in the point
  const Vec c = centreOf(tree, node) - m_origin;
  const double radius = tree.radius[node];
  const double constant = dot(c, c) - radius * radius + m_radius * m_radius + slack;
  const auto excess = [&](const Vec& x) { return constant - 2.0 * dot(c, x); };
  std::array<Vec, kMostCorners> kept;
  std::size_t count = 0;
  for (std::size_t i = 0; i < m_count; ++i) {
    const Vec &here = m_corner[i], &next = m_corner[(i + 1) % m_count];
    const double e = excess(here), f = excess(next);
    if (count + 2 > kMostCorners) return;
    if (e >= 0) kept[count++] = here;
    if ((e >= 0) != (f >= 0)) kept[count++] = here + (e / (e - f)) * (next - here);
  }
  m_corner = kept;
  m_count = count;
}

}  // namespace lumen::field
