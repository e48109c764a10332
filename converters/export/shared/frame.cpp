// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/frame.h"

#include <cstddef>
#include <utility>

#include "converters/base/vectors.h"

namespace lumen::convert {

namespace {

/// A float, without the sign of zero.
float single(double value) {
  return static_cast<float>(value == 0 ? 0.0 : value);
}

Float3 floats(const Eigen::Vector3d& v) {
  return {single(v.x()), single(v.y()), single(v.z())};
}

}  // namespace

std::string_view unitName(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::Centimetre:
      return "cm";
    case LengthUnit::Metre:
      return "m";
    case LengthUnit::Millimetre:
      break;
  }
  return "mm";
}

std::string_view axesName(Axes axes) {
  switch (axes) {
    case Axes::Ras:
      return "RAS";
    case Axes::Lsa:
      return "LSA";
    case Axes::Lps:
      break;
  }
  return "LPS";
}

std::string_view upName(Axes axes) {
  return axes == Axes::Lsa ? "y" : "z";
}

std::string_view axesText(Axes axes) {
  switch (axes) {
    case Axes::Ras:
      return "x right, y anterior, z superior (up)";
    case Axes::Lsa:
      return "x left, y superior (up), z anterior";
    case Axes::Lps:
      break;
  }
  return "x left, y posterior, z superior (up)";
}

double ExportFrame::scale() const {
  switch (unit) {
    case LengthUnit::Centimetre:
      return 0.1;
    case LengthUnit::Metre:
      return 0.001;
    case LengthUnit::Millimetre:
      break;
  }
  return 1;
}

Eigen::Matrix3d ExportFrame::rotation() const {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  if (axes == Axes::Ras) r.diagonal() << -1, -1, 1;
  if (axes == Axes::Lsa) r << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return r;
}

Eigen::Vector3d ExportFrame::position(const Eigen::Vector3d& lps) const {
  return scale() * direction(lps);
}

Eigen::Vector3d ExportFrame::direction(const Eigen::Vector3d& lps) const {
  return rotation() * lps;
}

Eigen::Matrix4d ExportFrame::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = scale() * rotation();
  return m;
}

SurfaceMesh ExportFrame::of(SurfaceMesh mesh) const {
  for (Float3& p : mesh.position) p = floats(position(toEigen(p)));
  for (Float3& n : mesh.normal) n = floats(direction(toEigen(n)));
  for (float& r : mesh.radius) r = single(length(r));
  return mesh;
}

SurfaceMesh turnedOver(SurfaceMesh mesh) {
  for (Float3& n : mesh.normal)
    for (float& x : n) x = -x;
  for (Triangle& t : mesh.triangle) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace lumen::convert
