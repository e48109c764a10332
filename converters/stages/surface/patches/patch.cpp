// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/patches/patch.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "converters/base/vectors.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/stages/surface/closing/end_planes.h"

namespace lumen::convert {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

constexpr std::uint64_t edgeKey(std::uint32_t from, std::uint32_t to) {
  return static_cast<std::uint64_t>(from) << 32 | to;
}

void dropUnusedVertices(TriangleMesh& patch) {
  std::vector<std::uint32_t> newIndex(patch.position.size(), kNone);
  for (const Triangle& t : patch.triangle)
    for (const std::uint32_t v : t) newIndex[v] = 0;
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < newIndex.size(); ++v) {
    if (newIndex[v] == kNone) continue;
    patch.position[kept] = patch.position[v];
    newIndex[v] = kept++;
  }
  patch.position.resize(kept);
  for (Triangle& t : patch.triangle)
    for (std::uint32_t& v : t) v = newIndex[v];
}

// Cuts triangles by one plane; `distance` grows with the vertices that the cuts add.
class Clipper {
public:
  Clipper(TriangleMesh& patch, std::vector<double> distance)
      : m_patch(patch), m_distance(std::move(distance)) {}

  void cut() {
    std::vector<Triangle> input;
    input.swap(m_patch.triangle);
    m_patch.triangle.reserve(input.size());
    for (const Triangle& t : input) cutTriangle(t);
  }

private:
  void cutTriangle(const Triangle& t) {
    std::array<std::uint32_t, 4> kept{};
    std::size_t count = 0;
    bool inside = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = t[i], next = t[(i + 1) % 3];
      const double dv = m_distance[v], dn = m_distance[next];
      inside = inside || dv < 0;
      if (dv <= 0) kept[count++] = v;
      if ((dv < 0 && dn > 0) || (dv > 0 && dn < 0)) kept[count++] = cutEdge(v, next);
    }
    if (!inside || count < 3) return;
    if (count == 3) {
      m_patch.triangle.push_back({kept[0], kept[1], kept[2]});
    } else {
      addQuad(kept);
    }
  }

  void addQuad(const std::array<std::uint32_t, 4>& q) {
    const auto& p = m_patch.position;
    const bool first = (p[q[0]] - p[q[2]]).squaredNorm() <= (p[q[1]] - p[q[3]]).squaredNorm();
    if (first) {
      m_patch.triangle.push_back({q[0], q[1], q[2]});
      m_patch.triangle.push_back({q[0], q[2], q[3]});
    } else {
      m_patch.triangle.push_back({q[0], q[1], q[3]});
      m_patch.triangle.push_back({q[1], q[2], q[3]});
    }
  }

  std::uint32_t cutEdge(std::uint32_t a, std::uint32_t b) {
    if (a > b) std::swap(a, b);
    const auto [found, isNew] =
        m_cut.try_emplace(edgeKey(a, b), static_cast<std::uint32_t>(m_patch.position.size()));
    if (isNew) {
      const double t = m_distance[a] / (m_distance[a] - m_distance[b]);
      const Eigen::Vector3d point =
          m_patch.position[a] + t * (m_patch.position[b] - m_patch.position[a]);
      m_patch.position.push_back(point);
      m_distance.push_back(0.0);
    }
    return found->second;
  }

  TriangleMesh& m_patch;
  std::vector<double> m_distance;
  std::unordered_map<std::uint64_t, std::uint32_t> m_cut;
};

constexpr std::uint32_t nextCorner(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

// The directed edges of triangles by the vertex that they start from. A corner is the place of a
// vertex in a triangle, 3 t + i for vertex i of triangle t, and names the edge that starts there.
class DirectedEdges {
public:
  DirectedEdges(const std::vector<Triangle>& triangles, std::size_t vertices)
      : m_triangles(triangles), m_offset(vertices + 1), m_corner(3 * triangles.size()) {
    for (const Triangle& t : triangles)
      for (const std::uint32_t v : t) ++m_offset[v + 1];
    std::partial_sum(m_offset.begin(), m_offset.end(), m_offset.begin());
    std::vector<std::uint32_t> next(m_offset.begin(), m_offset.end() - 1);
    for (std::uint32_t corner = 0; corner < m_corner.size(); ++corner)
      m_corner[next[vertexAt(corner)]++] = corner;
  }

  [[nodiscard]] std::uint32_t vertexAt(std::uint32_t corner) const {
    return m_triangles[corner / 3][corner % 3];
  }

  // The corner of the only edge from one vertex to another; kNone if there is none, or more than
  // one.
  [[nodiscard]] std::uint32_t only(std::uint32_t from, std::uint32_t to) const {
    std::uint32_t found = kNone;
    for (std::uint32_t i = m_offset[from]; i < m_offset[from + 1]; ++i) {
      if (vertexAt(nextCorner(m_corner[i])) != to) continue;
      if (found != kNone) return kNone;
      found = m_corner[i];
    }
    return found;
  }

private:
  const std::vector<Triangle>& m_triangles;
  std::vector<std::uint32_t> m_offset, m_corner;
};

// Corners of one fan are in one set.
DisjointSets findFans(const TriangleMesh& patch) {
  const DirectedEdges edges(patch.triangle, patch.position.size());
  const auto corners = static_cast<std::uint32_t>(3 * patch.triangle.size());
  DisjointSets fans(corners);
  for (std::uint32_t corner = 0; corner < corners; ++corner) {
    const std::uint32_t from = edges.vertexAt(corner), to = edges.vertexAt(nextCorner(corner));
    if (from > to || edges.only(from, to) == kNone) continue;
    const std::uint32_t across = edges.only(to, from);
    if (across == kNone) continue;
    fans.join(corner, nextCorner(across));
    fans.join(nextCorner(corner), across);
  }
  return fans;
}

}  // namespace

void clip(TriangleMesh& patch, const HalfSpace& space, double snap) {
  std::vector<double> distance(patch.position.size());
  bool outside = false;
  for (std::size_t v = 0; v < distance.size(); ++v) {
    const double d = space.distance(patch.position[v]);
    distance[v] = std::abs(d) <= snap ? 0.0 : d;
    outside = outside || distance[v] > 0;
  }
  if (!outside) return;
  Clipper(patch, std::move(distance)).cut();
  dropUnusedVertices(patch);
}

void dropFarParts(TriangleMesh& patch, const Eigen::Vector3d& centre, double distance) {
  DisjointSets parts(patch.position.size());
  for (const Triangle& t : patch.triangle) {
    parts.join(t[0], t[1]);
    parts.join(t[0], t[2]);
  }
  std::vector<bool> isNear(patch.position.size());
  for (std::uint32_t v = 0; v < isNear.size(); ++v)
    if ((patch.position[v] - centre).squaredNorm() <= distance * distance)
      isNear[parts.find(v)] = true;
  std::erase_if(patch.triangle, [&](const Triangle& t) { return !isNear[parts.find(t[0])]; });
  dropUnusedVertices(patch);
}

void roundToFloat(TriangleMesh& patch) {
  // Through memory: gcc 12 drops a conversion to float and back that stays in a register.
  std::vector<Eigen::Vector3f> rounded;
  rounded.reserve(patch.position.size());
  for (const Eigen::Vector3d& p : patch.position) rounded.push_back(p.cast<float>());
  for (std::size_t v = 0; v < rounded.size(); ++v) patch.position[v] = rounded[v].cast<double>();
  DisjointSets sets(rounded.size());
  for (const Triangle& t : patch.triangle)
    for (std::size_t i = 0; i < 3; ++i)
      if (rounded[t[i]] == rounded[t[(i + 1) % 3]]) sets.join(t[i], t[(i + 1) % 3]);
  for (Triangle& t : patch.triangle)
    for (std::uint32_t& v : t) v = sets.find(v);
  std::erase_if(patch.triangle,
                [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  dropUnusedVertices(patch);
}

void separateFans(TriangleMesh& patch) {
  DisjointSets fans = findFans(patch);
  // The first fan of a vertex, by the number of its first corner, keeps the vertex.
  std::vector<std::uint32_t> owner(patch.position.size(), kNone);
  std::vector<std::uint32_t> vertexOfFan(3 * patch.triangle.size(), kNone);
  for (std::uint32_t corner = 0; corner < vertexOfFan.size(); ++corner) {
    std::uint32_t& vertex = patch.triangle[corner / 3][corner % 3];
    const std::uint32_t fan = fans.find(corner);
    if (vertexOfFan[fan] == kNone) {
      const bool isFirst = owner[vertex] == kNone;
      if (isFirst) owner[vertex] = fan;
      vertexOfFan[fan] = isFirst ? vertex : static_cast<std::uint32_t>(patch.position.size());
      if (!isFirst) patch.position.push_back(Eigen::Vector3d(patch.position[vertex]));
    }
    vertex = vertexOfFan[fan];
  }
}

namespace {

bool hasModel(const formats::Case& source, std::uint32_t node) {
  return source.models->offset[node] < source.models->offset[node + 1];
}

void addFreeEnds(const formats::Case& source, const formats::Neighbours& edges, std::uint32_t node,
                 std::vector<HalfSpace>& spaces) {
  for (const bool last : {false, true}) {
    const auto end = freeEnd(source, edges, source.tree.branch[node], last);
    if (end && end->node == node)
      spaces.push_back({end->normal, end->normal.dot(toEigen(source.tree.centre[node])) +
                                         reachOfEnd(source.tree, node)});
  }
}

}  // namespace

std::optional<NodeCell> nodeCell(const formats::Case& source, const formats::Neighbours& edges,
                                 std::span<const std::uint32_t> neighbours, std::uint32_t node) {
  const formats::CenterlineTree& tree = source.tree;
  const Eigen::Vector3d centre = toEigen(tree.centre[node]);
  const double radius = tree.radius[node];
  NodeCell cell;
  for (const std::uint32_t other : neighbours) {
    if (!hasModel(source, other)) continue;
    const Eigen::Vector3d away = toEigen(tree.centre[other]) - centre;
    const double distance = away.norm(), otherRadius = tree.radius[other];
    if (distance > 0) {
      const double power = (radius - otherRadius) * (radius + otherRadius);
      const Eigen::Vector3d normal = away / distance;
      cell.radical.push_back({normal, normal.dot(centre) + 0.5 * (distance + power / distance)});
    } else if (otherRadius > radius || (otherRadius == radius && other < node)) {
      return std::nullopt;  // two nodes in one place: the wider one draws, or else the first
    }
  }
  addFreeEnds(source, edges, node, cell.ends);
  return cell;
}

}  // namespace lumen::convert
