// SPDX-License-Identifier: Apache-2.0
#include "libblob/wire/chain_solver.h"

namespace lumen::wire {

namespace {

/// The inverse, by cofactors.
Symmetric inverse(const Symmetric& m) {
  const auto [xx, yy, zz, xy, xz, yz] = m;
  const double a = yy * zz - yz * yz, b = xz * yz - xy * zz, c = xy * yz - xz * yy;
  const double scale = 1.0 / (xx * a + xy * b + xz * c);
  return {a * scale, (xx * zz - xz * xz) * scale, (xx * yy - xy * xy) * scale, b * scale,
          c * scale, (xy * xz - xx * yz) * scale};
}

Vec3 times(const Symmetric& m, const Vec3& v) {
  return {m[0] * v[0] + m[3] * v[1] + m[4] * v[2], m[3] * v[0] + m[1] * v[1] + m[5] * v[2],
          m[4] * v[0] + m[5] * v[1] + m[2] * v[2]};
}

Vec3 row(const Block& m, std::size_t r) {
  return {m[3 * r], m[3 * r + 1], m[3 * r + 2]};
}

}  // namespace

void ChainSolver::solve(std::size_t count, Vec3* b) {
  // elimination: node i changes the blocks of i + 1 and i + 2
  for (std::size_t i = 0; i < count; ++i) {
    const Symmetric inverted = inverse(diagonal[i]);
    diagonal[i] = inverted;
    const Vec3 part = times(inverted, b[i]);
    m_part[i] = part;
    if (i + 1 >= count) break;
    const Block& across = next[i];
    const std::array<Vec3, 3> left{times(inverted, row(across, 0)), times(inverted, row(across, 1)),
                                   times(inverted, row(across, 2))};
    Symmetric& after = diagonal[i + 1];
    for (std::size_t r = 0; r < 3; ++r) {
      after[r] -= dot(left[r], row(across, r));
      b[i + 1][r] -= dot(row(across, r), part);
    }
    after[3] -= dot(left[0], row(across, 1));
    after[4] -= dot(left[0], row(across, 2));
    after[5] -= dot(left[1], row(across, 2));
    if (i + 2 >= count) continue;
    const double k = second[i];
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) next[i + 1][3 * r + c] -= k * left[c][r];
      b[i + 2][r] -= k * part[r];
    }
    for (std::size_t e = 0; e < 6; ++e) diagonal[i + 2][e] -= k * k * inverted[e];
  }
  for (std::size_t i = count; i-- > 0;) {
    Vec3 pull{};
    if (i + 1 < count)
      for (std::size_t c = 0; c < 3; ++c)
        pull[c] =
            next[i][c] * b[i + 1][0] + next[i][3 + c] * b[i + 1][1] + next[i][6 + c] * b[i + 1][2];
    if (i + 2 < count)
      for (std::size_t c = 0; c < 3; ++c) pull[c] += second[i] * b[i + 2][c];
    const Vec3 less = times(diagonal[i], pull);
    for (std::size_t c = 0; c < 3; ++c) b[i][c] = m_part[i][c] - less[c];
  }
}

}  // namespace lumen::wire
