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
#include "converters/geometry/triangle_tree.h"
#include "converters/stages/surface/simplify/collapsing_mesh.h"
#include "converters/stages/surface/simplify/plane_sum.h"

namespace lumen::convert {
namespace {

constexpr double kLeastSharp = 0.0076;  // squared sine of 5 degrees
constexpr double kMostTurned = 0.5;     // cosine of 60 degrees
// The same where a number of triangles is not reached otherwise: 1 and 80 degrees.
constexpr double kLeastSharpOfFew = 0.0003, kMostTurnedOfFew = 0.17;
constexpr std::size_t kLeastRim = 8;     // edges of a rim
constexpr std::size_t kMostAround = 48;  // triangles around a vertex that is looked at
constexpr std::size_t kFewAround = 6;    // that others of the pass may have taken from
constexpr std::size_t kFewest = 200;     // a pass that drops fewer of so many is the last
constexpr int kShare = 3;                // a pass takes the cheapest third
constexpr std::uint8_t kMostTries = 4;   // edges of one vertex between two changes around it
// Share of the allowed distances in the first passes, in which few sheets can meet. It decides the time
// alone: with 0.12 to 0.5 a case has the same triangles to within half a per cent.
constexpr double kFirstShare = 0.25;

double squaredDistance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                       const Eigen::Vector3d& c) {
  return (p - nearestPointOnTriangle(p, a, b, c)).squaredNorm();
}

class EdgeCollapses {
public:
  EdgeCollapses(CaseSurface& surface, const CollapseRules& rules, const Progress& progress)
      : m_mesh(surface, rules.closeFrom),
        m_rules(rules),
        m_progress(progress),
        m_share(rules.allowed.empty() ? 1 : kFirstShare) {
    m_mesh.lookWithin(m_share);
    const std::size_t vertices = m_mesh.vertices();
    m_normal.assign(vertices, Eigen::Vector3d::Zero());
    m_quadric.resize(vertices);
    m_spacing.assign(vertices, 0);
    m_tries.assign(vertices, 0);
    m_best.assign(vertices, {});
    m_isDirty.assign(vertices, 1);
    m_marked.assign(vertices, 0);
    sumPlanes();
  }

  std::vector<std::uint8_t> run() {
    while (m_mesh.triangles().size() > m_rules.triangles) {
      m_progress.check();
      const std::size_t before = m_mesh.triangles().size();
      m_mesh.beginPass();
      findCandidates();
      apply();
      m_mesh.undoCrossings(m_progress);
      settle();
      m_mesh.endPass();
      const std::size_t dropped = before - m_mesh.triangles().size();
      // the last vertices of a bound are not worth a pass
      const bool isEnd =
          m_rules.triangles == 0 ? dropped <= before / kFewest : dropped == 0 && isTried();
      if (isEnd && !useWholeShare() && (m_rules.triangles == 0 || !loosen())) break;
    }
    m_mesh.dropVertices();
    return m_mesh.isClose();
  }

private:
  struct Best {
    float cost = std::numeric_limits<float>::infinity();
    std::uint32_t onto = CollapsingMesh::kNone;
  };
  struct Candidate {
    float cost = 0;
    std::uint32_t vertex = 0;
  };

  void sumPlanes() {
    std::vector<std::uint32_t> sides(m_mesh.vertices(), 0);
    for (std::uint32_t f = 0; f < m_mesh.triangles().size(); ++f) {
      const Triangle& t = m_mesh.triangles()[f];
      const Eigen::Vector3d& origin = m_mesh.place(t[0]);
      const Eigen::Vector3d across =
          (m_mesh.place(t[1]) - origin).cross(m_mesh.place(t[2]) - origin);
      const double twice = across.norm();
      if (!(twice > 0)) continue;
      const Eigen::Vector3d n = across / twice;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t v = t[i];
        m_quadric[v].addPlane(n, -n.dot(origin), twice / 2);
        // ends where there is no wall do not bend the wall's normals
        if (m_mesh.kinds().kind(v) == Movable::Free || m_mesh.group(f) == 0) m_normal[v] += across;
        m_spacing[v] += (m_mesh.place(t[(i + 1) % 3]) - m_mesh.place(v)).norm();
        ++sides[v];
      }
    }
    for (std::size_t v = 0; v < sides.size(); ++v) {
      m_normal[v].normalize();
      if (sides[v] > 0) m_spacing[v] /= sides[v];
    }
  }

  [[nodiscard]] double squareAllowed(std::uint32_t v) const {
    const double allowed = m_share * m_rules.allowed[v];
    return allowed * allowed;
  }

  [[nodiscard]] float costOf(std::uint32_t gone, std::uint32_t kept) const {
    PlaneSum sum = m_quadric[gone];
    sum.add(m_quadric[kept]);
    const double square = sum.meanAt(m_mesh.place(kept));
    const double scale = m_rules.allowed.empty() ? m_spacing[gone] * m_spacing[gone] : 1;
    if (!m_rules.allowed.empty() && square > squareAllowed(gone))
      return std::numeric_limits<float>::infinity();
    return static_cast<float>(square / scale);
  }

  /// The edge that a vertex has to be tried next, by cost.
  [[nodiscard]] Best nextBest(std::uint32_t v) const {
    if (m_mesh.kinds().kind(v) == Movable::Kept || m_tries[v] >= m_mostTries) return {};
    std::array<Best, kMostAround> found;
    std::size_t count = 0;
    if (m_mesh.fan(v).size() > kMostAround) return {};
    for (const std::uint32_t f : m_mesh.fan(v)) {
      const Triangle& t = m_mesh.triangles()[f];
      const std::uint32_t w = t[(cornerOf(t, v) + 1) % 3];
      if (!m_mesh.kinds().mayMove(v, w)) continue;
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
    tbb::parallel_for(std::size_t{0}, m_mesh.vertices(), [&](std::size_t v) {
      if (m_isDirty[v] == 0) return;
      m_isDirty[v] = 0;
      m_best[v] = nextBest(static_cast<std::uint32_t>(v));
    });
    m_candidates.clear();
    for (std::uint32_t v = 0; v < m_mesh.vertices(); ++v)
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

  /// Lets vertices go that stay within all of the allowed distance, once.
  bool useWholeShare() {
    if (m_share == 1) return false;
    m_share = 1;
    m_mesh.lookWithin(m_share);
    tryAgain();
    return true;
  }

  void tryAgain() {
    m_tries.assign(m_tries.size(), 0);
    m_isDirty.assign(m_isDirty.size(), 1);
  }

  /// Loosens the rules for shapes, once.
  bool loosen() {
    if (m_mostTurned < kMostTurned) return false;
    m_mostTurned = kMostTurnedOfFew;
    m_leastSharp = m_leastFlat = kLeastSharpOfFew;
    m_mostTries = kMostAround;
    tryAgain();
    return true;
  }

  /// Collapses what may be.
  void apply() {
    std::size_t triangles = m_mesh.triangles().size();
    for (const Candidate& candidate : m_candidates) {
      if (triangles <= m_rules.triangles) break;
      const std::uint32_t gone = candidate.vertex, kept = m_best[gone].onto;
      if (m_mesh.isTouched(gone) || m_mesh.isTouched(kept)) continue;
      if (!isAllowed(gone, kept)) {
        tryNext(gone);
        continue;
      }
      m_mesh.collapse(gone, kept, m_after, m_taken);
      triangles -= 2;
    }
  }

  void tryNext(std::uint32_t v) {
    ++m_tries[v];
    m_isDirty[v] = 1;
  }

  /// Notes what the collapses have changed that were not undone.
  void settle() {
    for (const CollapsingMesh::Collapse& collapse : m_mesh.collapses()) {
      if (collapse.isUndone) {
        tryNext(collapse.gone);
        continue;
      }
      for (const auto& [f, t] : m_mesh.before(collapse))
        for (const std::uint32_t v : t) {
          m_isDirty[v] = 1;
          m_tries[v] = 0;
        }
      m_quadric[collapse.kept].add(m_quadric[collapse.gone]);
      m_best[collapse.gone] = {};
      m_isDirty[collapse.gone] = 0;
    }
  }

  /// Fills m_after with the triangles that would replace those around `gone`, in the order of the
  /// fan without those that go, and m_taken.
  bool isAllowed(std::uint32_t gone, std::uint32_t kept) {
    if (m_mesh.kinds().isRimShort(gone, kLeastRim)) return false;
    if (!hasSimpleLink(gone, kept)) return false;
    m_after.clear();
    m_taken.clear();
    for (const std::uint32_t f : m_mesh.fan(gone)) {
      const Triangle& before = m_mesh.triangles()[f];
      Triangle t = before;
      if (std::find(t.begin(), t.end(), kept) != t.end()) continue;
      std::replace(t.begin(), t.end(), gone, kept);
      if (!isWellShaped(before, t, m_mesh.group(f) == 0 ? m_leastSharp : m_leastFlat)) return false;
      m_after.push_back({f, t});
    }
    return m_rules.allowed.empty() || isNear(gone);
  }

  [[nodiscard]] static std::size_t cornerOf(const Triangle& t, std::uint32_t v) {
    return t[0] == v ? 0 : t[1] == v ? 1 : 2;
  }

  /// Whether both ends have exactly two neighbours in common, each of which keeps three or more.
  bool hasSimpleLink(std::uint32_t gone, std::uint32_t kept) {
    ++m_mark;
    for (const std::uint32_t f : m_mesh.fan(kept))
      for (const std::uint32_t v : m_mesh.triangles()[f]) m_marked[v] = m_mark;
    m_marked[gone] = m_marked[kept] = 0;
    std::size_t common = 0;
    for (const std::uint32_t f : m_mesh.fan(gone)) {
      const Triangle& t = m_mesh.triangles()[f];
      const std::uint32_t v = t[(cornerOf(t, gone) + 1) % 3];
      if (m_marked[v] != m_mark) continue;
      ++common;
      if (m_mesh.fan(v).size() <= (m_mesh.isTouched(v) ? kFewAround : 3)) return false;
    }
    return common == 2;
  }

  /// `least`: squared sine of the least angle. Flat ends need more: slivers of a plane turn over when
  /// places are rounded.
  [[nodiscard]] bool isWellShaped(const Triangle& before, const Triangle& now, double least) const {
    const auto &a = m_mesh.place(now[0]), &b = m_mesh.place(now[1]), &c = m_mesh.place(now[2]);
    const Eigen::Vector3d across = (b - a).cross(c - a);
    const double twice = across.norm();
    if (!(twice > 0)) return false;
    const auto &o = m_mesh.place(before[0]), &p = m_mesh.place(before[1]),
               &q = m_mesh.place(before[2]);
    const Eigen::Vector3d was = (p - o).cross(q - o);
    const double wasTwice = was.norm();
    for (std::size_t i = 0; i < 3; ++i) {
      const double turned = across.dot(m_normal[now[i]]) / twice;
      if (m_mesh.kinds().kind(now[i]) != Movable::Free || turned >= m_mostTurned) continue;
      if (!(wasTwice > 0) || turned < was.dot(m_normal[now[i]]) / wasTwice) return false;
    }
    if (wasTwice > 0 && across.dot(was) < m_mostTurned * twice * wasTwice &&
        squaredSine(o, p, q) > m_leastSharp)
      return false;
    const double sharp = squaredSine(a, b, c);
    return sharp >= least || sharp >= squaredSine(o, p, q);
  }

  /// Whether the vertices that went before, and the one that goes, stay near the new triangles.
  bool isNear(std::uint32_t gone) {
    for (const std::uint32_t f : m_mesh.fan(gone))
      for (std::uint32_t v = m_mesh.firstGone(f); v != CollapsingMesh::kNone;
           v = m_mesh.nextGone(v))
        if (!take(v, m_mesh.group(f))) return false;
    return take(gone, m_mesh.kinds().groupOf(gone)) && areMiddlesNear(gone);
  }

  /// Finds the new triangle of a group that a vertex is near.
  bool take(std::uint32_t v, std::uint32_t group) {
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t taker = CollapsingMesh::kNone;
    for (const auto& [f, t] : m_after) {
      if (m_mesh.group(f) != group) continue;
      const double square = squaredDistance(m_mesh.place(v), m_mesh.place(t[0]), m_mesh.place(t[1]),
                                            m_mesh.place(t[2]));
      if (square < least) {
        least = square;
        taker = f;
      }
    }
    if (!(least <= squareAllowed(v))) return false;
    m_taken.push_back({v, taker});
    return true;
  }

  /// Whether the middles of the new triangles are near those that they replace: a valley whose
  /// vertices are near its sides may not be bridged.
  [[nodiscard]] bool areMiddlesNear(std::uint32_t gone) const {
    const double allowed = squareAllowed(gone);
    return std::all_of(m_after.begin(), m_after.end(), [&](const ChangedTriangle& after) {
      const Triangle& t = after.corner;
      const Eigen::Vector3d middle =
          (m_mesh.place(t[0]) + m_mesh.place(t[1]) + m_mesh.place(t[2])) / 3;
      return std::ranges::any_of(m_mesh.fan(gone), [&](std::uint32_t f) {
        const Triangle& b = m_mesh.triangles()[f];
        return squaredDistance(middle, m_mesh.place(b[0]), m_mesh.place(b[1]),
                               m_mesh.place(b[2])) <= allowed;
      });
    });
  }

  CollapsingMesh m_mesh;
  const CollapseRules& m_rules;
  const Progress& m_progress;
  double m_share;  ///< of the allowed distances, that counts now
  std::vector<Eigen::Vector3d> m_normal;
  std::vector<PlaneSum> m_quadric;
  std::vector<double> m_spacing;
  std::vector<Best> m_best;
  double m_leastSharp = kLeastSharp, m_leastFlat = kSharpSquaredSine, m_mostTurned = kMostTurned;
  std::uint8_t m_mostTries = kMostTries;
  std::vector<std::uint8_t> m_tries, m_isDirty;
  std::vector<Candidate> m_candidates;
  std::vector<float> m_costs;
  std::vector<ChangedTriangle> m_after;
  std::vector<GoneVertex> m_taken;
  std::vector<std::uint32_t> m_marked;
  std::uint32_t m_mark = 0;
};

}  // namespace

std::vector<std::uint8_t> collapseEdges(CaseSurface& surface, const CollapseRules& rules,
                                        const Progress& progress) {
  return EdgeCollapses(surface, rules, progress).run();
}

}  // namespace lumen::convert
