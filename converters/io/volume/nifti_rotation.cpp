// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/nifti_rotation.h"

#include <cmath>

namespace lumen::convert {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3f;

/// The determinant, summed in the order of the NIfTI library.
double determinantOf(const Matrix3d& r) {
  return r(0, 0) * r(1, 1) * r(2, 2) - r(0, 0) * r(2, 1) * r(1, 2) - r(1, 0) * r(0, 1) * r(2, 2) +
         r(1, 0) * r(2, 1) * r(0, 2) + r(2, 0) * r(0, 1) * r(1, 2) - r(2, 0) * r(1, 1) * r(0, 2);
}

Matrix3f inverseTransposed(const Matrix3f& axes) {
  const Matrix3d r = axes.cast<double>();
  const double inverse = 1 / determinantOf(r);
  Matrix3f cofactors;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cofactors(i, j) =
          static_cast<float>(inverse * (r(i1, j1) * r(i2, j2) - r(i1, j2) * r(i2, j1)));
    }
  return cofactors;
}

/// The geometric mean of the greatest sums of magnitudes along a row and along a column.
float sizeOf(const Matrix3f& m) {
  const Matrix3d magnitudes = m.cast<double>().cwiseAbs();
  const auto rows = static_cast<float>(magnitudes.rowwise().sum().maxCoeff());
  const auto columns = static_cast<float>(magnitudes.colwise().sum().maxCoeff());
  return std::sqrt(rows * columns);
}

/// The columns, each divided by its length.
Matrix3f unitColumns(const Matrix3f& axes) {
  Matrix3d unit = axes.cast<double>();
  for (int c = 0; c < 3; ++c) {
    const double length =
        std::sqrt(unit(0, c) * unit(0, c) + unit(1, c) * unit(1, c) + unit(2, c) * unit(2, c));
    unit.col(c) /= length;
  }
  return unit.cast<float>();
}

/// The nearest orthogonal matrix: N. J. Higham, SIAM J. Sci. Stat. Comput. 7, 1160 (1986).
Matrix3f nearestOrthogonal(const Matrix3f& axes) {
  constexpr float kFar = 0.3F;  // from the end: steps are scaled
  constexpr double kEnd = 3e-6;
  constexpr int kMostSteps = 100;
  Matrix3f last = axes;
  float change = 1;
  for (int step = 0;; ++step) {
    const Matrix3f other = inverseTransposed(last);
    const float scale = change > kFar ? std::sqrt(sizeOf(other) / sizeOf(last)) : 1.0F;
    const float otherScale = static_cast<float>(1.0 / static_cast<double>(scale));
    const Matrix3f next = 0.5F * (scale * last + otherScale * other);
    change = static_cast<float>((next - last).cast<double>().cwiseAbs().sum());
    if (step >= kMostSteps || static_cast<double>(change) < kEnd) return next;
    last = next;
  }
}

}  // namespace

Matrix3f niftiAxes(const NiftiRotation& rotation, const std::array<float, 3>& steps) {
  constexpr double kHalfTurn = 1e-7;  // below it the quaternion's a is 0
  double b = static_cast<double>(rotation.quaternion[0]);
  double c = static_cast<double>(rotation.quaternion[1]);
  double d = static_cast<double>(rotation.quaternion[2]);
  double a = 1 - (b * b + c * c + d * d);
  if (a < kHalfTurn) {
    const double scale = 1 / std::sqrt(b * b + c * c + d * d);
    b *= scale, c *= scale, d *= scale;
    a = 0;
  } else {
    a = std::sqrt(a);
  }
  Matrix3d axes;
  axes << a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c),  //
      2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b),      //
      2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - c * c - b * b;
  for (int column = 0; column < 3; ++column)
    axes.col(column) *= static_cast<double>(steps[static_cast<std::size_t>(column)]);
  if (rotation.handedness < 0) axes.col(2) *= -1;
  return axes.cast<float>();
}

Matrix3f orthogonalAxes(const Matrix3f& axes) {
  Matrix3f rows = axes.transpose();
  for (int r = 0; r < 3; ++r) {
    const float squared =
        rows(r, 0) * rows(r, 0) + rows(r, 1) * rows(r, 1) + rows(r, 2) * rows(r, 2);
    rows.row(r) *= static_cast<float>(1 / std::sqrt(static_cast<double>(squared)));
  }
  return nearestOrthogonal(rows).transpose();
}

NiftiRotation niftiRotation(const Matrix3f& axes) {
  Matrix3d r = nearestOrthogonal(unitColumns(axes)).cast<double>();
  NiftiRotation rotation;
  if (!(determinantOf(r) > 0)) {
    rotation.handedness = -1;
    r.col(2) *= -1;
  }
  // the quaternion by the greatest of its parts a, b, c and d, which divides the others
  double a = r(0, 0) + r(1, 1) + r(2, 2) + 1;
  Eigen::Vector3d bcd;
  if (a > 0.5) {
    a = 0.5 * std::sqrt(a);
    bcd << 0.25 * (r(2, 1) - r(1, 2)) / a, 0.25 * (r(0, 2) - r(2, 0)) / a,
        0.25 * (r(1, 0) - r(0, 1)) / a;
  } else {
    int i = 0;
    const auto squared = [&](int p) {
      return 1 + r(p, p) - (r((p + 1) % 3, (p + 1) % 3) + r((p + 2) % 3, (p + 2) % 3));
    };
    while (i < 2 && !(squared(i) > 1)) ++i;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    bcd[i] = 0.5 * std::sqrt(squared(i));
    bcd[j] = 0.25 * (r(i, j) + r(j, i)) / bcd[i];
    bcd[k] = 0.25 * (r(i, k) + r(k, i)) / bcd[i];
    if (0.25 * (r(k, j) - r(j, k)) / bcd[i] < 0) bcd *= -1;
  }
  for (std::size_t p = 0; p < 3; ++p)
    rotation.quaternion[p] = static_cast<float>(bcd[static_cast<Eigen::Index>(p)]);
  return rotation;
}

}  // namespace lumen::convert
