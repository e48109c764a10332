// SPDX-License-Identifier: Apache-2.0
#include "converters/mesh/node_field.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

#include "converters/common/simd.h"
#include "formats/case/blobby.h"

namespace lumen::convert {
namespace {

using formats::Kernel;

// exp(-q) for q >= 0 to a few units in the last place: 2^-n exp(-r), |r| <= ln(2) / 2, by Taylor's
// series. Adding 1.5 * 2^52 leaves the nearest integer in the low bits of the sum.
inline double expNegative(double q) {
  constexpr double kRound = 0x1.8p52, kInverseLn2 = 1.4426950408889634;
  constexpr double kLn2High = 0x1.62e42fefa38p-1, kLn2Low = 0x1.ef35793c7673p-45;
  q = q < 700.0 ? q : 700.0;
  const double shifted = -q * kInverseLn2 + kRound;
  const double n = shifted - kRound;
  const double r = (-q - n * kLn2High) - n * kLn2Low;
  double sum = 1.0 / 6227020800.0;
  constexpr double kInverseFactorials[] = {1.0 / 479001600,
                                           1.0 / 39916800,
                                           1.0 / 3628800,
                                           1.0 / 362880,
                                           1.0 / 40320,
                                           1.0 / 5040,
                                           1.0 / 720,
                                           1.0 / 120,
                                           1.0 / 24,
                                           1.0 / 6,
                                           0.5,
                                           1.0,
                                           1.0};
  for (const double c : kInverseFactorials) sum = sum * r + c;
  return sum * std::bit_cast<double>((std::bit_cast<std::uint64_t>(shifted) + 1023U) << 52);
}

// phi as a function of u, which is scale * |X - C|^2.
template <Kernel kernel>
inline double phi(double u) {
  if constexpr (kernel == Kernel::Cauchy) {
    const double t = 1.0 + u;
    return 1.0 / (t * t);
  } else if constexpr (kernel == Kernel::Gaussian) {
    return expNegative(u);
  } else if constexpr (kernel == Kernel::Quartic) {
    const double t = u < 1.0 ? 1.0 - u : 0.0;
    return t * t;
  } else {
    const double value = 1.0 + u * (-22.0 / 9.0 + u * (17.0 / 9.0 - u * (4.0 / 9.0)));
    return u < 1.0 ? value : 0.0;
  }
}

// d phi / d u.
template <Kernel kernel>
inline double phiDerivative(double u) {
  if constexpr (kernel == Kernel::Cauchy) {
    const double t = 1.0 + u;
    return -2.0 / (t * t * t);
  } else if constexpr (kernel == Kernel::Gaussian) {
    return -expNegative(u);
  } else if constexpr (kernel == Kernel::Quartic) {
    return u < 1.0 ? -2.0 * (1.0 - u) : 0.0;
  } else {
    return u < 1.0 ? -22.0 / 9.0 + u * (34.0 / 9.0 - u * (4.0 / 3.0)) : 0.0;
  }
}

struct Row {
  double blobX, offAxis2, scale, width, cell;
  int first;
};

template <Kernel kernel>
inline void addBlob(Row row, double* out, int count) {  // by value: `out` cannot alias it
  for (int i = 0; i < count; ++i) {
    const double dx = row.cell * (row.first + i) - row.blobX;
    out[i] += row.width * phi<kernel>(row.scale * (dx * dx + row.offAxis2));
  }
}

LUMEN_SIMD_CLONES
void addCauchy(const Row& row, double* out, int count) {
  addBlob<Kernel::Cauchy>(row, out, count);
}
LUMEN_SIMD_CLONES
void addGaussian(const Row& row, double* out, int count) {
  addBlob<Kernel::Gaussian>(row, out, count);
}
LUMEN_SIMD_CLONES
void addQuartic(const Row& row, double* out, int count) {
  addBlob<Kernel::Quartic>(row, out, count);
}
LUMEN_SIMD_CLONES
void addSoftObject(const Row& row, double* out, int count) {
  addBlob<Kernel::SoftObject>(row, out, count);
}

using AddBlob = void (*)(const Row&, double*, int);

AddBlob addBlobOf(Kernel kernel) {
  switch (kernel) {
    case Kernel::Cauchy:
      return addCauchy;
    case Kernel::Gaussian:
      return addGaussian;
    case Kernel::Quartic:
      return addQuartic;
    case Kernel::SoftObject:
      break;
  }
  return addSoftObject;
}

double phiOf(Kernel kernel, double u) {
  switch (kernel) {
    case Kernel::Cauchy:
      return phi<Kernel::Cauchy>(u);
    case Kernel::Gaussian:
      return phi<Kernel::Gaussian>(u);
    case Kernel::Quartic:
      return phi<Kernel::Quartic>(u);
    case Kernel::SoftObject:
      break;
  }
  return phi<Kernel::SoftObject>(u);
}

double phiDerivativeOf(Kernel kernel, double u) {
  switch (kernel) {
    case Kernel::Cauchy:
      return phiDerivative<Kernel::Cauchy>(u);
    case Kernel::Gaussian:
      return phiDerivative<Kernel::Gaussian>(u);
    case Kernel::Quartic:
      return phiDerivative<Kernel::Quartic>(u);
    case Kernel::SoftObject:
      break;
  }
  return phiDerivative<Kernel::SoftObject>(u);
}

double scaleOf(const formats::BlobbyModels& models, double width) {
  const bool hasParameter = models.kernel == Kernel::Cauchy || models.kernel == Kernel::Gaussian;
  return (hasParameter ? models.kernelParameter : 1.0) / (width * width);
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
    m_scale.push_back(scaleOf(models, width));
    // Of N terms that exceed T together, one exceeds T / N alone.
    const double share = m_level / (end - begin);
    m_reach.push_back(formats::isoRadius(m_kernel, m_parameter, width, share));
    m_low = m_low.cwiseMin((centre.array() - m_reach.back()).matrix());
    m_high = m_high.cwiseMax((centre.array() + m_reach.back()).matrix());
  }
}

double NodeField::value(const Eigen::Vector3d& point) const {
  double f = 0;
  for (std::size_t j = 0; j < m_width.size(); ++j) {
    const double dx = point.x() - m_x[j], dy = point.y() - m_y[j], dz = point.z() - m_z[j];
    f += m_width[j] * phiOf(m_kernel, m_scale[j] * (dx * dx + (dy * dy + dz * dz)));
  }
  return f;
}

FieldSample NodeField::sample(const Eigen::Vector3d& point) const {
  FieldSample result;
  for (std::size_t j = 0; j < m_width.size(); ++j) {
    const Eigen::Vector3d d = point - Eigen::Vector3d(m_x[j], m_y[j], m_z[j]);
    const double u = m_scale[j] * (d.x() * d.x() + (d.y() * d.y() + d.z() * d.z()));
    result.f += m_width[j] * phiOf(m_kernel, u);
    result.gradient += (2.0 * m_width[j] * m_scale[j] * phiDerivativeOf(m_kernel, u)) * d;
  }
  return result;
}

void NodeField::sampleRow(int first, double cell, double y, double z, std::span<double> out) const {
  std::fill(out.begin(), out.end(), 0.0);
  const AddBlob add = addBlobOf(m_kernel);
  for (std::size_t j = 0; j < m_width.size(); ++j) {
    const double dy = y - m_y[j], dz = z - m_z[j];
    const Row row{m_x[j], dy * dy + dz * dz, m_scale[j], m_width[j], cell, first};
    add(row, out.data(), static_cast<int>(out.size()));
  }
}

void NodeField::sampleRowReference(int first, double cell, double y, double z,
                                   std::span<double> out) const {
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = value(Eigen::Vector3d(cell * (first + static_cast<int>(i)), y, z));
}

// For the Cauchy kernel f^(-1/2) grows with the square of the distance from a blob, so it is nearly
// straight across one cell; the other kernels are steep but smooth there, and are used as they are.
double NodeField::straightened(double f) const {
  return m_kernel == Kernel::Cauchy ? 1.0 / std::sqrt(f) : -f;
}

double NodeField::crossing(const Eigen::Vector3d& a, double fa, const Eigen::Vector3d& b,
                           double fb) const {
  constexpr int kMaxSteps = 10;       // edges that graze the wall need more than the usual two
  constexpr double kLastStep = 3e-4;  // Newton's next step would be about its square
  const double target = straightened(m_level);
  const bool rising = fb < fa;  // `straightened` falls where f rises
  const Eigen::Vector3d edge = b - a;
  double low = 0, high = 1;
  const double ga = straightened(fa), gb = straightened(fb);
  double t = std::clamp((target - ga) / (gb - ga), 0.0, 1.0);
  for (int step = 0; step < kMaxSteps; ++step) {
    const FieldSample here = sample(a + t * edge);
    const double g = straightened(here.f);
    if (g == target) break;
    ((g < target) == rising ? low : high) = t;
    const double slopeOfF = here.gradient.dot(edge);
    const double slope = m_kernel == Kernel::Cauchy ? -0.5 * g / here.f * slopeOfF : -slopeOfF;
    const double next = t + (target - g) / slope;
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
    bound += m_width[j] * phiOf(m_kernel, m_scale[j] * offAxis * offAxis);
    if (offAxis >= m_reach[j]) continue;
    const double half = std::sqrt(m_reach[j] * m_reach[j] - offAxis * offAxis) + slack;
    first = std::min(first, m_x[j] - half);
    last = std::max(last, m_x[j] + half);
  }
  if (bound <= m_level || first > last) return {};
  return {static_cast<int>(std::floor(first / cell)), static_cast<int>(std::ceil(last / cell))};
}

}  // namespace lumen::convert
