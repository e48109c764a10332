// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/distance_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/option_name.h"
#include "converters/base/text.h"

namespace lumen::convert {

namespace {

constexpr double kUsualSamples = 8e6;
/// Samples of a row that are asked together: enough to fill the query's lanes, few enough that the
/// box around them shows which nodes are near.
constexpr std::size_t kChunk = 32;

void sampleChunk(const GridSource& source, std::span<const Eigen::Vector3d> points,
                 std::span<WallDistance> answers) {
  if (source.region)
    source.vessels.ofRegion(*source.region, points, source.band, answers);
  else
    source.vessels.ofAll(points, source.band, answers);
  const auto band = static_cast<float>(source.band);
  for (WallDistance& answer : answers) answer.distance = std::clamp(answer.distance, -band, band);
}

std::vector<WallDistance> askRows(const GridSource& source, std::size_t rows, std::size_t length,
                                  const RowPlaces& places, Progress& progress) {
  std::vector<WallDistance> answers(rows * length);
  tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t row) {
    progress.check();
    std::vector<Eigen::Vector3d> points;
    for (std::size_t begin = 0; begin < length; begin += kChunk) {
      const std::size_t end = std::min(begin + kChunk, length);
      points.clear();
      for (std::size_t i = begin; i < end; ++i) points.push_back(places(row, i));
      sampleChunk(source, points, std::span(answers).subspan(row * length + begin, end - begin));
    }
    progress.advance();
  });
  return answers;
}

std::size_t rowsOf(const Lattice& lattice) {
  return static_cast<std::size_t>(lattice.size[1]) * static_cast<std::size_t>(lattice.size[2]);
}

DistanceGrid askLattice(const GridSource& source, const Lattice& lattice, Progress& progress) {
  const auto nx = static_cast<std::size_t>(lattice.size[0]),
             ny = static_cast<std::size_t>(lattice.size[1]);
  if (static_cast<double>(nx) * static_cast<double>(rowsOf(lattice)) >
      static_cast<double>(kMostGridSamples))
    refuseSpacing(lattice.spacing,
                  "this makes more samples than " + std::to_string(kMostGridSamples));
  return {lattice,
          askRows(
              source, rowsOf(lattice), nx,
              [&](std::size_t row, std::size_t i) { return lattice.at(i, row % ny, row / ny); },
              progress)};
}

}  // namespace

Eigen::Vector3d Lattice::at(std::size_t i, std::size_t j, std::size_t k) const {
  return first + spacing * Eigen::Vector3d(static_cast<double>(i), static_cast<double>(j),
                                           static_cast<double>(k));
}

Eigen::Vector3d Lattice::last() const {
  return at(static_cast<std::size_t>(size[0] - 1), static_cast<std::size_t>(size[1] - 1),
            static_cast<std::size_t>(size[2] - 1));
}

std::size_t Lattice::count() const {
  return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
         static_cast<std::size_t>(size[2]);
}

double gridSpacing(double asked, const Box3d& box, double margin,
                   const formats::CenterlineTree& tree) {
  if (asked > 0) return asked;
  const double thinnest =
      static_cast<double>(*std::min_element(tree.radius.begin(), tree.radius.end()));
  const Eigen::Vector3d edges = (box.size().array() + 2 * margin).matrix();
  return std::max(thinnest / 4, std::cbrt(edges.x() * edges.y() * edges.z() / kUsualSamples));
}

std::vector<std::string> gridLosses(double spacing, const formats::CenterlineTree& tree) {
  const auto lost = std::count_if(tree.radius.begin(), tree.radius.end(), [spacing](float radius) {
    return static_cast<double>(radius) < spacing;
  });
  if (lost == 0) return {};
  return {"the grid's samples are " + fixedText(spacing, 2) +
          " mm apart, too wide for the vessels at " +
          counted(static_cast<std::size_t>(lost), "node", "nodes") + " of " +
          std::to_string(tree.nodeCount()) + "; " + kOption.grid.shown() +
          " takes a smaller distance"};
}

void refuseSpacing(double spacing, const std::string& what) {
  throw Error(ErrorKind::Usage, kOption.grid.shown() + " " + shownNumber(spacing) + ": " + what +
                                    "; choose a wider spacing");
}

Lattice latticeOver(const Box3d& box, double margin, double spacing) {
  Lattice lattice;
  lattice.spacing = spacing;
  for (int a = 0; a < 3; ++a) {
    const double cells =
        std::max(1.0, std::ceil((box.high[a] - box.low[a] + 2 * margin) / spacing));
    if (cells >= std::numeric_limits<int>::max())
      refuseSpacing(spacing, "this makes more than 2147483647 samples along an axis");
    lattice.size[static_cast<std::size_t>(a)] = static_cast<int>(cells) + 1;
    lattice.first[a] = box.low[a] - margin;
  }
  return lattice;
}

Lattice cropLattice(const Lattice& whole, const Box3d& box, double margin) {
  Lattice part = whole;
  for (int a = 0; a < 3; ++a) {
    const int samples = whole.size[static_cast<std::size_t>(a)];
    const auto index = [&](double place) {
      return static_cast<int>(std::clamp(place, 0.0, static_cast<double>(samples - 1)));
    };
    const int begin = std::min(
        index(std::floor((box.low[a] - margin - whole.first[a]) / whole.spacing)), samples - 2);
    const int end = std::max(
        index(std::ceil((box.high[a] + margin - whole.first[a]) / whole.spacing)), begin + 1);
    part.size[static_cast<std::size_t>(a)] = end - begin + 1;
    part.first[a] = whole.first[a] + begin * whole.spacing;
  }
  return part;
}

std::vector<WallDistance> sampleRows(const GridSource& source, std::size_t rows, std::size_t length,
                                     const RowPlaces& places, Progress& progress) {
  progress.begin("distances", rows);
  std::vector<WallDistance> answers = askRows(source, rows, length, places, progress);
  progress.end();
  return answers;
}

DistanceGrid sampleGrid(const GridSource& source, const Lattice& lattice, Progress& progress) {
  progress.begin("distances", rowsOf(lattice));
  DistanceGrid grid = askLattice(source, lattice, progress);
  progress.end();
  return grid;
}

void sampleLayers(const GridSource& source, const Lattice& lattice, int layers,
                  const TakeLayers& take, Progress& progress) {
  progress.begin("distances", rowsOf(lattice));
  for (int begin = 0; begin < lattice.size[2]; begin += layers) {
    Lattice part = lattice;
    part.size[2] = std::min(layers, lattice.size[2] - begin);
    part.first[2] = lattice.first[2] + begin * lattice.spacing;
    take(askLattice(source, part, progress), begin);
  }
  progress.end();
}

}  // namespace lumen::convert
