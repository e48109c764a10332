// SPDX-License-Identifier: Apache-2.0
// Inputs that lie far from 0, where floats, in which cases state positions, have no room for a vessel.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/shown_text.h"

namespace lumen::convert {

inline constexpr double kFarStep = 1e4;  // mm

/// The whole tens of metres by which an input is moved whose lowest place is `low`, mm, so that all
/// inputs of one place move alike. Floats are exact to a thousandth of a millimetre within ten metres;
/// at a kilometre they are not to a tenth.
inline Eigen::Vector3d farMove(const Eigen::Vector3d& low) {
  return low.unaryExpr([](double at) { return kFarStep * std::trunc(at / kFarStep); });
}

/// A place that a person states in the coordinates of an input, as a case of it states it: less the tens
/// of metres by which it comes nearest to `about`, a place of the case. A body is smaller than these.
inline Eigen::Vector3d placeNear(const Eigen::Vector3d& about, const Eigen::Vector3d& place) {
  return place - (place - about).unaryExpr([](double off) {
    return kFarStep * std::round(off / kFarStep);
  });
}

/// placeNear() of each place.
inline void bringNear(const Eigen::Vector3d& about, std::vector<Eigen::Vector3d>& places) {
  for (Eigen::Vector3d& place : places) place = placeNear(about, place);
}

/// The sentence on such a move, about "its origin" or "its points".
inline std::string farSentence(const std::string& what, const Eigen::Vector3d& move) {
  constexpr int kDigits = 12;
  return what + " far from 0: all positions are stated less " + vectorText(move, kDigits) +
         " mm, as floats would round them there";
}

/// Lowest coordinates of points, of which there is one.
inline Eigen::Vector3d lowestOf(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d low = points.front();
  for (const Eigen::Vector3d& point : points) low = low.cwiseMin(point);
  return low;
}

/// Moves points that lie a thousand times farther from 0 than their box is long to near 0, by whole
/// numbers that round none of them, and returns the vector back; 0 for other points. Volumes, which
/// are sums of products of three coordinates, would have no digit left of the sixteen of a double.
inline Eigen::Vector3d moveNear(std::vector<Eigen::Vector3d>& points) {
  constexpr double kFarRatio = 1e3, kStep = 1024;
  if (points.empty()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d low = lowestOf(points);
  Eigen::Vector3d high = low;
  for (const Eigen::Vector3d& point : points) high = high.cwiseMax(point);
  if (!(low.cwiseAbs().maxCoeff() > kFarRatio * (high - low).norm()))
    return Eigen::Vector3d::Zero();
  const Eigen::Vector3d back =
      low.unaryExpr([](double at) { return kStep * std::trunc(at / kStep); });
  for (Eigen::Vector3d& point : points) point -= back;
  return back;
}

}  // namespace lumen::convert
