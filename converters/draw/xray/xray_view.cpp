// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/xray/xray_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/geometry/box.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

constexpr double kMargin = 1.03;
constexpr double kWallRadii = 2;  // a model's wall does not reach beyond

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

}  // namespace

Vector3d XrayView::towards() const {
  const double a = radians(primary), b = radians(secondary);
  return {std::sin(a) * std::cos(b), -std::cos(a) * std::cos(b), std::sin(b)};
}

Vector3d XrayView::right() const {
  const double a = radians(primary);
  return {std::cos(a), std::sin(a), 0};
}

Vector3d XrayView::up() const {
  const double a = radians(primary), b = radians(secondary);
  return {-std::sin(a) * std::sin(b), std::cos(a) * std::sin(b), std::cos(b)};
}

Vector3d XrayView::source() const {
  return isocentre - sourceToIsocentre * towards();
}

Vector3d XrayView::pixelPlace(int x, int y) const {
  const double u = (x + 0.5 - 0.5 * width) * pixel, v = (0.5 * height - y - 0.5) * pixel;
  return source() + sourceToDetector * towards() + u * right() + v * up();
}

double XrayView::solidAngle(int x, int y) const {
  const double far = (pixelPlace(x, y) - source()).norm();
  return pixel * pixel * sourceToDetector / (far * far * far);
}

Vector3d middleOf(const formats::CenterlineTree& tree) {
  Box3d box;
  for (std::size_t n = 0; n < tree.nodeCount(); ++n)
    box.add(toEigen(tree.centre[n]), double{tree.radius[n]});
  return 0.5 * (box.low + box.high);
}

double pixelFor(const formats::CenterlineTree& tree, const XrayView& view) {
  double reach = 0;
  for (std::size_t n = 0; n < tree.nodeCount(); ++n)
    reach =
        std::max(reach, (toEigen(tree.centre[n]) - view.isocentre).norm() + double{tree.radius[n]});
  // the tangent of the cone from the source around the ball that holds all
  const double along = view.sourceToIsocentre;
  if (reach >= along)
    throw invalidInput("the vessels reach " + shownNumber(reach, 4) +
                       " mm from the isocentre, and the source is " + shownNumber(along, 4) +
                       " mm from it");
  const double half = view.sourceToDetector * reach / std::sqrt(along * along - reach * reach);
  return kMargin * 2 * half / std::min(view.width, view.height);
}

void requireBetween(const formats::CenterlineTree& tree, const XrayView& view) {
  for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
    const Vector3d centre = toEigen(tree.centre[n]);
    const double depth = view.towards().dot(centre - view.source());
    const double radius = kWallRadii * double{tree.radius[n]};
    if (depth - radius > 0 && depth + radius < view.sourceToDetector) continue;
    throw invalidInput("the vessel at " + placeText(centre) + " lies " +
                       (depth - radius > 0 ? "behind the detector" : "at the source") +
                       " of the X-ray: expected all vessels between both");
  }
}

}  // namespace lumen::convert
