// SPDX-License-Identifier: Apache-2.0
// Cells of a voxel grid, and boxes of them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

namespace lumen::convert {

/// The integer place of a voxel in its volume: along i (fastest), j, k.
using Cell = Eigen::Vector3i;

/// The steps from a cell to those that share a face with it.
inline const std::array<Cell, 6> kFaceSteps = {Cell(-1, 0, 0), Cell(1, 0, 0),  Cell(0, -1, 0),
                                               Cell(0, 1, 0),  Cell(0, 0, -1), Cell(0, 0, 1)};

/// A box of cells, numbered from 0 with i fastest.
struct CellBox {
  Cell low = Cell::Zero(), size = Cell::Zero();

  /// The box with both corners included.
  static CellBox between(const Cell& first, const Cell& last) {
    return {first, last - first + Cell::Ones()};
  }

  /// The last cell along every axis.
  [[nodiscard]] Cell high() const { return low + size - Cell::Ones(); }

  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
           static_cast<std::size_t>(size[2]);
  }
  [[nodiscard]] bool contains(const Cell& cell) const {
    const Cell at = cell - low;
    return (at.array() >= 0).all() && (at.array() < size.array()).all();
  }
  /// The number of a cell of the box.
  [[nodiscard]] std::size_t index(const Cell& cell) const {
    return (static_cast<std::size_t>(cell[2] - low[2]) * static_cast<std::size_t>(size[1]) +
            static_cast<std::size_t>(cell[1] - low[1])) *
               static_cast<std::size_t>(size[0]) +
           static_cast<std::size_t>(cell[0] - low[0]);
  }
  /// The cell with a given number.
  [[nodiscard]] Cell cell(std::size_t index) const {
    const auto nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]);
    const std::size_t row = index / nx;
    return low + Cell(static_cast<int>(index % nx), static_cast<int>(row % ny),
                      static_cast<int>(row / ny));
  }
  /// The difference between the numbers of two neighbours along an axis.
  [[nodiscard]] std::size_t stride(int axis) const {
    std::size_t stride = 1;
    for (int a = 0; a < axis; ++a) stride *= static_cast<std::size_t>(size[a]);
    return stride;
  }
  /// The cell nearest to a position in index space; empty if it lies outside of the box.
  [[nodiscard]] std::optional<Cell> nearest(const Eigen::Vector3d& position) const {
    Cell cell;
    for (int a = 0; a < 3; ++a) {
      const double nearest = std::round(position[a]) - low[a];
      if (!(nearest >= 0 && nearest < size[a])) return {};
      cell[a] = low[a] + static_cast<int>(nearest);
    }
    return cell;
  }

  /// The intersection of this box and another one; empty boxes have a size of 0.
  [[nodiscard]] CellBox meet(const CellBox& other) const {
    const Cell first = low.cwiseMax(other.low), last = high().cwiseMin(other.high());
    return between(first, last.cwiseMax(first - Cell::Ones()));
  }

  /// Calls visit(cell) for every cell, in the order of their numbers.
  template <class Visit>
  void forEach(Visit&& visit) const {
    for (int z = low[2]; z < low[2] + size[2]; ++z)
      for (int y = low[1]; y < low[1] + size[1]; ++y)
        for (int x = low[0]; x < low[0] + size[0]; ++x) visit(Cell(x, y, z));
  }

  /// Calls visit(cell) for every other cell of the box that shares a corner with a cell.
  template <class Visit>
  void forEachNeighbour(const Cell& cell, Visit&& visit) const {
    meet(between(cell - Cell::Ones(), cell + Cell::Ones())).forEach([&](const Cell& other) {
      if (other != cell) visit(other);
    });
  }
};

}  // namespace lumen::convert
