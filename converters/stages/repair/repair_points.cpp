// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

#include "converters/geometry/disjoint_sets.h"
#include "converters/stages/repair/repair_steps.h"

namespace lumen::convert {
namespace {

// Share of the box's diagonal: ten times the resolution of f32, far below the side of any triangle.
constexpr double kSamePoint = 1e-6;

/// Triangles with points renumbered; returns the number of distinct points that were dropped.
std::size_t renumber(MeshInRepair& work, const std::vector<std::uint32_t>& same) {
  std::size_t merged = 0;
  for (std::size_t i = 0; i < same.size(); ++i) merged += same[i] != i ? 1 : 0;
  if (merged > 0)
    for (Triangle& t : work.mesh.triangle)
      for (std::uint32_t& v : t) v = same[v];
  return merged;
}

/// For each point the lowest index in its chain of points within `tolerance` of one another. A
/// sweep along x: few points share so thin a slab.
std::vector<std::uint32_t> closePoints(const std::vector<Eigen::Vector3d>& position,
                                       double tolerance) {
  std::vector<std::uint32_t> order(position.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto cell = [&](double x) { return std::floor(x / (8 * tolerance)); };
  const auto key = [&](std::uint32_t i) {
    const Eigen::Vector3d& p = position[i];
    return std::tuple(cell(p.x()), cell(p.y()), p.z());
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple_cat(key(a), std::tuple(a)) < std::tuple_cat(key(b), std::tuple(b));
  });
  DisjointSets sets(position.size());
  const auto joinRun = [&](std::size_t i, std::size_t j) {
    for (; j < order.size(); ++j) {
      const Eigen::Vector3d &p = position[order[i]], &q = position[order[j]];
      if (cell(p.x()) != cell(q.x()) || cell(p.y()) != cell(q.y()) || q.z() - p.z() > tolerance)
        return;
      if ((p - q).squaredNorm() <= tolerance * tolerance) sets.join(order[i], order[j]);
    }
  };
  for (std::size_t i = 0; i < order.size(); ++i) joinRun(i, i + 1);
  std::vector<std::uint32_t> same(position.size());
  for (std::uint32_t i = 0; i < same.size(); ++i) same[i] = sets.find(i);
  return same;
}

}  // namespace

void MeshInRepair::record(const char* verb, std::size_t count, const char* one, const char* many) {
  if (count > 0)
    repairs.push_back(std::string(verb) + " " + std::to_string(count) + " " +
                      (count == 1 ? one : many));
}

std::size_t MeshInRepair::dropTriangles(const std::vector<bool>& drop) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    if (drop[t]) continue;
    mesh.triangle[kept] = mesh.triangle[t];
    source[kept++] = source[t];
  }
  const std::size_t dropped = mesh.triangle.size() - kept;
  mesh.triangle.resize(kept);
  source.resize(kept);
  opposite.clear();
  return dropped;
}

void mergePoints(MeshInRepair& work) {
  std::size_t merged = renumber(work, equalPoints(work.mesh.position));
  dropUnusedPoints(work);
  const double tolerance = kSamePoint * boundingBox(work.mesh).size().norm();
  if (tolerance > 0) {
    // again in cells that are shifted by half, so that no pair is torn by the border of a cell
    for (int shift = 0; shift < 4; ++shift) {
      const Eigen::Vector3d by(shift % 2 * 4 * tolerance, shift / 2 * 4 * tolerance, 0);
      std::vector<Eigen::Vector3d> shifted = work.mesh.position;
      for (Eigen::Vector3d& p : shifted) p += by;
      merged += renumber(work, closePoints(shifted, tolerance));
    }
    dropUnusedPoints(work);
  }
  work.record("merged", merged, "duplicate point", "duplicate points");
}

void dropUnusedPoints(MeshInRepair& work) {
  std::vector<std::uint32_t> place(work.mesh.position.size(), 0);
  for (const Triangle& t : work.mesh.triangle)
    for (const std::uint32_t v : t) place[v] = 1;
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] == 0) continue;
    work.mesh.position[kept] = work.mesh.position[v];
    place[v] = kept++;
  }
  work.mesh.position.resize(kept);
  for (Triangle& t : work.mesh.triangle)
    for (std::uint32_t& v : t) v = place[v];
}

namespace {

/// The side of a sliver that is as long as both others together.
std::uint32_t longestSide(const TriangleMesh& mesh, std::uint32_t triangle) {
  std::uint32_t longest = 3 * triangle;
  double length = -1;
  for (std::uint32_t s = 3 * triangle; s < 3 * triangle + 3; ++s) {
    const double l =
        (mesh.position[startOf(mesh.triangle, s)] - mesh.position[endOf(mesh.triangle, s)])
            .squaredNorm();
    if (l > length) {
      length = l;
      longest = s;
    }
  }
  return longest;
}

/// Gives the neighbour across a sliver's longest side the sliver's middle point: both become the
/// halves of the neighbour. False if there is not one such neighbour.
bool giveToNeighbour(MeshInRepair& work, std::uint32_t sliver, const std::vector<EdgeUse>& uses,
                     std::vector<bool>& changed) {
  std::vector<Triangle>& triangle = work.mesh.triangle;
  const std::uint32_t side = longestSide(work.mesh, sliver);
  const auto [low, high] = std::minmax({startOf(triangle, side), endOf(triangle, side)});
  const std::uint32_t middle = startOf(triangle, previousSide(side));
  const EdgeUse edge{low, high, 0};
  const auto first =
      std::lower_bound(uses.begin(), uses.end(), edge, [](const EdgeUse& a, const EdgeUse& b) {
        return std::tie(a.low, a.high) < std::tie(b.low, b.high);
      });
  std::uint32_t other = kNoSide;
  std::size_t count = 0;
  for (auto use = first; use != uses.end() && use->sameEdge(edge); ++use) {
    ++count;
    if (use->side / 3 != sliver) other = use->side;
  }
  if (count != 2 || other == kNoSide || changed[other / 3]) return false;
  const Triangle n = triangle[other / 3];
  const std::uint32_t from = n[other % 3], to = n[(other % 3 + 1) % 3],
                      tip = n[(other % 3 + 2) % 3];
  if (tip == middle) return false;
  triangle[other / 3] = {from, middle, tip};
  triangle[sliver] = {middle, to, tip};
  changed[other / 3] = changed[sliver] = true;
  return true;
}

}  // namespace

void dropDegenerate(MeshInRepair& work) {
  constexpr int kPasses = 8;  // a row of slivers needs a pass for each
  std::size_t dropped = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<bool> drop(work.mesh.triangle.size(), false);
    std::vector<std::uint32_t> slivers;
    for (std::uint32_t t = 0; t < drop.size(); ++t) {
      const Triangle& points = work.mesh.triangle[t];
      const bool repeats =
          points[0] == points[1] || points[1] == points[2] || points[2] == points[0];
      drop[t] = repeats;
      if (!repeats && isDegenerate(work.mesh, points)) slivers.push_back(t);
    }
    const std::size_t repeating = work.dropTriangles(drop);
    dropped += repeating;
    if (repeating > 0) {
      --pass;  // indices moved; look again, with fewer triangles
      continue;
    }
    if (slivers.empty()) break;
    const std::vector<EdgeUse> uses = edgeUses(work.mesh.triangle);
    std::vector<bool> changed(work.mesh.triangle.size(), false), gone = changed;
    for (const std::uint32_t sliver : slivers) {
      if (changed[sliver]) continue;
      const bool last = pass + 1 == kPasses;
      if (last || !giveToNeighbour(work, sliver, uses, changed)) gone[sliver] = true;
      ++dropped;
    }
    work.dropTriangles(gone);
  }
  work.record("dropped", dropped, "triangle without area", "triangles without area");
}

void dropDuplicates(MeshInRepair& work) {
  std::vector<std::pair<Triangle, std::uint32_t>> sorted;
  sorted.reserve(work.mesh.triangle.size());
  for (const Triangle& t : work.mesh.triangle) {
    Triangle key = t;
    std::sort(key.begin(), key.end());
    sorted.emplace_back(key, static_cast<std::uint32_t>(sorted.size()));
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<bool> drop(sorted.size(), false);
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[i - 1].first) drop[sorted[i].second] = true;
  work.record("dropped", work.dropTriangles(drop), "triangle that was there twice",
              "triangles that were there twice");
}

}  // namespace lumen::convert
