// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/picture/camera.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "converters/base/vectors.h"
#include "converters/geometry/box.h"

namespace lumen::convert {

namespace {

constexpr double kMargin = 0.06;        // share of the picture, on each side
constexpr double kLeastContent = 1e-6;  // mm: least size of a picture's content
constexpr int kStepsOfCircle = 64;      // after n steps the radius is some 1/n too wide

/// Directions in which the extent is no more than this times the least one count as of least
/// extent.
constexpr double kAlike = 1.1;

/// The direction of least extent, from the front of the patient or from his head; of several, that
/// which is nearest to his front.
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
  const double most = kAlike * kAlike * std::max(0.0, solver.eigenvalues()[0]) +
                      1e-9 * std::max(0.0, solver.eigenvalues()[2]);
  const Eigen::Vector3d front = -Eigen::Vector3d::UnitY();
  Eigen::Vector3d nearest = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    if (k == 0 || solver.eigenvalues()[k] <= most)
      nearest += solver.eigenvectors().col(k).dot(front) * solver.eigenvectors().col(k);
  if (nearest.norm() > 1e-3) return nearest.normalized();
  const Eigen::Vector3d least = solver.eigenvectors().col(0);
  return least.z() < 0 ? Eigen::Vector3d(-least) : least;
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

Eigen::Matrix3d viewAxes(const Eigen::Vector3d& towards) {
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

/// The part of space that a picture has to hold.
struct Extent {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< mm, LPS
  double width = 0, height = 0;                      ///< mm
};

Extent measureExtent(const formats::CenterlineTree& tree, const Eigen::Matrix3d& axes) {
  Box3d box;
  for (std::size_t n = 0; n < tree.nodeCount(); ++n)
    box.add(axes * toEigen(tree.centre[n]), double{tree.radius[n]});
  return {axes.transpose() * box.middle(), box.size().x(), box.size().y()};
}

/// About the upright axis through the centre all nodes stay within the width at any turn: it is a
/// nearly least circle around them (M. Badoiu, K. L. Clarkson, Smaller core-sets for balls, 2003).
Extent measureExtentOfTurns(const formats::CenterlineTree& tree, const Eigen::Matrix3d& axes) {
  Extent extent = measureExtent(tree, axes);
  Eigen::Vector3d centre = axes * extent.centre;
  for (int step = 1; step <= kStepsOfCircle; ++step) {
    double farthest = -1;
    Eigen::Vector2d towards = Eigen::Vector2d::Zero();
    for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
      const Eigen::Vector3d d = axes * toEigen(tree.centre[n]) - centre;
      const Eigen::Vector2d flat(d.x(), d.z());
      const double reach = flat.norm() + double{tree.radius[n]};
      if (reach <= farthest) continue;
      farthest = reach;
      towards = flat.norm() > 0 ? Eigen::Vector2d(flat * (reach / flat.norm())) : flat;
    }
    extent.width = 2 * farthest;
    if (step < kStepsOfCircle)
      centre += Eigen::Vector3d(towards.x(), 0, towards.y()) / (step + 1.0);
  }
  extent.centre = axes.transpose() * centre;
  return extent;
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

Camera Camera::scaled(double times) const {
  Camera other = *this;
  other.scale *= times;
  other.width = static_cast<int>(std::lround(width * times));
  other.height = static_cast<int>(std::lround(height * times));
  return other;
}

Camera cameraFor(const formats::CenterlineTree& tree, const Framing& framing) {
  Camera camera;
  camera.width = framing.width;
  camera.height = framing.height;
  camera.axes = viewAxes(towardsViewer(tree, framing.view));
  const Eigen::Matrix3d unturned = camera.axes;
  const Eigen::Vector3d up = unturned.row(1);
  camera.axes = unturned * Eigen::AngleAxisd(framing.turn, up).toRotationMatrix().transpose();
  const Extent held =
      framing.allTurns ? measureExtentOfTurns(tree, unturned) : measureExtent(tree, camera.axes);
  camera.centre = held.centre;
  const double across = (1 - 2 * kMargin) * framing.width;
  const double down =
      framing.height -
      2 * std::min(std::max(kMargin * framing.height, framing.margin), 0.4 * framing.height);
  camera.scale = std::min(across / std::max(held.width, kLeastContent),
                          down / std::max(held.height, kLeastContent));
  return camera;
}

}  // namespace lumen::convert
