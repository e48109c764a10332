// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/triangle_block.h"

#include "converters/base/simd.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// T. Moeller and B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
LUMEN_SIMD_CLONES void meetFour(const double* __restrict corner, const double* __restrict from,
                                const double* __restrict to, double* __restrict distances,
                                double* __restrict dets) {
  constexpr std::size_t kWidth = TriangleBlock::kWidth;
  for (std::size_t k = 0; k < kWidth; ++k) {
    const double ax = corner[k], ay = corner[kWidth + k], az = corner[2 * kWidth + k];
    const double bx = corner[3 * kWidth + k] - ax, by = corner[4 * kWidth + k] - ay,
                 bz = corner[5 * kWidth + k] - az;
    const double cx = corner[6 * kWidth + k] - ax, cy = corner[7 * kWidth + k] - ay,
                 cz = corner[8 * kWidth + k] - az;
    const double dx = to[0], dy = to[1], dz = to[2];
    const double px = dy * cz - dz * cy, py = dz * cx - dx * cz, pz = dx * cy - dy * cx;
    const double det = bx * px + by * py + bz * pz;
    const double ox = from[0] - ax, oy = from[1] - ay, oz = from[2] - az;
    const double u = (ox * px + oy * py + oz * pz) / det;
    const double qx = oy * bz - oz * by, qy = oz * bx - ox * bz, qz = ox * by - oy * bx;
    const double v = (dx * qx + dy * qy + dz * qz) / det;
    double distance = (cx * qx + cy * qy + cz * qz) / det;
    // not a number where the triangle has no area: then no comparison holds
    distance = u >= 0 ? distance : -1;
    distance = v >= 0 ? distance : -1;
    distance = u + v <= 1 ? distance : -1;
    distances[k] = distance;
    dets[k] = det;
  }
}

// nearestPointOnTriangle() without branches, by the same operations.
LUMEN_SIMD_CLONES void nearestFour(const double* __restrict corner, const double* __restrict p,
                                   double* __restrict squared, double* __restrict outX,
                                   double* __restrict outY, double* __restrict outZ) {
  constexpr std::size_t kWidth = TriangleBlock::kWidth;
  for (std::size_t k = 0; k < kWidth; ++k) {
    const double ax = corner[k], ay = corner[kWidth + k], az = corner[2 * kWidth + k];
    const double bx = corner[3 * kWidth + k], by = corner[4 * kWidth + k],
                 bz = corner[5 * kWidth + k];
    const double cx = corner[6 * kWidth + k], cy = corner[7 * kWidth + k],
                 cz = corner[8 * kWidth + k];
    const double abX = bx - ax, abY = by - ay, abZ = bz - az;
    const double acX = cx - ax, acY = cy - ay, acZ = cz - az;
    const double apX = p[0] - ax, apY = p[1] - ay, apZ = p[2] - az;
    const double bpX = p[0] - bx, bpY = p[1] - by, bpZ = p[2] - bz;
    const double cpX = p[0] - cx, cpY = p[1] - cy, cpZ = p[2] - cz;
    const double d1 = abX * apX + abY * apY + abZ * apZ, d2 = acX * apX + acY * apY + acZ * apZ;
    const double d3 = abX * bpX + abY * bpY + abZ * bpZ, d4 = acX * bpX + acY * bpY + acZ * bpZ;
    const double d5 = abX * cpX + abY * cpY + abZ * cpZ, d6 = acX * cpX + acY * cpY + acZ * cpZ;
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    const double along = d4 - d3, back = d5 - d6, sum = va + vb + vc;
    // within the triangle, then what overrides it, from the last of the reference's cases
    double u = sum > 0 ? vb / sum : 0, v = sum > 0 ? vc / sum : 0;
    double fromX = ax, fromY = ay, fromZ = az, sideX = abX, sideY = abY, sideZ = abZ;
    const bool onBC = (va <= 0) & (along >= 0) & (back >= 0);
    u = onBC ? (along + back > 0 ? along / (along + back) : 0) : u;
    v = onBC ? 0 : v;
    const bool onAC = (vb <= 0) & (d2 >= 0) & (d6 <= 0);
    u = onAC ? 0 : u;
    v = onAC ? (d2 - d6 > 0 ? d2 / (d2 - d6) : 0) : v;
    const bool atC = (d6 >= 0) & (d5 <= d6);
    const bool onAB = (vc <= 0) & (d1 >= 0) & (d3 <= 0);
    u = onAB ? (d1 - d3 > 0 ? d1 / (d1 - d3) : 0) : u;
    const bool atB = (d3 >= 0) & (d4 <= d3), atA = (d1 <= 0) & (d2 <= 0);
    const bool isFirst = onAB | atB | atA;  // one of the cases before that of the corner c
    const bool isC = atC & !isFirst, isB = atB & !atA, isEdgeBC = onBC & !(onAC | atC | isFirst);
    const bool fromB = isB | isEdgeBC, isCorner = isC | atB | atA;
    u = isCorner ? 0 : u;
    v = (isCorner | onAB) ? 0 : v;
    fromX = fromB ? bx : fromX;
    fromY = fromB ? by : fromY;
    fromZ = fromB ? bz : fromZ;
    fromX = isC ? cx : fromX;
    fromY = isC ? cy : fromY;
    fromZ = isC ? cz : fromZ;
    sideX = isEdgeBC ? cx - bx : sideX;
    sideY = isEdgeBC ? cy - by : sideY;
    sideZ = isEdgeBC ? cz - bz : sideZ;
    const double x = fromX + u * sideX + v * acX, y = fromY + u * sideY + v * acY,
                 z = fromZ + u * sideZ + v * acZ;
    outX[k] = x;
    outY[k] = y;
    outZ[k] = z;
    squared[k] = (x - p[0]) * (x - p[0]) + (y - p[1]) * (y - p[1]) + (z - p[2]) * (z - p[2]);
  }
}

}  // namespace

void TriangleBlock::set(std::size_t k, const std::array<Vector3d, 3>& triangle) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      corner[i][axis][k] = triangle[i][static_cast<Eigen::Index>(axis)];
}

void meetBlock(const TriangleBlock& block, const Vector3d& origin, const Vector3d& direction,
               BlockHits& out) {
  meetFour(block.corner[0][0].data(), origin.data(), direction.data(), out.distance.data(),
           out.det.data());
}

void nearestInBlock(const TriangleBlock& block, const Vector3d& point, BlockPoints& out) {
  nearestFour(block.corner[0][0].data(), point.data(), out.squared.data(), out.at[0].data(),
              out.at[1].data(), out.at[2].data());
}

// The point of a triangle that is nearest to `p` (C. Ericson, "Real-time collision detection",
// 2005, section 5.1.5).
Vector3d nearestPointOnTriangle(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                                const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return d1 - d3 > 0 ? Vector3d(a + d1 / (d1 - d3) * ab) : a;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return d2 - d6 > 0 ? Vector3d(a + d2 / (d2 - d6) * ac) : a;
  const double va = d3 * d6 - d5 * d4, along = d4 - d3, back = d5 - d6;
  if (va <= 0 && along >= 0 && back >= 0)
    return along + back > 0 ? Vector3d(b + along / (along + back) * (c - b)) : b;
  const double sum = va + vb + vc;
  return sum > 0 ? Vector3d(a + ab * (vb / sum) + ac * (vc / sum)) : a;
}

}  // namespace lumen::convert
