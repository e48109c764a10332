// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/phantom/into_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/sha256.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/volume/write_volume.h"
#include "converters/stages/phantom/phantom_scene.h"
#include "converters/stages/phantom/placing.h"
#include "converters/stages/phantom/render.h"
#include "converters/voxels/grid_geometry.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kLeastShare = 0.00135;  // that of a flat wall three spreads away
constexpr double kReachSpreads = 5;      // around vessels, beyond the last tap of the blur
constexpr double kWidestGrain = 5;       // voxels
// Vessels are drawn in halves of the voxels' edges. In whole ones the blur of a wall, squared, would
// hang on where it lies between voxels, by a quarter of a squared edge: sharp scans blur by a third.
constexpr int kFiner = 2;
// Streams of their own: clicks and noise do not change with each other.
constexpr std::uint64_t kNoise = 0x6e6f697365ULL;

// The sum of products of taps that are `apart` from each other.
double powerOf(const std::vector<float>& weights, std::size_t apart) {
  double sum = 0;
  for (std::size_t i = 0; i + apart < weights.size(); ++i)
    sum += static_cast<double>(weights[i]) * static_cast<double>(weights[i + apart]);
  return sum;
}

// The standard deviation, in voxels, of the Gaussian that makes the neighbours of white noise alike
// by `grain`.
double sigmaOfGrain(double grain) {
  double low = 0, high = kWidestGrain;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    const std::vector<float> weights = gaussianWeights(middle);
    (powerOf(weights, 1) < grain * powerOf(weights, 0) ? low : high) = middle;
  }
  return low;
}

// Noise of standard deviation 1 in which neighbours are alike by `grain`.
Image grainyNoise(const Cell& size, const Vector3d& grain, std::uint64_t seed, Progress& progress) {
  Image noise{size, std::vector<float>(CellBox{Cell::Zero(), size}.count())};
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y) {
      Random random(seed ^ kNoise, noise.index(y, z));
      float* row = noise.row(y, z);
      for (int x = 0; x < size[0]; ++x) row[x] = static_cast<float>(countedNormal(random));
    }
  Vector3d sigma;
  double power = 1;
  for (int a = 0; a < 3; ++a) {
    sigma[a] = sigmaOfGrain(grain[a]);
    power *= powerOf(gaussianWeights(sigma[a]), 0);
  }
  blur(noise, sigma, progress);
  for (float& value : noise.value) value *= static_cast<float>(1 / std::sqrt(power));
  return noise;
}

// Appends the vessels of a tree to `builder`, which lie in the body; returns the millimetres that do
// not.
double addTree(const CenterlineFile& file, double voxel, const char* system,
               const VolumeGeometry& geometry, const std::vector<std::uint8_t>& air,
               TreeBuilder& builder) {
  const std::vector<SmoothVessel> vessels = smoothVessels(file, 0.1 * voxel);
  const BodyVessels body = cutToBody(vessels, geometry, air);
  std::vector<std::vector<std::uint32_t>> branches(vessels.size());
  std::size_t index = 0;
  for (const BodyVessels::Stretch& stretch : body.stretches) {
    const std::int32_t parent = vessels[static_cast<std::size_t>(stretch.vessel)].parent;
    std::int32_t from = formats::kNoParent;
    double nearest = voxel;
    if (stretch.isFirst && parent != formats::kNoParent)
      for (const std::uint32_t candidate : branches[static_cast<std::size_t>(parent)]) {
        const formats::Branch& branch = builder.tree().branches[candidate];
        for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n) {
          const double away =
              (toEigen(builder.tree().centre[n]) - stretch.path.front().position).norm();
          if (away >= nearest) continue;
          nearest = away;
          from = static_cast<std::int32_t>(candidate);
        }
      }
    branches[static_cast<std::size_t>(stretch.vessel)].push_back(
        builder.add(std::string(system).append(paddedNumber(index++, 3)), from, stretch.path));
  }
  return body.lost;
}

// The design in the frame of the scan's grid, where the axes are those of LPS.
Design inGrid(const Design& design, const VolumeGeometry& world, const VolumeGeometry& grid) {
  Design moved = design;
  for (formats::Vec3f& c : moved.tree.centre) c = toVec3f(inFrame(world, grid, toEigen(c)));
  return moved;
}

// The grid of the cells around the vessels that they may change, and its first cell.
CellBox cellsAround(const formats::CenterlineTree& tree, const VolumeGeometry& grid,
                    const Vector3d& spread) {
  const Box3d box = boxOf(tree);
  const Vector3d reach = kReachSpreads * spread + 2 * grid.spacing;
  return grid.cellsAround((box.low - reach).cwiseQuotient(grid.spacing),
                          (box.high + reach).cwiseQuotient(grid.spacing));
}

// The share of each voxel of `grid` that the design fills, times its contrast, as a point spread of
// standard deviations `spread` shows it.
Image drawBlurred(const Design& design, VolumeGeometry grid, const Vector3d& spread,
                  Progress& progress) {
  Image image{grid.cells().size, std::vector<float>(grid.voxelCount())};
  grid.spacing /= kFiner;
  for (int& n : grid.size) n = kFiner * (n - 1) + 1;
  Image fine = drawOccupancy(design, grid, progress);
  // the drawing holds the box of its voxels
  const Eigen::Array3d variance = spread.cwiseQuotient(grid.spacing).array().square() - 1.0 / 12;
  blur(fine, variance.max(0).sqrt(), progress);
  for (int z = 0; z < image.size[2]; ++z)
    for (int y = 0; y < image.size[1]; ++y)
      for (int x = 0; x < image.size[0]; ++x)
        image.row(y, z)[x] = fine.row(kFiner * y, kFiner * z)[kFiner * x];
  return image;
}

struct Drawn {
  CellBox cells;
  Image share, contrast, noise;
};

Drawn drawVessels(const Design& design, const VolumeGeometry& scan, const ScanLook& look,
                  std::uint64_t seed, Progress& progress) {
  VolumeGeometry grid = gridGeometry(scan);
  Design full = inGrid(design, scan, grid);
  Drawn drawn;
  drawn.cells = cellsAround(full.tree, grid, look.spread);
  grid.origin = grid.position(drawn.cells.low);
  for (int a = 0; a < 3; ++a) grid.size[static_cast<std::size_t>(a)] = drawn.cells.size[a];
  // two drawings, each with a blur, and the blur of the noise
  progress.begin("phantom", static_cast<std::size_t>((4 * kFiner + 1) * grid.size[2] +
                                                     (2 * kFiner + 1) * grid.size[1]));
  drawn.contrast = drawBlurred(full, grid, look.spread, progress);
  std::fill(full.contrast.begin(), full.contrast.end(), 1.0F);
  drawn.share = drawBlurred(full, grid, look.spread, progress);
  drawn.noise = grainyNoise(drawn.cells.size, look.grain, seed, progress);
  progress.end();
  return drawn;
}

template <class T>
T asVoxel(double value) {
  if constexpr (std::is_floating_point_v<T>) return static_cast<T>(value);
  return static_cast<T>(std::clamp(std::nearbyint(value),
                                   static_cast<double>(std::numeric_limits<T>::lowest()),
                                   static_cast<double>(std::numeric_limits<T>::max())));
}

void blend(const Drawn& drawn, const ScanLook& look, Volume& scan) {
  std::visit(
      [&](auto& voxels) {
        using T = typename std::decay_t<decltype(voxels)>::value_type;
        for (std::size_t i = 0; i < drawn.cells.count(); ++i) {
          const double a = std::clamp(static_cast<double>(drawn.share.value[i]), 0.0, 1.0);
          if (a < kLeastShare) continue;
          T& voxel = voxels[scan.geometry.index(drawn.cells.cell(i))];
          const auto old = static_cast<double>(voxel);
          voxel = asVoxel<T>(
              old + a * (look.tissue - old) + static_cast<double>(drawn.contrast.value[i]) +
              look.noise * std::sqrt(a * (2 - a)) * static_cast<double>(drawn.noise.value[i]));
        }
      },
      scan.voxels);
}

formats::Step describe(const PhantomOptions& options, const IntoOptions& into,
                       const IntoResult& result, const std::string& scan) {
  formats::Step step;
  step.name = "phantom";
  step.tool = "lumen " LUMEN_VERSION;
  step.parameters = {{"random-seed", static_cast<std::int64_t>(options.seed)},
                     {"tree-sha256", digestOfFile(options.tree).sha256},
                     {"into-sha256", scan},
                     {"contrast", into.contrast},
                     {"move", joinedNumbers(result.move, ",")},
                     {"turn", joinedNumbers(into.turn, ",")},
                     {"tissue", result.look.tissue},
                     {"noise", result.look.noise},
                     {"point-spread", joinedNumbers(result.look.spread, ",", 4)}};
  if (options.fade != 0) step.parameters["fade"] = options.fade;
  if (!into.veins.empty()) {
    step.parameters["veins-sha256"] = digestOfFile(into.veins).sha256;
    step.parameters["vein-contrast"] = into.veinContrast;
  }
  return step;
}

// Both trees, placed and cut, with the contrast of each node in the units of the scan.
Design designIn(const PhantomOptions& options, const IntoOptions& into, const Volume& scan,
                IntoResult& result, const Progress& progress) {
  const double voxel = scan.geometry.spacing.minCoeff();
  const bool hasVeins = !into.veins.empty();
  std::vector<CenterlineFile> files = {readSwc(options.tree)};
  if (hasVeins) files.push_back(readSwc(into.veins));
  const std::filesystem::path* names[] = {&options.tree, &into.veins};
  for (std::size_t f = 0; f < files.size(); ++f)
    checkEffort(files[f], voxel / kFiner, formats::printable(names[f]->string()), "larger voxels");
  const Placement placement = placeTrees(files, into.turn, into.move, scan, result.look, progress);
  result.move = placement.move;
  const std::vector<std::uint8_t> air = outerAir(scan, result.look.border);
  TreeBuilder builder(Frame{voxel, 0});
  for (std::size_t f = 0; f < files.size(); ++f) {
    placement.apply(files[f]);
    const std::size_t first = builder.tree().nodeCount();
    const char* const system = !hasVeins ? "b" : f == 0 ? "artery-" : "vein-";
    result.lost += addTree(files[f], voxel, system, scan.geometry, air, builder);
    std::vector<float>& contrast = builder.design().contrast;
    std::fill(contrast.begin() + static_cast<std::ptrdiff_t>(first), contrast.end(),
              static_cast<float>(f == 0 ? into.contrast : into.veinContrast));
    if (hasVeins)
      builder.design().systems.resize(
          contrast.size(), f == 0 ? formats::VesselSystem::Artery : formats::VesselSystem::Vein);
  }
  if (builder.tree().nodeCount() == 0)
    throw invalidInput("no vessel of the trees lies in the body; " + options.word("move") +
                       " displaces them by " + joinedNumbers(placement.move, ",") + " mm");
  fadeContrast(builder.design(), options.fade);
  return builder.design();
}

}  // namespace

void IntoOptions::addRows(OptionTable& table) {
  constexpr NumberRange kContrasts{1, 1e5};
  table
      .add("contrast", &contrast, "LEVEL",
           "Level of arteries over soft tissue, in the units of the volume, such as HU")
      .in(kContrasts)
      .onlyWith("into");
  table.add("vein-contrast", &veinContrast, "LEVEL", "Level of veins over soft tissue")
      .in(kContrasts)
      .onlyWith("veins");
}

IntoResult drawIntoScan(const PhantomOptions& options, const IntoOptions& into, Volume scan,
                        Progress& progress) {
  IntoResult result;
  const std::string source = describeSource(scan).sha256;
  result.look = measureScan(scan, progress);
  Design design = designIn(options, into, scan, result, progress);
  blend(drawVessels(design, scan.geometry, result.look, options.seed, progress), result.look, scan);
  result.phantom.seeds = clickTree(design.tree, options, scan.geometry.spacing.minCoeff());
  result.phantom.truth.tree = std::move(design.tree);
  if (!design.systems.empty()) formats::setNodeSystems(result.phantom.truth, design.systems);
  result.phantom.truth.metadata.steps.push_back(describe(options, into, result, source));
  result.phantom.truth.metadata.voxelSize = scan.geometry.voxelSize();
  result.phantom.truth.metadata.source = describeSource(scan);
  result.phantom.volume = std::move(scan);
  return result;
}

}  // namespace lumen::convert
