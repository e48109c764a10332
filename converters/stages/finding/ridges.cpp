// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/ridges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <variant>

#include <Eigen/Eigenvalues>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "converters/base/simd.h"
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

/// The sums of the second derivatives along the axes at adjacent voxels, the traces of hessianAt().
LUMEN_SIMD_CLONES
void laplacians(const float* __restrict v, const std::array<std::ptrdiff_t, 3>& stride,
                const Eigen::Vector3f& spacing, float* __restrict out, std::ptrdiff_t count) {
  const std::ptrdiff_t p = stride[0], q = stride[1], r = stride[2];
  const float a = spacing[0] * spacing[0], b = spacing[1] * spacing[1], c = spacing[2] * spacing[2];
  for (std::ptrdiff_t x = 0; x < count; ++x)
    out[x] = (v[x + p] + v[x - p] - 2 * v[x]) / a + (v[x + q] + v[x - q] - 2 * v[x]) / b +
             (v[x + r] + v[x - r] - 2 * v[x]) / c;
}

/// A brick of voxels with a rim, and room to smooth it.
struct Brick {
  CellBox box;
  std::vector<float> voxels, smoothed, buffer;
  std::vector<float> traces;  ///< of a row

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

/// The strength of a ridge whose second derivatives are `hessian`, per mm^2; 0 if it is none.
float measureStrength(const Eigen::Matrix3f& hessian) {
  const float sum = hessian.trace();
  if (!(sum < 0)) return 0;
  const float products = 0.5F * (sum * sum - hessian.squaredNorm());
  if (products < kLeastProducts * sum * sum) return 0;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(hessian, Eigen::EigenvaluesOnly);
  const Eigen::Vector3f curved = solver.eigenvalues();  // ascending
  if (!(curved[1] < 0) || curved[1] > kRound * curved[0]) return 0;
  return std::abs(curved[2]) > -kAlong * curved[1] ? 0.0F : -curved[1];
}

/// Second derivatives of the smoothed brick at a voxel, by its neighbours.
Eigen::Matrix3f hessianAt(const Brick& brick, std::size_t i, const Eigen::Vector3f& spacing) {
  const float* v = brick.smoothed.data() + i;
  const std::array<std::ptrdiff_t, 3> step = brick.strides();
  Eigen::Matrix3f h;
  for (int a = 0; a < 3; ++a) {
    const std::ptrdiff_t p = step[static_cast<std::size_t>(a)];
    h(a, a) = (v[p] + v[-p] - 2 * v[0]) / (spacing[a] * spacing[a]);
    for (int b = 0; b < a; ++b) {
      const std::ptrdiff_t q = step[static_cast<std::size_t>(b)];
      h(a, b) = h(b, a) =
          (v[p + q] + v[-p - q] - v[p - q] - v[q - p]) / (4 * spacing[a] * spacing[b]);
    }
  }
  return h;
}

/// Calls visit(cell) for the first cell of every row along x.
template <class Visit>
void eachRow(const CellBox& box, const Visit& visit) {
  CellBox firsts = box;
  firsts.size[0] = 1;
  firsts.forEach(visit);
}

}  // namespace

std::vector<float> ridgeStrength(const Volume& volume, float sign, const Progress& progress) {
  const VolumeGeometry geometry = gridGeometry(volume.geometry);
  const CellBox cells = geometry.cells();
  const double voxel = geometry.voxelSize();
  const Eigen::Vector3f spacing = geometry.spacing.cast<float>();
  std::vector<float> out(cells.count(), 0.0F);
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
    for (std::size_t s = 0; s < kScales.size(); ++s) {
      progress.check();
      brick.smoothed = brick.voxels;
      for (int a = 0; a < 3; ++a) brick.smoothAlong(a, kernels[s][static_cast<std::size_t>(a)]);
      const auto variance = static_cast<float>(kScales[s] * kScales[s] * voxel * voxel);
      eachRow(core, [&](const Cell& first) {
        const std::size_t from = brick.box.index(first);
        float* const best = out.data() + cells.index(first);
        brick.traces.resize(static_cast<std::size_t>(core.size[0]));
        laplacians(brick.smoothed.data() + from, brick.strides(), spacing, brick.traces.data(),
                   core.size[0]);
        for (std::size_t x = 0; x < brick.traces.size(); ++x) {
          // c1 + c2 + c3 <= -(2 - kAlong) |c2| on a ridge, so few voxels need their eigenvalues
          if (!(-brick.traces[x] * variance > kLeastCurved * best[x])) continue;
          best[x] =
              std::max(best[x], variance * measureStrength(hessianAt(brick, from + x, spacing)));
        }
      });
    }
  };
  tbb::parallel_for(std::size_t{0}, bricks.count(), work);
  return out;
}

}  // namespace lumen::convert
