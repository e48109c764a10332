// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/bspline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "converters/base/simd.h"
#include "formats/case/blobby.h"

namespace lumen::convert {
namespace {

// A brick serves kBrick^3 cells. A sample in cell i reads coefficients i-1 .. i+2, so each axis
// stores kBrick + 3 of them and every 4x4x4 support lies in one brick. Rows are padded to a
// multiple of 4.
constexpr int kBrickShift = 5;
constexpr int kBrick = 1 << kBrickShift;
constexpr int kStored = kBrick + 3;
constexpr int kRow = kStored + 1;
constexpr int kPlane = kRow * kStored;
constexpr std::size_t kBrickFloats = static_cast<std::size_t>(kPlane) * kStored;

// The prefilter's impulse response is sqrt(3) z^|n| with z = sqrt(3) - 2. Cut after kHalo terms on
// each side, its tail is at most 2e-7 of the voxels' range, the size of float rounding.
constexpr int kHalo = 12;
constexpr int kPadded = kStored + 2 * kHalo;
constexpr int kPaddedRow = (kPadded + 3) / 4 * 4;

using Taps = std::array<float, kHalo + 1>;

/// One side of the truncated symmetric filter, scaled so that a constant is preserved: the
/// prefilter after a Gaussian of `sigma` voxels.
Taps makeTaps(double sigma) {
  const double pole = std::sqrt(3.0) - 2.0;
  std::array<double, 4 * kHalo + 1> gauss{1.0}, prefilter{1.0};
  for (std::size_t n = 1; n < gauss.size(); ++n) {
    const double x = static_cast<double>(n);
    gauss[n] = sigma > 0 ? formats::repeatableExp(-0.5 * x * x / (sigma * sigma)) : 0.0;
    prefilter[n] = prefilter[n - 1] * pole;
  }
  std::array<double, kHalo + 1> exact{};
  double sum = 0;
  for (int n = 0; n <= kHalo; ++n) {
    double& tap = exact[static_cast<std::size_t>(n)];
    for (int m = -3 * kHalo; m <= 3 * kHalo; ++m)
      tap += gauss[static_cast<std::size_t>(std::abs(m))] *
             prefilter[static_cast<std::size_t>(std::abs(n - m))];
    sum += n == 0 ? tap : 2 * tap;
  }
  Taps taps{};
  for (std::size_t n = 0; n < taps.size(); ++n) taps[n] = static_cast<float>(exact[n] / sum);
  return taps;
}

/// out[x] = sum_n taps[|n|] in[x + n * stride] for `count` adjacent x.
LUMEN_SIMD_CLONES
void filterRun(const float* __restrict in, std::ptrdiff_t stride, const float* __restrict taps,
               float* __restrict out, int count) {
  for (int x = 0; x < count; ++x) {
    float sum = taps[0] * in[x];
    for (std::ptrdiff_t n = 1; n <= kHalo; ++n)
      sum += taps[n] * (in[x - n * stride] + in[x + n * stride]);
    out[x] = sum;
  }
}

/// Index `i` of the infinite signal that repeats voxels 0 .. n-1 mirrored about both end voxels.
int mirror(int i, int n) {
  if (n == 1) return 0;
  const int period = 2 * (n - 1);
  i %= period;
  if (i < 0) i += period;
  return i < n ? i : period - i;
}

/// The weights of coefficients i-1 .. i+2 at i + t, t in [0, 1].
std::array<double, 4> weightsAt(double t) {
  const double u = 1 - t;
  return {u * u * u / 6, 2.0 / 3 + t * t * (t / 2 - 1), 2.0 / 3 + u * u * (u / 2 - 1),
          t * t * t / 6};
}

// ---- blocks of samples on a line ----

constexpr int kBlock = 64;
constexpr int kBeyond = 8;  // room behind a block for a group of lanes that begins in it
using BlockFloats = std::array<float, kBlock>;
using BlockValues = std::array<float, kBlock + kBeyond>;

/// Samples as a structure of arrays.
struct alignas(64) Block {
  std::array<BlockFloats, 3> t;  ///< position inside the cell
  std::array<std::array<int, kBlock>, 3> cell;
  std::array<int, kBlock> inside;            ///< 0 or 1
  std::array<int, kBlock> brick, offset;     ///< brick, and offset of the 4x4x4 support in it
  std::array<const float*, kBlock> support;  ///< null outside
  std::array<std::array<BlockValues, 4>, 3> weight;
};

/// Data of a line and of the volume for `locate`.
struct LineSetup {
  std::array<double, 3> start, step, highest;
  std::array<int, 3> lastCell, bricks;
};

/// Fills all of a block but `support`, for samples first .. first + kBlock - 1 of the line.
LUMEN_SIMD_CLONES
void locate(const LineSetup& line, int first, Block& block) {
  block.inside.fill(1);
  for (std::size_t a = 0; a < 3; ++a) {
    const double start = line.start[a], step = line.step[a], highest = line.highest[a];
    const int lastCell = line.lastCell[a];
    for (std::size_t i = 0; i < kBlock; ++i) {
      const double at = start + static_cast<double>(first + static_cast<int>(i)) * step;
      const bool inside = (at >= 0) & (at <= highest);
      const double safe = inside ? at : 0.0;
      int cell = static_cast<int>(safe);
      cell = cell < lastCell ? cell : lastCell;
      block.inside[i] &= inside ? 1 : 0;
      block.cell[a][i] = cell;
      block.t[a][i] = static_cast<float>(safe - static_cast<double>(cell));
    }
    for (std::size_t i = 0; i < kBlock; ++i) {
      const float t = block.t[a][i], u = 1 - t;
      block.weight[a][0][i] = u * u * u * (1.0F / 6);
      block.weight[a][1][i] = 2.0F / 3 + t * t * (0.5F * t - 1);
      block.weight[a][2][i] = 2.0F / 3 + u * u * (0.5F * u - 1);
      block.weight[a][3][i] = t * t * t * (1.0F / 6);
    }
  }
  constexpr int mask = kBrick - 1;
  for (std::size_t i = 0; i < kBlock; ++i) {
    const int x = block.cell[0][i], y = block.cell[1][i], z = block.cell[2][i];
    block.brick[i] = ((z >> kBrickShift) * line.bricks[1] + (y >> kBrickShift)) * line.bricks[0] +
                     (x >> kBrickShift);
    block.offset[i] = (z & mask) * kPlane + (y & mask) * kRow + (x & mask);
  }
}

// Samples side by side, whose sums do not depend on how many these are: WebAssembly has four lanes, and half of eight would
// most often be beyond a run.
#if defined(__wasm__)
constexpr std::size_t kLanes = 4;
#else
constexpr std::size_t kLanes = 8;
#endif
typedef float Lanes __attribute__((vector_size(4 * kLanes)));
typedef float LooseLanes __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));
static_assert(kBeyond >= kLanes);

/// The 64-term sum of each sample: over y, then z, then x. A line stays in a cell for a while, so its
/// samples come in runs that share a support; each is computed in whole groups of lanes, and what such
/// a group holds beyond its run is overwritten by the next.
LUMEN_SIMD_CLONES
void interpolate(const Block& block, std::size_t count, float* out) {
  const auto& [wx, wy, wz] = block.weight;
  for (std::size_t i = 0; i < count;) {
    const float* support = block.support[i];
    std::size_t end = i + 1;
    while (end < count && block.support[end] == support) ++end;
    for (; support != nullptr && i < end; i += kLanes) {
      const Lanes y0 = *reinterpret_cast<const LooseLanes*>(&wy[0][i]),
                  y1 = *reinterpret_cast<const LooseLanes*>(&wy[1][i]),
                  y2 = *reinterpret_cast<const LooseLanes*>(&wy[2][i]),
                  y3 = *reinterpret_cast<const LooseLanes*>(&wy[3][i]);
      std::array<Lanes, 4> sum{};
      for (std::size_t k = 0; k < 4; ++k) {
        const float* c = support + k * kPlane;
        const Lanes z = *reinterpret_cast<const LooseLanes*>(&wz[k][i]);
        for (std::size_t x = 0; x < 4; ++x, ++c)
          sum[x] += z * ((y0 * c[0] + y1 * c[kRow]) + (y2 * c[2 * kRow] + y3 * c[3 * kRow]));
      }
      for (std::size_t x = 0; x < 4; ++x) sum[x] *= *reinterpret_cast<const LooseLanes*>(&wx[x][i]);
      const Lanes all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
      *reinterpret_cast<LooseLanes*>(out + i) = all;
    }
    if (support == nullptr) std::fill(out + i, out + end, std::numeric_limits<float>::quiet_NaN());
    i = end;
  }
}

}  // namespace

struct BsplineVolume::Bricks {
  const Volume& volume;
  VolumeGeometry geometry;        ///< in place of the volume's
  std::array<int, 3> lastCell{};  ///< cells are 0 .. lastCell; a single voxel still makes one cell
  std::array<int, 3> count{};     ///< bricks along each axis
  std::array<Taps, 3> taps;
  std::vector<std::atomic<float*>> coefficients;
  std::atomic<std::size_t> built{0};

  Bricks(const Volume& v, const VolumeGeometry& g, const Eigen::Vector3d& smoothing)
      : volume(v), geometry(g) {
    std::size_t total = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<Eigen::Index>(a);
      taps[a] = makeTaps(smoothing[axis] / g.spacing[axis]);
      lastCell[a] = std::max(g.size[a] - 2, 0);
      count[a] = (lastCell[a] >> kBrickShift) + 1;
      total *= static_cast<std::size_t>(count[a]);
    }
    coefficients = std::vector<std::atomic<float*>>(total);
  }
  ~Bricks() {
    for (auto& c : coefficients) delete[] c.load(std::memory_order_relaxed);
  }
  Bricks(const Bricks&) = delete;
  Bricks& operator=(const Bricks&) = delete;

  const float* at(std::size_t id) {
    const float* ready = coefficients[id].load(std::memory_order_acquire);
    return ready ? ready : build(id);
  }
  const float* build(std::size_t id);
  template <class T>
  void filter(const std::vector<T>& voxels, const std::array<int, 3>& low, float* out) const;
};

/// Several threads may build the same brick; they compute the same bytes and the first one is kept.
const float* BsplineVolume::Bricks::build(std::size_t id) {
  const auto n = static_cast<int>(id);
  const std::array<int, 3> low{(n % count[0]) * kBrick - 1, (n / count[0] % count[1]) * kBrick - 1,
                               (n / count[0] / count[1]) * kBrick - 1};
  auto fresh = std::make_unique_for_overwrite<float[]>(kBrickFloats);
  std::visit([&](const auto& voxels) { filter(voxels, low, fresh.get()); }, volume.voxels);
  float* expected = nullptr;
  if (!coefficients[id].compare_exchange_strong(expected, fresh.get(), std::memory_order_acq_rel))
    return expected;
  built.fetch_add(1, std::memory_order_relaxed);
  return fresh.release();
}

/// The coefficients with indices low .. low + kStored - 1 on each axis. Each is a fixed sum over
/// the voxels around it, so bricks that share a coefficient agree on it bitwise.
template <class T>
void BsplineVolume::Bricks::filter(const std::vector<T>& voxels, const std::array<int, 3>& low,
                                   float* out) const {
  const auto& size = geometry.size;
  std::array<std::array<std::size_t, kPadded>, 3> source;
  for (std::size_t a = 0; a < 3; ++a)
    for (int i = 0; i < kPadded; ++i)
      source[a][static_cast<std::size_t>(i)] =
          static_cast<std::size_t>(mirror(low[a] - kHalo + i, size[a]));
  const auto nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]);

  const auto planes =
      std::make_unique_for_overwrite<float[]>(static_cast<std::size_t>(kPlane) * kPadded);
  std::array<float, static_cast<std::size_t>(kRow) * kPadded> rows;
  std::array<float, kPaddedRow> line{};
  rows.fill(0);
  for (std::size_t z = 0; z < kPadded; ++z) {
    for (std::size_t y = 0; y < kPadded; ++y) {
      const T* from = voxels.data() + (source[2][z] * ny + source[1][y]) * nx;
      for (std::size_t x = 0; x < kPadded; ++x) line[x] = static_cast<float>(from[source[0][x]]);
      filterRun(line.data() + kHalo, 1, taps[0].data(), rows.data() + y * kRow, kStored);
    }
    // rows are contiguous, so the y filter of a whole plane is one run
    filterRun(rows.data() + kHalo * kRow, kRow, taps[1].data(), planes.get() + z * kPlane, kPlane);
  }
  filterRun(planes.get() + static_cast<std::size_t>(kHalo) * kPlane, kPlane, taps[2].data(), out,
            static_cast<int>(kBrickFloats));
}

BsplineVolume::BsplineVolume(const Volume& volume, const Eigen::Vector3d& smoothing)
    : BsplineVolume(volume, volume.geometry, smoothing) {}
BsplineVolume::BsplineVolume(const Volume& volume, const VolumeGeometry& geometry,
                             const Eigen::Vector3d& smoothing)
    : m_bricks(std::make_unique<Bricks>(volume, geometry, smoothing)) {}
BsplineVolume::~BsplineVolume() = default;

const VolumeGeometry& BsplineVolume::geometry() const {
  return m_bricks->geometry;
}

std::size_t BsplineVolume::coefficientBytes() const {
  return m_bricks->built.load(std::memory_order_relaxed) * kBrickFloats * sizeof(float);
}

float BsplineVolume::sample(const Eigen::Vector3d& index) const {
  const auto& g = m_bricks->geometry;
  if (!g.containsIndex(index)) return std::numeric_limits<float>::quiet_NaN();
  std::array<int, 3> cell{};
  for (int a = 0; a < 3; ++a) {
    const auto u = static_cast<std::size_t>(a);
    cell[u] = std::min(static_cast<int>(index[a]), m_bricks->lastCell[u]);
  }
  const auto& count = m_bricks->count;
  const int id = ((cell[2] >> kBrickShift) * count[1] + (cell[1] >> kBrickShift)) * count[0] +
                 (cell[0] >> kBrickShift);
  constexpr int mask = kBrick - 1;
  const float* c = m_bricks->at(static_cast<std::size_t>(id)) + (cell[2] & mask) * kPlane +
                   (cell[1] & mask) * kRow + (cell[0] & mask);
  const auto x = weightsAt(index[0] - cell[0]), y = weightsAt(index[1] - cell[1]),
             z = weightsAt(index[2] - cell[2]);
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i)
        sum += z[k] * y[j] * x[i] * static_cast<double>(c[k * kPlane + j * kRow + i]);
  return static_cast<float>(sum);
}

void BsplineVolume::sampleLineReference(const Eigen::Vector3d& startIndex,
                                        const Eigen::Vector3d& stepIndex,
                                        std::span<float> out) const {
  for (std::size_t n = 0; n < out.size(); ++n)
    out[n] = sample(startIndex + static_cast<double>(n) * stepIndex);
}

void BsplineVolume::sampleLine(const Eigen::Vector3d& startIndex, const Eigen::Vector3d& stepIndex,
                               std::span<float> out) const {
  LineSetup line{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto e = static_cast<Eigen::Index>(a);
    line.start[a] = startIndex[e];
    line.step[a] = stepIndex[e];
    line.highest[a] = m_bricks->geometry.size[a] - 1;
  }
  line.lastCell = m_bricks->lastCell;
  line.bricks = m_bricks->count;
  Block block;
  for (auto& axis : block.weight)
    for (BlockValues& weight : axis) std::fill(weight.begin() + kBlock, weight.end(), 0.0F);
  BlockValues values;
  int brick = -1;
  const float* coefficients = nullptr;
  for (std::size_t first = 0; first < out.size(); first += kBlock) {
    locate(line, static_cast<int>(first), block);
    const std::size_t count = std::min<std::size_t>(kBlock, out.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      if (block.inside[i] != 0 && block.brick[i] != brick) {
        brick = block.brick[i];
        coefficients = m_bricks->at(static_cast<std::size_t>(brick));
      }
      block.support[i] = block.inside[i] != 0 ? coefficients + block.offset[i] : nullptr;
    }
    interpolate(block, count, values.data());
    std::copy_n(values.begin(), count, out.begin() + static_cast<std::ptrdiff_t>(first));
  }
  if (!geometry().image) return;
  for (std::size_t n = 0; n < out.size(); ++n)
    if (!geometry().containsIndex(startIndex + static_cast<double>(n) * stepIndex))
      out[n] = std::numeric_limits<float>::quiet_NaN();
}

}  // namespace lumen::convert
