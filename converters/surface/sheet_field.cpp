// SPDX-License-Identifier: Apache-2.0
#include "converters/surface/sheet_field.h"

#include "converters/common/surface_projection.h"

namespace lumen::convert {

SheetField::SheetField(const formats::Case& source, const field::BlendedField& field,
                       const SheetOptions& options)
    : m_source(source), m_field(field), m_options(options) {}

SheetSample SheetField::at(const Eigen::Vector3d& point, std::uint32_t node) const {
  const field::Vec p{point.x(), point.y(), point.z()};
  SheetSample sample;
  sample.node = m_field.follow(p, node);
  const field::Jet<1> f = m_field.blended(p, sample.node);
  const Eigen::Vector3d gradient(f.gradient);
  const double slope = gradient.norm();
  if (!(slope > 0)) return sample;
  sample.gradient = -gradient / slope;
  sample.distance = (m_field.level() - f.value) / slope;
  return sample;
}

std::optional<SheetField::Foot> SheetField::project(const Eigen::Vector3d& start,
                                                    std::uint32_t node,
                                                    const Eigen::Vector3d* plane) const {
  const auto foot = projectOnSurface(m_field, start, node, radius(node), plane);
  if (!foot) return std::nullopt;
  return Foot{foot->position, {0, -foot->gradient.normalized(), foot->node, false}};
}

}  // namespace lumen::convert
