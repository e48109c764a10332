// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/neck_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "converters/base/vectors.h"
#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr int kTriedPlanes = 32;            // planes of one direction that are tried first
constexpr int kRefinements = 10;            // halvings of an interval between two of them
constexpr int kGoldenSteps = 14;            // 1e-4 of the way between the first planes, at last
constexpr double kTilt = 1;                 // tangent of the greatest tilt that is searched
constexpr int kTiltsAcross = 5;             // of the first grid of tilts, in either direction
constexpr double kLastTilt = 0.004;         // tangent: the search ends
constexpr double kFirstRefinedTilt = 0.05;  // tangent: of the search on a finer surface

double score(const PlaneCutter::Cut& cut) {
  return cut.volume > 0 ? cut.area / std::cbrt(cut.volume * cut.volume)
                        : std::numeric_limits<double>::infinity();
}

std::uint32_t nearestVertex(const TriangleMesh& mesh, const Vector3d& point) {
  std::uint32_t best = 0;
  for (std::uint32_t v = 1; v < mesh.position.size(); ++v)
    if ((mesh.position[v] - point).squaredNorm() < (mesh.position[best] - point).squaredNorm())
      best = v;
  return best;
}

struct Found {
  NeckPlane plane;
  double score = std::numeric_limits<double>::infinity();
};

/// Searches the planes of one normal.
class OffsetSearch {
public:
  OffsetSearch(PlaneCutter& cutter, const Vector3d& normal, double low, double high)
      : m_cutter(cutter), m_normal(normal), m_low(low), m_step((high - low) / kTriedPlanes) {}

  /// Near a plane that was the best of a normal near by.
  Found runNear(double offset) {
    const double i = (offset - m_low) / m_step;
    const double below = scoreAt(at(i - 1)), here = scoreAt(at(i)), above = scoreAt(at(i + 1));
    if (std::isinf(here) || !(here <= above)) return run();
    if (std::isinf(below)) return refineLowest(i);
    return here <= below ? golden(at(i - 1), at(i + 1)) : run();
  }

  Found run() {
    std::array<std::optional<PlaneCutter::Cut>, kTriedPlanes> cuts;
    int widest = -1;
    for (int i = kTriedPlanes - 1; i >= 0; --i) {
      cuts[static_cast<std::size_t>(i)] = m_cutter.cut({m_normal, at(i)});
      const auto& cut = cuts[static_cast<std::size_t>(i)];
      // planes below one that separates nothing would cut the sac twice
      if (!cut) break;
      if (widest < 0 || cut->area > cuts[static_cast<std::size_t>(widest)]->area) widest = i;
    }
    if (widest < 0) return {};
    int best = widest, lowest = widest;
    for (int i = widest; i >= 0 && cuts[static_cast<std::size_t>(i)]; --i) {
      lowest = i;
      if (score(*cuts[static_cast<std::size_t>(i)]) < score(*cuts[static_cast<std::size_t>(best)]))
        best = i;
    }
    return best == lowest ? refineLowest(lowest) : refineInner(best);
  }

private:
  [[nodiscard]] double at(double i) const { return m_low + i * m_step; }
  double scoreAt(double offset) {
    const auto cut = m_cutter.cut({m_normal, offset});
    return cut ? score(*cut) : std::numeric_limits<double>::infinity();
  }

  // The section may be smallest at the last plane that separates, or between it and the next.
  Found refineLowest(double lowest) {
    double good = at(lowest), bad = at(lowest - 1);
    for (int i = 0; i < kRefinements; ++i) {
      const double middle = 0.5 * (good + bad);
      (m_cutter.cut({m_normal, middle}) ? good : bad) = middle;
    }
    return golden(good, at(lowest + 1));
  }
  Found refineInner(int best) { return golden(at(best - 1), at(best + 1)); }

  Found golden(double low, double high) {
    constexpr double kGolden = 0.6180339887498949;
    double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    double fa = scoreAt(a), fb = scoreAt(b);
    Found found{{m_normal, low}, scoreAt(low)};
    const auto keep = [&](double offset, double value) {
      if (value < found.score) found = {{m_normal, offset}, value};
    };
    for (int i = 0; i < kGoldenSteps; ++i) {
      keep(a, fa);
      keep(b, fb);
      if (fa < fb) {
        high = b;
        b = a;
        fb = fa;
        a = high - kGolden * (high - low);
        fa = scoreAt(a);
      } else {
        low = a;
        a = b;
        fa = fb;
        b = low + kGolden * (high - low);
        fb = scoreAt(b);
      }
    }
    return found;
  }

  PlaneCutter& m_cutter;
  Vector3d m_normal;
  double m_low, m_step;
};

}  // namespace

PlaneCutter::PlaneCutter(const LocalSurface& surface, const NeckPlace& place)
    : m_surface(surface),
      m_place(place),
      m_height(surface.mesh.position.size()),
      m_side(surface.mesh.position.size(), Side::Below) {
  const TriangleMesh& mesh = surface.mesh;
  // the wall that a ray from the vessel through the sac's point meets last, about
  const Vector3d along = (place.sac - place.vessel).normalized();
  m_seed = 0;
  double best = std::numeric_limits<double>::infinity();
  for (std::uint32_t v = 0; v < mesh.position.size(); ++v) {
    const Vector3d out = mesh.position[v] - place.sac;
    const double height = out.dot(along), aside = (out - height * along).norm();
    if (height > 0 && aside + 0.1 * height < best) {
      best = aside + 0.1 * height;
      m_seed = v;
    }
  }
  for (const Vector3d& node : place.axes) m_axisVertex.push_back(nearestVertex(mesh, node));
  listNeighbours();
}

void PlaneCutter::listNeighbours() {
  const TriangleMesh& mesh = m_surface.mesh;
  const std::size_t count = mesh.position.size();
  // two triangles at each edge, but at the borders of the box, name each neighbour twice
  std::vector<std::uint32_t> offset(count + 1, 0);
  for (const Triangle& t : mesh.triangle)
    for (const std::uint32_t v : t) offset[v + 1] += 2;
  for (std::size_t v = 0; v < count; ++v) offset[v + 1] += offset[v];
  std::vector<std::uint32_t> named(offset.back()), next(offset.begin(), offset.end() - 1);
  for (const Triangle& t : mesh.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      named[next[t[i]]++] = t[(i + 1) % 3];
      named[next[t[i]]++] = t[(i + 2) % 3];
    }
  m_offset.push_back(0);
  for (std::size_t v = 0; v < count; ++v) {
    const auto first = named.begin() + offset[v], last = named.begin() + offset[v + 1];
    std::sort(first, last);
    m_neighbour.insert(m_neighbour.end(), first, std::unique(first, last));
    m_offset.push_back(static_cast<std::uint32_t>(m_neighbour.size()));
  }
}

// Marks the vertices beyond the plane that are connected with the seed.
bool PlaneCutter::grow() {
  if (m_side.empty() || m_side[m_seed] == Side::Below) return false;
  m_open.assign(1, m_seed);
  m_side[m_seed] = Side::Beyond;
  while (!m_open.empty()) {
    const std::uint32_t v = m_open.back();
    m_open.pop_back();
    if (m_surface.isOpen[v] != 0) return false;
    for (std::uint32_t e = m_offset[v]; e < m_offset[v + 1]; ++e) {
      const std::uint32_t other = m_neighbour[e];
      if (m_side[other] != Side::Above) continue;
      m_side[other] = Side::Beyond;
      m_open.push_back(other);
    }
  }
  return true;
}

std::optional<PlaneCutter::Cut> PlaneCutter::cut(const NeckPlane& plane) {
  const std::vector<Vector3d>& position = m_surface.mesh.position;
  for (std::size_t v = 0; v < position.size(); ++v) {
    m_height[v] = plane.normal.dot(position[v]) - plane.offset;
    m_side[v] = m_height[v] > 0 ? Side::Above : Side::Below;
  }
  if (plane.normal.dot(m_place.vessel) > plane.offset || !grow()) return std::nullopt;
  for (std::size_t i = 0; i < m_axisVertex.size(); ++i)
    if (plane.normal.dot(m_place.axes[i]) > plane.offset && isBeyond(m_axisVertex[i]))
      return std::nullopt;
  return measure(plane);
}

// Sums over the triangles that lie beyond the plane, and the parts of those that it cuts. The
// section's area is that of its oriented rim; volumes are those of tetrahedra with a corner in the
// plane, so that the section adds nothing.
PlaneCutter::Cut PlaneCutter::measure(const NeckPlane& plane) const {
  const TriangleMesh& mesh = m_surface.mesh;
  const Vector3d base = m_place.sac - (plane.normal.dot(m_place.sac) - plane.offset) * plane.normal;
  Cut cut;
  Vector3d section = Vector3d::Zero();
  const auto rim = [&](std::uint32_t in, std::uint32_t out) -> Vector3d {
    const double t = m_height[in] / (m_height[in] - m_height[out]);
    return mesh.position[in] + t * (mesh.position[out] - mesh.position[in]) - base;
  };
  for (const Triangle& t : mesh.triangle) {
    const bool in[3] = {isBeyond(t[0]), isBeyond(t[1]), isBeyond(t[2])};
    const int count = static_cast<int>(in[0]) + static_cast<int>(in[1]) + static_cast<int>(in[2]);
    if (count == 0) continue;
    const auto point = [&](std::size_t i) -> Vector3d { return mesh.position[t[i]] - base; };
    if (count == 3) {
      cut.volume += tetrahedronVolume(point(0), point(1), point(2));
      continue;
    }
    // the corner that is alone on its side
    std::size_t i = 0;
    while ((count == 1) != in[i]) ++i;
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    if (count == 1) {
      const Vector3d p = rim(t[i], t[j]), q = rim(t[i], t[k]);
      cut.volume += tetrahedronVolume(point(i), p, q);
      section += p.cross(q);
    } else {
      const Vector3d p = rim(t[j], t[i]), q = rim(t[k], t[i]);
      cut.volume += tetrahedronVolume(p, point(j), point(k)) + tetrahedronVolume(p, point(k), q);
      section += q.cross(p);
    }
  }
  cut.area = std::abs(0.5 * section.dot(plane.normal));
  return cut;
}

namespace {

/// Searches normals, the best offset of each: those within kTilt of the way from the vessel to the
/// sac.
class TiltSearch {
public:
  TiltSearch(PlaneCutter& cutter, const Progress& progress)
      : m_cutter(cutter),
        m_place(cutter.place()),
        m_progress(progress),
        m_along((m_place.sac - m_place.vessel).normalized()),
        m_across(planeBasis(m_along)) {}

  bool keep(double a, double b) {
    m_progress.check();
    if (std::max(std::abs(a), std::abs(b)) > kTilt) return false;
    const Vector3d normal = (m_along + a * m_across.first + b * m_across.second).normalized();
    OffsetSearch search(m_cutter, normal, normal.dot(m_place.vessel),
                        normal.dot(m_cutter.farSide()));
    const Found found = std::isinf(m_best.score) ? search.run() : search.runNear(normal.dot(hub()));
    if (!(found.score < m_best.score)) return false;
    m_best = found;
    m_a = a;
    m_b = b;
    return true;
  }
  bool keep(const Vector3d& normal) {
    const double along = normal.dot(m_along);
    return along > 0 &&
           keep(normal.dot(m_across.first) / along, normal.dot(m_across.second) / along);
  }

  // Steps to better normals, which are halved where there is none.
  void descend(double step) {
    while (step > kLastTilt) {
      const double a = m_a, b = m_b;
      bool isBetter = keep(a + step, b);
      isBetter = keep(a - step, b) || isBetter;
      isBetter = keep(a, b + step) || isBetter;
      isBetter = keep(a, b - step) || isBetter;
      if (!isBetter) step *= 0.5;
    }
  }

  [[nodiscard]] std::optional<NeckPlane> best() const {
    return std::isinf(m_best.score) ? std::nullopt : std::optional(m_best.plane);
  }

private:
  /// The point of the best plane on the way from the vessel to the sac.
  [[nodiscard]] Vector3d hub() const {
    const NeckPlane& plane = m_best.plane;
    const double way =
        (plane.offset - plane.normal.dot(m_place.vessel)) / plane.normal.dot(m_along);
    return m_place.vessel + way * m_along;
  }

  PlaneCutter& m_cutter;
  const NeckPlace& m_place;
  const Progress& m_progress;
  Vector3d m_along;
  std::pair<Vector3d, Vector3d> m_across;
  Found m_best;
  double m_a = 0, m_b = 0;
};

}  // namespace

std::optional<NeckPlane> findNeck(PlaneCutter& surface, const Progress& progress) {
  const NeckPlace& place = surface.place();
  if (surface.surface().mesh.triangle.empty() || place.sac == place.vessel) return std::nullopt;
  TiltSearch search(surface, progress);
  search.keep(0, 0);
  constexpr double kStep = 2 * kTilt / (kTiltsAcross - 1);
  for (int i = 0; i < kTiltsAcross; ++i)
    for (int j = 0; j < kTiltsAcross; ++j) search.keep(i * kStep - kTilt, j * kStep - kTilt);
  search.descend(0.5 * kStep);
  return search.best();
}

std::optional<NeckPlane> refineNeck(const NeckPlane& found, PlaneCutter& fine,
                                    const Progress& progress) {
  TiltSearch search(fine, progress);
  search.keep(found.normal);
  search.descend(kFirstRefinedTilt);
  return search.best();
}

}  // namespace lumen::convert
