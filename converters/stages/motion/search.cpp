// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/motion/search.h"

#include <algorithm>
#include <array>
#include <limits>

#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/statistics.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// A strain of 0.7 costs as much as vessel that is not seen.
constexpr double kStrainCost = 2;
/// Stations in one place would be tied without bound: the least gap, in radii.
constexpr double kLeastGap = 0.25;

/// The least usual contrast, as a share of the median: below, a station has nothing to be followed by, as
/// in a sac, and goes with its neighbours.
constexpr double kFaintest = 0.2;

// The contrast of a station at a place, on a grid of `step` mm: a step must not leap over a vessel.
double contrastOf(const StationShape& shape, const Vector3d& move, double step,
                  const Evidence& evidence) {
  const Vector3d place = shape.centre + move;
  const double radius = std::max(shape.radius, 0.6 * step);
  return shape.outward.isZero()
             ? evidence.contrastAt(place, shape.direction, radius)
             : evidence.contrastOfEnd(place, shape.direction, shape.outward, radius);
}

// The energies of all moves of one station, x fastest.
using Energies = std::vector<float>;

class Search {
public:
  Search(const Stations& stations, const std::vector<StationShape>& shapes,
         const std::vector<Vector3d>& around, const MoveGrid& grid)
      : m_stations(stations), m_shapes(shapes), m_around(around), m_grid(grid) {}

  // Contrasts, as shares of the usual ones.
  void see(const std::vector<double>& usual, const Evidence& evidence, Progress& progress) {
    m_seen.assign(m_stations.size(), Energies(m_grid.count()));
    std::vector<double> best(m_stations.size());
    tbb::parallel_for(std::size_t{0}, m_stations.size(), [&](std::size_t i) {
      progress.check();
      for (std::size_t label = 0; label < m_grid.count(); ++label)
        m_seen[i][label] = static_cast<float>(
            contrastOf(m_shapes[i], m_around[i] + m_grid.move(label), m_grid.step, evidence));
      best[i] = double{*std::max_element(m_seen[i].begin(), m_seen[i].end())};
      progress.advance();
    });
    if (!(*std::max_element(best.begin(), best.end()) > 0))
      throw invalidInput(
          "no vessel of the case is seen in the volume, within the way that it may move");
    std::vector<double> sorted = usual.empty() ? best : usual;
    const double middle = std::max(upperMedian(sorted), 0.0);
    for (std::size_t i = 0; i < m_seen.size(); ++i) {
      const double whole = usual.empty() ? middle : usual[i];
      const bool isFaint = !(whole > kFaintest * middle);
      for (float& value : m_seen[i])
        value = isFaint ? 0.0F : static_cast<float>(std::clamp(double{value} / whole, 0.0, 1.0));
    }
  }

  SearchResult solve() {
    m_energy.clear();
    for (std::size_t i = 0; i < m_stations.size(); ++i) {
      Energies& energy = m_energy.emplace_back(m_seen[i]);
      for (float& e : energy) e = static_cast<float>(m_stations.length[i] * (1.0 - double{e}));
    }
    for (std::size_t i = m_stations.size(); i-- > 0;)
      if (m_stations.parent[i] >= 0) sendUp(i);
    SearchResult result;
    for (std::size_t i = 0; i < m_stations.size(); ++i) choose(i, result);
    return result;
  }

private:
  // The weight of the square of a difference of moves along an edge, 1/mm.
  [[nodiscard]] double stiffness(std::size_t i) const {
    return kStrainCost / std::max(m_stations.gap[i], kLeastGap * m_shapes[i].radius);
  }
  // The difference of the moves of a station and its parent around which both search, less that of a
  // turn, in steps.
  [[nodiscard]] Vector3d shift(std::size_t i) const {
    const Vector3d& above = m_around[static_cast<std::size_t>(m_stations.parent[i])];
    return (m_around[i] - above - m_shapes[i].turned) / m_grid.step;
  }

  // out(b) = min over a of in(a) + w (a - b + s)^2 along one axis, whose places are `stride` apart.
  void spreadAxis(Energies& energy, std::size_t stride, double w, double s) const {
    const int width = m_grid.width();
    std::vector<double> cost(static_cast<std::size_t>(2 * width));
    for (int d = -width + 1; d < width; ++d)
      cost[static_cast<std::size_t>(d + width - 1)] = w * (d + s) * (d + s);
    std::vector<float> line(static_cast<std::size_t>(width));
    for (std::size_t first = 0; first < energy.size(); ++first) {
      if (first / stride % static_cast<std::size_t>(width) != 0) continue;
      for (int a = 0; a < width; ++a)
        line[static_cast<std::size_t>(a)] = energy[first + static_cast<std::size_t>(a) * stride];
      for (int b = 0; b < width; ++b) {
        double least = std::numeric_limits<double>::infinity();
        for (int a = 0; a < width; ++a)
          least = std::min(least, double{line[static_cast<std::size_t>(a)]} +
                                      cost[static_cast<std::size_t>(a - b + width - 1)]);
        energy[first + static_cast<std::size_t>(b) * stride] = static_cast<float>(least);
      }
    }
  }

  void sendUp(std::size_t i) {
    Energies message = m_energy[i];
    const double w = stiffness(i) * m_grid.step * m_grid.step;
    const Vector3d s = shift(i);
    std::size_t stride = 1;
    for (int axis = 0; axis < 3; ++axis, stride *= static_cast<std::size_t>(m_grid.width()))
      spreadAxis(message, stride, w, s[axis]);
    Energies& parent = m_energy[static_cast<std::size_t>(m_stations.parent[i])];
    for (std::size_t label = 0; label < parent.size(); ++label) parent[label] += message[label];
  }

  // The best move of a station, given that of its parent, which comes before it.
  void choose(std::size_t i, SearchResult& result) const {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t label = 0; label < m_grid.count(); ++label) {
      double energy = double{m_energy[i][label]};
      if (m_stations.parent[i] >= 0) {
        const Vector3d& above = result.moves[static_cast<std::size_t>(m_stations.parent[i])];
        energy += stiffness(i) *
                  (m_around[i] + m_grid.move(label) - above - m_shapes[i].turned).squaredNorm();
      }
      if (energy >= least) continue;
      least = energy;
      best = label;
    }
    result.moves.emplace_back(m_around[i] + m_grid.move(best));
    result.evidence.push_back(double{m_seen[i][best]});
  }

  const Stations& m_stations;
  const std::vector<StationShape>& m_shapes;
  const std::vector<Vector3d>& m_around;
  MoveGrid m_grid;
  std::vector<Energies> m_seen, m_energy;
};

}  // namespace

Vector3d MoveGrid::move(std::size_t label) const {
  const auto w = static_cast<std::size_t>(width());
  const std::array<std::size_t, 3> cell = {label % w, label / w % w, label / (w * w)};
  Vector3d result;
  for (int axis = 0; axis < 3; ++axis)
    result[axis] = step * (static_cast<double>(cell[static_cast<std::size_t>(axis)]) - steps);
  return result;
}

SearchResult searchMoves(const Stations& stations, const std::vector<StationShape>& shapes,
                         const std::vector<Vector3d>& around, const std::vector<double>& usual,
                         const MoveGrid& grid, const Evidence& evidence, Progress& progress) {
  Search search(stations, shapes, around, grid);
  search.see(usual, evidence, progress);
  return search.solve();
}

std::vector<double> contrastsAt(const std::vector<StationShape>& shapes,
                                const std::vector<Vector3d>& around, double step,
                                const Evidence& evidence) {
  std::vector<double> contrasts;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    contrasts.push_back(contrastOf(shapes[i], around[i], step, evidence));
  return contrasts;
}

}  // namespace lumen::convert
