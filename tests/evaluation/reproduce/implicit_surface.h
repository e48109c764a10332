// SPDX-License-Identifier: Apache-2.0
// The surface f = T of one node's model: nearest points and crossings of rays.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "formats/case/case.h"

namespace lumen::reproduce {

using Eigen::Vector3d;

/// Refers to the models that it was made from. Lengths in mm.
class ImplicitSurface {
public:
  ImplicitSurface(const formats::BlobbyModels& models, std::uint32_t node)
      : m_models(models), m_node(node) {}

  struct Value {
    double f = 0;
    Vector3d gradient = Vector3d::Zero();
  };
  [[nodiscard]] Value at(const Vector3d& p) const;
  [[nodiscard]] double level() const { return m_models.isoLevel; }
  [[nodiscard]] bool isInside(const Vector3d& p) const { return at(p).f > level(); }

  /// Taubin's first-order distance |T - f| / |grad f|; infinite where the field is flat.
  [[nodiscard]] double taubinDistance(const Vector3d& p) const;

  /// The point of the surface that Newton's method along the gradient reaches from `p` in steps of
  /// at most `longestStep`; nothing if it does not converge.
  [[nodiscard]] std::optional<Vector3d> project(const Vector3d& p, double longestStep) const;

  /// The nearest point of the surface, for a `p` that is close to it: projects, then slides along
  /// the tangent plane until the way back to `p` is normal to the surface.
  [[nodiscard]] std::optional<Vector3d> nearest(const Vector3d& p, double longestStep) const;

  /// Where the ray from `p`, which is inside, along the unit vector `direction` leaves the inside
  /// first, looked for in steps of `step`; nothing within `longest`.
  [[nodiscard]] std::optional<Vector3d> leave(const Vector3d& p, const Vector3d& direction,
                                              double step, double longest) const;

private:
  const formats::BlobbyModels& m_models;
  std::uint32_t m_node;
};

}  // namespace lumen::reproduce
