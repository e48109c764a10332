// SPDX-License-Identifier: Apache-2.0
// Files of Discregrid (.cdf): distances as cubic polynomials on cells, which Bullet's
// btSdfCollisionShape loads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "converters/base/field_word.h"
#include "converters/base/progress.h"
#include "converters/export/shared/distance_grid.h"

namespace lumen::convert {

/// A cell has a node at each corner, and two on each edge, at a third and two thirds. Nodes are in
/// the file's order: corners, then those of edges along x, y and z, in which x, y and z run
/// fastest, in turn.
class CdfNodes {
public:
  explicit CdfNodes(const std::array<std::size_t, 3>& cells) : m_cells(cells) {}
  /// Rows of nodes along an axis: 0 the corners, along x; 1, 2 and 3 the edges along x, y and z.
  struct Family {
    std::size_t rows = 0, length = 0;
  };
  [[nodiscard]] Family family(std::size_t which) const;
  /// Place of a node, in cells from the first corner.
  [[nodiscard]] Eigen::Vector3d place(std::size_t which, std::size_t row, std::size_t index) const;
  /// The 32 nodes of a cell, in the order of Discregrid's shape functions.
  [[nodiscard]] std::array<std::uint32_t, 32> ofCell(std::size_t i, std::size_t j,
                                                     std::size_t k) const;

private:
  std::array<std::size_t, 3> m_cells;
};

/// Cells between the lattice's samples; distances positive in the lumen, where Bullet lets bodies
/// move. With a band, cells without a node in it are left out, and a query there has no answer.
/// `unit`: lengths of the file in mm, 1 or 1000. Throws Error(Usage) for a lattice whose file
/// Bullet could not load (2^31 bytes), Error(Cancelled).
std::string encodeCdf(const GridSource& source, const Lattice& lattice, double unit,
                      Progress& progress);

// OpenVDB level sets, where the library was there when lumen was built.

/// Throws Error(Unsupported), with the field "format", without the library.
void requireVdb(const FieldWord& word);

struct VdbOptions {
  double unit = 1;    ///< lengths of the file in mm: 1 or 1000
  bool half = false;  ///< distances of 16 bits
};

/// A level set "distance", negative in the lumen, of the class "level set", whose background is the
/// band, which must be finite; and a grid of integers "branch": for a sample in the lumen the index
/// of its branch and 1, elsewhere 0. Both have a linear transform to positions in LPS. Equal
/// samples give equal bytes. Throws as requireVdb(), and Error(Cancelled).
std::string encodeVdb(const GridSource& source, const Lattice& lattice, const VdbOptions& options,
                      Progress& progress);

// Arrays as NumPy's .npy files, version 1.0, little-endian, in C order.

/// The last entry of `shape` runs fastest; its product is the number of values.
std::string encodeNpy(std::span<const float> values, const std::vector<std::size_t>& shape);
std::string encodeNpy(std::span<const std::uint8_t> values, const std::vector<std::size_t>& shape);
std::string encodeNpy(std::span<const std::int64_t> values, const std::vector<std::size_t>& shape);

}  // namespace lumen::convert
