// SPDX-License-Identifier: Apache-2.0
#include "formats/field/posed_field.h"

#include <algorithm>
#include <utility>

namespace lumen::field {
namespace {

Vec vec(const double* c) {
  return {c[0], c[1], c[2]};
}

}  // namespace

PosedField::PosedField(const BlendedField& rest, const TreeView& tree, std::vector<NodePose> poses)
    : m_rest(rest), m_poses(std::move(poses)), m_offset{0} {
  const Neighbourhood edges = findEdges(tree);
  for (std::uint32_t i = 0; i < tree.nodeCount; ++i) {
    const NodePose& pose = m_poses[i];
    m_nodes.push_back(
        {{pose.centre.x, pose.centre.y, pose.centre.z}, pose.factor * tree.radius[i]});
  }
  const auto edgesOf = [&](std::uint32_t i) {
    return std::span(edges.node).subspan(edges.offset[i], edges.offset[i + 1] - edges.offset[i]);
  };
  const auto offset = [&](std::uint32_t i, std::uint32_t k) {
    return vec(m_nodes[k].centre) - vec(m_nodes[i].centre);
  };
  std::vector<double> spacing(tree.nodeCount, 0.0);
  for (std::uint32_t i = 0; i < tree.nodeCount; ++i)
    for (const std::uint32_t k : edgesOf(i))
      spacing[i] = std::max(spacing[i], dot(offset(i, k), offset(i, k)));
  for (std::uint32_t i = 0; i < tree.nodeCount; ++i) {
    for (const std::uint32_t k : rest.neighbours(i)) {
      const Vec to = offset(i, k);
      const double square = dot(to, to), ri = m_nodes[i].radius, rk = m_nodes[k].radius;
      const std::span<const std::uint32_t> joined = edgesOf(i);
      const bool isEdge = std::find(joined.begin(), joined.end(), k) != joined.end();
      const double tau =
          blendingWidth(square, std::min(ri, rk), isEdge, 0.5 * (spacing[i] + spacing[k]));
      m_rivals.push_back(
          {{-2.0 * to.x, -2.0 * to.y, -2.0 * to.z}, square - rk * rk + ri * ri, 1.0 / tau, k});
    }
    m_offset.push_back(static_cast<std::uint32_t>(m_rivals.size()));
  }
}

double PosedField::power(const Vec& point, std::uint32_t node) const {
  const Vec from = point - vec(m_nodes[node].centre);
  return dot(from, from) - m_nodes[node].radius * m_nodes[node].radius;
}

std::uint32_t PosedField::locate(const Vec& point) const {
  std::uint32_t best = 0;
  for (std::uint32_t i = 1; i < m_nodes.size(); ++i)
    if (power(point, i) < power(point, best)) best = i;
  return best;
}

std::uint32_t PosedField::follow(const Vec& point, std::uint32_t node) const {
  const double p[3] = {point.x, point.y, point.z};
  return followNodes(*this, p, node);
}

Jet<1> PosedField::local(const Vec& point, std::uint32_t node) const {
  const std::uint32_t lender = m_rest.lender(node);
  if (lender == kNowhere) return {};
  const NodePose& pose = m_poses[lender];
  const Vec rest = carriedBack(pose, vec(m_rest.centre(lender)), point);
  Jet<1> f = m_rest.local(rest, node);
  const Vec gradient = (1.0 / pose.factor) * rotated(pose.rotation, vec(f.gradient));
  f.gradient[0] = gradient.x;
  f.gradient[1] = gradient.y;
  f.gradient[2] = gradient.z;
  return f;
}

}  // namespace lumen::field
