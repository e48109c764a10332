// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/remesh/mend_crossings.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include "converters/geometry/box_tree.h"
#include "converters/stages/surface/remesh/remesh.h"

namespace lumen::convert {

Box3d boxOf(const TriangleMesh& mesh, const Triangle& triangle) {
  Box3d box;
  for (const std::uint32_t v : triangle) box.add(mesh.position[v]);
  return box;
}

BoxSet::BoxSet(std::vector<Box3d> boxes) : m_boxes(std::move(boxes)) {
  if (m_boxes.empty()) return;
  std::vector<Eigen::Vector3d> middles;
  middles.reserve(m_boxes.size());
  for (const Box3d& box : m_boxes) middles.push_back(box.middle());
  m_tree = BoxTree<double>(m_boxes, middles);
}

bool BoxSet::meets(const Box3d& box) const {
  return anyItemNear(m_tree, box, [&](std::uint32_t i) { return m_boxes[i].meets(box); });
}

namespace {

constexpr std::size_t kMostPairs = 1'000'000;
constexpr int kMostRounds = 8;
constexpr int kMostSmoothings = 30;

std::vector<bool> isOnEnd(const CaseSurface& surface) {
  std::vector<bool> result(surface.mesh.position.size(), false);
  for (std::size_t t = 0; t < surface.mesh.triangle.size(); ++t)
    if (surface.groups[surface.group[t]].kind != FaceKind::Wall)
      for (const std::uint32_t v : surface.mesh.triangle[t]) result[v] = true;
  return result;
}

// The vertices of crossing triangles that may move, ascending.
std::vector<std::uint32_t> crossingVertices(const TriangleMesh& mesh,
                                            const SelfIntersections& found,
                                            const std::vector<bool>& isFixed) {
  std::vector<std::uint32_t> vertices;
  for (const auto& pair : found.pairs)
    for (const std::uint32_t t : pair)
      for (const std::uint32_t v : mesh.triangle[t])
        if (!isFixed[v]) vertices.push_back(v);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

// Moves each of these vertices to the middle of its neighbours.
void moveToMiddles(TriangleMesh& mesh, const std::vector<std::uint32_t>& vertices) {
  std::vector<Eigen::Vector4d> sum(vertices.size(), Eigen::Vector4d::Zero());
  for (const Triangle& t : mesh.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = std::lower_bound(vertices.begin(), vertices.end(), t[i]);
      if (at == vertices.end() || *at != t[i]) continue;
      // a closed surface has each neighbour once as the next corner
      sum[static_cast<std::size_t>(at - vertices.begin())] +=
          mesh.position[t[(i + 1) % 3]].homogeneous();
    }
  for (std::size_t i = 0; i < vertices.size(); ++i)
    mesh.position[vertices[i]] = roundedToFloats(sum[i].hnormalized());
}

// Some triangles of a mesh, with their vertices alone.
TriangleMesh partOf(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  constexpr std::uint32_t kUnused = UINT32_MAX;
  std::vector<std::uint32_t> number(mesh.position.size(), kUnused);
  TriangleMesh part;
  part.triangle.reserve(triangles.size());
  for (const std::uint32_t t : triangles) {
    Triangle& corner = part.triangle.emplace_back(mesh.triangle[t]);
    for (std::uint32_t& v : corner) {
      if (number[v] == kUnused) {
        number[v] = static_cast<std::uint32_t>(part.position.size());
        part.position.push_back(mesh.position[v]);
      }
      v = number[v];
    }
  }
  return part;
}

}  // namespace

SelfIntersections crossingsAmong(const TriangleMesh& mesh, const std::vector<std::uint8_t>& isAmong,
                                 const Progress& progress) {
  std::vector<std::uint32_t> number;
  for (std::uint32_t t = 0; t < isAmong.size(); ++t)
    if (isAmong[t] != 0) number.push_back(t);
  const TriangleMesh part = partOf(mesh, number);
  SelfIntersections found = selfIntersections(part, kMostPairs, &progress);
  for (auto& pair : found.pairs) pair = {number[pair[0]], number[pair[1]]};
  return found;
}

namespace {

// The crossings of a mesh in which only triangles near those that have changed can cross.
SelfIntersections searchNear(const TriangleMesh& mesh, const std::vector<std::uint8_t>& isChanged,
                             const Progress& progress) {
  std::vector<Box3d> boxes;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    if (isChanged[t] != 0) boxes.push_back(boxOf(mesh, mesh.triangle[t]));
  const BoxSet changed(std::move(boxes));
  std::vector<std::uint8_t> isNear(mesh.triangle.size());
  tbb::parallel_for(std::size_t{0}, isNear.size(), [&](std::size_t t) {
    isNear[t] = changed.meets(boxOf(mesh, mesh.triangle[t])) ? 1 : 0;
  });
  return crossingsAmong(mesh, isNear, progress);
}

// The crossings after vertices were moved. Two triangles that cross now, and did not before, are
// both near one that changed.
SelfIntersections searchAgain(const TriangleMesh& mesh, const SelfIntersections& before,
                              const std::vector<std::uint32_t>& moved, const Progress& progress) {
  if (!before.isComplete) return selfIntersections(mesh, kMostPairs, &progress);
  std::vector<std::uint8_t> isMoved(mesh.position.size(), 0), isChanged(mesh.triangle.size(), 0);
  for (const std::uint32_t v : moved) isMoved[v] = 1;
  tbb::parallel_for(std::size_t{0}, isChanged.size(), [&](std::size_t t) {
    const auto& [a, b, c] = mesh.triangle[t];
    isChanged[t] = isMoved[a] | isMoved[b] | isMoved[c];
  });
  for (const auto& pair : before.pairs)
    for (const std::uint32_t t : pair) isChanged[t] = 1;
  return searchNear(mesh, isChanged, progress);
}

// Spreads the bits of the corners' coordinates (the finaliser of D. Stafford's Mix13).
std::uint64_t hashOf(const TriangleMesh& mesh, const Triangle& triangle) {
  std::uint64_t hash = 0;
  for (const std::uint32_t v : triangle)
    for (const double x : mesh.position[v]) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0xBF58476D1CE4E5B9ULL;
      hash = (hash ^ hash >> 27) * 0x94D049BB133111EBULL;
      hash ^= hash >> 31;
    }
  return hash;
}

}  // namespace

void CrossingSearch::keep(const TriangleMesh& mesh, const SelfIntersections& found) {
  std::vector<std::uint8_t> crosses(mesh.triangle.size(), 0);
  for (const auto& pair : found.pairs)
    for (const std::uint32_t t : pair) crosses[t] = 1;
  m_first = mesh;
  for (std::uint32_t t = 0; t < crosses.size(); ++t)
    if (crosses[t] == 0) m_known.emplace_back(0, t);
  tbb::parallel_for(std::size_t{0}, m_known.size(), [&](std::size_t i) {
    m_known[i].first = hashOf(mesh, mesh.triangle[m_known[i].second]);
  });
  tbb::parallel_sort(m_known.begin(), m_known.end());
  m_start.assign(m_known.size() + 1, 0);
  for (const auto& entry : m_known) ++m_start[bucketOf(entry.first) + 1];
  std::partial_sum(m_start.begin(), m_start.end(), m_start.begin());
}

// As many buckets as hashes, which are spread evenly.
std::size_t CrossingSearch::bucketOf(std::uint64_t hash) const {
  return static_cast<std::size_t>((hash >> 32) * m_known.size() >> 32);
}

bool CrossingSearch::isKnown(const TriangleMesh& mesh, const Triangle& triangle) const {
  const std::uint64_t hash = hashOf(mesh, triangle);
  const std::size_t bucket = bucketOf(hash);
  for (std::uint32_t i = m_start[bucket]; i < m_start[bucket + 1]; ++i) {
    if (m_known[i].first != hash) continue;
    const Triangle& known = m_first.triangle[m_known[i].second];
    if (std::equal(known.begin(), known.end(), triangle.begin(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     return m_first.position[a] == mesh.position[b];
                   }))
      return true;
  }
  return false;
}

SelfIntersections CrossingSearch::find(const TriangleMesh& mesh, const Progress& progress) {
  if (m_known.empty()) {
    SelfIntersections found = selfIntersections(mesh, kMostPairs, &progress);
    // a search that was given up knows nothing
    if (!found.pairs.empty() && found.isComplete) keep(mesh, found);
    return found;
  }
  std::vector<std::uint8_t> isChanged(mesh.triangle.size());
  tbb::parallel_for(std::size_t{0}, isChanged.size(),
                    [&](std::size_t t) { isChanged[t] = isKnown(mesh, mesh.triangle[t]) ? 0 : 1; });
  return searchNear(mesh, isChanged, progress);
}

SelfIntersections mendCrossings(CaseSurface& surface, const SeparatedField& field,
                                CrossingSearch& search, Progress& progress) {
  progress.begin("crossings", 0);
  roundToFloats(surface.mesh);
  SelfIntersections found = search.find(surface.mesh, progress);
  const std::vector<bool> isFixed = found.pairs.empty() ? std::vector<bool>() : isOnEnd(surface);
  for (int round = 0; !found.pairs.empty() && round < kMostRounds; ++round) {
    const auto moved = crossingVertices(surface.mesh, found, isFixed);
    tbb::parallel_for(std::size_t{0}, moved.size(), [&](std::size_t i) {
      const std::uint32_t v = moved[i];
      Eigen::Vector3d& position = surface.mesh.position[v];
      const SeparatedSample sample = field.at(position, surface.node[v]);
      const double step = std::max(0.25 * field.options().gap, 0.02 * field.radius(sample.node));
      position = roundedToFloats(position - step * sample.gradient);
    });
    found = searchAgain(surface.mesh, found, moved, progress);
  }
  progress.end();
  return found;
}

std::size_t smoothCrossings(CaseSurface& surface, SelfIntersections& found, Progress& progress) {
  progress.begin("crossings", 0);
  const std::vector<bool> isFixed = isOnEnd(surface);
  TriangleMesh mesh = surface.mesh;
  SelfIntersections left = found;
  std::vector<std::uint32_t> all;
  for (int round = 0; !left.pairs.empty() && round < kMostSmoothings; ++round) {
    const auto moved = crossingVertices(mesh, left, isFixed);
    moveToMiddles(mesh, moved);
    all.insert(all.end(), moved.begin(), moved.end());
    left = searchAgain(mesh, left, moved, progress);
  }
  progress.end();
  if (left.pairs.size() >= found.pairs.size()) return 0;
  surface.mesh = std::move(mesh);
  found = std::move(left);
  std::sort(all.begin(), all.end());
  return static_cast<std::size_t>(std::unique(all.begin(), all.end()) - all.begin());
}

namespace {

constexpr int kMostRepeats = 4;
constexpr double kFirstReach = 1;  // radii around a crossing

// Adds the boxes of `radii` local radii around the corners of crossing triangles.
void addPlaces(const CaseSurface& surface, const SeparatedField& field,
               const SelfIntersections& found, double radii, std::vector<Box3d>& places) {
  for (const auto& pair : found.pairs)
    for (const std::uint32_t t : pair)
      for (const std::uint32_t v : surface.mesh.triangle[t])
        places.emplace_back().add(surface.mesh.position[v], radii * field.radius(surface.node[v]));
}

// The vertices that are in one of `places`; empty if there are none of these.
std::vector<std::uint8_t> verticesIn(const CaseSurface& surface, const std::vector<Box3d>& places) {
  if (places.empty()) return {};
  const BoxSet set(places);
  std::vector<std::uint8_t> isIn(surface.mesh.position.size());
  tbb::parallel_for(std::size_t{0}, isIn.size(), [&](std::size_t v) {
    Box3d point;
    point.add(surface.mesh.position[v]);
    isIn[v] = set.meets(point) ? 1 : 0;
  });
  return isIn;
}

}  // namespace

RefineReport refine(CaseSurface& surface, const SeparatedField& field, const EdgeLength& edge,
                    Progress& progress) {
  const CaseSurface given = surface;
  RepeatedRemesh remeshing(given, field, edge, progress);
  CrossingSearch search;
  std::vector<Box3d> places;
  double reach = kFirstReach;
  for (int repeats = 0;; ++repeats) {
    const RemeshReport made = remeshing.run(verticesIn(given, places), surface);
    SelfIntersections left = mendCrossings(surface, field, search, progress);
    if (left.pairs.empty()) return {made.offField, made.sharp, 0};
    if (repeats == kMostRepeats) {
      const std::size_t moved = smoothCrossings(surface, left, progress);
      return {made.offField + moved, made.sharp, left.pairs.size()};
    }
    addPlaces(surface, field, left, reach, places);
    reach *= 2;
  }
}

}  // namespace lumen::convert
