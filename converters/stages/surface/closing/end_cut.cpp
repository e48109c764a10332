// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/closing/end_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <unordered_map>

#include <Eigen/Geometry>

#include "converters/base/vectors.h"
#include "converters/stages/surface/closing/flat_region.h"

namespace lumen::convert {
namespace {

// A vertex goes onto the plane if that is so near along one of its edges, as a share of the edge:
// then no triangle of the rim is thinner. Less where that makes the rim touch itself.
constexpr double kSnaps[] = {0.25, 0.1, 0};
constexpr double kMostShift = 0.5;  // mean edges of the rim: the longest projection of its vertices

double distanceTo(const EndPlane& plane, const Eigen::Vector3d& point) {
  return plane.normal.dot(point - plane.centre);
}

Eigen::Vector3d ontoPlane(const EndPlane& plane, const Eigen::Vector3d& point) {
  return point - distanceTo(plane, point) * plane.normal;
}

bool holds(const std::vector<std::uint32_t>& sorted, std::uint32_t value) {
  return std::binary_search(sorted.begin(), sorted.end(), value);
}

// Triangles at the vertices, ascending.
std::vector<std::uint32_t> trianglesAt(const SurfaceFans& fans,
                                       const std::vector<std::uint32_t>& vertices) {
  std::vector<std::uint32_t> triangles;
  for (const std::uint32_t v : vertices)
    triangles.insert(triangles.end(), fans.of(v).begin(), fans.of(v).end());
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

// The Euler characteristic of the vertices with the edges and triangles between them.
std::ptrdiff_t eulerCharacteristic(const SurfaceFans& fans,
                                   const std::vector<std::uint32_t>& part) {
  std::ptrdiff_t halfEdges = 0, faces = 0;
  for (const std::uint32_t t : trianglesAt(fans, part)) {
    const Triangle& corner = fans.surface().mesh.triangle[t];
    const auto inside = std::count_if(corner.begin(), corner.end(),
                                      [&part](std::uint32_t v) { return holds(part, v); });
    halfEdges += inside == 3 ? 3 : inside == 2 ? 1 : 0;
    faces += inside == 3 ? 1 : 0;
  }
  return static_cast<std::ptrdiff_t>(part.size()) - halfEdges / 2 + faces;
}

// One way of cutting off a part, with one bound for moving vertices onto the plane.
class EndCutPlanner {
public:
  EndCutPlanner(const SurfaceFans& fans, const SeparatedField& field, const EndPlane& plane,
                const std::vector<std::uint32_t>& part)
      : m_fans(fans), m_mesh(fans.surface().mesh), m_field(field), m_plane(plane), m_part(part) {}

  std::optional<EndCut> plan(double snap, bool project) {
    m_cut = {};
    m_onPlane.clear();
    m_fresh.clear();
    m_next.clear();
    m_keptOf.clear();
    m_isSimple = true;
    moveNear(snap);
    std::vector<std::uint32_t> touched = m_part;
    for (const auto& entry : m_onPlane) touched.push_back(entry.first);
    const std::vector<std::uint32_t> triangles = trianglesAt(m_fans, touched);
    for (const std::uint32_t t : triangles) cut(t);
    if (!walkRim()) return std::nullopt;
    placeRim(project);
    for (const std::uint32_t v : m_cut.rim) addToLoop(v);
    if (!isUpright(triangles) || !closeRim()) return std::nullopt;
    for (const auto& [v, place] : m_onPlane) m_cut.moved.emplace_back(v, place);
    return std::move(m_cut);
  }

private:
  enum class Side : std::uint8_t { Inner, On, Beyond };

  [[nodiscard]] Side sideOf(std::uint32_t v) const {
    if (v >= m_mesh.position.size() || m_onPlane.count(v) > 0) return Side::On;
    return holds(m_part, v) ? Side::Beyond : Side::Inner;
  }

  // The place where an edge from beyond crosses the plane, as a share of the edge.
  [[nodiscard]] double crossing(std::uint32_t beyond, std::uint32_t inner) const {
    const double a = distanceTo(m_plane, m_mesh.position[beyond]);
    const double b = distanceTo(m_plane, m_mesh.position[inner]);
    return a / (a - b);
  }

  [[nodiscard]] Eigen::Vector3d pointOn(std::uint32_t beyond, std::uint32_t inner) const {
    const Eigen::Vector3d &a = m_mesh.position[beyond], &b = m_mesh.position[inner];
    return ontoPlane(m_plane, a + crossing(beyond, inner) * (b - a));
  }

  // Moves vertices near the plane to their nearest crossing: first those beyond, then those within
  // that still have a neighbour beyond.
  void moveNear(double snap) {
    for (const bool isBeyond : {true, false}) {
      std::map<std::uint32_t, double> nearest;
      std::map<std::uint32_t, Eigen::Vector3d> place;
      eachCrossing([&](std::uint32_t v, std::uint32_t w) {
        const double share = crossing(v, w), shareMoved = isBeyond ? share : 1 - share;
        // a vertex in the plane is on it, whatever the bound
        if (m_onPlane.count(v) > 0 || (shareMoved > 0 && shareMoved >= snap)) return;
        const auto [entry, isNew] = nearest.try_emplace(isBeyond ? v : w, shareMoved);
        if (!isNew && entry->second <= shareMoved) return;
        entry->second = shareMoved;
        place[entry->first] = pointOn(v, w);
      });
      m_onPlane.merge(place);
    }
  }

  template <class Visit>
  void eachCrossing(Visit&& visit) const {
    for (const std::uint32_t v : m_part)
      for (const std::uint32_t t : m_fans.of(v))
        for (const std::uint32_t w : m_mesh.triangle[t])
          if (!holds(m_part, w)) visit(v, w);
  }

  std::uint32_t freshOn(std::uint32_t beyond, std::uint32_t inner) {
    const auto number = static_cast<std::uint32_t>(m_mesh.position.size() + m_cut.fresh.size());
    const auto [entry, isNew] = m_fresh.try_emplace({beyond, inner}, number);
    if (isNew) {
      const std::uint32_t near = crossing(beyond, inner) < 0.5 ? beyond : inner;
      m_cut.fresh.push_back({pointOn(beyond, inner), m_fans.surface().node[near]});
    }
    return entry->second;
  }

  void addRimEdge(std::uint32_t from, std::uint32_t to) {
    m_isSimple = m_next.try_emplace(from, to).second && m_isSimple;
  }

  void cut(std::uint32_t t) {
    const Triangle& corner = m_mesh.triangle[t];
    std::array<Side, 3> side{};
    for (std::size_t i = 0; i < 3; ++i) side[i] = sideOf(corner[i]);
    const auto beyond = std::count(side.begin(), side.end(), Side::Beyond);
    const auto inner = std::count(side.begin(), side.end(), Side::Inner);
    if (inner > 0 && beyond == 0) return;
    m_cut.removed.push_back(t);
    std::vector<std::uint32_t> rest;  // the remaining corners, around
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if (side[i] != Side::Beyond) rest.push_back(corner[i]);
      if (side[i] == Side::Beyond && side[j] == Side::Inner)
        rest.push_back(freshOn(corner[i], corner[j]));
      if (side[i] == Side::Inner && side[j] == Side::Beyond)
        rest.push_back(freshOn(corner[j], corner[i]));
    }
    if (inner > 0) keep(rest);
    m_keptOf.resize(m_cut.kept.size(), t);
    if (inner == 0) addOuterEdges(corner, side);
  }

  // The part of a triangle that stays: three or four corners, of which two follow on one another
  // in the plane.
  void keep(const std::vector<std::uint32_t>& rest) {
    const std::size_t n = rest.size();
    for (std::size_t i = 0; i < n; ++i)
      if (sideOf(rest[i]) == Side::On && sideOf(rest[(i + 1) % n]) == Side::On)
        addRimEdge(rest[(i + 1) % n], rest[i]);
    if (n == 3) {
      m_cut.kept.push_back({rest[0], rest[1], rest[2]});
      return;
    }
    const double one = (placeOf(rest[0]) - placeOf(rest[2])).squaredNorm();
    const double other = (placeOf(rest[1]) - placeOf(rest[3])).squaredNorm();
    const std::size_t i = one <= other ? 0 : 1;
    m_cut.kept.push_back({rest[i], rest[i + 1], rest[i + 2]});
    m_cut.kept.push_back({rest[i], rest[i + 2], rest[(i + 3) % 4]});
  }

  // Edges in the plane between a triangle that is removed and one that stays.
  void addOuterEdges(const Triangle& corner, const std::array<Side, 3>& side) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if (side[i] != Side::On || side[j] != Side::On) continue;
      for (const std::uint32_t t : m_fans.of(corner[i])) {
        const Triangle& other = m_mesh.triangle[t];
        for (std::size_t k = 0; k < 3; ++k)
          if (other[k] == corner[j] && other[(k + 1) % 3] == corner[i] &&
              sideOf(other[(k + 2) % 3]) == Side::Inner)
            addRimEdge(corner[i], corner[j]);
      }
    }
  }

  // True if the edges in the plane make one simple loop.
  bool walkRim() {
    if (!m_isSimple || m_next.size() < 3) return false;
    std::uint32_t v = m_next.begin()->first;
    do {
      m_cut.rim.push_back(v);
      const auto next = m_next.find(v);
      if (next == m_next.end() || m_cut.rim.size() > m_next.size()) return false;
      v = next->second;
    } while (v != m_cut.rim[0]);
    return m_cut.rim.size() == m_next.size();
  }

  [[nodiscard]] const Eigen::Vector3d& placeOf(std::uint32_t v) const {
    if (v >= m_mesh.position.size()) return m_cut.fresh[v - m_mesh.position.size()].position;
    const auto moved = m_onPlane.find(v);
    return moved == m_onPlane.end() ? m_mesh.position[v] : moved->second;
  }

  [[nodiscard]] double rimEdge() const {
    double length = 0;
    for (std::size_t i = 0; i < m_cut.rim.size(); ++i)
      length += (placeOf(m_cut.rim[i]) - placeOf(m_cut.rim[(i + 1) % m_cut.rim.size()])).norm();
    return length / static_cast<double>(m_cut.rim.size());
  }

  // Moves the rim onto the field's surface within the plane.
  void placeRim(bool project) {
    m_edge = rimEdge();
    if (!project) return;
    for (const std::uint32_t v : m_cut.rim) {
      const bool isFresh = v >= m_mesh.position.size();
      EndCut::Vertex* fresh = isFresh ? &m_cut.fresh[v - m_mesh.position.size()] : nullptr;
      const Eigen::Vector3d start = placeOf(v);
      const auto foot =
          m_field.project(start, isFresh ? fresh->node : m_fans.surface().node[v], &m_plane.normal);
      if (!foot || (foot->position - start).norm() > kMostShift * m_edge) continue;
      (isFresh ? fresh->position : m_onPlane[v]) = ontoPlane(m_plane, foot->position);
    }
  }

  void addToLoop(std::uint32_t v) {
    const auto [along, across] = planeBasis(m_plane.normal);
    const Eigen::Vector3d offset = placeOf(v) - m_plane.centre;
    m_cut.loop.emplace_back(along.dot(offset), across.dot(offset));
  }

  [[nodiscard]] Eigen::Vector3d areaVector(const Triangle& t) const {
    return (placeOf(t[1]) - placeOf(t[0])).cross(placeOf(t[2]) - placeOf(t[0]));
  }

  // True if no remaining triangle is turned over by the moves of its vertices.
  [[nodiscard]] bool isUpright(const std::vector<std::uint32_t>& triangles) const {
    const auto before = [this](std::uint32_t t) -> Eigen::Vector3d {
      const Triangle& c = m_mesh.triangle[t];
      return (m_mesh.position[c[1]] - m_mesh.position[c[0]])
          .cross(m_mesh.position[c[2]] - m_mesh.position[c[0]]);
    };
    for (const std::uint32_t t : triangles)
      if (!holds(m_cut.removed, t) && !(before(t).dot(areaVector(m_mesh.triangle[t])) > 0))
        return false;
    for (std::size_t k = 0; k < m_cut.kept.size(); ++k)
      if (!(before(m_keptOf[k]).dot(areaVector(m_cut.kept[k])) > 0)) return false;
    return true;
  }

  bool closeRim() {
    m_cut.cap = triangulateRegion(m_cut.loop, {}, m_edge);
    // An edge across the cap that the wall has too would have four triangles.
    const auto rimSize = static_cast<std::uint32_t>(m_cut.rim.size());
    for (std::size_t t = 0; t < m_cut.cap.triangle.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = m_cut.cap.triangle[t][i], b = m_cut.cap.triangle[t][(i + 1) % 3];
        const bool isAcross = a < rimSize && b < rimSize && b != (a + 1) % rimSize;
        if (isAcross && isInWall(m_cut.rim[a], m_cut.rim[b])) splitEdge(m_cut.cap, a, b);
      }
    return !m_cut.cap.triangle.empty();
  }

  [[nodiscard]] bool isInWall(std::uint32_t a, std::uint32_t b) const {
    const auto count = m_mesh.position.size();
    return a < count && b < count && m_fans.areJoined(a, b);
  }

  const SurfaceFans& m_fans;
  const TriangleMesh& m_mesh;
  const SeparatedField& m_field;
  const EndPlane& m_plane;
  const std::vector<std::uint32_t>& m_part;
  EndCut m_cut;
  std::map<std::uint32_t, Eigen::Vector3d> m_onPlane;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> m_fresh;
  std::map<std::uint32_t, std::uint32_t> m_next;  ///< along the rim
  std::vector<std::uint32_t> m_keptOf;            ///< the triangle that each of `kept` is of
  bool m_isSimple = true;
  double m_edge = 0;
};

}  // namespace

std::vector<std::uint32_t> partBeyond(const SurfaceFans& fans, const EndPlane& plane,
                                      const std::vector<std::uint32_t>& nodes,
                                      const std::vector<std::uint32_t>& candidates, bool& leaves) {
  const CaseSurface& surface = fans.surface();
  const auto isBeyond = [&](std::uint32_t v) {
    return distanceTo(plane, surface.mesh.position[v]) > 0;
  };
  std::optional<std::pair<double, std::uint32_t>> start;
  for (const std::uint32_t v : candidates) {
    if (fans.of(v).empty() || !isBeyond(v)) continue;
    const Eigen::Vector3d& p = surface.mesh.position[v];
    const double off = (ontoPlane(plane, p) - plane.centre).norm();
    if (!start || std::pair{off, v} < *start) start = {off, v};
  }
  leaves = false;
  if (!start) return {};
  std::vector<std::uint32_t> part{start->second};
  std::unordered_map<std::uint32_t, bool> seen{{start->second, true}};
  for (std::size_t i = 0; i < part.size(); ++i)
    for (const std::uint32_t t : fans.of(part[i]))
      for (const std::uint32_t v : surface.mesh.triangle[t]) {
        if (!isBeyond(v) || !seen.try_emplace(v, true).second) continue;
        const bool isOurs = holds(nodes, surface.node[v]) && surface.group[t] == 0;
        leaves = leaves || !isOurs;
        if (isOurs) part.push_back(v);
      }
  std::sort(part.begin(), part.end());
  return part;
}

std::variant<EndCut, NoCut> planCut(const SurfaceFans& fans, const SeparatedField& field,
                                    const EndPlane& plane, const std::vector<std::uint32_t>& nodes,
                                    const std::vector<std::uint32_t>& candidates) {
  bool leaves = false;
  const auto part = partBeyond(fans, plane, nodes, candidates, leaves);
  if (part.empty()) return NoCut::Before;
  if (leaves) return NoCut::Other;
  if (eulerCharacteristic(fans, part) != 1) return NoCut::Handle;
  EndCutPlanner planner(fans, field, plane, part);
  for (const double snap : kSnaps)
    for (const bool project : {true, false})
      if (auto cut = planner.plan(snap, project)) return std::move(*cut);
  return NoCut::Crooked;
}

void applyCut(SurfaceFans& fans, const EndPlane& plane, const EndCut& cut, std::uint32_t group) {
  for (const auto& [v, place] : cut.moved) fans.surface().mesh.position[v] = place;
  for (const std::uint32_t t : cut.removed) fans.remove(t);
  for (const EndCut::Vertex& v : cut.fresh) fans.addVertex(v.position, v.node);
  for (const Triangle& t : cut.kept) fans.add(t, 0);
  std::vector<std::uint32_t> number = cut.rim;
  const auto [along, across] = planeBasis(plane.normal);
  for (std::size_t i = number.size(); i < cut.cap.point.size(); ++i) {
    const Eigen::Vector2d& p = cut.cap.point[i];
    number.push_back(fans.addVertex(plane.centre + p.x() * along + p.y() * across, plane.node));
  }
  for (const Triangle& t : cut.cap.triangle)
    fans.add({number[t[0]], number[t[1]], number[t[2]]}, group);
}

}  // namespace lumen::convert
