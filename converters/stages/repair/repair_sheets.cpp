// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "converters/io/mesh/mesh_builder.h"
#include "converters/stages/repair/repair_steps.h"

namespace lumen::convert {
namespace {

/// Reverses triangle t: corners 0 and 1 are exchanged, so the sides keep their edges but for those
/// of corners 1 and 2.
void turn(MeshInRepair& work, std::uint32_t t) {
  std::swap(work.mesh.triangle[t][1], work.mesh.triangle[t][2]);
  // sides 01, 12, 20 become 02, 21, 10: the first and the last are exchanged
  const std::array<std::uint32_t, 3> before = {work.opposite[3 * t], work.opposite[3 * t + 1],
                                               work.opposite[3 * t + 2]};
  const std::array<std::uint32_t, 3> after = {before[2], before[1], before[0]};
  for (std::uint32_t i = 0; i < 3; ++i) {
    work.opposite[3 * t + i] = after[i];
    if (after[i] != kNoSide) work.opposite[after[i]] = 3 * t + i;
  }
}

bool runSame(const MeshInRepair& work, std::uint32_t a, std::uint32_t b) {
  return startOf(work.mesh.triangle, a) == startOf(work.mesh.triangle, b);
}

/// Reverses triangles until those that `opposite` joins agree; as few as possible per part. Returns
/// the number of reversed triangles, and counts the pairs that cannot agree.
std::size_t propagate(MeshInRepair& work, std::size_t& disagreeing) {
  const std::size_t n = work.mesh.triangle.size();
  std::vector<std::int8_t> side(n, 0);  // 1: as it is, -1: to be turned
  std::vector<std::uint32_t> part;
  std::size_t turned = 0;
  disagreeing = 0;
  std::vector<bool> toTurn(n, false);
  for (std::uint32_t seed = 0; seed < n; ++seed) {
    if (side[seed] != 0) continue;
    side[seed] = 1;
    part.assign(1, seed);
    std::size_t flips = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::uint32_t t = part[i];
      flips += side[t] < 0 ? 1 : 0;
      for (std::uint32_t s = 3 * t; s < 3 * t + 3; ++s) {
        const std::uint32_t o = work.opposite[s];
        if (o == kNoSide) continue;
        const auto wanted = static_cast<std::int8_t>(runSame(work, s, o) ? -side[t] : side[t]);
        if (side[o / 3] == 0) {
          side[o / 3] = wanted;
          part.push_back(o / 3);
        } else if (side[o / 3] != wanted && o > s) {
          ++disagreeing;
        }
      }
    }
    const std::int8_t minority = 2 * flips > part.size() ? 1 : -1;
    for (const std::uint32_t t : part) toTurn[t] = side[t] == minority;
    turned += std::min(flips, part.size() - flips);
  }
  for (std::uint32_t t = 0; t < n; ++t)
    if (toTurn[t]) turn(work, t);
  return turned;
}

/// A side at an edge of many triangles.
struct Leaf {
  double angle;  ///< around the edge
  std::uint32_t side;
  bool along;  ///< runs along the edge from low to high
};

/// The triangles of an edge by their angle around it, seen against its direction.
std::vector<Leaf> sortLeaves(const MeshInRepair& work, std::span<const EdgeUse> edge) {
  const std::vector<Eigen::Vector3d>& position = work.mesh.position;
  const Eigen::Vector3d& low = position[edge[0].low];
  const Eigen::Vector3d axis = (position[edge[0].high] - low).normalized();
  const Eigen::Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  std::vector<Leaf> leaves;
  for (const EdgeUse& use : edge) {
    const Eigen::Vector3d tip = position[startOf(work.mesh.triangle, previousSide(use.side))] - low;
    leaves.push_back({std::atan2(tip.dot(v), tip.dot(u)), use.side,
                      startOf(work.mesh.triangle, use.side) == use.low});
  }
  std::sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) {
    return a.angle != b.angle ? a.angle < b.angle : a.side < b.side;
  });
  return leaves;
}

/// Pairs the two triangles of a sheet that runs over the edge: a flap that is attached to it is no
/// part of that sheet. `part` is that of each triangle; the other leaves are returned.
std::vector<Leaf> pairSheets(MeshInRepair& work, const std::vector<Leaf>& leaves,
                             const std::vector<std::uint32_t>& part) {
  std::vector<Leaf> left;
  for (const Leaf& leaf : leaves) {
    const auto same = [&](const Leaf& other) {
      return part[other.side / 3] == part[leaf.side / 3];
    };
    const auto other = std::find_if(leaves.begin(), leaves.end(), [&](const Leaf& l) {
      return same(l) && l.along != leaf.along;
    });
    if (std::count_if(leaves.begin(), leaves.end(), same) == 2 && other != leaves.end())
      work.opposite[leaf.side] = other->side;
    else
      left.push_back(leaf);
  }
  return left;
}

/// Pairs the triangles of an edge that have the inside between them. A triangle that runs along the
/// edge's direction has its normal towards growing angles, so the inside is before it: pairs are
/// one that runs back followed by one that runs along. In a mesh that is inside out the order is
/// reversed.
void pairLeaves(MeshInRepair& work, const std::vector<Leaf>& leaves, bool insideOut) {
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const Leaf &here = leaves[i], &next = leaves[(i + 1) % leaves.size()];
    if (here.along != insideOut || next.along == insideOut) continue;
    work.opposite[here.side] = next.side;
    work.opposite[next.side] = here.side;
  }
}

std::string countOf(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

[[noreturn]] void refuseOneSided(const std::string& name, std::size_t disagreeing) {
  refuseMesh(name, "",
             "the surface cannot be oriented: it has one side only, as a Moebius strip (" +
                 countOf(disagreeing, "edge", "edges") +
                 " where neighbours cannot agree); expected a surface with an inside and an "
                 "outside");
}

}  // namespace

std::size_t orientSheets(MeshInRepair& work, const std::string& name) {
  work.opposite = oppositeSides(work.mesh.triangle);
  std::size_t disagreeing = 0;
  const std::size_t turned = propagate(work, disagreeing);
  if (disagreeing > 0) refuseOneSided(name, disagreeing);
  return turned;
}

std::size_t cutEdges(MeshInRepair& work) {
  const bool insideOut = signedVolume(work.mesh) < 0;
  std::size_t cut = 0, parts = 0;
  const std::vector<std::uint32_t> part = labelParts(work, parts);
  forEachEdge(edgeUses(work.mesh.triangle), [&](std::span<const EdgeUse> edge) {
    if (edge.size() <= 2) return;
    pairLeaves(work, pairSheets(work, sortLeaves(work, edge), part), insideOut);
    ++cut;
  });
  return cut;
}

std::size_t splitPoints(MeshInRepair& work) {
  std::vector<Triangle>& triangle = work.mesh.triangle;
  const std::size_t points = work.mesh.position.size();
  std::vector<bool> taken(points, false), done(3 * triangle.size(), false);
  std::size_t split = 0;
  const auto across = [&](std::uint32_t corner) {  // the same point's corner beyond the side before
    return work.opposite[previousSide(corner)];
  };
  for (std::uint32_t corner = 0; corner < 3 * triangle.size(); ++corner) {
    if (done[corner]) continue;
    // back to the first triangle of the fan, or once around
    std::uint32_t first = corner;
    for (std::uint32_t o = work.opposite[first]; o != kNoSide; o = work.opposite[first]) {
      first = nextSide(o);
      if (first == corner) break;
    }
    const std::uint32_t point = triangle[corner / 3][corner % 3];
    std::uint32_t index = point;
    if (taken[point]) {
      index = static_cast<std::uint32_t>(work.mesh.position.size());
      work.mesh.position.push_back(Eigen::Vector3d(work.mesh.position[point]));
      ++split;
    }
    taken[point] = true;
    for (std::uint32_t c = first; c != kNoSide && !done[c]; c = across(c)) {
      done[c] = true;
      triangle[c / 3][c % 3] = index;
    }
  }
  return split;
}

}  // namespace lumen::convert
