// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/simplify/collapse_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/geometry/triangle_quality.h"
#include "converters/stages/surface/simplify/vertex_kinds.h"

namespace lumen::convert {
namespace {

constexpr std::uint32_t kNoVertex = UINT32_MAX;
constexpr double kLeastSharp = 0.0076;  // squared sine of 5 degrees
constexpr double kMostTurned = 0.5;     // cosine of 60 degrees
// The same where a number of triangles is not reached otherwise: 1 and 80 degrees.
constexpr double kLeastSharpOfFew = 0.0003, kMostTurnedOfFew = 0.17;
constexpr std::size_t kLeastRim = 8;     // edges of a rim
constexpr std::size_t kMostAround = 48;  // triangles around a vertex that is looked at
constexpr std::size_t kFewest = 200;     // a pass that drops fewer of so many is the last
constexpr int kShare = 3;                // a pass takes the cheapest third
constexpr std::uint8_t kMostTries = 4;   // edges of one vertex between two changes around it

/// The squared distances from planes, weighted by areas.
struct PlaneSum {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0, x = 0, y = 0, z = 0, d = 0, area = 0;

  void addPlane(const Eigen::Vector3d& n, double offset, double weight) {
    xx += weight * n.x() * n.x();
    yy += weight * n.y() * n.y();
    zz += weight * n.z() * n.z();
    xy += weight * n.x() * n.y();
    xz += weight * n.x() * n.z();
    yz += weight * n.y() * n.z();
    x += weight * n.x() * offset;
    y += weight * n.y() * offset;
    z += weight * n.z() * offset;
    d += weight * offset * offset;
    area += weight;
  }
  void add(const PlaneSum& o) {
    xx += o.xx, yy += o.yy, zz += o.zz, xy += o.xy, xz += o.xz, yz += o.yz;
    x += o.x, y += o.y, z += o.z, d += o.d, area += o.area;
  }
  /// Of points relative to the same origin as the planes.
  [[nodiscard]] double at(const Eigen::Vector3d& p) const {
    return p.x() * (xx * p.x() + 2 * (xy * p.y() + xz * p.z() + x)) +
           p.y() * (yy * p.y() + 2 * (yz * p.z() + y)) + p.z() * (zz * p.z() + 2 * z) + d;
  }
};

/// Squared distance of a point from a triangle.
double squaredDistance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                       const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.squaredNorm();
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.squaredNorm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).squaredNorm();
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.squaredNorm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).squaredNorm();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return (bp - t * (c - b)).squaredNorm();
  }
  const Eigen::Vector3d n = ab.cross(ac);
  const double along = n.dot(ap);
  return along * along / n.squaredNorm();
}

class EdgeCollapses {
public:
  EdgeCollapses(CaseSurface& surface, const CollapseRules& rules, const Progress& progress)
      : m_surface(surface),
        m_rules(rules),
        m_progress(progress),
        m_place(surface.mesh.position),
        m_triangle(surface.mesh.triangle),
        m_group(surface.group),
        m_kinds(surface, rules.isKept) {
    const std::size_t vertices = m_place.size();
    m_normal.assign(vertices, Eigen::Vector3d::Zero());
    m_quadric.resize(vertices);
    m_spacing.assign(vertices, 0);
    m_tries.assign(vertices, 0);
    m_best.assign(vertices, {});
    m_isDirty.assign(vertices, 1);
    m_nextGone.assign(vertices, kNoVertex);
    m_firstGone.assign(m_triangle.size(), kNoVertex);
    sumPlanes();
  }

  void run() {
    while (m_triangle.size() > m_rules.triangles) {
      m_progress.check();
      const std::size_t before = m_triangle.size();
      findFans();
      findCandidates();
      if (!m_candidates.empty()) apply();
      dropTriangles();
      // the last vertices of a bound are not worth a pass
      const bool isEnd = m_rules.triangles == 0 ? before - m_triangle.size() <= before / kFewest
                                                : before == m_triangle.size() && isTried();
      if (isEnd && (m_rules.triangles == 0 || !loosen())) break;
    }
    dropVertices();
  }

private:
  struct Best {
    float cost = std::numeric_limits<float>::infinity();
    std::uint32_t onto = kNoVertex;
  };
  struct Candidate {
    float cost = 0;
    std::uint32_t vertex = 0;
    bool operator<(const Candidate& other) const {
      return cost < other.cost || (cost == other.cost && vertex < other.vertex);
    }
  };

  void sumPlanes() {
    std::vector<std::uint32_t> sides(m_place.size(), 0);
    for (std::size_t f = 0; f < m_triangle.size(); ++f) {
      const Triangle& t = m_triangle[f];
      const Eigen::Vector3d across =
          (m_place[t[1]] - m_place[t[0]]).cross(m_place[t[2]] - m_place[t[0]]);
      const double twice = across.norm();
      if (!(twice > 0)) continue;
      const Eigen::Vector3d n = across / twice;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t v = t[i];
        m_quadric[v].addPlane(n, -n.dot(m_place[t[0]]), twice / 2);
        // ends where there is no wall do not bend the wall's normals
        if (m_kinds.kind(v) == Movable::Free || m_group[f] == 0) m_normal[v] += across;
        m_spacing[v] += (m_place[t[(i + 1) % 3]] - m_place[v]).norm();
        ++sides[v];
      }
    }
    for (std::size_t v = 0; v < m_place.size(); ++v) {
      m_normal[v].normalize();
      if (sides[v] > 0) m_spacing[v] /= sides[v];
    }
  }

  /// The triangles around each vertex, in the order of their indices.
  void findFans() {
    m_offset.assign(m_place.size() + 1, 0);
    for (const Triangle& t : m_triangle)
      for (const std::uint32_t v : t) ++m_offset[v + 1];
    for (std::size_t v = 0; v < m_place.size(); ++v) m_offset[v + 1] += m_offset[v];
    m_fan.resize(3 * m_triangle.size());
    m_at.assign(m_offset.begin(), m_offset.end() - 1);
    for (std::uint32_t f = 0; f < m_triangle.size(); ++f)
      for (const std::uint32_t v : m_triangle[f]) m_fan[m_at[v]++] = f;
  }

  [[nodiscard]] std::span<const std::uint32_t> fan(std::uint32_t v) const {
    return std::span(m_fan).subspan(m_offset[v], m_offset[v + 1] - m_offset[v]);
  }

  [[nodiscard]] float costOf(std::uint32_t gone, std::uint32_t kept) const {
    PlaneSum sum = m_quadric[gone];
    sum.add(m_quadric[kept]);
    const double square = sum.area > 0 ? std::max(0.0, sum.at(m_place[kept])) / sum.area : 0;
    const double scale = m_rules.allowed.empty() ? m_spacing[gone] * m_spacing[gone] : 1;
    if (!m_rules.allowed.empty() && square > m_rules.allowed[gone] * m_rules.allowed[gone])
      return std::numeric_limits<float>::infinity();
    return static_cast<float>(square / scale);
  }

  /// The edge that a vertex has to be tried next, by cost.
  [[nodiscard]] Best nextBest(std::uint32_t v) const {
    if (m_kinds.kind(v) == Movable::Kept || m_tries[v] >= m_mostTries) return {};
    std::array<Best, kMostAround> found;
    std::size_t count = 0;
    if (fan(v).size() > kMostAround) return {};
    for (const std::uint32_t f : fan(v)) {
      const Triangle& t = m_triangle[f];
      const std::size_t i = t[0] == v ? 0 : t[1] == v ? 1 : 2;
      const std::uint32_t w = t[(i + 1) % 3];
      if (!m_kinds.mayMove(v, w)) continue;
      found[count++] = {costOf(v, w), w};
    }
    if (m_tries[v] >= count) return {};
    const auto isLess = [](const Best& a, const Best& b) {
      return a.cost < b.cost || (a.cost == b.cost && a.onto < b.onto);
    };
    std::nth_element(found.begin(), found.begin() + m_tries[v], found.begin() + count, isLess);
    return found[m_tries[v]];
  }

  void findCandidates() {
    tbb::parallel_for(std::size_t{0}, m_place.size(), [&](std::size_t v) {
      if (m_isDirty[v] == 0) return;
      m_isDirty[v] = 0;
      m_best[v] = nextBest(static_cast<std::uint32_t>(v));
    });
    m_candidates.clear();
    for (std::uint32_t v = 0; v < m_place.size(); ++v)
      if (m_best[v].cost < std::numeric_limits<float>::infinity())
        m_candidates.push_back({m_best[v].cost, v});
    // The dearer ones wait. The others keep the order of the vertices, which is that of space, so
    // that what they need is near in memory.
    const std::size_t most = m_candidates.size() / kShare;
    if (most < 1) return;
    m_costs.clear();
    for (const Candidate& candidate : m_candidates) m_costs.push_back(candidate.cost);
    const auto middle = m_costs.begin() + static_cast<std::ptrdiff_t>(most);
    std::nth_element(m_costs.begin(), middle, m_costs.end());
    std::erase_if(m_candidates, [&](const Candidate& c) { return c.cost > *middle; });
  }

  /// Whether no vertex has an edge that was not tried.
  [[nodiscard]] bool isTried() const {
    return std::ranges::none_of(m_isDirty, [](std::uint8_t dirty) { return dirty != 0; });
  }

  /// Loosens the rules for shapes, once.
  bool loosen() {
    if (m_mostTurned < kMostTurned) return false;
    m_mostTurned = kMostTurnedOfFew;
    m_leastSharp = m_leastFlat = kLeastSharpOfFew;
    m_mostTries = kMostAround;
    m_tries.assign(m_tries.size(), 0);
    m_isDirty.assign(m_isDirty.size(), 1);
    return true;
  }

  /// Collapses what may be.
  void apply() {
    m_isTouched.assign(m_place.size(), 0);
    m_isDropped.assign(m_triangle.size(), 0);
    std::size_t triangles = m_triangle.size();
    for (const Candidate& candidate : m_candidates) {
      if (triangles <= m_rules.triangles) break;
      const std::uint32_t gone = candidate.vertex, kept = m_best[gone].onto;
      if (m_isTouched[gone] != 0 || m_isTouched[kept] != 0) continue;
      if (!isAllowed(gone, kept)) {
        ++m_tries[gone];
        m_isDirty[gone] = 1;
        continue;
      }
      collapse(gone, kept);
      triangles -= 2;
    }
  }

  /// Fills m_after with the triangles that would replace those around `gone`, in the order of the
  /// fan without those that go.
  bool isAllowed(std::uint32_t gone, std::uint32_t kept) {
    if (m_kinds.isRimShort(gone, kLeastRim)) return false;
    if (!hasSimpleLink(gone, kept)) return false;
    m_after.clear();
    for (const std::uint32_t f : fan(gone)) {
      Triangle t = m_triangle[f];
      if (std::find(t.begin(), t.end(), kept) != t.end()) continue;
      std::replace(t.begin(), t.end(), gone, kept);
      if (!isWellShaped(m_triangle[f], t, m_group[f] == 0 ? m_leastSharp : m_leastFlat))
        return false;
      m_after.push_back({f, t});
    }
    return m_rules.allowed.empty() || isNear(gone);
  }

  /// Whether both ends have exactly two neighbours in common, each of which keeps three or more.
  bool hasSimpleLink(std::uint32_t gone, std::uint32_t kept) {
    ++m_mark;
    m_marked.resize(m_place.size(), 0);
    for (const std::uint32_t f : fan(kept))
      for (const std::uint32_t v : m_triangle[f]) m_marked[v] = m_mark;
    m_marked[gone] = m_marked[kept] = 0;
    std::size_t common = 0;
    for (const std::uint32_t f : fan(gone)) {
      const Triangle& t = m_triangle[f];
      const std::size_t i = t[0] == gone ? 0 : t[1] == gone ? 1 : 2;
      const std::uint32_t v = t[(i + 1) % 3];
      if (m_marked[v] != m_mark) continue;
      ++common;
      if (fan(v).size() <= 3) return false;
    }
    return common == 2;
  }

  /// `least`: squared sine of the least angle. Flat ends need more: slivers of a plane turn over when
  /// places are rounded.
  [[nodiscard]] bool isWellShaped(const Triangle& before, const Triangle& now, double least) const {
    const auto &a = m_place[now[0]], &b = m_place[now[1]], &c = m_place[now[2]];
    const Eigen::Vector3d across = (b - a).cross(c - a);
    const double twice = across.norm();
    if (!(twice > 0)) return false;
    const auto &o = m_place[before[0]], &p = m_place[before[1]], &q = m_place[before[2]];
    const Eigen::Vector3d was = (p - o).cross(q - o);
    const double wasTwice = was.norm();
    for (std::size_t i = 0; i < 3; ++i) {
      const double turned = across.dot(m_normal[now[i]]) / twice;
      if (m_kinds.kind(now[i]) != Movable::Free || turned >= m_mostTurned) continue;
      if (!(wasTwice > 0) || turned < was.dot(m_normal[now[i]]) / wasTwice) return false;
    }
    if (wasTwice > 0 && across.dot(was) < m_mostTurned * twice * wasTwice &&
        squaredSine(o, p, q) > m_leastSharp)
      return false;
    const double sharp = squaredSine(a, b, c);
    return sharp >= least || sharp >= squaredSine(o, p, q);
  }

  /// Whether the vertices that went before, and the one that goes, stay near the new triangles;
  /// m_taker: for each of them the new triangle, in the order of their lists.
  bool isNear(std::uint32_t gone) {
    m_taker.clear();
    m_goneAt.clear();
    const auto take = [&](std::uint32_t v, std::uint32_t group) {
      const double allowed = m_rules.allowed[v] * m_rules.allowed[v];
      double least = std::numeric_limits<double>::infinity();
      std::uint32_t taker = kNoVertex;
      for (std::uint32_t i = 0; i < m_after.size(); ++i) {
        if (m_group[m_after[i].index] != group) continue;
        const Triangle& t = m_after[i].corner;
        const double square =
            squaredDistance(m_place[v], m_place[t[0]], m_place[t[1]], m_place[t[2]]);
        if (square < least) {
          least = square;
          taker = i;
        }
      }
      if (!(least <= allowed)) return false;
      m_goneAt.push_back(v);
      m_taker.push_back(taker);
      return true;
    };
    for (const std::uint32_t f : fan(gone))
      for (std::uint32_t v = m_firstGone[f]; v != kNoVertex; v = m_nextGone[v])
        if (!take(v, m_group[f])) return false;
    return take(gone, m_kinds.groupOf(gone)) && areMiddlesNear(gone);
  }

  /// Whether the middles of the new triangles are near those that they replace: a valley whose
  /// vertices are near its sides may not be bridged.
  [[nodiscard]] bool areMiddlesNear(std::uint32_t gone) const {
    const double allowed = m_rules.allowed[gone] * m_rules.allowed[gone];
    return std::all_of(m_after.begin(), m_after.end(), [&](const After& after) {
      const Triangle& t = after.corner;
      const Eigen::Vector3d middle = (m_place[t[0]] + m_place[t[1]] + m_place[t[2]]) / 3;
      return std::ranges::any_of(fan(gone), [&](std::uint32_t f) {
        const Triangle& b = m_triangle[f];
        return squaredDistance(middle, m_place[b[0]], m_place[b[1]], m_place[b[2]]) <= allowed;
      });
    });
  }

  void collapse(std::uint32_t gone, std::uint32_t kept) {
    for (const std::uint32_t f : fan(gone)) {
      m_firstGone[f] = kNoVertex;
      m_isDropped[f] = 1;
      for (const std::uint32_t v : m_triangle[f]) {
        m_isTouched[v] = 1;
        m_isDirty[v] = 1;
        m_tries[v] = 0;
      }
    }
    for (const auto& [f, t] : m_after) {
      m_triangle[f] = t;
      m_isDropped[f] = 0;
    }
    if (!m_rules.allowed.empty())
      for (std::size_t i = 0; i < m_goneAt.size(); ++i) {
        std::uint32_t& first = m_firstGone[m_after[m_taker[i]].index];
        m_nextGone[m_goneAt[i]] = first;
        first = m_goneAt[i];
      }
    m_kinds.remove(gone);
    m_quadric[kept].add(m_quadric[gone]);
    m_best[gone] = {};
    m_isDirty[gone] = 0;
  }

  void dropTriangles() {
    std::size_t to = 0;
    for (std::size_t f = 0; f < m_triangle.size(); ++f) {
      if (m_isDropped[f] != 0) continue;
      m_triangle[to] = m_triangle[f];
      m_group[to] = m_group[f];
      m_firstGone[to] = m_firstGone[f];
      ++to;
    }
    m_triangle.resize(to);
    m_group.resize(to);
    m_firstGone.resize(to);
  }

  void dropVertices() {
    std::vector<std::uint32_t> to(m_place.size(), kNoVertex);
    for (const Triangle& t : m_triangle)
      for (const std::uint32_t v : t) to[v] = 0;
    std::uint32_t count = 0;
    for (std::size_t v = 0; v < to.size(); ++v) {
      if (to[v] == kNoVertex) continue;
      m_place[count] = m_place[v];
      m_surface.node[count] = m_surface.node[v];
      to[v] = count++;
    }
    m_place.resize(count);
    m_surface.node.resize(count);
    for (Triangle& t : m_triangle)
      for (std::uint32_t& v : t) v = to[v];
  }

  struct After {
    std::uint32_t index = 0;
    Triangle corner{};
  };

  CaseSurface& m_surface;
  const CollapseRules& m_rules;
  const Progress& m_progress;
  std::vector<Eigen::Vector3d>& m_place;
  std::vector<Triangle>& m_triangle;
  std::vector<std::uint32_t>& m_group;
  VertexKinds m_kinds;
  std::vector<Eigen::Vector3d> m_normal;
  std::vector<PlaneSum> m_quadric;
  std::vector<double> m_spacing;
  std::vector<std::uint32_t> m_offset, m_fan, m_at;  ///< CSR: triangles around each vertex
  std::vector<Best> m_best;
  double m_leastSharp = kLeastSharp, m_leastFlat = kSharpSquaredSine, m_mostTurned = kMostTurned;
  std::uint8_t m_mostTries = kMostTries;
  std::vector<std::uint8_t> m_tries, m_isDirty, m_isTouched, m_isDropped;
  std::vector<Candidate> m_candidates;
  std::vector<float> m_costs;
  std::vector<std::uint32_t> m_nextGone, m_firstGone;  ///< lists of vertices that went, by triangle
  std::vector<After> m_after;
  std::vector<std::uint32_t> m_goneAt, m_taker;
  std::vector<std::uint32_t> m_marked;
  std::uint32_t m_mark = 0;
};

}  // namespace

void collapseEdges(CaseSurface& surface, const CollapseRules& rules, const Progress& progress) {
  EdgeCollapses(surface, rules, progress).run();
}

}  // namespace lumen::convert
