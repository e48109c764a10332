// SPDX-License-Identifier: Apache-2.0
// Declared in bright_voxels.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include <Eigen/Eigenvalues>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "converters/base/simd.h"
#include "converters/stages/finding/bright_voxels.h"
#include "converters/voxels/grid_geometry.h"

namespace lumen::convert {
namespace {

constexpr std::array kScales = {1.0, 1.6, 2.5};  // voxels: standard deviations
constexpr double kCut = 3;                       // standard deviations of a kernel
constexpr int kBrick = 64;                       // voxels along an edge
constexpr float kRound = 0.4F;  // least ratio of the curvatures across: a sheet has one
constexpr float kAlong = 0.5F;  // largest ratio of the curvature along to the lesser one across

/// Least sum of all curvatures of a ridge in units of its strength, less what rounding may take.
constexpr float kLeastCurved = (2 - kAlong) * 0.999F;

/// A ridge has a sum of products of curvatures of at least 0 (its least: -c1, -c2 and c3 = 1, 1 and 1/2); less than this
/// share of the squared sum below 0 is what rounding may make of it, and of the curvatures.
constexpr float kLeastProducts = -0.01F;

/// Half of a symmetric kernel, its middle first.
std::vector<float> gaussian(double sigma) {
  std::vector<float> half(static_cast<std::size_t>(std::ceil(kCut * sigma)) + 1);
  double sum = 0;
  for (std::size_t i = 0; i < half.size(); ++i) {
    const double at = static_cast<double>(i) / sigma;
    half[i] = static_cast<float>(std::exp(-0.5 * at * at));
    sum += (i == 0 ? 1.0 : 2.0) * static_cast<double>(half[i]);
  }
  for (float& weight : half) weight = static_cast<float>(static_cast<double>(weight) / sum);
  return half;
}

/// out[x] = sum over k of half[|k|] in[x + k * stride], for `count` adjacent x.
LUMEN_SIMD_CLONES
void smoothRow(const float* __restrict in, std::ptrdiff_t stride, const std::vector<float>& half,
               float* __restrict out, std::ptrdiff_t count) {
  const auto reach = static_cast<std::ptrdiff_t>(half.size()) - 1;
  for (std::ptrdiff_t x = 0; x < count; ++x) out[x] = half[0] * in[x];
  for (std::ptrdiff_t k = 1; k <= reach; ++k) {
    const float weight = half[static_cast<std::size_t>(k)];
    for (std::ptrdiff_t x = 0; x < count; ++x)
      out[x] += weight * (in[x - k * stride] + in[x + k * stride]);
  }
}

/// Second derivatives at adjacent voxels of a row, as a structure of arrays.
struct Curvatures {
  using Row = std::array<float, kBrick>;
  alignas(64) Row xx, yy, zz, xy, xz, yz;
  alignas(64) Row trace;
  alignas(64) Row products;  ///< sum of the products of any two principal curvatures

  [[nodiscard]] Eigen::Matrix3f hessian(std::size_t i) const {
    Eigen::Matrix3f h;
    h << xx[i], xy[i], xz[i], xy[i], yy[i], yz[i], xz[i], yz[i], zz[i];
    return h;
  }
};

/// The second derivatives at `count` voxels from `v` on, by their neighbours.
LUMEN_SIMD_CLONES
void differentiate(const float* v, const std::array<std::ptrdiff_t, 3>& stride,
                   const Eigen::Vector3f& spacing, std::size_t count, Curvatures& out) {
  const auto along = [&](std::size_t axis, Curvatures::Row & row) __attribute__((always_inline)) {
    const std::ptrdiff_t p = stride[axis];
    const float square = spacing[static_cast<int>(axis)] * spacing[static_cast<int>(axis)];
    for (std::size_t x = 0; x < count; ++x) {
      const float* at = v + x;
      row[x] = (at[p] + at[-p] - 2 * at[0]) / square;
    }
  };
  const auto across = [&](std::size_t a, std::size_t b, Curvatures::Row & row)
      __attribute__((always_inline)) {
    const std::ptrdiff_t p = stride[a], q = stride[b];
    const float area = 4 * spacing[static_cast<int>(a)] * spacing[static_cast<int>(b)];
    for (std::size_t x = 0; x < count; ++x) {
      const float* at = v + x;
      row[x] = (at[p + q] + at[-p - q] - at[p - q] - at[q - p]) / area;
    }
  };
  along(0, out.xx);
  along(1, out.yy);
  along(2, out.zz);
  across(1, 0, out.xy);
  across(2, 0, out.xz);
  across(2, 1, out.yz);
  for (std::size_t x = 0; x < count; ++x) {
    const float xx = out.xx[x], yy = out.yy[x], zz = out.zz[x];
    out.trace[x] = xx + yy + zz;
    out.products[x] = xx * yy + yy * zz + zz * xx - out.xy[x] * out.xy[x] - out.xz[x] * out.xz[x] -
                      out.yz[x] * out.yz[x];
  }
}

/// A brick of voxels with a rim, and room to smooth it.
struct Brick {
  CellBox box;
  std::vector<float> voxels, smoothed, buffer;
  Curvatures curvatures;  ///< of a row

  [[nodiscard]] std::array<std::ptrdiff_t, 3> strides() const {
    std::array<std::ptrdiff_t, 3> out{};
    for (int a = 0; a < 3; ++a)
      out[static_cast<std::size_t>(a)] = static_cast<std::ptrdiff_t>(box.stride(a));
    return out;
  }

  /// Copies the voxels; those beyond the volume repeat its faces.
  template <class T>
  void take(const std::vector<T>& from, const CellBox& volume, float sign) {
    voxels.resize(box.count());
    std::size_t next = 0;
    const Cell last = volume.high();
    box.forEach([&](const Cell& cell) {
      const auto value =
          static_cast<float>(from[volume.index(cell.cwiseMax(Cell::Zero()).cwiseMin(last))]);
      voxels[next++] = std::isfinite(value) ? sign * value : 0.0F;
    });
  }

  /// Smooths along one axis. Voxels nearer to the rim than the kernel is long hold nothing of use then.
  void smoothAlong(int axis, const std::vector<float>& half) {
    const auto reach = static_cast<std::ptrdiff_t>(half.size()) - 1;
    const auto stride = static_cast<std::ptrdiff_t>(box.stride(axis));
    const auto row = static_cast<std::size_t>(box.size[0]);
    buffer.resize(smoothed.size());
    const std::size_t rows = box.count() / row;
    const std::ptrdiff_t first = axis == 0 ? reach : 0;
    for (std::size_t r = 0; r < rows; ++r) {
      const Cell at = Cell(0, static_cast<int>(r) % box.size[1], static_cast<int>(r) / box.size[1]);
      if (axis > 0 && (at[axis] < reach || at[axis] >= box.size[axis] - reach)) continue;
      const std::size_t from = r * row + static_cast<std::size_t>(first);
      smoothRow(smoothed.data() + from, stride, half, buffer.data() + from,
                static_cast<std::ptrdiff_t>(row) - 2 * first);
    }
    smoothed.swap(buffer);
  }
};

/// The strength of the ridge at a voxel of a row, per mm^2; 0 if there is none.
float measureStrength(const Curvatures& row, std::size_t x) {
  const float sum = row.trace[x];
  if (!(sum < 0) || row.products[x] < kLeastProducts * sum * sum) return 0;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(row.hessian(x), Eigen::EigenvaluesOnly);
  const Eigen::Vector3f curved = solver.eigenvalues();  // ascending
  if (!(curved[1] < 0) || curved[1] > kRound * curved[0]) return 0;
  return std::abs(curved[2]) > -kAlong * curved[1] ? 0.0F : -curved[1];
}

/// Calls visit(cell) for the first cell of every row along x.
template <class Visit>
void eachRow(const CellBox& box, const Visit& visit) {
  CellBox firsts = box;
  firsts.size[0] = 1;
  firsts.forEach(visit);
}

}  // namespace

ZeroedArray<float> ridgeStrength(const Volume& volume, float sign, const Progress& progress) {
  const VolumeGeometry geometry = gridGeometry(volume.geometry);
  const CellBox cells = geometry.cells();
  const double voxel = geometry.voxelSize();
  const Eigen::Vector3f spacing = geometry.spacing.cast<float>();
  ZeroedArray<float> out(cells.count());
  CellBox bricks;
  bricks.size = (cells.size.array() + kBrick - 1) / kBrick;
  tbb::enumerable_thread_specific<Brick> workspaces;
  std::array<std::array<std::vector<float>, 3>, kScales.size()> kernels;
  Cell rim = Cell::Zero();
  for (std::size_t s = 0; s < kScales.size(); ++s)
    for (int a = 0; a < 3; ++a) {
      auto& half = kernels[s][static_cast<std::size_t>(a)];
      half = gaussian(kScales[s] * voxel / geometry.spacing[a]);
      rim[a] = std::max(rim[a], static_cast<int>(half.size()));
    }
  const auto work = [&](std::size_t b) {
    Brick& brick = workspaces.local();
    const CellBox core = CellBox{bricks.cell(b) * kBrick, Cell::Constant(kBrick)}.meet(cells);
    brick.box = CellBox::between(core.low - rim, core.high() + rim);
    std::visit([&](const auto& voxels) { brick.take(voxels, cells, sign); }, volume.voxels);
    const auto count = static_cast<std::size_t>(core.size[0]);
    for (std::size_t s = 0; s < kScales.size(); ++s) {
      progress.check();
      brick.smoothed = brick.voxels;
      for (int a = 0; a < 3; ++a) brick.smoothAlong(a, kernels[s][static_cast<std::size_t>(a)]);
      const auto variance = static_cast<float>(kScales[s] * kScales[s] * voxel * voxel);
      eachRow(core, [&](const Cell& first) {
        const std::size_t from = brick.box.index(first);
        float* const best = out.data() + cells.index(first);
        const Curvatures& row = brick.curvatures;
        differentiate(brick.smoothed.data() + from, brick.strides(), spacing, count,
                      brick.curvatures);
        for (std::size_t x = 0; x < count; ++x) {
          // c1 + c2 + c3 <= -(2 - kAlong) |c2| on a ridge, so few voxels need their eigenvalues
          if (!(-row.trace[x] * variance > kLeastCurved * best[x])) continue;
          best[x] = std::max(best[x], variance * measureStrength(row, x));
        }
      });
    }
  };
  tbb::parallel_for(std::size_t{0}, bricks.count(), work);
  return out;
}

}  // namespace lumen::convert
