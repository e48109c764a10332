// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/scan_look.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "converters/base/error.h"
#include "converters/base/otsu.h"
#include "converters/base/statistics.h"
#include "converters/voxels/bspline.h"
#include "converters/voxels/profile_edge.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kBins = 1024;          // of the histogram
constexpr std::size_t kSamples = 1'000'000;  // voxels that medians and the histogram take, at most
constexpr double kSoftDeviations = 4;        // of the tissue's levels: bone is beyond
constexpr int kBlock = 6;                    // voxels along the edge of a block of soft tissue
constexpr double kQuiet = 0.25;              // quantile of the blocks that hold noise alone
// Variances of a quiet block, at most, where neighbours are compared: the quiet quarter alone has less
// of what neighbours share, while blocks with the variance of noise are rarely beyond.
constexpr double kMostNoise = 2;
constexpr std::size_t kFewestBlocks = 8;
constexpr std::size_t kMostPlaces = 20'000;  // on the surface, to bound the time
constexpr std::size_t kFewestPlaces = 16;    // that face along an axis
constexpr double kFacing = 0.9;  // cosine between a surface's normal and an axis, at least
// Quantile of the widths. Folds and hair widen edges, and a spline does where one lies between voxels: in
// steps blurred by 0.6 voxels by up to a third, at this quantile by 3 %.
constexpr double kNarrow = 0.25;
constexpr int kPerVoxel = 10;    // samples of a profile
constexpr int kReachVoxels = 5;  // of a profile to either side of the surface
constexpr double kFlat = 0.25;   // of the step, the greatest difference of a level from its side's

// Values spread evenly over the volume.
std::vector<double> sampled(const Volume& volume) {
  const std::size_t count = volume.geometry.voxelCount();
  const std::size_t step = count / kSamples + 1;
  std::vector<double> values;
  for (std::size_t i = 0; i < count; i += step) values.push_back(valueAt(volume, i));
  return values;
}

double otsuThreshold(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double width = (*high - *low) / kBins;
  if (!(width > 0)) return *low;
  std::vector<std::size_t> count(kBins, 0);
  for (const double v : values)
    ++count[std::min(kBins - 1, static_cast<std::size_t>((v - *low) / width))];
  return *low + static_cast<double>(otsuSplit(count, 0)) * width;
}

struct BlockNoise {
  double variance = 0;
  Vector3d covariance = Vector3d::Zero();  // of neighbours along each axis
};

// The noise of a block without its slope; empty where a voxel is not soft.
std::optional<BlockNoise> noiseOf(const Volume& volume, const ScanLook& look,
                                  const CellBox& block) {
  std::vector<double> values;
  double mean = 0;
  Vector3d slope = Vector3d::Zero();
  const Vector3d middle = block.low.cast<double>() + Vector3d::Constant(0.5 * (kBlock - 1));
  for (std::size_t i = 0; i < block.count(); ++i) {
    const Cell cell = block.cell(i);
    values.push_back(valueAt(volume, volume.geometry.index(cell)));
    if (!look.isSoft(values.back())) return std::nullopt;
    mean += values.back();
    slope += values.back() * (cell.cast<double>() - middle);
  }
  const auto count = static_cast<double>(block.count());
  mean /= count;
  slope /= count * (kBlock * kBlock - 1) / 12.0;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] -= mean + slope.dot(block.cell(i).cast<double>() - middle);
  BlockNoise noise;
  for (const double v : values) noise.variance += v * v / (count - 4);
  for (int a = 0; a < 3; ++a) {
    const std::size_t stride = block.stride(a);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (block.cell(i)[a] < block.high()[a])
        noise.covariance[a] += values[i] * values[i + stride] / (count * (kBlock - 1.0) / kBlock);
  }
  return noise;
}

void measureNoise(const Volume& volume, const Progress& progress, ScanLook& look) {
  std::vector<BlockNoise> blocks;
  const CellBox cells = volume.geometry.cells();
  const CellBox grid{Cell::Zero(), cells.size / kBlock};
  for (std::size_t b = 0; b < grid.count(); ++b) {
    if (b % 4096 == 0) progress.check();
    if (const auto noise = noiseOf(volume, look, {grid.cell(b) * kBlock, Cell::Constant(kBlock)}))
      blocks.push_back(*noise);
  }
  if (blocks.size() < kFewestBlocks)
    throw invalidInput("the volume has " + std::to_string(blocks.size()) +
                       " blocks of even tissue, expected at least " +
                       std::to_string(kFewestBlocks) +
                       ", in which its noise is measured: a scan with air and soft tissue");
  std::vector<double> variances;
  for (const BlockNoise& block : blocks) variances.push_back(block.variance);
  const double quiet = lowerQuantile(variances, kQuiet);
  BlockNoise sum;
  for (const BlockNoise& block : blocks) {
    if (block.variance > kMostNoise * quiet) continue;
    sum.variance += block.variance;
    sum.covariance += block.covariance;
  }
  look.noise = std::sqrt(quiet);
  if (sum.variance > 0) look.grain = (sum.covariance / sum.variance).cwiseMax(0);
}

// A voxel of tissue beside air, away from the volume's faces.
bool isOnSurface(const Volume& volume, double border, std::size_t index) {
  const CellBox cells = volume.geometry.cells();
  const Cell cell = cells.cell(index);
  if (((cell - cells.low).array() < kReachVoxels).any() ||
      ((cells.high() - cell).array() < kReachVoxels).any() || valueAt(volume, index) <= border)
    return false;
  return std::any_of(kFaceSteps.begin(), kFaceSteps.end(), [&](const Cell& step) {
    return valueAt(volume, cells.index(cell + step)) <= border;
  });
}

struct SurfaceWidth {
  Vector3d normal;   // unit, along the index axes, towards the air
  double width = 0;  // mm
};

// The width of the edge at a voxel on the surface, along its normal; empty unless it leads from even
// tissue to even air.
std::optional<SurfaceWidth> widthAt(const Volume& volume, const BsplineVolume& spline,
                                    const ScanLook& look, double air, std::size_t index) {
  const VolumeGeometry& geometry = volume.geometry;
  const Cell cell = geometry.cell(index);
  Vector3d normal;
  for (int a = 0; a < 3; ++a) {
    const Cell step = Cell::Unit(a);
    normal[a] = (valueAt(volume, geometry.index(cell - step)) -
                 valueAt(volume, geometry.index(cell + step))) /
                geometry.spacing[a];
  }
  if (normal.norm() == 0) return std::nullopt;
  normal.normalize();
  // a profile as fine as the voxel is long in its direction
  const double voxel = 1 / normal.cwiseQuotient(geometry.spacing).norm();
  const Vector3d step = (normal * (voxel / kPerVoxel)).cwiseQuotient(geometry.spacing);
  std::array<float, 2 * kReachVoxels * kPerVoxel + 1> values{};
  spline.sampleLine(cell.cast<double>() - kReachVoxels * kPerVoxel * step, step, values);
  std::array<double, values.size()> fall{};
  for (std::size_t i = 1; i + 1 < values.size(); ++i)
    fall[i] = static_cast<double>(values[i - 1] - values[i + 1]);
  const auto level = [&](std::size_t first) {
    double sum = 0;
    for (std::size_t i = first; i < first + kPerVoxel; ++i) sum += static_cast<double>(values[i]);
    return sum / kPerVoxel;
  };
  const double most = kFlat * (look.tissue - air);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
    if (!(std::abs(level(i * kPerVoxel) - look.tissue) <= most &&
          std::abs(level(values.size() - (i + 1) * kPerVoxel) - air) <= most))
      return std::nullopt;
  const FallWidth steepest = fallWidth(fall, 2 * kPerVoxel);
  if (steepest.width == 0) return std::nullopt;
  return SurfaceWidth{normal, steepest.width * voxel / kPerVoxel};
}

std::vector<SurfaceWidth> surfaceWidths(const Volume& volume, const ScanLook& look,
                                        const Progress& progress) {
  std::vector<std::size_t> surface;
  std::vector<double> dark;
  const std::size_t count = volume.geometry.voxelCount(), step = count / kSamples + 1;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 1'000'000 == 0) progress.check();
    if (isOnSurface(volume, look.border, i)) surface.push_back(i);
    if (i % step == 0 && valueAt(volume, i) <= look.border) dark.push_back(valueAt(volume, i));
  }
  if (dark.empty()) return {};
  const double air = upperMedian(dark);
  const BsplineVolume spline(volume);
  std::vector<SurfaceWidth> widths;
  const std::size_t places = std::min(surface.size(), kMostPlaces);
  for (std::size_t i = 0; i < places; ++i) {
    if (i % 256 == 0) progress.check();
    if (const auto width = widthAt(volume, spline, look, air, surface[i * surface.size() / places]))
      widths.push_back(*width);
  }
  return widths;
}

void measureSpread(const Volume& volume, const Progress& progress, ScanLook& look) {
  const std::vector<SurfaceWidth> widths = surfaceWidths(volume, look, progress);
  for (int a = 0; a < 3; ++a) {
    std::vector<double> facing;
    for (const SurfaceWidth& place : widths)
      if (std::abs(place.normal[a]) >= kFacing) facing.push_back(place.width);
    if (facing.size() < kFewestPlaces)
      throw invalidInput("the volume has " + std::to_string(facing.size()) +
                         " places where tissue meets air along the axis " + "ijk"[a] +
                         ", expected at least " + std::to_string(kFewestPlaces) +
                         ", at which its point spread is measured");
    look.spread[a] = lowerQuantile(facing, kNarrow) / kWidthAtHalfHeight;
  }
}

}  // namespace

double valueAt(const Volume& volume, std::size_t index) {
  return std::visit([&](const auto& voxels) { return static_cast<double>(voxels[index]); },
                    volume.voxels);
}

ScanLook measureScan(const Volume& volume, const Progress& progress) {
  ScanLook look;
  std::vector<double> values = sampled(volume);
  look.border = otsuThreshold(values);
  std::erase_if(values, [&](double v) { return v <= look.border; });
  if (values.empty())
    throw invalidInput("the volume's voxels are all equal, expected a scan with air and tissue");
  look.tissue = upperMedian(values);
  for (double& v : values) v = std::abs(v - look.tissue);
  look.reach = kSoftDeviations * kDeviationOfMedian * upperMedian(values);
  measureNoise(volume, progress, look);
  measureSpread(volume, progress, look);
  return look;
}

std::vector<std::uint8_t> outerAir(const Volume& volume, double border) {
  const CellBox cells = volume.geometry.cells();
  std::vector<std::uint8_t> isOuter(cells.count(), 0);
  std::vector<std::size_t> queue;
  const auto reach = [&](const Cell& cell) {
    if (!cells.contains(cell)) return;
    const std::size_t i = cells.index(cell);
    if (isOuter[i] != 0 || valueAt(volume, i) > border) return;
    isOuter[i] = 1;
    queue.push_back(i);
  };
  cells.forEach([&](const Cell& cell) {
    if ((cell.array() == 0).any() || (cell.array() == cells.high().array()).any()) reach(cell);
  });
  while (!queue.empty()) {
    const Cell cell = cells.cell(queue.back());
    queue.pop_back();
    for (const Cell& step : kFaceSteps) reach(cell + step);
  }
  return isOuter;
}

}  // namespace lumen::convert
