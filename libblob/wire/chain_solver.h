// SPDX-License-Identifier: Apache-2.0
// Equations of a chain of nodes, each coupled to two on either side, solved directly.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace lumen::wire {

using Vec3 = std::array<double, 3>;

inline double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// a + scale * b.
inline Vec3 plus(const Vec3& a, double scale, const Vec3& b) {
  return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
}

/// A symmetric block of 3 by 3: xx, yy, zz, xy, xz, yz.
using Symmetric = std::array<double, 6>;

/// A block, by rows.
using Block = std::array<double, 9>;

/// A symmetric positive definite matrix of nodes in 3D: blocks on the diagonal, blocks between
/// neighbours, and multiples of the identity between a node and the one after the next.
class ChainSolver {
public:
  void resize(std::size_t nodes) {
    diagonal.resize(nodes);
    next.resize(nodes);
    second.resize(nodes);
    m_part.resize(nodes);
  }

  std::vector<Symmetric> diagonal;
  std::vector<Block> next;     ///< entry i: rows of node i + 1, columns of node i
  std::vector<double> second;  ///< entry i: between nodes i and i + 2

  /// Replaces the first `count` vectors of `b` by the solution, and the diagonal by its inverses
  /// on the way (block LDL^T; G. Golub and C. Van Loan, Matrix Computations, 4th ed. 2013, 4.5.2).
  void solve(std::size_t count, Vec3* b);

private:
  std::vector<Vec3> m_part;
};

}  // namespace lumen::wire
