// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/simplify/split_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/geometry/mesh_edges.h"
#include "converters/stages/surface/simplify/close_sheets.h"

namespace lumen::convert {
namespace {

constexpr std::uint32_t kNoNew = UINT32_MAX;
constexpr int kSplitRounds = 4;
constexpr double kLeastOutward = 0.17;     // cosine of 80 degrees: thin triangles turn far
constexpr std::size_t kSplitBatch = 1024;  // places between two looks at the progress

struct Place {
  double distance = 0;  // mm; negative in the lumen
  double radius = 0;    // mm
  std::uint32_t node = 0;
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();
};

class FarEdges {
public:
  FarEdges(CaseSurface& surface, const SeparatedField& field, const SurfaceError& allowed,
           std::vector<std::uint8_t>& isClose, Progress& progress)
      : m_surface(surface),
        m_field(field),
        m_allowed(allowed),
        m_isClose(isClose),
        m_progress(progress),
        m_place(surface.mesh.position),
        m_triangle(surface.mesh.triangle),
        m_isNew(m_triangle.size(), 1),
        m_normal(surface.groups.size()) {
    for (const SurfaceEnd& end : surface.ends)
      if (surface.groups[end.group].kind != FaceKind::Cap) m_normal[end.group] = end.normal;
  }

  FieldError run() {
    for (int round = 0; round < kSplitRounds; ++round) {
      m_progress.check();
      findEdges();
      measure();
      chooseEdges();
      placeMiddles();
      if (addVertices() == 0) break;
      split();
      takeBack(m_isNew);
    }
    measureAll();
    balance();
    measure();
    return summarise();
  }

  FieldError error() {
    measureAll();
    return summarise();
  }

private:
  struct Edge {
    std::uint32_t side = 0;
    const Eigen::Vector3d* plane = nullptr;  // of the flat end that it is the rim of
    bool isSplit = false;
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  // of the new vertex, where it is split
    std::uint32_t node = 0, vertex = 0;
  };

  [[nodiscard]] Place measureAt(const Eigen::Vector3d& at, std::uint32_t node,
                                std::uint32_t other) const {
    SeparatedSample sample = m_field.at(at, node);
    // an edge between two nodes: the cursor of either may be the one that is on the sheet
    if (other != node) {
      const SeparatedSample second = m_field.at(at, other);
      if (std::abs(second.distance) < std::abs(sample.distance)) sample = second;
    }
    return {sample.distance, m_field.radius(sample.node), sample.node, sample.gradient};
  }

  [[nodiscard]] bool isFar(const Place& place) const {
    return std::abs(place.distance) > chordAt(m_field, place.node, m_allowed);
  }

  void measureAll() {
    m_isNew.assign(m_triangle.size(), 1);
    findEdges();
    measure();
  }

  // The edges of new triangles of the wall, each once.
  void findEdges() {
    m_edges.clear();
    m_opposite = oppositeSides(m_triangle);
    m_edgeOf.assign(3 * m_triangle.size(), kNoNew);
    for (std::uint32_t side = 0; side < m_opposite.size(); ++side) {
      const std::uint32_t other = m_opposite[side];
      const auto& own = m_normal[m_surface.group[side / 3]];
      const bool hasOther = other != kNoSide;
      const auto& beyond = hasOther ? m_normal[m_surface.group[other / 3]] : own;
      if (own && (!hasOther || beyond)) continue;                        // within a flat end
      if (hasOther && (own ? true : !beyond && other < side)) continue;  // the other one's
      if (m_isNew[side / 3] == 0 && !(hasOther && m_isNew[other / 3] != 0)) continue;
      m_edgeOf[side] = static_cast<std::uint32_t>(m_edges.size());
      if (hasOther) m_edgeOf[other] = m_edgeOf[side];
      m_edges.emplace_back(Edge{.side = side, .plane = beyond ? &*beyond : nullptr});
    }
  }

  [[nodiscard]] Eigen::Vector3d middleOf(std::uint32_t side) const {
    return 0.5 * (m_place[startOf(m_triangle, side)] + m_place[endOf(m_triangle, side)]);
  }
  [[nodiscard]] Eigen::Vector3d centreOf(const Triangle& t) const {
    return (m_place[t[0]] + m_place[t[1]] + m_place[t[2]]) / 3;
  }

  void measure() {
    m_ofEdge.resize(m_edges.size());
    tbb::parallel_for(std::size_t{0}, m_edges.size(), [&](std::size_t e) {
      if (e % kSplitBatch == 0) m_progress.check();
      const std::uint32_t side = m_edges[e].side;
      m_ofEdge[e] = measureAt(middleOf(side), m_surface.node[startOf(m_triangle, side)],
                              m_surface.node[endOf(m_triangle, side)]);
    });
    m_ofTriangle.resize(m_triangle.size());
    tbb::parallel_for(std::size_t{0}, m_triangle.size(), [&](std::size_t f) {
      if (f % kSplitBatch == 0) m_progress.check();
      const Triangle& t = m_triangle[f];
      if (m_isNew[f] != 0 && !m_normal[m_surface.group[f]])
        m_ofTriangle[f] = measureAt(centreOf(t), m_surface.node[t[0]], m_surface.node[t[1]]);
    });
  }

  void chooseEdges() {
    for (std::size_t e = 0; e < m_edges.size(); ++e) m_edges[e].isSplit = isFar(m_ofEdge[e]);
    for (std::uint32_t f = 0; f < m_triangle.size(); ++f)
      if (m_isNew[f] != 0 && isFar(m_ofTriangle[f])) splitLongest(f);
  }

  [[nodiscard]] bool isMarked(std::uint32_t side) const {
    return m_edgeOf[side] != kNoNew && m_edges[m_edgeOf[side]].isSplit;
  }
  [[nodiscard]] bool isDivided(std::uint32_t f) const {
    return isMarked(3 * f) || isMarked(3 * f + 1) || isMarked(3 * f + 2);
  }

  void splitLongest(std::uint32_t f) {
    if (isDivided(f)) return;
    std::uint32_t longest = kNoNew;
    double most = 0;
    for (std::uint32_t side = 3 * f; side < 3 * f + 3; ++side) {
      const double square =
          (m_place[startOf(m_triangle, side)] - m_place[endOf(m_triangle, side)]).squaredNorm();
      if (m_edgeOf[side] == kNoNew || square <= most) continue;
      most = square;
      longest = side;
    }
    if (longest != kNoNew) m_edges[m_edgeOf[longest]].isSplit = true;
  }

  // Whether both parts of the triangle at a side still look outward when the side's middle moves.
  [[nodiscard]] bool looksOutward(std::uint32_t side, const SeparatedField::Foot& foot) const {
    const Eigen::Vector3d &a = m_place[startOf(m_triangle, side)],
                          &b = m_place[endOf(m_triangle, side)],
                          &c = m_place[endOf(m_triangle, nextSide(side))];
    const auto looks = [&](const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
      const Eigen::Vector3d across = (other - one).cross(c - one);
      return across.dot(foot.sample.gradient) > kLeastOutward * across.norm();
    };
    return looks(a, foot.position) && looks(foot.position, b);
  }

  // Puts the middles of edges to split onto the field. One whose triangles would turn stays, as where
  // the field jumps or folds.
  void placeMiddles() {
    tbb::parallel_for(std::size_t{0}, m_edges.size(), [&](std::size_t e) {
      Edge& edge = m_edges[e];
      if (!edge.isSplit) return;
      const Eigen::Vector3d middle = middleOf(edge.side);
      edge.isSplit = false;
      const auto foot = m_field.project(middle, m_ofEdge[e].node, edge.plane);
      if (!foot || !looksOutward(edge.side, *foot)) return;
      const std::uint32_t other = m_opposite[edge.side];
      if (other != kNoSide && edge.plane == nullptr && !looksOutward(other, *foot)) return;
      edge.isSplit = true;
      edge.place = roundedToFloats(foot->position);
      edge.node = foot->sample.node;
    });
  }

  std::size_t addVertices() {
    const std::size_t before = m_place.size();
    m_rest = m_place;
    for (Edge& edge : m_edges) {
      if (!edge.isSplit) continue;
      edge.vertex = static_cast<std::uint32_t>(m_place.size());
      m_rest.push_back(roundedToFloats(middleOf(edge.side)));
      m_place.push_back(edge.place);
      m_surface.node.push_back(edge.node);
    }
    return m_place.size() - before;
  }

  [[nodiscard]] std::uint32_t vertexOn(std::uint32_t side) const {
    return isMarked(side) ? m_edges[m_edgeOf[side]].vertex : kNoNew;
  }

  // A part of triangle f.
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t f) {
    m_triangle.push_back({a, b, c});
    m_surface.group.push_back(m_surface.group[f]);
    m_isClose.push_back(m_isClose[f]);
    m_isNew.push_back(1);
  }

  // Puts vertices that were moved back to where they rested, as long as triangles of those
  // `isChanged` pass through others.
  void takeBack(const std::vector<std::uint8_t>& isChanged) {
    for (bool isAny = true; isAny;) {
      isAny = false;
      for (const auto& pair : crossingsOfChanged(m_surface.mesh, isChanged, m_isClose, m_progress))
        for (const std::uint32_t f : pair)
          for (const std::uint32_t v : m_triangle[f]) {
            if (m_place[v] == m_rest[v]) continue;
            m_place[v] = m_rest[v];
            isAny = true;
          }
    }
  }

  void split() {
    const auto count = static_cast<std::uint32_t>(m_triangle.size());
    for (std::uint32_t f = 0; f < count; ++f) {
      m_isNew[f] = 0;
      std::array<std::uint32_t, 3> middle{vertexOn(3 * f), vertexOn(3 * f + 1),
                                          vertexOn(3 * f + 2)};
      Triangle t = m_triangle[f];
      const auto marked = 3 - std::count(middle.begin(), middle.end(), kNoNew);
      if (marked == 0) continue;
      m_isNew[f] = 1;
      // turned until the first side is marked, and of two the second as well
      while (middle[0] == kNoNew || (marked == 2 && middle[1] == kNoNew)) {
        std::rotate(t.begin(), t.begin() + 1, t.end());
        std::rotate(middle.begin(), middle.begin() + 1, middle.end());
      }
      const auto [a, b, c] = t;
      if (marked == 1) {
        m_triangle[f] = {a, middle[0], c};
        add(middle[0], b, c, f);
      } else if (marked == 2) {
        m_triangle[f] = {middle[0], b, middle[1]};
        const bool isFirst = (m_place[a] - m_place[middle[1]]).squaredNorm() <
                             (m_place[middle[0]] - m_place[c]).squaredNorm();
        add(a, middle[0], isFirst ? middle[1] : c, f);
        if (isFirst)
          add(a, middle[1], c, f);
        else
          add(middle[0], middle[1], c, f);
      } else {
        m_triangle[f] = {middle[0], middle[1], middle[2]};
        add(a, middle[0], middle[2], f);
        add(middle[0], b, middle[1], f);
        add(middle[2], middle[1], c, f);
      }
    }
  }

  // Moves vertices along the field's gradient by the mean distance of the triangles around, which is
  // that of the middles of their edges: the rule of quadrature is exact to the second order.
  void balance() {
    std::vector<double> sum(m_place.size(), 0), area(m_place.size(), 0);
    for (std::uint32_t f = 0; f < m_triangle.size(); ++f) {
      if (m_normal[m_surface.group[f]]) continue;
      double mean = 0;
      for (std::uint32_t side = 3 * f; side < 3 * f + 3; ++side)
        mean += m_edgeOf[side] == kNoNew ? 0 : m_ofEdge[m_edgeOf[side]].distance / 3;
      const double weight = vectorArea(m_surface.mesh, m_triangle[f]).norm();
      for (const std::uint32_t v : m_triangle[f]) {
        sum[v] += weight * mean;
        area[v] += weight;
      }
    }
    std::vector<const Eigen::Vector3d*> plane(m_place.size(), nullptr);
    for (const Edge& edge : m_edges)
      if (edge.plane != nullptr)
        plane[startOf(m_triangle, edge.side)] = plane[endOf(m_triangle, edge.side)] = edge.plane;
    m_rest = m_place;
    tbb::parallel_for(std::size_t{0}, m_place.size(), [&](std::size_t v) {
      if (!(area[v] > 0) || m_field.mayTouch(m_surface.node[v])) return;
      const SeparatedSample sample = m_field.at(m_place[v], m_surface.node[v]);
      const double most = m_allowed.at(m_field.radius(sample.node));
      const double outward = std::clamp(-sum[v] / area[v], -most, most);
      Eigen::Vector3d along = sample.gradient;
      if (plane[v] != nullptr) along -= along.dot(*plane[v]) * *plane[v];
      m_place[v] = roundedToFloats(m_place[v] + outward * along);
    });
    takeBack(std::vector<std::uint8_t>(m_triangle.size(), 1));
  }

  FieldError summarise() {
    std::vector<std::uint8_t> isOnWall(m_place.size(), 0);
    for (std::size_t f = 0; f < m_triangle.size(); ++f)
      if (!m_normal[m_surface.group[f]])
        for (const std::uint32_t v : m_triangle[f]) isOnWall[v] = 1;
    std::vector<Place> ofVertex(m_place.size());
    tbb::parallel_for(std::size_t{0}, ofVertex.size(), [&](std::size_t v) {
      if (isOnWall[v] != 0)
        ofVertex[v] = measureAt(m_place[v], m_surface.node[v], m_surface.node[v]);
    });
    FieldError result;
    std::vector<float> errors;
    const auto note = [&](const Place& place) {
      const double error = std::abs(place.distance);
      errors.push_back(static_cast<float>(error));
      if (error > m_allowed.at(place.radius)) ++result.beyond;
    };
    for (const Place& place : m_ofEdge) note(place);
    for (std::size_t f = 0; f < m_triangle.size(); ++f)
      if (!m_normal[m_surface.group[f]]) note(m_ofTriangle[f]);
    for (std::size_t v = 0; v < ofVertex.size(); ++v)
      if (isOnWall[v] != 0) note(ofVertex[v]);
    if (errors.empty()) return result;
    result.places = errors.size();
    const auto at = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 9 / 10);
    std::nth_element(errors.begin(), at, errors.end());
    result.ninetieth = double{*at};
    result.greatest = double{*std::max_element(at, errors.end())};
    return result;
  }

  CaseSurface& m_surface;
  const SeparatedField& m_field;
  SurfaceError m_allowed;
  std::vector<std::uint8_t>& m_isClose;
  Progress& m_progress;
  std::vector<Eigen::Vector3d>& m_place;
  std::vector<Eigen::Vector3d> m_rest;  // places at which no triangle passes through another
  std::vector<Triangle>& m_triangle;
  std::vector<std::uint8_t> m_isNew;
  std::vector<std::optional<Eigen::Vector3d>> m_normal;  // of flat ends, by group
  std::vector<std::uint32_t> m_opposite, m_edgeOf;       // by sides
  std::vector<Edge> m_edges;
  std::vector<Place> m_ofEdge, m_ofTriangle;
};

}  // namespace

double chordAt(const SeparatedField& field, std::uint32_t node, const SurfaceError& allowed) {
  return (field.mayTouch(node) ? 1 : kChordShare) * allowed.at(field.radius(node));
}

FieldError splitFarEdges(CaseSurface& surface, const SeparatedField& field,
                         const SurfaceError& allowed, std::vector<std::uint8_t>& isClose,
                         Progress& progress) {
  return FarEdges(surface, field, allowed, isClose, progress).run();
}

FieldError fieldErrorOf(CaseSurface& surface, const SeparatedField& field,
                        const SurfaceError& allowed, Progress& progress) {
  std::vector<std::uint8_t> none;
  return FarEdges(surface, field, allowed, none, progress).error();
}

}  // namespace lumen::convert
