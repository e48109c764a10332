// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/energy.h"

#include <algorithm>
#include <cmath>

#include "converters/stages/fitting/energy_kernels.h"
#include "converters/stages/fitting/jacobian_sums.h"

namespace lumen::convert::fitting {
namespace {

constexpr std::size_t roundUp(std::size_t n, std::size_t to) {
  return (n + to - 1) / to * to;
}

/// Makes room for `n` values without giving memory back.
template <class T>
void reserve(std::vector<T>& buffer, std::size_t n) {
  if (buffer.size() < n) buffer.resize(n);
}

/// Weight of one pair in the sum over i < j, given Nb.
double pairWeight(std::size_t blobs) {
  return 2.0 / (static_cast<double>(blobs) * static_cast<double>(blobs - 1));
}

double sumLanes(const double (&lanes)[kLanes]) {
  return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) +
         ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}

/// Sum of squares in kLanes independent partial sums; `count` is a multiple of kLanes.
double sumOfSquares(const double* values, std::size_t count) {
  double lanes[kLanes] = {};
  for (std::size_t k = 0; k < count; k += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) lanes[l] += values[k + l] * values[k + l];
  }
  return sumLanes(lanes);
}

BlockParameters blockParameters(const EnergyParameters& p) {
  return {p.kernel, field::chainScale(p.kernel, p.kernelParameter), p.isoLevel,
          std::sqrt(p.curvatureWeight), p.expectedCurvature};
}

double cohesion(const Blob& a, const Blob& b, double scale) {
  const double dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
  const double sigma = scale * scale * a.width * b.width / (dx * dx + dy * dy + dz * dz);
  return sigma * sigma * sigma - 1.0;
}

}  // namespace

CohesionResidual cohesionResidual(const Blob& first, const Blob& second, double scale) {
  const double dx = first.x - second.x, dy = first.y - second.y, dz = first.z - second.z;
  const double distance2 = dx * dx + dy * dy + dz * dz;
  const double sigma = scale * scale * first.width * second.width / distance2;
  const double cube = sigma * sigma * sigma;
  const double slope = -6.0 * cube / distance2;
  return {cube - 1.0,
          {slope * dx, slope * dy, slope * dz, 3.0 * cube / first.width, -slope * dx, -slope * dy,
           -slope * dz, 3.0 * cube / second.width}};
}

void Energy::setPoints(std::span<const formats::Vec3d> points,
                       std::span<const formats::Vec3d> seams, double seamWeight) {
  m_count = points.size();
  m_padded = roundUp(m_count + seams.size(), kLanes);
  const std::size_t stride = std::clamp<std::size_t>(m_count / kFewestSamples, 1, kSampleStride);
  m_samples = stride > 1 ? m_count / stride / kLanes * kLanes : m_padded;
  m_rows = m_padded;
  m_active = 0;
  for (auto* buffer : {&m_x, &m_y, &m_z, &m_weight, &m_share, &m_field, &m_gradient2, &m_slope2}) {
    reserve(*buffer, m_padded);
  }
  for (auto& sums : m_frozen) {
    reserve(sums, m_padded);
    std::fill(sums.begin(), sums.end(), 0.0);
  }
  reserve(m_residual, m_padded + m_samples);
  const double weight = 1.0 / std::sqrt(static_cast<double>(m_count));
  const double share = 1.0 / std::sqrt(static_cast<double>(std::min(m_samples, m_count)));
  const double shared =
      seams.empty() ? 0.0 : std::sqrt(seamWeight / static_cast<double>(seams.size()));
  // samples come first: k stride for k < m_samples, then all other points in their order
  std::size_t other = 0;
  for (std::size_t k = 0; k < m_padded; ++k) {
    const bool onSeam = k >= m_count && k < m_count + seams.size();
    std::size_t from = k * stride;
    if (k >= m_samples || k >= m_count) {
      while (stride > 1 && other % stride == 0 && other < m_samples * stride) ++other;
      from = std::min(other++, m_count - 1);
    }
    const formats::Vec3d& p = onSeam ? seams[k - m_count] : points[from];
    m_x[k] = p.x;
    m_y[k] = p.y;
    m_z[k] = p.z;
    m_share[k] = k < std::min(m_samples, m_count) ? share : 0.0;
    m_weight[k] = onSeam ? shared : k < m_count ? weight : 0.0;
  }
}

formats::Vec3d Energy::point(std::size_t k) const {
  return {m_x[k], m_y[k], m_z[k]};
}

void Energy::freeze(std::span<const Blob> blobs, std::size_t active, At at) {
  m_active = active;
  m_rows = at == At::Samples ? m_samples : m_padded;
  double* sums[10];
  for (std::size_t i = 0; i < 10; ++i) {
    sums[i] = m_frozen[i].data();
    std::fill_n(sums[i], m_rows, 0.0);
  }
  accumulateField(blockParameters(m_parameters), m_rows, m_x.data(), m_y.data(), m_z.data(),
                  blobs.first(active), sums);
}

double Energy::evaluate(std::span<const Blob> blobs) {
  return run(blobs, false);
}

double Energy::linearise(std::span<const Blob> blobs) {
  reserve(m_jacobian, 4 * (blobs.size() - m_active) * columnRows());
  return run(blobs, true);
}

double Energy::run(std::span<const Blob> blobs, bool withJacobian) {
  const std::span<const Blob> unknown = blobs.subspan(m_active);
  reserve(m_scratch, unknown.size() * kScratchArrays * kBlock);
  const BlockParameters parameters = blockParameters(m_parameters);
  Block block;
  block.columnStride = columnRows();
  block.scratch = m_scratch.data();
  for (std::size_t k = 0; k < m_rows; k += block.count) {
    block.isSample = k < m_samples;
    block.count = std::min(kBlock, (block.isSample ? m_samples : m_rows) - k);
    block.x = m_x.data() + k;
    block.y = m_y.data() + k;
    block.z = m_z.data() + k;
    block.weight = m_weight.data() + k;
    block.share = m_share.data() + k;
    for (std::size_t i = 0; i < 10; ++i) block.frozen[i] = m_frozen[i].data() + k;
    block.field = m_field.data() + k;
    block.gradient2 = m_gradient2.data() + k;
    block.slope2 = m_slope2.data() + k;
    block.dataResidual = m_residual.data() + k;
    block.curvatureResidual = m_residual.data() + m_padded + k;
    if (withJacobian) {
      block.dataRows = m_jacobian.data() + k;
      block.curvatureRows = m_jacobian.data() + m_padded + k;
      block.slopeRows = m_jacobian.data() + m_padded + m_samples + k;
    }
    evaluateBlock(parameters, block, unknown, withJacobian);
  }
  return sumTerms(blobs);
}

double Energy::sumTerms(std::span<const Blob> blobs) {
  const double curvature = sumOfSquares(m_residual.data() + m_padded, m_samples);
  m_slope = meanSlope();
  m_terms.data = sumOfSquares(m_residual.data(), m_rows) * dataFactor();
  m_terms.curvature =
      m_parameters.curvatureWeight > 0 ? curvature / m_parameters.curvatureWeight : 0;
  m_terms.cohesion = 0;
  if (blobs.size() > 1 && m_parameters.cohesionWeight > 0) {
    double total = 0;
    for (std::size_t j = 1; j < blobs.size(); ++j) {
      for (std::size_t i = 0; i < j; ++i) {
        const double value = cohesion(blobs[i], blobs[j], m_parameters.cohesionScale);
        total += value * value;
      }
    }
    m_terms.cohesion = total * pairWeight(blobs.size());
  }
  m_terms.evenness = 0;
  for (const Blob& blob : blobs) {
    const double r = blob.width / m_parameters.evenWidth - 1.0;
    m_terms.evenness += r * r;
  }
  return m_terms.data + m_parameters.cohesionWeight * m_terms.cohesion + curvature +
         m_parameters.evennessWeight * m_terms.evenness;
}

double Energy::dataFactor() const {
  const double points =
      m_rows < m_padded ? static_cast<double>(m_count) / static_cast<double>(m_samples) : 1.0;
  const double reference = m_parameters.referenceSlope;
  return reference > 0 ? points * reference / m_slope : points;
}

double Energy::meanSlope() const {
  double lanes[kLanes] = {};
  for (std::size_t k = 0; k < m_samples; k += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      lanes[l] += m_share[k + l] * m_share[k + l] * m_slope2[k + l];
    }
  }
  return sumLanes(lanes) + kFlatField;
}

double Energy::meanCurvature() const {
  if (!(m_parameters.curvatureWeight > 0)) return m_parameters.expectedCurvature;
  double lanes[kLanes] = {};
  for (std::size_t k = 0; k < m_samples; k += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      lanes[l] += m_share[k + l] * m_residual[m_padded + k + l];
    }
  }
  return m_parameters.expectedCurvature + sumLanes(lanes) / std::sqrt(m_parameters.curvatureWeight);
}

void Energy::normalEquations(std::span<const Blob> blobs, std::span<double> a,
                             std::span<double> b) {
  const std::size_t n = 4 * (blobs.size() - m_active), stride = columnRows();
  std::fill_n(a.data(), n * n, 0.0);
  std::fill_n(b.data(), n, 0.0);
  multiplyTransposed(m_jacobian.data(), stride, n, m_residual.data(), m_rows, a.data(), b.data());
  if (m_parameters.referenceSlope > 0 || m_rows < m_padded) normaliseData(n, a, b);
  multiplyTransposed(m_jacobian.data() + m_padded, stride, n, m_residual.data() + m_padded,
                     m_samples, a.data(), b.data());
  if (blobs.size() > 1 && m_parameters.cohesionWeight > 0) addCohesion(blobs, a, b);
  if (m_parameters.evennessWeight > 0) addEvenness(blobs, a, b);
}

/// From the plain residuals r to the normalised ones s r, s^2 = reference / slope, whose Jacobian
/// is s J + r s'^T: the normal equations change by matrices of rank one only.
void Energy::normaliseData(std::size_t n, std::span<double> a, std::span<double> b) {
  reserve(m_slopeGradient, n);
  sumColumns(m_jacobian.data() + m_padded + m_samples, columnRows(), n, m_samples,
             m_slopeGradient.data());
  const double s2 = dataFactor(), factor = m_parameters.referenceSlope > 0 ? -0.5 / m_slope : 0.0;
  const double squares = m_terms.data;  // s^2 r^T r
  for (std::size_t i = 0; i < n; ++i) {
    const double di = factor * m_slopeGradient[i];  // s' / s
    for (std::size_t j = i; j < n; ++j) {
      const double dj = factor * m_slopeGradient[j];
      a[i * n + j] = s2 * (a[i * n + j] + b[i] * dj + di * b[j]) + squares * di * dj;
    }
  }
  for (std::size_t i = 0; i < n; ++i) b[i] = s2 * b[i] + squares * factor * m_slopeGradient[i];
}

void Energy::addEvenness(std::span<const Blob> blobs, std::span<double> a,
                         std::span<double> b) const {
  const std::size_t n = 4 * (blobs.size() - m_active);
  const double slope = 1.0 / m_parameters.evenWidth, weight = m_parameters.evennessWeight * slope;
  for (std::size_t j = m_active; j < blobs.size(); ++j) {
    const std::size_t i = 4 * (j - m_active) + 3;
    a[i * n + i] += weight * slope;
    b[i] += weight * (blobs[j].width * slope - 1.0);
  }
}

void Energy::addCohesion(std::span<const Blob> blobs, std::span<double> a,
                         std::span<double> b) const {
  const std::size_t n = 4 * (blobs.size() - m_active);
  const double weight = m_parameters.cohesionWeight * pairWeight(blobs.size());
  for (std::size_t j = m_active; j < blobs.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      const CohesionResidual r = cohesionResidual(blobs[i], blobs[j], m_parameters.cohesionScale);
      const bool unknown = i >= m_active;  // blob j always is
      const std::size_t columnI = unknown ? 4 * (i - m_active) : 0, columnJ = 4 * (j - m_active);
      for (std::size_t p = unknown ? 0 : 4; p < 8; ++p) {
        const std::size_t row = p < 4 ? columnI + p : columnJ + p - 4;
        const double scaled = weight * r.gradient[p];
        b[row] += scaled * r.value;
        for (std::size_t q = p; q < 8; ++q) {
          const std::size_t column = q < 4 ? columnI + q : columnJ + q - 4;
          a[row * n + column] += scaled * r.gradient[q];
        }
      }
    }
  }
}

}  // namespace lumen::convert::fitting
