// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/local_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

#include "converters/base/vectors.h"
#include "converters/geometry/mesh_edges.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kReach = 2;        // radii: a node's blobs and its blend end within
constexpr int kCrossingSteps = 12;  // of the search for the wall on an edge
constexpr double kEdgeEnd = 1e-9;   // of an edge: the search ends
constexpr int kBand = 2;            // cells of the coarse field around its wall

// The share of the edge from a to b at which the field is 0: false position (Illinois).
double crossing(const BoxedField& field, const Vector3d& a, double fa, const Vector3d& b,
                double fb) {
  double low = 0, high = 1, t = 0.5;
  for (int i = 0, side = 0; i < kCrossingSteps && high - low > kEdgeEnd; ++i) {
    t = (low * fb - high * fa) / (fb - fa);
    if (!(t > low && t < high)) t = 0.5 * (low + high);
    const double f = field.value(a + t * (b - a));
    if (f == 0) break;
    if ((f > 0) == (fb > 0)) {
      high = t;
      fb = f;
      if (side == 1) fa *= 0.5;
      side = 1;
    } else {
      low = t;
      fa = f;
      if (side == -1) fb *= 0.5;
      side = -1;
    }
  }
  return std::clamp(t, 1e-6, 1 - 1e-6);
}

}  // namespace

LocalField::LocalField(const formats::CenterlineTree& tree, const field::BlendedField& field,
                       const std::vector<std::uint32_t>& from, const Box3d& box)
    : m_field(field), m_box(box) {
  const formats::Neighbours neighbours(tree);
  std::vector<std::uint8_t> isKnown(tree.nodeCount(), 0);
  std::vector<std::uint32_t> open = from;
  for (const std::uint32_t n : from) isKnown[n] = 1;
  while (!open.empty()) {
    const std::uint32_t n = open.back();
    open.pop_back();
    m_nodes.push_back(n);
    for (const std::uint32_t other : neighbours.of(n)) {
      const double reach = kReach * static_cast<double>(tree.radius[other]);
      if (isKnown[other] != 0 || (box.gap(toEigen(tree.centre[other])).array() > reach).any())
        continue;
      isKnown[other] = 1;
      open.push_back(other);
    }
  }
  std::sort(m_nodes.begin(), m_nodes.end());
  for (const std::uint32_t n : m_nodes) {
    const auto r = static_cast<double>(tree.radius[n]);
    m_balls.push_back({toEigen(tree.centre[n]), r * r});
  }
}

double LocalField::value(const Vector3d& point) const {
  double least = std::numeric_limits<double>::infinity();
  std::size_t best = 0;
  for (std::size_t i = 0; i < m_balls.size(); ++i) {
    const double power = (point - m_balls[i].centre).squaredNorm() - m_balls[i].square;
    if (power < least) {
      least = power;
      best = i;
    }
  }
  const field::Vec p{point.x(), point.y(), point.z()};
  return m_field.blended<1>(p, m_field.follow(p, m_nodes[best])).value - m_field.level();
}

SampledField::SampledField(const BoxedField& field, double cell, const SampledField* coarse,
                           const Progress& progress)
    : m_field(field) {
  const Box3d& box = field.box;
  // the positions of a finer field include those of a coarser one
  const double unit = coarse != nullptr ? coarse->m_grid.cell : cell;
  const int times = coarse != nullptr ? 2 : 1;
  const Eigen::Vector3i low = times * (box.low / unit).array().floor().cast<int>().matrix();
  const Eigen::Vector3i high = times * (box.high / unit).array().ceil().cast<int>().matrix();
  m_grid.cell = cell;
  m_grid.lowY = low.y();
  m_grid.lowZ = low.z();
  m_grid.rowsY = high.y() - low.y() + 1;
  m_grid.rowsZ = high.z() - low.z() + 1;
  const int count = high.x() - low.x() + 1;
  const auto rows = static_cast<std::size_t>(m_grid.rowsY) * static_cast<std::size_t>(m_grid.rowsZ);
  for (std::size_t i = 0; i < rows; ++i)
    m_grid.rows.push_back({low.x(), count, i * static_cast<std::size_t>(count)});
  m_grid.value.resize(rows * static_cast<std::size_t>(count));
  tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t i) {
    progress.check();
    const int y = low.y() + static_cast<int>(i) % m_grid.rowsY,
              z = low.z() + static_cast<int>(i) / m_grid.rowsY;
    double* out = m_grid.value.data() + m_grid.rows[i].offset;
    for (int x = 0; x < count; ++x) {
      const double known = coarse != nullptr ? coarse->knownSide(low.x() + x, y, z) : 0;
      out[x] = known != 0 ? known : field.value(cell * Vector3d(low.x() + x, y, z));
    }
  });
}

double SampledField::at(int x, int y, int z) const {
  const SampleGrid::SampleRow& row = m_grid.row(y - m_grid.lowY, z - m_grid.lowZ);
  return m_grid.value[row.offset + static_cast<std::size_t>(x - row.first)];
}

// A value of the sign that all samples around a place have; 0 near the wall. The place is given in
// halves of the cell.
double SampledField::knownSide(int x, int y, int z) const {
  const auto range = [](int place, int low, int count) {
    const int cell = place >= 0 ? place / 2 : -((1 - place) / 2);
    return std::pair{std::max(low, cell - kBand + 1), std::min(low + count - 1, cell + kBand)};
  };
  const auto [x0, x1] = range(x, m_grid.rows[0].first, m_grid.rows[0].count);
  const auto [y0, y1] = range(y, m_grid.lowY, m_grid.rowsY);
  const auto [z0, z1] = range(z, m_grid.lowZ, m_grid.rowsZ);
  const double first = at(x0, y0, z0);
  for (int k = z0; k <= z1; ++k)
    for (int j = y0; j <= y1; ++j)
      for (int i = x0; i <= x1; ++i)
        if ((at(i, j, k) > 0) != (first > 0)) return 0;
  return first != 0 ? first : -1;
}

LocalSurface SampledField::surface(const Vector3d& seed) const {
  const std::vector<SampleState> state = markLumen(m_grid, 0, seed, 2 * m_grid.cell);
  LocalSurface surface;
  surface.mesh =
      marchingCubes(m_grid, state, [&](const Vector3d& a, double fa, const Vector3d& b, double fb) {
        return crossing(m_field, a, fa, b, fb);
      });
  surface.isOpen.assign(surface.mesh.position.size(), 0);
  const std::vector<std::uint32_t> opposite = oppositeSides(surface.mesh.triangle);
  for (std::uint32_t side = 0; side < opposite.size(); ++side)
    if (opposite[side] == kNoSide)
      surface.isOpen[startOf(surface.mesh.triangle, side)] =
          surface.isOpen[endOf(surface.mesh.triangle, side)] = 1;
  return surface;
}

}  // namespace lumen::convert
