// SPDX-License-Identifier: Apache-2.0
#include "converters/check/places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <tuple>
#include <variant>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Offset = std::array<int, 3>;

constexpr double kDarkDepth = 1, kBrightAway = 2;         // voxels: the wall's own blur and error
constexpr std::size_t kLeastDark = 4, kLeastBright = 20;  // voxels: less is a speck
constexpr double kLeastLength = 4;                        // voxels
constexpr std::size_t kCheckEvery = 1 << 16;              // voxels: well below 100 ms

/// What is known of a voxel.
enum State : std::uint8_t { kUnseen, kInside, kMember, kCore, kSwept, kTaken };

/// A voxel on the way of a search, and the entry of the list from which it was reached.
struct Reached {
  std::size_t index;
  std::uint32_t node;
  std::uint32_t from;
};

/// The grid, and the steps from voxel to voxel.
class Grid {
public:
  explicit Grid(const VolumeGeometry& geometry)
      : m_geometry(geometry),
        m_size{geometry.size[0], geometry.size[1], geometry.size[2]},
        m_steps(within(std::sqrt(3.0), false)) {}

  /// Offsets of up to `reach` voxels' edges, or of that many voxel sizes if `inMm`.
  [[nodiscard]] std::vector<Offset> within(double reach, bool inMm) const {
    std::vector<Offset> offsets;
    const double limit = reach * (inMm ? m_geometry.voxelSize() : 1) + 1e-9;
    const Vector3d unit = inMm ? m_geometry.spacing : Vector3d::Ones();
    const int most = static_cast<int>(limit / unit.minCoeff());
    for (int z = -most; z <= most; ++z)
      for (int y = -most; y <= most; ++y)
        for (int x = -most; x <= most; ++x)
          if ((x != 0 || y != 0 || z != 0) && unit.cwiseProduct(Vector3d(x, y, z)).norm() <= limit)
            offsets.push_back({x, y, z});
    return offsets;
  }

  /// Calls `visit` with the index of every voxel at one of the offsets; stops where it gives false.
  template <class Visit>
  bool each(std::size_t index, std::span<const Offset> offsets, Visit&& visit) const {
    const Offset at = place(index);
    for (const Offset& o : offsets) {
      const int x = at[0] + o[0], y = at[1] + o[1], z = at[2] + o[2];
      if (x < 0 || y < 0 || z < 0 || x >= m_size[0] || y >= m_size[1] || z >= m_size[2]) continue;
      const auto row = static_cast<std::size_t>(z) * static_cast<std::size_t>(m_size[1]) +
                       static_cast<std::size_t>(y);
      if (!visit(row * static_cast<std::size_t>(m_size[0]) + static_cast<std::size_t>(x)))
        return false;
    }
    return true;
  }
  template <class Visit>
  void eachBeside(std::size_t index, Visit&& visit) const {
    each(index, m_steps, [&](std::size_t i) {
      visit(i);
      return true;
    });
  }

  [[nodiscard]] Vector3d position(std::size_t index) const {
    const Offset p = place(index);
    return m_geometry.worldFromIndex({double(p[0]), double(p[1]), double(p[2])});
  }
  [[nodiscard]] double voxelSize() const { return m_geometry.voxelSize(); }

private:
  [[nodiscard]] Offset place(std::size_t index) const {
    const auto nx = static_cast<std::size_t>(m_size[0]), ny = static_cast<std::size_t>(m_size[1]);
    return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
            static_cast<int>(index / nx / ny)};
  }

  const VolumeGeometry& m_geometry;
  Offset m_size;
  std::vector<Offset> m_steps;
};

/// Groups voxels of the state kCore into places.
class Grouping {
public:
  Grouping(const Grid& grid, std::vector<std::uint8_t>& state, std::size_t leastVoxels,
           double leastLength)
      : m_grid(grid), m_state(state), m_leastVoxels(leastVoxels), m_leastLength(leastLength) {}

  /// The group of `seed`, which no later call finds again.
  void add(std::size_t seed, std::uint32_t node, Places& out) {
    sweep(seed, kCore, kSwept);
    const std::size_t count = m_reached.size();
    const double voxel = m_grid.voxelSize(), cubed = voxel * voxel * voxel;
    out.volume += static_cast<double>(count) * cubed;
    if (count < m_leastVoxels) return;
    sweep(m_reached.back().index, kSwept, kTaken);  // from one end to the other
    Place place;
    place.node = node;
    place.voxels = count;
    place.volume = static_cast<double>(count) * cubed;
    measureWay(place);
    if (place.length < m_leastLength * voxel) return;
    place.radius = std::sqrt(place.volume / (std::numbers::pi * place.length));
    out.places.push_back(place);
  }

private:
  /// All voxels of one state that hang together with `seed`, nearest first.
  void sweep(std::size_t seed, State from, State to) {
    m_reached.assign(1, {seed, 0, 0});
    m_state[seed] = to;
    for (std::size_t i = 0; i < m_reached.size(); ++i) {
      const auto here = static_cast<std::uint32_t>(i);
      m_grid.eachBeside(m_reached[i].index, [&](std::size_t next) {
        if (m_state[next] != from) return;
        m_state[next] = to;
        m_reached.push_back({next, 0, here});
      });
    }
  }

  /// Length and middle of the way to the voxel that was reached last. Chords over a few voxels: a
  /// way along the grid is longer than the vessel.
  void measureWay(Place& place) {
    constexpr std::size_t kChord = 5;
    m_way.clear();
    std::uint32_t at = static_cast<std::uint32_t>(m_reached.size() - 1);
    for (;; at = m_reached[at].from) {
      m_way.push_back(m_grid.position(m_reached[at].index));
      if (at == 0) break;
    }
    place.position = m_way[m_way.size() / 2];
    place.length = m_grid.voxelSize();  // half a voxel beyond either end
    for (std::size_t i = 0; i + 1 < m_way.size(); i += kChord)
      place.length += (m_way[std::min(i + kChord, m_way.size() - 1)] - m_way[i]).norm();
  }

  const Grid& m_grid;
  std::vector<std::uint8_t>& m_state;
  std::size_t m_leastVoxels;
  double m_leastLength;
  std::vector<Reached> m_reached;
  std::vector<Vector3d> m_way;
};

void sortByLength(Places& places) {
  std::stable_sort(places.places.begin(), places.places.end(), [](const Place& a, const Place& b) {
    return std::tie(a.length, a.volume) > std::tie(b.length, b.volume);
  });
}

template <class Visit>
void withVoxels(const Levels& levels, Visit&& visit) {
  std::visit(
      [&](const auto& voxels) {
        visit([&voxels, dark = levels.dark](std::size_t i) {
          const auto value = static_cast<float>(voxels[i]);
          return dark ? -value : value;
        });
      },
      levels.volume.voxels);
}

/// The voxels outside that are reached from the lumen through bright ones, nearest first.
template <class Value>
std::vector<Reached> growOutwards(const Grid& grid, const LumenVoxels& lumen, const Levels& levels,
                                  const Value& value, std::vector<std::uint8_t>& state,
                                  const Progress& progress) {
  std::vector<Reached> reached;
  const auto from = [&](std::size_t index, std::uint32_t node) {
    grid.eachBeside(index, [&](std::size_t next) {
      if (state[next] != kUnseen || !(value(next) > levels.half[node])) return;
      state[next] = kMember;
      reached.push_back({next, node, 0});
    });
  };
  for (const LumenVoxel& voxel : lumen.voxels()) from(voxel.index, voxel.node);
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (i % kCheckEvery == 0) progress.check();
    const Reached here = reached[i];
    from(here.index, here.node);
  }
  return reached;
}

}  // namespace

Places darkInside(const LumenVoxels& lumen, const Levels& levels, const Progress& progress) {
  const Grid grid(levels.volume.geometry);
  const std::vector<Offset> around = grid.within(kDarkDepth, true);
  std::vector<std::uint8_t> state = lumen.inside();
  std::vector<LumenVoxel> dark;
  withVoxels(levels, [&](const auto& value) {
    for (const LumenVoxel& voxel : lumen.voxels())
      if (value(voxel.index) < levels.half[voxel.node] &&
          grid.each(voxel.index, around, [&](std::size_t i) { return lumen.inside()[i] != 0; }))
        dark.push_back(voxel);
  });
  progress.check();
  for (const LumenVoxel& voxel : dark) state[voxel.index] = kCore;
  Places result;
  Grouping grouping(grid, state, kLeastDark, 0);
  for (const LumenVoxel& voxel : dark)
    if (state[voxel.index] == kCore) grouping.add(voxel.index, voxel.node, result);
  sortByLength(result);
  return result;
}

Places brightOutside(const LumenVoxels& lumen, const Levels& levels, const Progress& progress) {
  const Grid grid(levels.volume.geometry);
  const std::vector<Offset> around = grid.within(kBrightAway, true);
  std::vector<std::uint8_t> state = lumen.inside();
  std::vector<Reached> bright;
  withVoxels(levels, [&](const auto& value) {
    bright = growOutwards(grid, lumen, levels, value, state, progress);
  });
  for (const Reached& voxel : bright)
    if (grid.each(voxel.index, around, [&](std::size_t i) { return lumen.inside()[i] == 0; }))
      state[voxel.index] = kCore;
  Places result;
  Grouping grouping(grid, state, kLeastBright, kLeastLength);
  for (const Reached& voxel : bright) {
    if (state[voxel.index] != kCore) continue;
    progress.check();
    grouping.add(voxel.index, voxel.node, result);
  }
  sortByLength(result);
  return result;
}

}  // namespace lumen::convert
