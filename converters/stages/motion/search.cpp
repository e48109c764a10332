// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/motion/search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/statistics.h"
#include "converters/base/vectors.h"

namespace lumen::convert {

namespace {

double lengthAbove(const formats::CenterlineTree& tree, std::uint32_t node) {
  const std::int32_t parent = tree.parent[node];
  if (parent < 0) return 0;
  return (toEigen(tree.centre[node]) - toEigen(tree.centre[static_cast<std::size_t>(parent)]))
      .norm();
}

std::vector<bool> chooseStations(const formats::CenterlineTree& tree) {
  std::vector<bool> isStation(tree.nodeCount(), false);
  for (const formats::Branch& branch : tree.branches) {
    isStation[branch.firstNode + branch.nodeCount - 1] = true;
    if (branch.parentNode < 0)
      isStation[branch.firstNode] = true;
    else
      isStation[static_cast<std::size_t>(branch.parentNode)] = true;
  }
  for (const formats::Branch& branch : tree.branches) {
    const std::uint32_t end = branch.firstNode + branch.nodeCount;
    double way = 0, left = 0;
    for (std::uint32_t i = branch.firstNode + 1; i < end; ++i) left += lengthAbove(tree, i);
    for (std::uint32_t i = branch.firstNode; i < end; ++i) {
      way += lengthAbove(tree, i);
      if (i > branch.firstNode) left -= lengthAbove(tree, i);
      // a tip is as far from the station before it as others are: alone it would be turned by little
      if (!isStation[i] && std::min(way, left) < double{tree.radius[i]}) continue;
      isStation[i] = true;
      way = 0;
    }
  }
  return isStation;
}

}  // namespace

Stations placeStations(const formats::CenterlineTree& tree) {
  constexpr std::uint32_t kNone = UINT32_MAX;
  const std::vector<bool> isStation = chooseStations(tree);
  Stations s;
  std::vector<double> way(tree.nodeCount(), 0.0);  // mm from the station above
  s.between.resize(tree.nodeCount(), {kNone, kNone, 0.0});
  std::vector<std::uint32_t> index(tree.nodeCount(), kNone);
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
    const std::int32_t parent = tree.parent[i];
    std::int32_t above = -1;
    if (parent >= 0) {
      const auto p = static_cast<std::uint32_t>(parent);
      way[i] = lengthAbove(tree, i) + (isStation[p] ? 0.0 : way[p]);
      above = static_cast<std::int32_t>(isStation[p] ? index[p] : s.between[p].above);
    }
    if (!isStation[i]) {
      s.between[i].above = static_cast<std::uint32_t>(above);
      continue;
    }
    index[i] = static_cast<std::uint32_t>(s.node.size());
    s.node.push_back(i);
    s.parent.push_back(above);
    s.gap.push_back(way[i]);
    s.between[i] = {index[i], index[i], 0.0};
  }
  // from the tips up: the next station of the same branch
  for (std::uint32_t i = static_cast<std::uint32_t>(tree.nodeCount()); i-- > 0;) {
    if (isStation[i]) continue;
    const std::uint32_t next = i + 1;  // of the same branch, as its last node is a station
    s.between[i].below = isStation[next] ? index[next] : s.between[next].below;
    const double gap = s.gap[s.between[i].below];
    s.between[i].share = gap > 0 ? way[i] / gap : 0.0;
  }
  s.length.assign(s.size(), 0.0);
  std::vector<int> children(s.size(), 0);
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (s.parent[i] < 0) continue;
    s.length[i] += 0.5 * s.gap[i];
    s.length[static_cast<std::size_t>(s.parent[i])] += 0.5 * s.gap[i];
    ++children[static_cast<std::size_t>(s.parent[i])];
  }
  for (std::size_t i = 0; i < s.size(); ++i)
    s.end.push_back(s.parent[i] < 0 ? (children[i] == 1 ? -1 : 0) : (children[i] == 0 ? 1 : 0));
  return s;
}

std::vector<Eigen::Vector3d> Stations::spread(const std::vector<Eigen::Vector3d>& moves) const {
  std::vector<Eigen::Vector3d> all;
  for (const Between& b : between)
    all.emplace_back((1 - b.share) * moves[b.above] + b.share * moves[b.below]);
  return all;
}

namespace {

using Eigen::Vector3d;

// Places of a disc of radius 1: its middle, and rings with equal areas for each place.
constexpr double kRing = 1.7;
constexpr int kInner = 4, kOuter = 8, kAround = 10;

Vector3d smoothingOf(const Volume& volume, double smoothing) {
  const Vector3d& spacing = volume.geometry.spacing;
  return spacing.cwiseMin(smoothing / BsplineVolume::kMostSmoothing * Vector3d::Ones())
      .cwiseProduct(Vector3d::Constant(BsplineVolume::kMostSmoothing))
      .cwiseMin(Vector3d::Constant(smoothing));
}

}  // namespace

Evidence::Evidence(const Volume& volume, bool dark, double smoothing)
    : m_voxels(volume, smoothingOf(volume, smoothing)), m_sign(dark ? -1.0 : 1.0) {}

Evidence::Disc Evidence::discAt(const Vector3d& centre, const Vector3d& direction,
                                double radius) const {
  const auto [u, v] = planeBasis(direction);
  const VolumeGeometry& geometry = m_voxels.geometry();
  const auto meanOf = [&, &u = u, &v = v](double at, int count) {
    double sum = 0;
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5) / count;
      const Vector3d place = centre + at * radius * (std::cos(angle) * u + std::sin(angle) * v);
      sum += double{m_voxels.sample(geometry.indexFromWorld(place))};
    }
    return sum / count;
  };
  const double middle = double{m_voxels.sample(geometry.indexFromWorld(centre))};
  const double inside = (middle + kInner * meanOf(0.45, kInner) + kOuter * meanOf(0.8, kOuter)) /
                        (1 + kInner + kOuter);
  return {m_sign * inside, m_sign * meanOf(kRing, kAround)};
}

double Evidence::contrastAt(const Vector3d& centre, const Vector3d& direction,
                            double radius) const {
  const Disc disc = discAt(centre, direction, radius);
  const double contrast = disc.inside - disc.around;
  return std::isfinite(contrast) ? contrast : 0.0;
}

double Evidence::contrastOfEnd(const Vector3d& centre, const Vector3d& direction,
                               const Vector3d& outward, double radius) const {
  const Disc disc = discAt(centre, direction, radius);
  const Disc beyond = discAt(centre + 2 * radius * outward, direction, radius);
  const double contrast = disc.inside - std::max(disc.around, beyond.inside);
  return std::isfinite(contrast) ? contrast : 0.0;
}

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
