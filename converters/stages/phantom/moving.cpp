// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/moving.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include "converters/base/vectors.h"
#include "converters/stages/motion/posing.h"

namespace lumen::convert {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// From 0 at rest to 1 in the middle of the cycle, and back.
double swing(double phase) {
  return 0.5 - 0.5 * std::cos(2 * std::numbers::pi * phase);
}

// A left ventricle shortens by some 15 % in each direction and twists by some 13 degrees from its base
// to its apex; its arteries go along.
Vector3d placeOnHeart(const Box3d& rest, const Vector3d& point, double phase) {
  constexpr double kNarrower = 0.15, kShorter = 0.15, kTwist = 0.22;
  const double beat = swing(phase);
  const Vector3d size = rest.size().cwiseMax(1e-6);
  const Vector3d apex{rest.middle().x(), rest.middle().y(), rest.low.z()};
  const Vector3d from = point - apex;
  const double along = from.z() / size.z(), angle = kTwist * beat * (along - 0.5);
  const Vector3d turned = Eigen::AngleAxisd(angle, Vector3d::UnitZ()) * from;
  const double across = 1 - kNarrower * beat;
  // a whole turn of the heart in its bag besides, so that nothing stays where it was
  return apex +
         Vector3d(across * turned.x(), across * turned.y(), (1 - kShorter * beat) * turned.z()) +
         beat * Vector3d(1.5, -1, 0.5) * std::min(1.0, size.maxCoeff() / 40);
}

// Liver: its dome moves by 10 to 25 mm towards the feet in quiet breathing, a few to the front
// (P. Keall et al., report of AAPM task group 76, 2006).
Vector3d placeInBreath(const Box3d& rest, const Vector3d& point, double phase) {
  const double height = std::max(rest.size().z(), 1e-6), up = (point.z() - rest.low.z()) / height;
  const double down = std::min(12.0, 0.3 * height), share = 0.6 + 0.4 * std::clamp(up, 0.0, 1.0);
  return point + swing(phase) * Vector3d(0, -0.25 * down * share, -down * share);
}

}  // namespace

const std::map<std::string, PhantomMotion>& phantomMotionByName() {
  static const std::map<std::string, PhantomMotion> names = {{"none", PhantomMotion::None},
                                                             {"heart", PhantomMotion::Heart},
                                                             {"breath", PhantomMotion::Breath}};
  return names;
}

double periodOf(PhantomMotion motion) {
  return motion == PhantomMotion::Heart ? 0.8 : 4.0;
}

MovingTissue::MovingTissue(PhantomMotion motion, const Box3d& rest)
    : m_motion(motion), m_rest(rest) {}

Vector3d MovingTissue::place(const Vector3d& point, double phase) const {
  return m_motion == PhantomMotion::Heart ? placeOnHeart(m_rest, point, phase)
                                          : placeInBreath(m_rest, point, phase);
}

formats::Pose MovingTissue::pose(const Vector3d& centre, double phase) const {
  constexpr double kStep = 1e-3, kPulse = 0.04;
  Matrix3d deformation;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d step = kStep * Vector3d::Unit(axis);
    deformation.col(axis) =
        (place(centre + step, phase) - place(centre - step, phase)) / (2 * kStep);
  }
  const Eigen::JacobiSVD<Matrix3d> parts(deformation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3d turn = parts.matrixU() * parts.matrixV().transpose();
  const double factor = m_motion == PhantomMotion::Heart ? 1 - kPulse * swing(phase) : 1.0;
  return poseOf(place(centre, phase), Eigen::Quaterniond(turn), factor);
}

formats::Motion motionOfTissue(const formats::CenterlineTree& tree, const MovingTissue& tissue,
                               double period, std::size_t phases) {
  formats::Motion motion;
  motion.period = period;
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) motion.node.push_back(i);
  for (std::size_t t = 0; t < phases; ++t) {
    const double share = static_cast<double>(t) / static_cast<double>(phases);
    motion.time.push_back(share * period);
    for (std::uint32_t i = 0; i < tree.nodeCount(); ++i)
      motion.pose.push_back(tissue.pose(toEigen(tree.centre[i]), share));
  }
  return motion;
}

}  // namespace lumen::convert
