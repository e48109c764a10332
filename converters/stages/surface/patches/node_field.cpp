// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/patches/node_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "converters/base/simd.h"
#include "formats/case/blobby.h"

namespace lumen::convert {
namespace {

using formats::Kernel;

struct BlobRow {
  double blobX, offAxis2, scale, width, cell;
  int first;
};

// Adds one blob to a row of samples. `row` by value: `out` cannot alias it.
template <class K>
[[gnu::always_inline]] inline void addBlob(BlobRow row, double* out, int count) {
  for (int i = 0; i < count; ++i) {
    const double dx = row.cell * (row.first + i) - row.blobX;
    out[i] += row.width * K::phi(row.scale * (dx * dx + row.offAxis2));
  }
}

LUMEN_SIMD_CLONES
void addBlobToRow(Kernel kernel, const BlobRow& row, double* out, int count) {
  field::withKernel(
      kernel, [&](auto k)
                  __attribute__((always_inline)) { addBlob<decltype(k)>(row, out, count); });
}

}  // namespace

NodeField::NodeField(const formats::BlobbyModels& models, std::uint32_t node)
    : m_kernel(models.kernel), m_parameter(models.kernelParameter), m_level(models.isoLevel) {
  m_low.setConstant(std::numeric_limits<double>::infinity());
  m_high = -m_low;
  const std::uint32_t begin = models.offset[node], end = models.offset[node + 1];
  for (std::uint32_t j = begin; j < end; ++j) {
    const Eigen::Vector3d centre(models.centre[j].x, models.centre[j].y, models.centre[j].z);
    const double width = models.width[j];
    m_x.push_back(centre.x());
    m_y.push_back(centre.y());
    m_z.push_back(centre.z());
    m_width.push_back(width);
    m_scale.push_back(field::blobScale(m_kernel, m_parameter, width));
    // If N terms exceed T together, one exceeds T / N alone.
    const double share = m_level / (end - begin);
    m_reach.push_back(formats::isoRadius(m_kernel, m_parameter, width, share));
    m_low = m_low.cwiseMin((centre.array() - m_reach.back()).matrix());
    m_high = m_high.cwiseMax((centre.array() + m_reach.back()).matrix());
  }
}

double NodeField::value(const Eigen::Vector3d& point) const {
  return field::withKernel(m_kernel, [&](auto k) {
    double f = 0;
    for (std::size_t j = 0; j < m_width.size(); ++j) {
      const double dx = point.x() - m_x[j], dy = point.y() - m_y[j], dz = point.z() - m_z[j];
      f += m_width[j] * k.phi(m_scale[j] * (dx * dx + (dy * dy + dz * dz)));
    }
    return f;
  });
}

FieldSample NodeField::sample(const Eigen::Vector3d& point) const {
  return field::withKernel(m_kernel, [&](auto k) {
    FieldSample result;
    for (std::size_t j = 0; j < m_width.size(); ++j) {
      const Eigen::Vector3d d = point - Eigen::Vector3d(m_x[j], m_y[j], m_z[j]);
      const double u = m_scale[j] * (d.x() * d.x() + (d.y() * d.y() + d.z() * d.z()));
      result.f += m_width[j] * k.phi(u);
      result.gradient += (2.0 * m_width[j] * m_scale[j] * k.first(u)) * d;
    }
    return result;
  });
}

void NodeField::sampleRow(int first, double cell, double y, double z, std::span<double> out) const {
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t j = 0; j < m_width.size(); ++j) {
    const double dy = y - m_y[j], dz = z - m_z[j];
    const BlobRow row{m_x[j], dy * dy + dz * dz, m_scale[j], m_width[j], cell, first};
    addBlobToRow(m_kernel, row, out.data(), static_cast<int>(out.size()));
  }
}

void NodeField::sampleRowReference(int first, double cell, double y, double z,
                                   std::span<double> out) const {
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = value(Eigen::Vector3d(cell * (first + static_cast<int>(i)), y, z));
}

double NodeField::crossing(const Eigen::Vector3d& a, double fa, const Eigen::Vector3d& b,
                           double fb) const {
  constexpr int kMaxSteps = 10;       // edges that graze the wall need more than the usual two
  constexpr double kLastStep = 3e-4;  // Newton's next step would be about its square
  const auto transform = [this](double f, double slope) {
    return field::levelTransform(m_kernel, f, slope);
  };
  const double target = transform(m_level, 0).h;
  const bool rising = fb < fa;  // h falls where f rises
  const Eigen::Vector3d edge = b - a;
  double low = 0, high = 1;
  const double ha = transform(fa, 0).h, hb = transform(fb, 0).h;
  double t = std::clamp((target - ha) / (hb - ha), 0.0, 1.0);
  for (int step = 0; step < kMaxSteps; ++step) {
    const FieldSample at = sample(a + t * edge);
    const field::LevelTransform here = transform(at.f, -at.gradient.dot(edge));
    if (here.h == target) break;
    ((here.h < target) == rising ? low : high) = t;
    const double next = t + (target - here.h) / here.slope;
    const double before = t;
    t = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(t - before) < kLastStep) break;
  }
  return t;
}

NodeField::Range NodeField::rangeNearInside(double cell, double y, double z) const {
  const double slack = 1.5 * cell;  // more than the diagonal of a cell's face
  double first = std::numeric_limits<double>::infinity(), last = -first, bound = 0;
  for (std::size_t j = 0; j < m_width.size(); ++j) {
    const double dy = y - m_y[j], dz = z - m_z[j];
    const double offAxis = std::max(0.0, std::sqrt(dy * dy + dz * dz) - slack);
    bound += m_width[j] * field::phi(m_kernel, m_scale[j] * offAxis * offAxis);
    if (offAxis >= m_reach[j]) continue;
    const double half = std::sqrt(m_reach[j] * m_reach[j] - offAxis * offAxis) + slack;
    first = std::min(first, m_x[j] - half);
    last = std::max(last, m_x[j] + half);
  }
  if (bound <= m_level || first > last) return {};
  return {static_cast<int>(std::floor(first / cell)), static_cast<int>(std::ceil(last / cell))};
}

}  // namespace lumen::convert
