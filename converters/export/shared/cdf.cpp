// SPDX-License-Identifier: Apache-2.0
// Declared in grid_files.h.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "converters/export/shared/grid_files.h"
#include "converters/export/shared/grid_shortcuts.h"

namespace lumen::convert {

namespace {

static_assert(std::endian::native == std::endian::little, "the file has the machine's numbers");

constexpr std::size_t kNodesOfCell = 32;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
/// Bullet counts its bytes in an int.
constexpr double kMostBytes = 2147483647;
/// Nodes that are held at once: 512 MB of floats.
constexpr std::size_t kMostNodes = std::size_t{1} << 27;

template <class T>
void append(std::string& bytes, const T& value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(T));
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}

template <class T>
void appendList(std::string& bytes, const std::vector<T>& values) {
  append(bytes, std::uint64_t{1});  // fields
  append(bytes, static_cast<std::uint64_t>(values.size()));
  const std::size_t at = bytes.size();
  bytes.resize(at + values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(bytes.data() + at, values.data(), values.size() * sizeof(T));
}

std::vector<float> sampleNodes(const GridSource& source, const Lattice& lattice,
                               const CdfNodes& nodes, double unit, Progress& progress) {
  const GridShortcuts shortcuts(source, lattice, progress);
  std::vector<float> values;
  for (std::size_t which = 0; which < 4; ++which) {
    const CdfNodes::Family family = nodes.family(which);
    const auto answers = sampleRows(
        shortcuts.source(), family.rows, family.length,
        [&](std::size_t row, std::size_t index) {
          return Eigen::Vector3d(lattice.first + lattice.spacing * nodes.place(which, row, index));
        },
        progress);
    for (const WallDistance& answer : answers)
      values.push_back(static_cast<float>(-static_cast<double>(answer.distance) / unit));
  }
  return values;
}

struct Cells {
  std::vector<double> nodes;
  std::vector<std::array<std::uint32_t, kNodesOfCell>> cells;
  std::vector<std::uint32_t> map;  ///< number of each cell of the lattice, or kNone
};

/// The cells that have a node within `band`, and the nodes that they have.
Cells keepBand(const std::vector<float>& values, const CdfNodes& nodes,
               const std::array<std::size_t, 3>& n, double band) {
  Cells kept;
  std::vector<std::uint32_t> newIndex(values.size(), kNone);
  for (std::size_t k = 0; k < n[2]; ++k)
    for (std::size_t j = 0; j < n[1]; ++j)
      for (std::size_t i = 0; i < n[0]; ++i) {
        auto cell = nodes.ofCell(i, j, k);
        const bool isKept = std::any_of(cell.begin(), cell.end(), [&](std::uint32_t v) {
          return std::abs(static_cast<double>(values[v])) < band;
        });
        kept.map.push_back(isKept ? static_cast<std::uint32_t>(kept.cells.size()) : kNone);
        if (!isKept) continue;
        for (std::uint32_t& v : cell) {
          if (newIndex[v] == kNone) {
            newIndex[v] = static_cast<std::uint32_t>(kept.nodes.size());
            kept.nodes.push_back(static_cast<double>(values[v]));
          }
          v = newIndex[v];
        }
        kept.cells.push_back(cell);
      }
  return kept;
}

void appendHead(std::string& bytes, const Lattice& lattice, const std::array<std::size_t, 3>& n,
                double unit) {
  for (const double x : lattice.first) append(bytes, x / unit);
  const Eigen::Vector3d last = lattice.last();
  for (const double x : last) append(bytes, x / unit);
  for (const std::size_t count : n) append(bytes, static_cast<std::uint32_t>(count));
  for (int a = 0; a < 3; ++a) append(bytes, lattice.spacing / unit);
  for (int a = 0; a < 3; ++a) append(bytes, unit / lattice.spacing);
  append(bytes, static_cast<std::uint64_t>(n[0] * n[1] * n[2]));
  append(bytes, std::uint64_t{1});  // fields
}

/// `cells`: those that are kept, of `all`.
void requireLoadable(double all, double cells, double nodes, const Lattice& lattice) {
  const double bytes = all * 4 + cells * kNodesOfCell * 4 + nodes * 8 + 200;
  if (bytes > kMostBytes)
    refuseSpacing(lattice, "the .cdf would have " + std::to_string(std::llround(bytes / 1e6)) +
                               " MB, and Bullet loads less than 2147");
}

}  // namespace

CdfNodes::Family CdfNodes::family(std::size_t which) const {
  const auto [x, y, z] = m_cells;
  if (which == 0) return {(y + 1) * (z + 1), x + 1};
  if (which == 1) return {(y + 1) * (z + 1), 2 * x};
  if (which == 2) return {(x + 1) * (z + 1), 2 * y};
  return {(x + 1) * (y + 1), 2 * z};
}

Eigen::Vector3d CdfNodes::place(std::size_t which, std::size_t row, std::size_t index) const {
  const auto [x, y, z] = m_cells;
  const auto number = [](std::size_t n) { return static_cast<double>(n); };
  const double along = number(index / 2) + number(1 + index % 2) / 3;
  if (which == 0) return {number(index), number(row % (y + 1)), number(row / (y + 1))};
  if (which == 1) return {along, number(row % (y + 1)), number(row / (y + 1))};
  if (which == 2) return {number(row / (z + 1)), along, number(row % (z + 1))};
  return {number(row % (x + 1)), number(row / (x + 1)), along};
}

std::array<std::uint32_t, 32> CdfNodes::ofCell(std::size_t i, std::size_t j, std::size_t k) const {
  std::array<std::uint32_t, 32> nodes{};
  const auto [x, y, z] = m_cells;
  std::size_t at = 0;
  const auto put = [&](std::size_t node) { nodes[at++] = static_cast<std::uint32_t>(node); };
  const auto putPair = [&](std::size_t first) {
    put(first);
    put(first + 1);
  };
  for (const std::size_t c : {k, k + 1})
    for (const std::size_t b : {j, j + 1})
      for (const std::size_t a : {i, i + 1}) put((c * (y + 1) + b) * (x + 1) + a);
  std::size_t begin = (x + 1) * (y + 1) * (z + 1);
  for (const std::size_t b : {j, j + 1})
    for (const std::size_t c : {k, k + 1}) putPair(begin + 2 * ((c * (y + 1) + b) * x + i));
  begin += 2 * x * (y + 1) * (z + 1);
  for (const std::size_t c : {k, k + 1})
    for (const std::size_t a : {i, i + 1}) putPair(begin + 2 * ((a * (z + 1) + c) * y + j));
  begin += 2 * (x + 1) * y * (z + 1);
  for (const std::size_t a : {i, i + 1})
    for (const std::size_t b : {j, j + 1}) putPair(begin + 2 * ((b * (x + 1) + a) * z + k));
  return nodes;
}

std::string encodeCdf(const GridSource& source, const Lattice& lattice, double unit,
                      Progress& progress) {
  std::array<std::size_t, 3> n{};
  double cells = 1, samples = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    n[a] = static_cast<std::size_t>(lattice.size[a] - 1);
    cells *= static_cast<double>(n[a]);
  }
  const CdfNodes nodes(n);
  for (std::size_t which = 0; which < 4; ++which)
    samples += static_cast<double>(nodes.family(which).rows * nodes.family(which).length);
  if (samples > static_cast<double>(kMostNodes))
    refuseSpacing(lattice, "this makes more nodes in the .cdf than " + std::to_string(kMostNodes));
  if (!std::isfinite(source.band)) requireLoadable(cells, cells, samples, lattice);
  // cells at the band's border have all their nodes: none is clamped that is within a cell's
  // diagonal
  const GridSource beyond{source.vessels, source.region, source.band + 2 * lattice.spacing};
  const std::vector<float> values = sampleNodes(beyond, lattice, nodes, unit, progress);
  const Cells kept = keepBand(values, nodes, n, source.band / unit);
  requireLoadable(cells, static_cast<double>(kept.cells.size()),
                  static_cast<double>(kept.nodes.size()), lattice);
  std::string bytes;
  appendHead(bytes, lattice, n, unit);
  appendList(bytes, kept.nodes);
  appendList(bytes, kept.cells);
  appendList(bytes, kept.map);
  return bytes;
}

}  // namespace lumen::convert
