// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/growth.h"

#include <algorithm>
#include <cmath>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

Vector3d partAcross(const Vector3d& v, const Vector3d& tangent) {
  return v - v.dot(tangent) * tangent;
}

// One walk; all lengths in mm.
class Walk {
public:
  Walk(const GrowthRequest& request, const GrownBranches& grown, double step, Random& random)
      : m_request(request),
        m_grown(grown),
        m_step(step),
        m_random(random),
        m_point(request.start),
        m_tangent(request.direction.normalized()) {}

  Path run() {
    Path path;
    const int steps = static_cast<int>(m_request.length / m_step);
    for (int i = 0; i <= steps; ++i) {
      m_arc = i * m_step;
      m_radius = m_request.startRadius +
                 (m_request.endRadius - m_request.startRadius) * m_arc / m_request.length;
      if (!isClear(path)) break;
      path.push_back({m_point, m_radius});
      turn();
      m_point += m_step * m_tangent;
    }
    return path;
  }

private:
  bool isClear(const Path& path) {
    if (m_request.parent >= 0 && m_grown.depthInBox(m_point, m_radius) < 0) return false;
    if (m_request.parent < 0 && m_arc > 4 * m_radius && m_grown.depthInBox(m_point, m_radius) < 0)
      return false;
    m_others = m_grown.nearestBut(m_request.parent, m_point, m_radius);
    if (m_others.clearance < m_grown.gap()) return false;
    m_ownParent = {};
    if (m_request.parent >= 0) {
      m_ownParent = m_grown.nearestOnBranch(m_request.parent, m_point, m_radius);
      const bool clear = m_ownParent.clearance >= m_grown.gap();
      if (m_left && !clear) return false;
      if (!m_left && !clear && m_arc > m_request.freeLength) return false;
      m_left = m_left || clear;
    }
    return isClearOfItself(path);
  }

  // Curvature is bounded, so only parts farther back than half a turn can come close.
  [[nodiscard]] bool isClearOfItself(const Path& path) const {
    const double halfTurn = 3.2 * tightestBend(m_request.startRadius);
    const auto skipped = static_cast<std::size_t>(halfTurn / m_step);
    for (std::size_t i = 0; i + skipped < path.size(); i += 2) {
      const double reach = path[i].radius + m_radius + m_grown.gap();
      if ((path[i].position - m_point).squaredNorm() < reach * reach) return false;
    }
    return true;
  }

  void turn() {
    const double strongest = 1 / tightestBend(m_radius);
    const double memory = 6 * m_radius + 2;  // mm over which the wandering forgets itself
    const double sigma = m_request.tortuosity * strongest;
    Vector3d noise;
    for (double& coordinate : noise) coordinate = m_random.normal();
    m_wander += -m_wander * (m_step / memory) + sigma * std::sqrt(2 * m_step / memory) * noise;
    if (m_arc < m_request.straight) return;
    Vector3d curvature = partAcross(m_wander, m_tangent);
    curvature += 0.4 * strongest * partAcross((m_request.target - m_point).normalized(), m_tangent);
    // turn away from walls that are near, the parent's own once it is left behind
    const double comfort = m_grown.gap() + 2.5 * m_radius + 1.2;
    const auto avoid = [&](const GrownBranches::Nearest& near) {
      const double closeness = 1 - near.clearance / comfort;
      if (closeness > 0)
        curvature += 1.5 * strongest * closeness * partAcross(near.away, m_tangent);
    };
    avoid(m_others);
    if (m_left) avoid(m_ownParent);
    curvature += strongest * partAcross(inwards(), m_tangent);
    const double size = curvature.norm();
    if (size > strongest) curvature *= strongest / size;
    m_tangent = (m_tangent + m_step * curvature).normalized();
  }

  // Grows from 0 to 2 on each axis as the point ahead comes near the box's faces.
  [[nodiscard]] Vector3d inwards() const {
    const double reach = 2 * tightestBend(m_radius) + 2 * m_radius;
    const Vector3d ahead = m_point + 0.5 * reach * m_tangent;
    Vector3d push = Vector3d::Zero();
    if (m_request.parent < 0 && m_arc < reach) return push;
    for (int a = 0; a < 3; ++a) {
      const double low = ahead[a] - m_grown.low()[a], high = m_grown.high()[a] - ahead[a];
      if (low < reach) push[a] += 2 * std::min(1.0, 1 - low / reach);
      if (high < reach) push[a] -= 2 * std::min(1.0, 1 - high / reach);
    }
    return push;
  }

  const GrowthRequest& m_request;
  const GrownBranches& m_grown;
  double m_step;
  Random& m_random;
  Vector3d m_point, m_tangent;
  Vector3d m_wander = Vector3d::Zero();
  double m_arc = 0, m_radius = 0;
  bool m_left = false;  // the parent's wall is a gap away, or was
  GrownBranches::Nearest m_others, m_ownParent;
};

}  // namespace

void GrownBranches::add(const Path& path, int branch) {
  // balls a third of a radius apart stand for the tube to 1.5 % of its radius
  Vector3d last = Vector3d::Constant(std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0 && i + 1 < path.size() && (path[i].position - last).norm() < path[i].radius / 3)
      continue;
    last = path[i].position;
    m_balls.push_back({last, path[i].radius, branch});
  }
}

template <class Accept>
GrownBranches::Nearest GrownBranches::nearest(const Vector3d& point, double radius,
                                              Accept accept) const {
  Nearest best;
  const BranchBall* found = nullptr;
  for (const BranchBall& ball : m_balls) {
    if (!accept(ball.branch)) continue;
    const double reach = best.clearance + ball.radius + radius;
    const double squared = (point - ball.centre).squaredNorm();
    if (reach < 0 || squared >= reach * reach) continue;
    best.clearance = std::sqrt(squared) - ball.radius - radius;
    found = &ball;
  }
  if (found) best.away = (point - found->centre).stableNormalized();
  return best;
}

GrownBranches::Nearest GrownBranches::nearestBut(int except, const Vector3d& point,
                                                 double radius) const {
  return nearest(point, radius, [except](int branch) { return branch != except; });
}

GrownBranches::Nearest GrownBranches::nearestOnBranch(int branch, const Vector3d& point,
                                                      double radius) const {
  return nearest(point, radius, [branch](int other) { return other == branch; });
}

double GrownBranches::depthInBox(const Vector3d& point, double radius) const {
  return std::min((point - m_low).minCoeff(), (m_high - point).minCoeff()) - radius;
}

double tightestBend(double radius) {
  return std::max(3.2 * radius, 1.6);
}

Path grow(const GrowthRequest& request, const GrownBranches& grown, double step, Random& random) {
  return Walk(request, grown, step, random).run();
}

}  // namespace lumen::convert
