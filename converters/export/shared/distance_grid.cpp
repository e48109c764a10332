// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/distance_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "converters/export/shared/grid_shortcuts.h"

namespace lumen::convert {

namespace {

constexpr double kUsualSamples = 8e6;
/// Samples of a row that are asked together: enough to fill the query's lanes, few enough that the
/// box around them shows which nodes are near.
constexpr std::size_t kChunk = 32;

/// The samples of a row, which are asked in chunks: those far from the band are not asked at all.
class RowSampler {
public:
  RowSampler(const GridSource& source, std::span<WallDistance> answers)
      : m_source(source), m_answers(answers) {}

  void add(std::size_t index, const Eigen::Vector3d& place) {
    if (m_source.near && !m_source.near->contains(place)) {
      m_answers[index] = {static_cast<float>(m_source.band), 0};
      return;
    }
    if (m_points.size() == kChunk || m_begin + m_points.size() != index) finish();
    if (m_points.empty()) m_begin = index;
    m_points.push_back(place);
  }

  void finish() {
    const std::span<WallDistance> answers = m_answers.subspan(m_begin, m_points.size());
    if (m_source.far)
      askNear(answers);
    else
      m_source.ask(m_points, answers);
    m_points.clear();
  }

private:
  /// Asks for the points that the far field has no answer for.
  void askNear(std::span<WallDistance> answers) {
    m_isAnswered.resize(m_points.size());
    m_source.far->answer(m_points, answers, m_isAnswered);
    std::vector<Eigen::Vector3d> rest;
    for (std::size_t i = 0; i < m_points.size(); ++i)
      if (m_isAnswered[i] == 0) rest.push_back(m_points[i]);
    std::vector<WallDistance> found(rest.size());
    m_source.ask(rest, found);
    std::size_t next = 0;
    for (std::size_t i = 0; i < m_points.size(); ++i) {
      if (m_isAnswered[i] != 0) continue;
      const WallDistance& one = found[next++];
      if (one.distance < answers[i].distance) answers[i] = one;
    }
  }

  const GridSource& m_source;
  std::span<WallDistance> m_answers;
  std::size_t m_begin = 0;
  std::vector<Eigen::Vector3d> m_points;
  std::vector<char> m_isAnswered;
};

std::vector<WallDistance> askRows(const GridSource& source, std::size_t rows, std::size_t length,
                                  const RowPlaces& places, Progress& progress) {
  std::vector<WallDistance> answers(rows * length);
  tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t row) {
    progress.check();
    RowSampler sampler(source, std::span(answers).subspan(row * length, length));
    for (std::size_t i = 0; i < length; ++i) sampler.add(i, places(row, i));
    sampler.finish();
    progress.advance();
  });
  return answers;
}

std::size_t rowsOf(const Lattice& lattice) {
  return static_cast<std::size_t>(lattice.size[1]) * static_cast<std::size_t>(lattice.size[2]);
}

void requireHeld(const Lattice& lattice) {
  if (static_cast<double>(lattice.size[0]) * static_cast<double>(rowsOf(lattice)) >
      static_cast<double>(kMostGridSamples))
    refuseSpacing(lattice, "this makes more samples than " + std::to_string(kMostGridSamples));
}

DistanceGrid askLattice(const GridSource& source, const Lattice& lattice, Progress& progress) {
  const auto nx = static_cast<std::size_t>(lattice.size[0]),
             ny = static_cast<std::size_t>(lattice.size[1]);
  return {lattice,
          askRows(
              source, rowsOf(lattice), nx,
              [&](std::size_t row, std::size_t i) { return lattice.at(i, row % ny, row / ny); },
              progress)};
}

}  // namespace

void GridSource::ask(std::span<const Eigen::Vector3d> points, std::span<WallDistance> answers,
                     std::span<WallFoot> feet) const {
  if (region)
    vessels.ofRegion(*region, points, band, answers, feet);
  else
    vessels.ofAll(points, band, answers, feet);
  const auto most = static_cast<float>(band);
  for (WallDistance& answer : answers) answer.distance = std::clamp(answer.distance, -most, most);
}

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

std::vector<std::string> gridLosses(const Lattice& lattice, const formats::CenterlineTree& tree) {
  const double spacing = lattice.spacing;
  const auto lost = std::count_if(tree.radius.begin(), tree.radius.end(), [spacing](float radius) {
    return static_cast<double>(radius) < spacing;
  });
  if (lost == 0) return {};
  return {"the grid's samples are " + fixedText(spacing, 2) +
          " mm apart, too wide for the vessels at " +
          counted(static_cast<std::size_t>(lost), "node", "nodes") + " of " +
          std::to_string(tree.nodeCount()) + "; " + lattice.word + " takes a smaller distance"};
}

void refuseSpacing(const Lattice& lattice, const std::string& what) {
  throw Error(ErrorKind::Usage, lattice.word + " " + shownNumber(lattice.spacing) + ": " + what +
                                    "; choose a wider spacing");
}

Lattice latticeOver(const Box3d& box, double margin, double spacing, const FieldWord& word) {
  Lattice lattice;
  lattice.word = word("grid");
  lattice.spacing = spacing;
  for (int a = 0; a < 3; ++a) {
    const double cells =
        std::max(1.0, std::ceil((box.high[a] - box.low[a] + 2 * margin) / spacing));
    if (cells >= std::numeric_limits<int>::max())
      refuseSpacing(lattice, "this makes more than 2147483647 samples along an axis");
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
  requireHeld(lattice);
  const GridShortcuts shortcuts(source, lattice, progress);
  progress.begin("distances", rowsOf(lattice));
  DistanceGrid grid = askLattice(shortcuts.source(), lattice, progress);
  progress.end();
  return grid;
}

Volume distanceVolume(const DistanceGrid& grid, float sign) {
  Volume volume;
  volume.geometry.size = grid.lattice.size;
  volume.geometry.spacing.setConstant(grid.lattice.spacing);
  volume.geometry.origin = grid.lattice.first;
  auto& distances = volume.voxels.emplace<std::vector<float>>();
  distances.reserve(grid.values.size());
  for (const WallDistance& value : grid.values) distances.push_back(sign * value.distance);
  return volume;
}

void sampleLayers(const GridSource& source, const Lattice& lattice, int layers,
                  const TakeLayers& take, Progress& progress) {
  const GridShortcuts shortcuts(source, lattice, progress);
  progress.begin("distances", rowsOf(lattice));
  for (int begin = 0; begin < lattice.size[2]; begin += layers) {
    Lattice part = lattice;
    part.size[2] = std::min(layers, lattice.size[2] - begin);
    part.first[2] = lattice.first[2] + begin * lattice.spacing;
    requireHeld(part);
    take(askLattice(shortcuts.source(), part, progress), begin);
  }
  progress.end();
}

}  // namespace lumen::convert
