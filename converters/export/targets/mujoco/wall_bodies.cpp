// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/mujoco/wall_bodies.h"

#include <algorithm>
#include <cstddef>

#include "blob.h"
#include "blob_pose.h"
#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "converters/export/shared/mujoco_text.h"
#include "converters/export/shared/units.h"
#include "formats/case/motion.h"

namespace lumen::convert {

namespace {

constexpr std::size_t kMostWeights = 24;  // libblob's: nodes that answer at a point

field::Vec vecOf(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

void addWords(std::string& text, const std::string& words) {
  text += (text.empty() ? "" : " ") + words;
}

}  // namespace

WallBodies::WallBodies(const formats::Case& source)
    : m_tree(source.tree), m_model(openModels(source)), m_times(source.motion->time) {
  for (const double time : m_times)
    m_poses.push_back(formats::posesAt(source.tree, *source.motion, time));
}

// Where a point of the wall is at each time, m; `node` is set to the one that answers at it.
std::vector<Eigen::Vector3d> WallBodies::wayOf(const Eigen::Vector3d& position,
                                               std::uint32_t& node) const {
  const Eigen::Vector3d mm = position / kMetres;
  node = blob_cursor_locate(m_model.get(), mm.data());
  std::uint32_t nodes[kMostWeights];
  double weights[kMostWeights];
  const std::size_t found =
      std::min(kMostWeights, blob_query_weights(m_model.get(), BLOB_BLENDED, mm.data(), &node,
                                                nodes, weights, kMostWeights));
  std::vector<Eigen::Vector3d> way;
  for (const std::vector<field::NodePose>& poses : m_poses) {
    field::Vec sum{0, 0, 0};
    for (std::size_t k = 0; k < found; ++k)
      sum = sum + weights[k] * field::carried(poses[nodes[k]],
                                              vecOf(toEigen(m_tree.centre[nodes[k]])), vecOf(mm));
    way.emplace_back(kMetres * Eigen::Vector3d(sum.x, sum.y, sum.z));
  }
  return way;
}

RidingBody WallBodies::carrying(std::span<const WallFacet> piece) const {
  const auto corners = static_cast<Eigen::Index>(3 * piece.size());
  Eigen::Matrix3Xd rest(3, corners);
  std::vector<Eigen::Matrix3Xd> moved(m_times.size(), Eigen::Matrix3Xd(3, corners));
  for (Eigen::Index i = 0; i < corners; ++i) {
    const auto at = static_cast<std::size_t>(i);
    rest.col(i) = piece[at / 3][at % 3].position;
    std::uint32_t node = 0;
    const std::vector<Eigen::Vector3d> way = wayOf(rest.col(i), node);
    for (std::size_t t = 0; t < way.size(); ++t) moved[t].col(i) = way[t];
  }
  RidingBody body;
  body.centre = rest.rowwise().mean();
  for (const Eigen::Matrix3Xd& to : moved) {
    const Eigen::Isometry3d fit(Eigen::umeyama(rest, to, false));
    body.turn.emplace_back(fit.linear());
    body.place.push_back(fit * body.centre);
    for (Eigen::Index i = 0; i < corners; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double off = (fit * rest.col(i) - to.col(i)).norm();
      body.misfit = std::max(body.misfit, off / piece[at / 3][at % 3].radius);
    }
  }
  return body;
}

RidingBody WallBodies::carrying(const SurfaceMesh& piece) const {
  return carrying(wallFacets(piece));
}

RidingBody WallBodies::carrying(const Eigen::Vector3d& place) const {
  RidingBody body;
  std::uint32_t node = 0;
  body.centre = place;
  body.place = wayOf(place, node);
  for (const std::vector<field::NodePose>& poses : m_poses) {
    const field::Quaternion& q = poses[node].rotation;
    body.turn.emplace_back(q[3], q[0], q[1], q[2]);
  }
  return body;
}

std::string WallBodies::keyframes(std::span<const RidingBody> bodies) const {
  std::string text;
  for (std::size_t t = 0; t < m_times.size(); ++t) {
    std::string places, turns;
    for (const RidingBody& body : bodies) {
      const Eigen::Quaterniond& q = body.turn[t];
      addWords(places, mujocoNumbers(body.place[t]));
      addWords(turns, mujocoNumbers({q.w(), q.x(), q.y(), q.z()}));
    }
    text += "    <key name=\"motion_" + std::to_string(t) + "\" time=\"" + numberText(m_times[t]) +
            "\" mpos=\"" + places + "\" mquat=\"" + turns + "\"/>\n";
  }
  return text;
}

}  // namespace lumen::convert
