// SPDX-License-Identifier: Apache-2.0
#include "implicit_surface.h"

#include <cmath>
#include <limits>

#include "formats/case/blobby.h"

namespace lumen::reproduce {
namespace {

constexpr int kNewtonSteps = 60;
constexpr int kSlides = 20;
constexpr int kBisections = 40;
constexpr double kOnSurface = 1e-9;  // mm

}  // namespace

ImplicitSurface::Value ImplicitSurface::at(const Vector3d& p) const {
  const formats::FieldValue value = formats::evaluateField(m_models, m_node, {p.x(), p.y(), p.z()});
  return {value.f, {value.gradient.x, value.gradient.y, value.gradient.z}};
}

double ImplicitSurface::taubinDistance(const Vector3d& p) const {
  const Value value = at(p);
  const double slope = value.gradient.norm();
  return slope > 0 ? std::abs(level() - value.f) / slope : std::numeric_limits<double>::infinity();
}

std::optional<Vector3d> ImplicitSurface::project(const Vector3d& p, double longestStep) const {
  Vector3d q = p;
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Value value = at(q);
    const double slope2 = value.gradient.squaredNorm();
    if (!(slope2 > 1e-20)) return {};
    Vector3d step = value.gradient * ((level() - value.f) / slope2);
    const double length = step.norm();
    if (length > longestStep) step *= longestStep / length;
    q += step;
    if (length <= kOnSurface) return q;
  }
  return {};
}

std::optional<Vector3d> ImplicitSurface::nearest(const Vector3d& p, double longestStep) const {
  std::optional<Vector3d> q = project(p, longestStep);
  for (int i = 0; q && i < kSlides; ++i) {
    const Vector3d normal = at(*q).gradient.normalized(), offset = p - *q;
    const Vector3d slide = offset - normal * normal.dot(offset);
    if (slide.norm() <= 1e-4 * offset.norm() + kOnSurface) break;
    const std::optional<Vector3d> next = project(*q + slide, longestStep);
    if (!next || (p - *next).norm() >= offset.norm()) break;
    q = next;
  }
  return q;
}

std::optional<Vector3d> ImplicitSurface::leave(const Vector3d& p, const Vector3d& direction,
                                               double step, double longest) const {
  double low = 0, high = step;
  while (isInside(p + high * direction)) {
    low = high;
    high += step;
    if (high > longest) return {};
  }
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (isInside(p + middle * direction) ? low : high) = middle;
  }
  return p + 0.5 * (low + high) * direction;
}

}  // namespace lumen::reproduce
