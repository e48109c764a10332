// SPDX-License-Identifier: Apache-2.0
#include "converters/picture/camera.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "converters/common/vectors.h"

namespace lumen::convert {

namespace {

constexpr double kMargin = 0.06;  // of the picture, on each side

/// The direction of least extent, towards the front of the patient or his head.
Eigen::Vector3d thinnestDirection(const formats::CenterlineTree& tree) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const formats::Vec3f& c : tree.centre) mean += toEigen(c);
  mean /= static_cast<double>(tree.nodeCount());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const formats::Vec3f& c : tree.centre) {
    const Eigen::Vector3d d = toEigen(c) - mean;
    spread += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  const Eigen::Vector3d least = solver.eigenvectors().col(0);
  return least.y() > 0 ? Eigen::Vector3d(-least) : least;
}

Eigen::Vector3d towardsViewer(const formats::CenterlineTree& tree, View view) {
  switch (view) {
    case View::Anterior:
      return -Eigen::Vector3d::UnitY();
    case View::Posterior:
      return Eigen::Vector3d::UnitY();
    case View::Left:
      return Eigen::Vector3d::UnitX();
    case View::Right:
      return -Eigen::Vector3d::UnitX();
    case View::Superior:
      return Eigen::Vector3d::UnitZ();
    case View::Inferior:
      return -Eigen::Vector3d::UnitZ();
    case View::Best:
      break;
  }
  return thinnestDirection(tree);
}

Eigen::Matrix3d axesOf(const Eigen::Vector3d& towards) {
  // seen from above or below the front of the patient is up
  const bool isAxial = std::abs(towards.z()) > 0.9;
  const Eigen::Vector3d upright = isAxial ? Eigen::Vector3d(-Eigen::Vector3d::UnitY())
                                          : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d up = (upright - upright.dot(towards) * towards).normalized();
  Eigen::Matrix3d axes;
  axes.row(0) = up.cross(towards).transpose();
  axes.row(1) = up.transpose();
  axes.row(2) = towards.transpose();
  return axes;
}

}  // namespace

Eigen::Vector3d Camera::project(const Eigen::Vector3d& lps) const {
  const Eigen::Vector3d v = axes * (lps - centre);
  return {0.5 * width + scale * v.x(), 0.5 * height - scale * v.y(), v.z()};
}

Eigen::Vector3d Camera::place(double x, double y, double depth) const {
  return centre + axes.transpose() *
                      Eigen::Vector3d((x - 0.5 * width) / scale, (0.5 * height - y) / scale, depth);
}

Camera cameraFor(const formats::CenterlineTree& tree, View view, double turn, int width,
                 int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.axes =
      axesOf(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * towardsViewer(tree, view));
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kInfinity), high = -low;
  for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
    const Eigen::Vector3d v = camera.axes * toEigen(tree.centre[n]);
    const Eigen::Vector3d r = Eigen::Vector3d::Constant(double{tree.radius[n]});
    low = low.cwiseMin(v - r);
    high = high.cwiseMax(v + r);
  }
  camera.centre = camera.axes.transpose() * (0.5 * (low + high));
  const Eigen::Vector3d extent = high - low;
  camera.scale = (1 - 2 * kMargin) *
                 std::min(width / std::max(extent.x(), 1e-6), height / std::max(extent.y(), 1e-6));
  return camera;
}

}  // namespace lumen::convert
