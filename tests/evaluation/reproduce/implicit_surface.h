// SPDX-License-Identifier: Apache-2.0
// The surface f = T of one node's model: nearest points and crossings of rays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
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

// How far the surfaces of adjacent models are apart where one takes over from the other.

/// A seam is the part of the radical plane of a node and its parent that both cells share: where no
/// other node within two edges of either has a smaller power. The surface of each of the two models
/// is sampled on it along rays in the plane, from the point where the plane meets the line between
/// the centres; the jump is the distance, mm, from the sample to the other model's surface.
struct SeamJumps {
  std::vector<double> jump;  ///< ascending
  std::size_t seams = 0;     ///< pairs of a node and its parent that have samples
  std::size_t lost = 0;      ///< samples from which the other surface was not found
  std::size_t open = 0;      ///< rays that left no model within 4 radii, or started outside it
};

/// The case must have models. Throws Error(Cancelled).
SeamJumps measureSeams(const formats::Case& value, Progress& progress);

/// The smallest value that at least `share` of the ascending values do not exceed; NaN of none.
double quantile(const std::vector<double>& ascending, double share);

}  // namespace lumen::reproduce
