// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/render.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>

#include <tbb/parallel_for.h>

#include "converters/base/simd.h"
#include "converters/geometry/tube_tree_distance.h"
#include "formats/case/blobby.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr float kUndrawn = 1e6F;
constexpr double kSubvoxels = 3;           // along the least edge of a voxel
constexpr double kHalfDiagonal = 0.50003;  // of the diagonal of a voxel, rounded up
constexpr int kColumns = 64;  // adjacent lines that one pass across rows takes together

/// Faster than VolumeGeometry::position(): the axes are those of LPS.
Vector3d centreOf(const VolumeGeometry& grid, int x, int y, int z) {
  return grid.origin + grid.spacing.cwiseProduct(Vector3d(x, y, z));
}

struct Segment {
  RoundCone cone;
  Vector3d low, high;  // mm: the box of the cone and of the voxels that it may share
};

std::vector<Segment> makeSegments(const formats::CenterlineTree& tree, double margin) {
  std::vector<Segment> segments;
  for (const formats::Branch& branch : tree.branches)
    for (std::uint32_t n = branch.firstNode; n + 1 < branch.firstNode + branch.nodeCount; ++n) {
      const Vector3d a = toEigen(tree.centre[n]), b = toEigen(tree.centre[n + 1]);
      const double ra = static_cast<double>(tree.radius[n]),
                   rb = static_cast<double>(tree.radius[n + 1]);
      segments.push_back({RoundCone(a, ra, b, rb),
                          (a.array() - ra).min(b.array() - rb).matrix().array() - margin,
                          (a.array() + ra).max(b.array() + rb).matrix().array() + margin});
    }
  return segments;
}

// Lowers the signed distances, in mm, of one slab of the image to those of a segment.
void drawSegment(const Segment& segment, const VolumeGeometry& grid, int zFirst, int zLast,
                 Image& image) {
  const auto lowest = [&](int axis, int limit) {
    return std::max(limit, static_cast<int>(std::ceil((segment.low[axis] - grid.origin[axis]) /
                                                      grid.spacing[axis])));
  };
  const auto highest = [&](int axis, int limit) {
    return std::min(limit, static_cast<int>(std::floor((segment.high[axis] - grid.origin[axis]) /
                                                       grid.spacing.x())));
  };
  const int x0 = lowest(0, 0), x1 = highest(0, grid.size[0] - 1);
  for (int z = lowest(2, zFirst); z <= highest(2, zLast); ++z)
    for (int y = lowest(1, 0); y <= highest(1, grid.size[1] - 1); ++y) {
      float* row = image.row(y, z);
      for (int x = x0; x <= x1; ++x)
        row[x] =
            std::min(row[x], static_cast<float>(segment.cone.distance(centreOf(grid, x, y, z))));
    }
}

// The parts of a voxel, about cubic.
class Subvoxels {
public:
  explicit Subvoxels(const Vector3d& voxel)
      : m_count((kSubvoxels * (voxel / voxel.minCoeff()).array()).ceil().cast<int>()),
        m_step(voxel.array() / m_count.cast<double>().array()) {}

  // The mean over the parts around `centre` of share(place).
  template <class Share>
  [[nodiscard]] double mean(const Vector3d& centre, const Share& share) const {
    const Vector3d middle = 0.5 * (m_count.array() - 1).cast<double>().matrix();
    double sum = 0;
    for (int k = 0; k < m_count[2]; ++k)
      for (int j = 0; j < m_count[1]; ++j)
        for (int i = 0; i < m_count[0]; ++i)
          sum += share(centre + m_step.cwiseProduct(Vector3d(i, j, k) - middle));
    return sum / m_count.prod();
  }
  // The share of a part that lies inside of a wall at the distance `distance` from its middle.
  [[nodiscard]] double inside(double distance) const {
    return std::clamp(0.5 - distance / m_step.minCoeff(), 0.0, 1.0);
  }

private:
  Cell m_count;
  Vector3d m_step;  // mm
};

// Integrates occupancy times contrast over the voxel around `centre`.
double integrateOccupancy(const TubeTreeDistance& wall, const std::vector<float>& contrast,
                          const Vector3d& centre, const VolumeGeometry& grid,
                          const Subvoxels& parts, std::vector<std::uint32_t>& near) {
  wall.collect(centre, kHalfDiagonal * grid.spacing.norm(), near);
  return parts.mean(centre, [&](const Vector3d& place) {
    const WallHit hit = wall.nearestAmong(near, place);
    const double a = static_cast<double>(contrast[hit.node]);
    const double b =
        static_cast<double>(contrast[std::min<std::size_t>(hit.node + 1, contrast.size() - 1)]);
    return parts.inside(hit.distance) * (a + hit.along * (b - a));
  });
}

void drawClosedForm(const std::function<double(const Vector3d&)>& wall, const VolumeGeometry& grid,
                    Image& image, Progress& progress) {
  const Subvoxels parts(grid.spacing);
  const double far = 2 * kHalfDiagonal * grid.spacing.norm();
  tbb::parallel_for(0, grid.size[2], [&](int z) {
    progress.check();
    for (int y = 0; y < grid.size[1]; ++y) {
      float* row = image.row(y, z);
      for (int x = 0; x < grid.size[0]; ++x) {
        const Vector3d centre = centreOf(grid, x, y, z);
        const double distance = wall(centre);
        if (std::abs(distance) > far)
          row[x] = distance < 0 ? 1 : 0;
        else
          row[x] = static_cast<float>(
              parts.mean(centre, [&](const Vector3d& place) { return parts.inside(wall(place)); }));
      }
    }
    progress.advance();
  });
}

// Multiplies occupancies by the contrast of the nearest node.
void applyContrast(const Design& design, const VolumeGeometry& grid, Image& image,
                   Progress& progress) {
  tbb::parallel_for(0, grid.size[2], [&](int z) {
    progress.check();
    for (int y = 0; y < grid.size[1]; ++y) {
      float* row = image.row(y, z);
      for (int x = 0; x < grid.size[0]; ++x) {
        if (row[x] == 0) continue;
        const Vector3d centre = centreOf(grid, x, y, z);
        std::uint32_t nearest = 0;
        for (std::uint32_t n = 1; n < design.tree.nodeCount(); ++n)
          if ((toEigen(design.tree.centre[n]) - centre).squaredNorm() <
              (toEigen(design.tree.centre[nearest]) - centre).squaredNorm())
            nearest = n;
        row[x] *= design.contrast[nearest];
      }
    }
  });
}

// out[i] = sum_k weights[k] * in[i + k * stride] over `count` independent lanes.
LUMEN_SIMD_CLONES void weightedSum(const float* in, const float* weights, std::size_t taps,
                                   std::size_t stride, float* out, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) out[i] = 0;
  for (std::size_t k = 0; k < taps; ++k)
    for (std::size_t i = 0; i < count; ++i) out[i] += weights[k] * in[i + k * stride];
}

void blurRows(Image& image, const std::vector<float>& weights, int z) {
  const auto n = static_cast<std::size_t>(image.size[0]), reach = weights.size() / 2;
  std::vector<float> padded(n + 2 * reach);
  for (int y = 0; y < image.size[1]; ++y) {
    float* row = image.row(y, z);
    for (std::size_t i = 0; i < padded.size(); ++i)
      padded[i] = row[std::min(n - 1, i < reach ? 0 : i - reach)];
    weightedSum(padded.data(), weights.data(), weights.size(), 1, row, n);
  }
}

// Lines of n values `step` apart, starting at `first` and its `width` successors.
void blurColumns(float* first, std::size_t n, std::size_t step, std::size_t width,
                 const std::vector<float>& weights, std::vector<float>& padded) {
  const std::size_t reach = weights.size() / 2;
  padded.resize((n + 2 * reach) * width);
  for (std::size_t i = 0; i < n + 2 * reach; ++i) {
    const float* from = first + std::min(n - 1, i < reach ? 0 : i - reach) * step;
    std::copy(from, from + width, padded.begin() + static_cast<std::ptrdiff_t>(i * width));
  }
  for (std::size_t i = 0; i < n; ++i)
    weightedSum(padded.data() + i * width, weights.data(), weights.size(), width, first + i * step,
                width);
}

struct Wave {
  Vector3d perVoxel;  // phase advance, radians
  double phase;
};

std::array<Wave, 4> biasWaves(int n, std::uint64_t seed) {
  Random random(seed, ~std::uint64_t{0});
  std::array<Wave, 4> waves;
  for (Wave& wave : waves) {
    Vector3d direction;
    do direction = randomInCube(random);
    while (direction.norm() < 0.1 || direction.norm() > 1);
    const double periods = random.uniform(0.5, 1.5);
    wave.perVoxel = direction.normalized() * (2 * std::numbers::pi * periods / n);
    wave.phase = random.uniform(0, 2 * std::numbers::pi);
  }
  return waves;
}

// Adds the mean of the waves times `bias` to a row, each wave by turning a phasor from voxel to
// voxel.
void addBias(float* row, int n, int y, double z, const std::array<Wave, 4>& waves, double bias) {
  for (const Wave& wave : waves) {
    const double start = wave.phase + wave.perVoxel.y() * y + wave.perVoxel.z() * z;
    double c = std::cos(start), s = std::sin(start);
    const double turnC = std::cos(wave.perVoxel.x()), turnS = std::sin(wave.perVoxel.x());
    for (int x = 0; x < n; ++x) {
      row[x] += static_cast<float>(0.25 * bias * c);
      const double next = c * turnC - s * turnS;
      s = s * turnC + c * turnS;
      c = next;
    }
  }
}

}  // namespace

Image drawOccupancy(const Design& design, const VolumeGeometry& grid, Progress& progress) {
  const auto [nx, ny, nz] = grid.size;
  Image image{grid.cells().size, std::vector<float>(grid.voxelCount(), kUndrawn)};
  const bool uniform = std::all_of(design.contrast.begin(), design.contrast.end(),
                                   [](float c) { return c == 1.0F; });
  if (design.wall) {
    drawClosedForm(design.wall, grid, image, progress);
    if (!uniform) applyContrast(design, grid, image, progress);
    return image;
  }
  const Subvoxels parts(grid.spacing);
  const double rim = kHalfDiagonal * grid.spacing.norm();
  const std::vector<Segment> segments = makeSegments(design.tree, rim);
  const TubeTreeDistance wall(design.tree);
  constexpr int kSlab = 4;
  tbb::parallel_for(0, (nz + kSlab - 1) / kSlab, [&, nx = nx, ny = ny, nz = nz](int slab) {
    const int zFirst = slab * kSlab, zLast = std::min(nz, zFirst + kSlab) - 1;
    for (const Segment& segment : segments)
      if (segment.high.z() >= centreOf(grid, 0, 0, zFirst).z() &&
          segment.low.z() <= centreOf(grid, 0, 0, zLast).z()) {
        progress.check();
        drawSegment(segment, grid, zFirst, zLast, image);
      }
    std::vector<std::uint32_t> near;
    for (int z = zFirst; z <= zLast; ++z) {
      progress.check();
      for (int y = 0; y < ny; ++y) {
        float* row = image.row(y, z);
        for (int x = 0; x < nx; ++x) {
          const double distance = static_cast<double>(row[x]);
          if (distance >= rim)
            row[x] = 0;
          else if (distance <= -rim && uniform)
            row[x] = 1;
          else
            row[x] = static_cast<float>(integrateOccupancy(
                wall, design.contrast, centreOf(grid, x, y, z), grid, parts, near));
        }
      }
      progress.advance();
    }
  });
  return image;
}

std::vector<float> gaussianWeights(double sigma) {
  if (sigma <= 0) return {1.0F};
  const int reach = std::max(1, static_cast<int>(std::ceil(4 * sigma)));
  std::vector<double> weights;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    weights.push_back(formats::repeatableExp(-0.5 * i * i / (sigma * sigma)));
    sum += weights.back();
  }
  std::vector<float> normalised;
  for (const double w : weights) normalised.push_back(static_cast<float>(w / sum));
  return normalised;
}

void blur(Image& image, const Vector3d& sigma, Progress& progress) {
  if (sigma.maxCoeff() <= 0) return;
  const std::array<std::vector<float>, 3> weights = {
      gaussianWeights(sigma[0]), gaussianWeights(sigma[1]), gaussianWeights(sigma[2])};
  const auto nx = static_cast<std::size_t>(image.size[0]),
             ny = static_cast<std::size_t>(image.size[1]),
             nz = static_cast<std::size_t>(image.size[2]);
  const auto columns = [&](float* first, std::size_t n, int axis, std::vector<float>& padded) {
    for (std::size_t x = 0; x < nx; x += kColumns)
      blurColumns(first + x, n, axis == 1 ? nx : nx * ny, std::min<std::size_t>(kColumns, nx - x),
                  weights[static_cast<std::size_t>(axis)], padded);
  };
  tbb::parallel_for(0, image.size[2], [&](int z) {
    progress.check();
    std::vector<float> padded;
    blurRows(image, weights[0], z);
    columns(image.row(0, z), ny, 1, padded);
    progress.advance();
  });
  tbb::parallel_for(0, image.size[1], [&](int y) {
    progress.check();
    std::vector<float> padded;
    columns(image.row(y, 0), nz, 2, padded);
    progress.advance();
  });
}

Image averageSlices(const Image& image, double thickness) {
  const std::size_t slice = image.index(0, 1);
  const int count = static_cast<int>(image.size[2] / thickness * (1 + 1e-12));
  Image thick{{image.size[0], image.size[1], count},
              std::vector<float>(slice * static_cast<std::size_t>(count), 0.0F)};
  tbb::parallel_for(0, count, [&](int k) {
    // voxel z reaches from z to z + 1
    const double low = k * thickness, high = low + thickness;
    float* out = thick.row(0, k);
    for (int z = static_cast<int>(low); z < image.size[2] && z < high; ++z) {
      const auto weight = static_cast<float>(
          (std::min(high, z + 1.0) - std::max(low, static_cast<double>(z))) / thickness);
      const float* in = image.value.data() + image.index(0, z);
      for (std::size_t i = 0; i < slice; ++i) out[i] += weight * in[i];
    }
  });
  return thick;
}

double countedNormal(Random& random) {
  const int ones = std::popcount(random.next()) + std::popcount(random.next());
  const std::uint64_t bits = random.next();
  const double u = static_cast<double>(bits >> 32) * 0x1.0p-32;
  const double v = static_cast<double>(bits & 0xffffffffU) * 0x1.0p-32;
  // the variances add: 128 / 4 of the count, 1 / 12 of each uniform deviate
  constexpr double kPerDeviation = 0.17632035;  // 1 / sqrt(32 + 1 / 6)
  return (ones - 64 + (u + v - 1)) * kPerDeviation;
}

std::vector<std::int16_t> degrade(Image& image, double bias, double noise, std::uint64_t seed,
                                  double thickness, Progress& progress) {
  const int nx = image.size[0], ny = image.size[1], nz = image.size[2];
  const int depth = static_cast<int>(std::lround(nz * thickness));
  const std::array<Wave, 4> waves = biasWaves(std::max({nx, ny, depth}), seed);
  std::vector<std::int16_t> voxels(image.value.size());
  tbb::parallel_for(0, nz, [&](int z) {
    progress.check();
    for (int y = 0; y < ny; ++y) {
      float* row = image.row(y, z);
      const std::size_t line =
          static_cast<std::size_t>(z) * static_cast<std::size_t>(ny) + static_cast<std::size_t>(y);
      if (bias > 0) addBias(row, nx, y, thickness * z, waves, bias);
      Random random(seed, line);
      std::int16_t* out = voxels.data() + image.index(y, z);
      for (int x = 0; x < nx; ++x) {
        double value = static_cast<double>(row[x]);
        if (noise > 0) value += noise * countedNormal(random);
        out[x] = static_cast<std::int16_t>(
            std::clamp(std::nearbyint(kBackground + kContrast * value), -32768.0, 32767.0));
      }
    }
    progress.advance();
  });
  return voxels;
}

}  // namespace lumen::convert
