// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/marching_cubes.h"

#include <algorithm>
#include <array>
#include <limits>

#include "converters/geometry/disjoint_sets.h"
#include "converters/geometry/marching_cubes_table.h"

namespace lumen::convert {
namespace {

// Consecutive samples of a row above the level: x in [first, last].
struct Run {
  int first, last;
  std::size_t offset;  ///< index of the first sample
};

struct Runs {
  std::vector<Run> run;
  std::vector<std::size_t> rowBegin;  ///< start of each row, and one past the end
};

Runs findRuns(const SampleGrid& grid, double level) {
  Runs result;
  result.rowBegin.push_back(0);
  for (const SampleGrid::SampleRow& row : grid.rows) {
    bool open = false;
    for (int i = 0; i < row.count; ++i) {
      const std::size_t at = row.offset + static_cast<std::size_t>(i);
      const bool inside = grid.value[at] > level;
      if (inside && !open) result.run.push_back({row.first + i, row.first + i, at});
      if (inside && open) result.run.back().last = row.first + i;
      open = inside;
    }
    result.rowBegin.push_back(result.run.size());
  }
  return result;
}

// Joins the runs of two rows whose samples come within `slack` of each other along x.
void joinRows(const Runs& runs, std::size_t row, std::size_t otherRow, int slack,
              DisjointSets& sets) {
  std::size_t a = runs.rowBegin[row], b = runs.rowBegin[otherRow];
  while (a < runs.rowBegin[row + 1] && b < runs.rowBegin[otherRow + 1]) {
    const Run &ra = runs.run[a], &rb = runs.run[b];
    if (ra.first <= rb.last + slack && rb.first <= ra.last + slack)
      sets.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
    ra.last < rb.last ? ++a : ++b;
  }
}

DisjointSets connectRuns(const SampleGrid& grid, const Runs& runs) {
  DisjointSets sets(runs.run.size());
  const auto rowsY = static_cast<std::size_t>(grid.rowsY);
  for (std::size_t row = 0; row < grid.rows.size(); ++row) {
    const std::size_t y = row % rowsY;
    const bool hasY = y > 0, hasZ = row >= rowsY;
    if (hasY) joinRows(runs, row, row - 1, 1, sets);
    if (hasZ) joinRows(runs, row, row - rowsY, 1, sets);
    if (hasY && hasZ) joinRows(runs, row, row - rowsY - 1, 0, sets);
    if (hasZ && y + 1 < rowsY) joinRows(runs, row, row - rowsY + 1, 0, sets);
  }
  return sets;
}

// The run nearest to `seed`, or the number of runs if none is within `reach`.
std::size_t nearestRun(const SampleGrid& grid, const Runs& runs, const Eigen::Vector3d& seed,
                       double reach) {
  std::size_t nearest = runs.run.size();
  double best = reach * reach;
  for (std::size_t row = 0; row < grid.rows.size(); ++row) {
    const auto rowsY = static_cast<std::size_t>(grid.rowsY);
    const double y = grid.cell * (grid.lowY + static_cast<int>(row % rowsY));
    const double z = grid.cell * (grid.lowZ + static_cast<int>(row / rowsY));
    for (std::size_t r = runs.rowBegin[row]; r < runs.rowBegin[row + 1]; ++r) {
      const double x = std::clamp(std::round(seed.x() / grid.cell), double(runs.run[r].first),
                                  double(runs.run[r].last));
      const double d2 = (Eigen::Vector3d(grid.cell * x, y, z) - seed).squaredNorm();
      if (d2 < best) {
        best = d2;
        nearest = r;
      }
    }
  }
  return nearest;
}

class MarchingCubes {
public:
  MarchingCubes(const SampleGrid& grid, std::span<const SampleState> state,
                const EdgeCrossing& crossing)
      : m_grid(grid), m_state(state), m_crossing(crossing) {
    m_vertexOnEdge.assign(3 * grid.value.size(), kNoVertex);
  }

  TriangleMesh run() {
    for (int z = 0; z + 1 < m_grid.rowsZ; ++z)
      for (int y = 0; y + 1 < m_grid.rowsY; ++y) alongRow(y, z);
    return std::move(m_patch);
  }

private:
  static constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

  // The cells between row (y, z) and its three upper neighbours.
  void alongRow(int y, int z) {
    int low = std::numeric_limits<int>::min(), high = std::numeric_limits<int>::max();
    for (unsigned k = 0; k < 4; ++k) {
      m_row[k] = &m_grid.row(y + static_cast<int>(k & 1), z + static_cast<int>(k >> 1));
      low = std::max(low, m_row[k]->first);
      high = std::min(high, m_row[k]->first + m_row[k]->count - 1);
    }
    m_y = m_grid.lowY + y;
    m_z = m_grid.lowZ + z;
    if (low >= high) return;
    unsigned corners = columnBits(low) << 1;
    for (int x = low; x < high; ++x) {
      corners = (corners >> 1 & 0x55U) | columnBits(x + 1) << 1;
      if (corners != 0 && corners != 255) emitCell(x, corners);
    }
  }

  [[nodiscard]] std::size_t sampleAt(unsigned row, int x) const {
    return m_row[row]->offset + static_cast<std::size_t>(x - m_row[row]->first);
  }

  // The four samples at x as the corners 0, 2, 4 and 6 of a cell.
  [[nodiscard]] unsigned columnBits(int x) const {
    unsigned bits = 0;
    for (unsigned k = 0; k < 4; ++k)
      bits |= static_cast<unsigned>(m_state[sampleAt(k, x)] != SampleState::Outside) << 2 * k;
    return bits;
  }

  void emitCell(int x, unsigned corners) {
    for (const CellTriangle& t : MarchingCubesTable::instance().triangles(corners)) {
      const std::size_t inside = sampleAt(t.inside >> 1U, x + (t.inside & 1));
      if (m_state[inside] != SampleState::Inside) continue;
      m_patch.triangle.push_back(
          {vertexOn(x, t.edge[0]), vertexOn(x, t.edge[1]), vertexOn(x, t.edge[2])});
    }
  }

  std::uint32_t vertexOn(int x, unsigned edge) {
    const unsigned corner = kCellEdges[edge].corner, axis = kCellEdges[edge].axis;
    const std::size_t start = sampleAt(corner >> 1, x + static_cast<int>(corner & 1));
    std::uint32_t& vertex = m_vertexOnEdge[3 * start + axis];
    if (vertex == kNoVertex) {
      vertex = static_cast<std::uint32_t>(m_patch.position.size());
      addVertex(x, corner, axis);
    }
    return vertex;
  }

  void addVertex(int x, unsigned corner, unsigned axis) {
    // Keeps the vertices on the six edges at one sample apart, also when the surface runs through
    // it.
    constexpr double kLeastShare = 1e-4;
    const unsigned end = corner | 1U << axis;
    const Eigen::Vector3d a = cornerPosition(x, corner), b = cornerPosition(x, end);
    const double fa = m_grid.value[sampleAt(corner >> 1, x + static_cast<int>(corner & 1))];
    const double fb = m_grid.value[sampleAt(end >> 1, x + static_cast<int>(end & 1))];
    const double t = std::clamp(m_crossing(a, fa, b, fb), kLeastShare, 1 - kLeastShare);
    m_patch.position.push_back(a + t * (b - a));
  }

  [[nodiscard]] Eigen::Vector3d cornerPosition(int x, unsigned corner) const {
    return m_grid.cell * Eigen::Vector3d(x + static_cast<int>(corner & 1),
                                         m_y + static_cast<int>(corner >> 1 & 1),
                                         m_z + static_cast<int>(corner >> 2));
  }

  const SampleGrid& m_grid;
  std::span<const SampleState> m_state;
  const EdgeCrossing& m_crossing;
  std::vector<std::uint32_t> m_vertexOnEdge;  ///< by the sample at the edge's start, and its axis
  std::array<const SampleGrid::SampleRow*, 4> m_row{};
  int m_y = 0, m_z = 0;
  TriangleMesh m_patch;
};

}  // namespace

std::vector<SampleState> markLumen(const SampleGrid& grid, double level,
                                   const Eigen::Vector3d& seed, double reach) {
  std::vector<SampleState> state(grid.value.size(), SampleState::Outside);
  const Runs runs = findRuns(grid, level);
  DisjointSets sets = connectRuns(grid, runs);
  const std::size_t nearest = nearestRun(grid, runs, seed, reach);
  const bool found = nearest < runs.run.size();
  const std::uint32_t lumen = found ? sets.find(static_cast<std::uint32_t>(nearest)) : 0;
  for (std::size_t r = 0; r < runs.run.size(); ++r) {
    const bool isLumen = found && sets.find(static_cast<std::uint32_t>(r)) == lumen;
    const Run& run = runs.run[r];
    std::fill_n(state.begin() + static_cast<std::ptrdiff_t>(run.offset), run.last - run.first + 1,
                isLumen ? SampleState::Inside : SampleState::OtherInside);
  }
  return state;
}

TriangleMesh marchingCubes(const SampleGrid& grid, std::span<const SampleState> state,
                           const EdgeCrossing& crossing) {
  return MarchingCubes(grid, state, crossing).run();
}

}  // namespace lumen::convert
