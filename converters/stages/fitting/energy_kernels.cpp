// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/energy_kernels.h"

#include <cmath>

#include "converters/base/simd.h"
#include "formats/field/kernel.h"

namespace lumen::convert::fitting {

namespace {

// The loops below must end up inside the clone that calls them, or they would keep the default
// instruction set.
#define LUMEN_INLINE [[gnu::always_inline]] inline

// The arrays of a block never overlap; the compiler cannot see this, and there are too many of them
// for its checks at run time.
#if defined(__clang__)
#define LUMEN_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define LUMEN_INDEPENDENT _Pragma("GCC ivdep")
#endif

/// The value that the data term measures instead of f, to first order T - f at the surface
/// (energy.h).
struct Residual {
  double value;
  double slope;   ///< -du/df
  double second;  ///< d2u/df2
};

/// Least field, as a share of the level: smaller fields count as this, so that u stays finite where
/// f vanishes.
constexpr double kLeastField = 1e-12;

template <class Phi>
LUMEN_INLINE Residual residualOf(double f, double level) {
  if constexpr (Phi::kTail == field::KernelTail::Power) {
    const double least = kLeastField * level, bounded = f > least ? f : least;
    const double ratio = level / bounded, root = std::sqrt(std::sqrt(ratio));
    return {4.0 * level * (root - 1.0), ratio * root, 1.25 * ratio * root / bounded};
  } else {
    return {level - f, 1.0, 0.0};
  }
}

using Lane = double[kBlock];

/// Sums over the blobs at every point of a block, and the terms that the curvature's derivatives
/// need.
struct alignas(64) Sums {
  Lane f, gx, gy, gz, ax, ay, az, wx, wy, wz, c;
  Lane dataSlope;  ///< -du/df
  Lane slopeTurn;  ///< effect of a change of f alone on the slope row, per row of the data
};

LUMEN_INLINE void start(const Block& in, Sums& s) {
  const std::size_t count = in.count;
  const double* const* frozen = in.frozen;
  LUMEN_INDEPENDENT
  for (std::size_t k = 0; k < count; ++k) {
    s.f[k] = frozen[0][k];
    s.gx[k] = frozen[1][k];
    s.gy[k] = frozen[2][k];
    s.gz[k] = frozen[3][k];
  }
}

/// First pass over a blob: the field, its gradient, and the data rows of the Jacobian.
template <bool kJacobian, class Phi>
LUMEN_INLINE void addField(double kernelScale, const Block& in, const Blob& blob, Sums& s,
                           double* __restrict scratch, float* __restrict column) {
  const std::size_t count = in.count, stride = in.columnStride;
  const double inverse = 1.0 / blob.width, width = blob.width;
  const double cx = blob.x, cy = blob.y, cz = blob.z;
  const double* __restrict px = in.x, * __restrict py = in.y, * __restrict pz = in.z;
  const double* __restrict weight = in.weight;
  LUMEN_INDEPENDENT
  for (std::size_t k = 0; k < count; ++k) {
    const double dx = (px[k] - cx) * inverse, dy = (py[k] - cy) * inverse;
    const double dz = (pz[k] - cz) * inverse;
    const double x = dx * dx + dy * dy + dz * dz;
    const field::KernelChain<double> v = Phi::chain(kernelScale * x, kernelScale);
    const double d1 = 2.0 * v.d1;
    s.f[k] += width * v.phi;
    s.gx[k] += d1 * dx;
    s.gy[k] += d1 * dy;
    s.gz[k] += d1 * dz;
    scratch[k] = dx;
    scratch[kBlock + k] = dy;
    scratch[2 * kBlock + k] = dz;
    scratch[3 * kBlock + k] = x;
    scratch[4 * kBlock + k] = v.d1;
    scratch[5 * kBlock + k] = v.d2;
    scratch[6 * kBlock + k] = v.d3;
    if constexpr (kJacobian) {
      const double wd1 = weight[k] * d1;
      column[k] = static_cast<float>(wd1 * dx);
      column[stride + k] = static_cast<float>(wd1 * dy);
      column[2 * stride + k] = static_cast<float>(wd1 * dz);
      column[3 * stride + k] = static_cast<float>(wd1 * x - weight[k] * v.phi);
    }
  }
}

LUMEN_INLINE void startCurvature(const Block& in, Sums& s) {
  const std::size_t count = in.count;
  const double* const* frozen = in.frozen;
  LUMEN_INDEPENDENT
  for (std::size_t k = 0; k < count; ++k) {
    const double gx = s.gx[k], gy = s.gy[k], gz = s.gz[k];
    s.ax[k] = frozen[4][k] * gx + frozen[7][k] * gy + frozen[8][k] * gz;
    s.ay[k] = frozen[7][k] * gx + frozen[5][k] * gy + frozen[9][k] * gz;
    s.az[k] = frozen[8][k] * gx + frozen[9][k] * gy + frozen[6][k] * gz;
  }
}

/// Second pass over a blob: A = Gamma G, with Gamma = H - (tr H) I.
LUMEN_INLINE void addCurvature(const Block& in, const Blob& blob, Sums& s,
                               double* __restrict scratch) {
  const std::size_t count = in.count;
  const double scale = 4.0 / blob.width;
  LUMEN_INDEPENDENT
  for (std::size_t k = 0; k < count; ++k) {
    const double dx = scratch[k], dy = scratch[kBlock + k], dz = scratch[2 * kBlock + k];
    const double gx = s.gx[k], gy = s.gy[k], gz = s.gz[k];
    const double u = gx * dx + gy * dy + gz * dz;
    const double d2 = scale * scratch[5 * kBlock + k];
    const double along = d2 * u;
    const double across = d2 * scratch[3 * kBlock + k] + scale * scratch[4 * kBlock + k];
    s.ax[k] += along * dx - across * gx;
    s.ay[k] += along * dy - across * gy;
    s.az[k] += along * dz - across * gz;
    scratch[7 * kBlock + k] = u;
  }
}

/// Residuals; and W, c such that d kappa = W . dG + c (G^T dH G - |G|^2 tr dH), scaled as the
/// residual is.
template <class Phi>
LUMEN_INLINE void finishPoints(const BlockParameters& p, const Block& in, Sums& s) {
  const std::size_t count = in.count;
  const double level = p.isoLevel, beta = p.curvatureScale, expected = p.expectedCurvature;
  const double* __restrict weight = in.weight, * __restrict share = in.share;
  double* __restrict field = in.field, * __restrict gradient2 = in.gradient2;
  double* __restrict data = in.dataResidual, * __restrict curvature = in.curvatureResidual;
  double* __restrict slope2 = in.slope2;
  LUMEN_INDEPENDENT
  for (std::size_t k = 0; k < count; ++k) {
    const double gx = s.gx[k], gy = s.gy[k], gz = s.gz[k];
    const double g2 = gx * gx + gy * gy + gz * gz;
    const double inverse2 = 1.0 / (g2 + kFlatField);
    const double inverse3 = inverse2 * std::sqrt(inverse2);
    const double scale = share[k] * beta;
    const double kappa = 0.5 * inverse3 * (gx * s.ax[k] + gy * s.ay[k] + gz * s.az[k]);
    const double direct = scale * inverse3, radial = scale * 3.0 * kappa * inverse2;
    field[k] = s.f[k];
    gradient2[k] = g2;
    const Residual r = residualOf<Phi>(s.f[k], level);
    data[k] = weight[k] * r.value;
    slope2[k] = r.slope * r.slope * g2;
    s.dataSlope[k] = r.slope;
    // the rows of the data have the weight, those of the slope the share squared
    const double toSlope = weight[k] > 0.0 ? share[k] * share[k] / weight[k] : 0.0;
    s.slopeTurn[k] = 2.0 * r.slope * r.second * g2 * toSlope;
    curvature[k] = scale * (kappa - expected);
    s.wx[k] = direct * s.ax[k] - radial * gx;
    s.wy[k] = direct * s.ay[k] - radial * gy;
    s.wz[k] = direct * s.az[k] - radial * gz;
    s.c[k] = 0.5 * direct;
  }
}

/// Third pass over a blob: the curvature and slope rows of the Jacobian, and the data rows from
/// those of T - f to those of u(f).
LUMEN_INLINE void differentiateCurvature(const Block& in, const Blob& blob, const Sums& s,
                                         const double* __restrict scratch, std::size_t unknown) {
  const std::size_t count = in.count, stride = in.columnStride;
  const double inverse = 1.0 / blob.width;
  const double* __restrict gradient2 = in.gradient2, * __restrict share = in.share;
  float* __restrict data = in.dataRows + unknown * stride;
  float* __restrict column = in.curvatureRows + unknown * stride;
  float* __restrict slope = in.slopeRows + unknown * stride;
  LUMEN_INDEPENDENT
  for (std::size_t k = 0; k < count; ++k) {
    const double dx = scratch[k], dy = scratch[kBlock + k], dz = scratch[2 * kBlock + k];
    const double x = scratch[3 * kBlock + k], d1 = scratch[4 * kBlock + k];
    const double d2 = scratch[5 * kBlock + k], d3 = scratch[6 * kBlock + k];
    const double u = scratch[7 * kBlock + k], g2 = gradient2[k];
    const double wd = s.wx[k] * dx + s.wy[k] * dy + s.wz[k] * dz;
    const double t = u * u - g2 * x;
    const double c8 = 8.0 * inverse * inverse * s.c[k];
    const double alongW = -2.0 * inverse * d1, alongG = -c8 * d2 * u;
    const double alongD = c8 * (2.0 * d2 * g2 - d3 * t) - 4.0 * inverse * d2 * wd;
    column[k] = static_cast<float>(alongD * dx + alongW * s.wx[k] + alongG * s.gx[k]);
    column[stride + k] = static_cast<float>(alongD * dy + alongW * s.wy[k] + alongG * s.gy[k]);
    column[2 * stride + k] = static_cast<float>(alongD * dz + alongW * s.wz[k] + alongG * s.gz[k]);
    column[3 * stride + k] = static_cast<float>(-2.0 * inverse * (2.0 * d2 * x + d1) * wd +
                                                c8 * (d2 * (2.0 * g2 * x - u * u) - d3 * x * t) -
                                                0.5 * c8 * (d2 * t - d1 * g2));
    const double w = -4.0 * inverse * share[k] * share[k], w2 = 2.0 * w * d2 * u, w1 = w * d1;
    const double d = s.dataSlope[k], d2u = d * d, turn = s.slopeTurn[k];
    const double ex = double{data[k]}, ey = double{data[stride + k]};
    const double ez = double{data[2 * stride + k]}, ew = double{data[3 * stride + k]};
    slope[k] = static_cast<float>(d2u * (w2 * dx + w1 * s.gx[k]) + turn * ex);
    slope[stride + k] = static_cast<float>(d2u * (w2 * dy + w1 * s.gy[k]) + turn * ey);
    slope[2 * stride + k] = static_cast<float>(d2u * (w2 * dz + w1 * s.gz[k]) + turn * ez);
    slope[3 * stride + k] = static_cast<float>(d2u * (w2 * x + w1 * u) + turn * ew);
    data[k] = static_cast<float>(ex * d);
    data[stride + k] = static_cast<float>(ey * d);
    data[2 * stride + k] = static_cast<float>(ez * d);
    data[3 * stride + k] = static_cast<float>(ew * d);
  }
}

template <bool kJacobian, class Phi>
LUMEN_INLINE void evaluate(const BlockParameters& parameters, const Block& in,
                           std::span<const Blob> blobs) {
  Sums sums;
  start(in, sums);
  for (std::size_t j = 0; j < blobs.size(); ++j) {
    addField<kJacobian, Phi>(parameters.kernelScale, in, blobs[j], sums,
                             in.scratch + j * kScratchArrays * kBlock,
                             kJacobian ? in.dataRows + 4 * j * in.columnStride : nullptr);
  }
  startCurvature(in, sums);
  for (std::size_t j = 0; j < blobs.size(); ++j) {
    addCurvature(in, blobs[j], sums, in.scratch + j * kScratchArrays * kBlock);
  }
  finishPoints<Phi>(parameters, in, sums);
  if constexpr (kJacobian) {
    for (std::size_t j = 0; j < blobs.size(); ++j) {
      differentiateCurvature(in, blobs[j], sums, in.scratch + j * kScratchArrays * kBlock, 4 * j);
    }
  }
}

/// The data's part of evaluate(): the field and its gradient, and the rows of the Jacobian.
template <bool kJacobian, class Phi>
LUMEN_INLINE void addData(double kernelScale, const Block& in, const Blob& blob, Sums& s,
                          std::size_t unknown) {
  const std::size_t count = in.count, stride = in.columnStride;
  const double inverse = 1.0 / blob.width, width = blob.width;
  const double cx = blob.x, cy = blob.y, cz = blob.z;
  const double* __restrict px = in.x, * __restrict py = in.y, * __restrict pz = in.z;
  float* __restrict column = kJacobian ? in.dataRows + unknown * stride : nullptr;
  LUMEN_INDEPENDENT
  for (std::size_t k = 0; k < count; ++k) {
    const double dx = (px[k] - cx) * inverse, dy = (py[k] - cy) * inverse;
    const double dz = (pz[k] - cz) * inverse;
    const double x = dx * dx + dy * dy + dz * dz;
    const field::KernelChain<double> v = Phi::chain(kernelScale * x, kernelScale);
    const double d1 = 2.0 * v.d1, gx = d1 * dx, gy = d1 * dy, gz = d1 * dz;
    s.f[k] += width * v.phi;
    s.gx[k] += gx;
    s.gy[k] += gy;
    s.gz[k] += gz;
    if constexpr (kJacobian) {
      column[k] = static_cast<float>(gx);
      column[stride + k] = static_cast<float>(gy);
      column[2 * stride + k] = static_cast<float>(gz);
      column[3 * stride + k] = static_cast<float>(d1 * x - v.phi);
    }
  }
}

template <class Phi>
LUMEN_INLINE void finishData(const BlockParameters& p, const Block& in, Sums& s) {
  const std::size_t count = in.count;
  const double level = p.isoLevel;
  const double* __restrict weight = in.weight;
  double* __restrict field = in.field, * __restrict gradient2 = in.gradient2;
  double* __restrict data = in.dataResidual;
  LUMEN_INDEPENDENT
  for (std::size_t k = 0; k < count; ++k) {
    const double gx = s.gx[k], gy = s.gy[k], gz = s.gz[k];
    const Residual r = residualOf<Phi>(s.f[k], level);
    field[k] = s.f[k];
    gradient2[k] = gx * gx + gy * gy + gz * gz;
    data[k] = weight[k] * r.value;
    s.dataSlope[k] = weight[k] * r.slope;
  }
}

/// From the derivatives of T - f to those of the residuals.
LUMEN_INLINE void scaleData(const Block& in, const Sums& s, std::size_t unknown) {
  const std::size_t count = in.count, stride = in.columnStride;
  float* __restrict column = in.dataRows + unknown * stride;
  LUMEN_INDEPENDENT
  for (std::size_t k = 0; k < count; ++k) {
    const auto d = static_cast<float>(s.dataSlope[k]);
    column[k] *= d;
    column[stride + k] *= d;
    column[2 * stride + k] *= d;
    column[3 * stride + k] *= d;
  }
}

template <bool kJacobian, class Phi>
LUMEN_INLINE void evaluateData(const BlockParameters& parameters, const Block& in,
                               std::span<const Blob> blobs) {
  Sums sums;
  start(in, sums);
  for (std::size_t j = 0; j < blobs.size(); ++j)
    addData<kJacobian, Phi>(parameters.kernelScale, in, blobs[j], sums, 4 * j);
  finishData<Phi>(parameters, in, sums);
  if constexpr (kJacobian) {
    for (std::size_t j = 0; j < blobs.size(); ++j) scaleData(in, sums, 4 * j);
  }
}

template <class Phi>
LUMEN_INLINE void accumulate(double kernelScale, std::size_t count, const double* __restrict px,
                             const double* __restrict py, const double* __restrict pz,
                             const Blob& blob, double* const (&sums)[10]) {
  double* __restrict f = sums[0], * __restrict gx = sums[1], * __restrict gy = sums[2];
  double* __restrict gz = sums[3], * __restrict xx = sums[4], * __restrict yy = sums[5];
  double* __restrict zz = sums[6], * __restrict xy = sums[7], * __restrict xz = sums[8];
  double* __restrict yz = sums[9];
  const double inverse = 1.0 / blob.width;
  LUMEN_INDEPENDENT
  for (std::size_t k = 0; k < count; ++k) {
    const double dx = (px[k] - blob.x) * inverse, dy = (py[k] - blob.y) * inverse;
    const double dz = (pz[k] - blob.z) * inverse;
    const double x = dx * dx + dy * dy + dz * dz;
    const field::KernelChain<double> v = Phi::chain(kernelScale * x, kernelScale);
    const double d1 = 2.0 * v.d1, d2 = 4.0 * inverse * v.d2;
    const double isotropic = d2 * x + 4.0 * inverse * v.d1;
    f[k] += blob.width * v.phi;
    gx[k] += d1 * dx;
    gy[k] += d1 * dy;
    gz[k] += d1 * dz;
    xx[k] += d2 * dx * dx - isotropic;
    yy[k] += d2 * dy * dy - isotropic;
    zz[k] += d2 * dz * dz - isotropic;
    xy[k] += d2 * dx * dy;
    xz[k] += d2 * dx * dz;
    yz[k] += d2 * dy * dz;
  }
}

}  // namespace

// Lambdas are inlined by force for the same reason as the loops.

LUMEN_SIMD_CLONES
void evaluateBlock(const BlockParameters& parameters, const Block& block,
                   std::span<const Blob> blobs, bool withJacobian) {
  field::withKernel(
      parameters.kernel, [&](auto phi) __attribute__((always_inline)) {
        if (withJacobian) {
          block.isSample ? evaluate<true, decltype(phi)>(parameters, block, blobs)
                         : evaluateData<true, decltype(phi)>(parameters, block, blobs);
        } else {
          block.isSample ? evaluate<false, decltype(phi)>(parameters, block, blobs)
                         : evaluateData<false, decltype(phi)>(parameters, block, blobs);
        }
      });
}

LUMEN_SIMD_CLONES
void accumulateField(const BlockParameters& parameters, std::size_t count, const double* x,
                     const double* y, const double* z, std::span<const Blob> blobs,
                     double* const (&sums)[10]) {
  field::withKernel(
      parameters.kernel, [&](auto phi) __attribute__((always_inline)) {
        for (const Blob& blob : blobs)
          accumulate<decltype(phi)>(parameters.kernelScale, count, x, y, z, blob, sums);
      });
}

}  // namespace lumen::convert::fitting
