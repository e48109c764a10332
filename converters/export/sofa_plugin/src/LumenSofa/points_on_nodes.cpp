// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <LumenSofa/points_on_nodes.h>
#include <sofa/type/Quat.h>

namespace lumensofa {

PointsOnNodes::PointsOnNodes(const blob_model* rest, std::uint32_t flags, const Coords& points)
    : m_rest(points) {
  std::uint32_t nodes[kMostWeights];
  double weights[kMostWeights];
  m_first.push_back(0);
  for (const auto& point : points) {
    std::uint32_t cursor = blob_cursor_locate(rest, point.data());
    const std::size_t found = std::min(
        kMostWeights,
        blob_query_weights(rest, flags, point.data(), &cursor, nodes, weights, kMostWeights));
    m_nodes.insert(m_nodes.end(), nodes, nodes + found);
    m_weights.insert(m_weights.end(), weights, weights + found);
    m_first.push_back(m_nodes.size());
  }
  m_centres.resize(blob_model_describe(rest).node_count);
  for (std::size_t i = 0; i < m_centres.size(); ++i)
    m_centres[i] = sofa::type::Vec3(blob_model_node(rest, static_cast<std::uint32_t>(i)).centre);
  m_carriers.resize(m_centres.size());
}

void PointsOnNodes::move(const blob_pose* pose, Coords& moved) {
  for (std::size_t i = 0; i < m_carriers.size(); ++i) {
    const blob_transform at = blob_pose_node(pose, static_cast<std::uint32_t>(i));
    const double* q = at.rotation;
    const sofa::type::Quat<double> turn(q[0], q[1], q[2], q[3]);
    Carrier& carrier = m_carriers[i];
    carrier.x = turn.rotate(sofa::type::Vec3(at.factor, 0, 0));
    carrier.y = turn.rotate(sofa::type::Vec3(0, at.factor, 0));
    carrier.z = turn.rotate(sofa::type::Vec3(0, 0, at.factor));
    const sofa::type::Vec3& o = m_centres[i];
    carrier.offset =
        sofa::type::Vec3(at.centre) - carrier.x * o[0] - carrier.y * o[1] - carrier.z * o[2];
  }
  for (std::size_t i = 0; i < m_rest.size(); ++i) {
    const auto& p = m_rest[i];
    sofa::type::Vec3 sum(0, 0, 0);
    for (std::size_t k = m_first[i]; k < m_first[i + 1]; ++k) {
      const Carrier& c = m_carriers[m_nodes[k]];
      sum += (c.x * p[0] + c.y * p[1] + c.z * p[2] + c.offset) * m_weights[k];
    }
    moved[i] = sum;
  }
}

}  // namespace lumensofa
