// SPDX-License-Identifier: Apache-2.0
// Axis-parallel boxes.
#pragma once

#include <limits>
#include <type_traits>

#include <Eigen/Core>

namespace lumen::convert {

/// All points p with low <= p <= high in each coordinate; ends are included. A default box is
/// empty.
template <class Scalar>
struct Box {
  static_assert(std::is_floating_point_v<Scalar>);
  using Vector = Eigen::Matrix<Scalar, 3, 1>;

  Vector low = Vector::Constant(std::numeric_limits<Scalar>::infinity());
  Vector high = -low;

  void add(const Vector& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  /// Adds all points within `radius` of `point` in each coordinate.
  void add(const Vector& point, Scalar radius) {
    add(point - Vector::Constant(radius), point + Vector::Constant(radius));
  }
  void add(const Box& other) { add(other.low, other.high); }

  [[nodiscard]] bool isEmpty() const { return (low.array() > high.array()).any(); }
  [[nodiscard]] bool meets(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
  [[nodiscard]] bool contains(const Vector& point) const {
    return (low.array() <= point.array()).all() && (point.array() <= high.array()).all();
  }
  [[nodiscard]] Vector size() const { return high - low; }
  [[nodiscard]] Vector middle() const { return Scalar{0.5} * (low + high); }
  /// Vector from the nearest point of the box to `point`, each coordinate without its sign.
  [[nodiscard]] Vector gap(const Vector& point) const {
    return (low - point).cwiseMax(point - high).cwiseMax(Scalar{0});
  }
  friend bool operator==(const Box&, const Box&) = default;

private:
  void add(const Vector& least, const Vector& greatest) {
    low = low.cwiseMin(least);
    high = high.cwiseMax(greatest);
  }
};

using Box3d = Box<double>;
using Box3f = Box<float>;

}  // namespace lumen::convert
