// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/sac_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "converters/base/vectors.h"
#include "converters/geometry/convex_hull.h"
#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;
constexpr std::uint32_t kNone = UINT32_MAX;
constexpr int kParallels = 48;  // parallel to the neck, of which the widest is taken

// The values that depend on the size of triangles.
constexpr std::array kOfTriangles = {&DomeShape::volume, &DomeShape::area, &DomeShape::hullVolume,
                                     &DomeShape::hullArea};

/// Cuts triangles at a plane, and keeps the vertices that it makes.
class Clipper {
public:
  /// `keep`: vertices that stay. `height`: of all vertices, above the plane.
  Clipper(const TriangleMesh& mesh, const std::vector<std::uint8_t>& keep,
          const std::vector<double>& height)
      : m_mesh(mesh), m_keep(keep), m_height(height), m_name(mesh.position.size(), kNone) {}

  void run() {
    for (const Triangle& t : m_mesh.triangle) {
      const int count = m_keep[t[0]] + m_keep[t[1]] + m_keep[t[2]];
      if (count == 3) m_out.triangle.push_back({name(t[0]), name(t[1]), name(t[2])});
      if (count == 0 || count == 3) continue;
      std::size_t i = 0;
      while ((count == 1) != (m_keep[t[i]] != 0)) ++i;
      const std::uint32_t a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      if (count == 1) {
        const std::uint32_t p = rimName(a, b), q = rimName(a, c);
        m_out.triangle.push_back({name(a), p, q});
        m_next[p] = q;
      } else {
        const std::uint32_t p = rimName(b, a), q = rimName(c, a);
        m_out.triangle.push_back({p, name(b), name(c)});
        m_out.triangle.push_back({p, name(c), q});
        m_next[q] = p;
      }
    }
  }

  TriangleMesh& mesh() { return m_out; }

  /// The vertices around the section; empty unless they make one loop.
  [[nodiscard]] std::vector<std::uint32_t> loop() const {
    std::vector<std::uint32_t> loop;
    if (m_next.empty()) return loop;
    std::uint32_t v = m_next.begin()->first;
    do {
      loop.push_back(v);
      const auto next = m_next.find(v);
      if (next == m_next.end() || loop.size() > m_next.size()) return {};
      v = next->second;
    } while (v != loop.front());
    return loop.size() == m_next.size() ? loop : std::vector<std::uint32_t>{};
  }

private:
  std::uint32_t add(const Vector3d& point) {
    m_out.position.push_back(point);
    return static_cast<std::uint32_t>(m_out.position.size() - 1);
  }
  std::uint32_t name(std::uint32_t v) {
    if (m_name[v] == kNone) m_name[v] = add(m_mesh.position[v]);
    return m_name[v];
  }
  std::uint32_t rimName(std::uint32_t in, std::uint32_t out) {
    const auto [at, isNew] = m_rim.try_emplace({in, out}, 0U);
    if (isNew) {
      const double t = m_height[in] / (m_height[in] - m_height[out]);
      at->second = add(m_mesh.position[in] + t * (m_mesh.position[out] - m_mesh.position[in]));
    }
    return at->second;
  }

  const TriangleMesh& m_mesh;
  const std::vector<std::uint8_t>& m_keep;
  const std::vector<double>& m_height;
  std::vector<std::uint32_t> m_name;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> m_rim;
  std::map<std::uint32_t, std::uint32_t> m_next;  // from a vertex of the rim to the next
  TriangleMesh m_out;
};

struct SectionShape {
  Vector3d centre = Vector3d::Zero();
  double area = 0, meanDiameter = 0;
};

// Takes segments that together make closed loops, in any order; each must run its loop's way round.
SectionShape shapeOfSegments(const std::vector<std::pair<Vector3d, Vector3d>>& segments,
                             const Vector3d& normal) {
  SectionShape shape;
  if (segments.empty()) return shape;
  const Vector3d base = segments.front().first;
  Vector3d moment = Vector3d::Zero();
  for (const auto& [p, q] : segments) {
    const double twice = normal.dot((p - base).cross(q - base));
    shape.area += 0.5 * twice;
    moment += twice / 6 * (p + q - 2 * base);
  }
  shape.centre = shape.area != 0 ? Vector3d(base + moment / shape.area) : base;
  shape.area = std::abs(shape.area);
  double sum = 0, length = 0;
  for (const auto& [p, q] : segments) {
    const double piece = (q - p).norm();
    length += piece;
    sum += piece / 6 *
           ((p - shape.centre).norm() + 4 * (0.5 * (p + q) - shape.centre).norm() +
            (q - shape.centre).norm());
  }
  if (length > 0) shape.meanDiameter = 2 * sum / length;
  return shape;
}

// Segments of the section of a mesh at a height above the plane.
std::vector<std::pair<Vector3d, Vector3d>> segmentsAt(const TriangleMesh& mesh,
                                                      const std::vector<double>& height,
                                                      double level) {
  std::vector<std::pair<Vector3d, Vector3d>> segments;
  const auto between = [&](std::uint32_t a, std::uint32_t b) -> Vector3d {
    // the same for both orders, so that rims close
    if (b < a) std::swap(a, b);
    const double t = (level - height[a]) / (height[b] - height[a]);
    return mesh.position[a] + t * (mesh.position[b] - mesh.position[a]);
  };
  for (const Triangle& t : mesh.triangle) {
    const bool in[3] = {height[t[0]] > level, height[t[1]] > level, height[t[2]] > level};
    const int count = static_cast<int>(in[0]) + static_cast<int>(in[1]) + static_cast<int>(in[2]);
    if (count == 0 || count == 3) continue;
    std::size_t i = 0;
    while ((count == 1) != in[i]) ++i;
    const Vector3d p = between(t[i], t[(i + 1) % 3]), q = between(t[i], t[(i + 2) % 3]);
    if (count == 1)
      segments.emplace_back(p, q);
    else
      segments.emplace_back(q, p);
  }
  return segments;
}

double widest(const TriangleMesh& mesh, const std::vector<double>& height, double top,
              const Vector3d& normal) {
  std::vector<double> width;
  for (int i = 0; i < kParallels; ++i)
    width.push_back(
        shapeOfSegments(segmentsAt(mesh, height, top * i / kParallels), normal).meanDiameter);
  const auto most =
      static_cast<std::size_t>(std::max_element(width.begin(), width.end()) - width.begin());
  if (most == 0 || most + 1 == width.size()) return width[most];
  // the top of the parabola through three of them
  const double a = width[most - 1], b = width[most], c = width[most + 1];
  const double bend = 2 * b - a - c, slope = 0.5 * (c - a);
  return bend > 0 ? b + 0.5 * slope * slope / bend : b;
}

void addHull(const DomeSurface& dome, const NeckPlane& plane, DomeShape& shape) {
  // the rim lies in the plane up to roundoff: faces of the hull with all corners there are the neck
  const std::vector<Vector3d>& position = dome.mesh.position;
  const double inPlane = 1e-9 * (1 + std::abs(plane.offset) + shape.height);
  const Vector3d base = shape.neckCentre;
  for (const Triangle& t : convexHull(position)) {
    const bool isNeck = std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
      return std::abs(plane.normal.dot(position[v]) - plane.offset) < inPlane;
    });
    const Vector3d a = position[t[0]] - base, b = position[t[1]] - base, c = position[t[2]] - base;
    shape.hullVolume += tetrahedronVolume(a, b, c);
    if (!isNeck) shape.hullArea += 0.5 * (b - a).cross(c - a).norm();
  }
}

}  // namespace

std::optional<DomeSurface> cutDome(PlaneCutter& cutter, const NeckPlane& plane) {
  if (!cutter.cut(plane)) return std::nullopt;
  const TriangleMesh& mesh = cutter.surface().mesh;
  const std::vector<Vector3d>& position = mesh.position;
  std::vector<std::uint8_t> keep(position.size());
  std::vector<double> height(position.size());
  for (std::uint32_t v = 0; v < position.size(); ++v) {
    keep[v] = cutter.isBeyond(v) ? 1 : 0;
    height[v] = plane.normal.dot(position[v]) - plane.offset;
  }
  Clipper clipper(mesh, keep, height);
  clipper.run();
  DomeSurface dome;
  const std::vector<std::uint32_t> loop = clipper.loop();
  if (loop.empty()) return std::nullopt;
  for (const std::uint32_t v : loop) dome.rim.push_back(clipper.mesh().position[v]);
  dome.mesh = std::move(clipper.mesh());
  return dome;
}

DomeShape shapeOf(const DomeSurface& dome, const NeckPlane& plane) {
  DomeShape shape;
  std::vector<std::pair<Vector3d, Vector3d>> rim;
  for (std::size_t i = 0; i < dome.rim.size(); ++i)
    rim.emplace_back(dome.rim[i], dome.rim[(i + 1) % dome.rim.size()]);
  const SectionShape neck = shapeOfSegments(rim, plane.normal);
  shape.neckCentre = neck.centre;
  shape.neckArea = neck.area;
  shape.neckDiameter = neck.meanDiameter;
  std::vector<double> height;
  for (const Vector3d& p : dome.mesh.position) {
    height.push_back(plane.normal.dot(p) - plane.offset);
    shape.height = std::max(shape.height, height.back());
    if ((p - neck.centre).norm() > shape.reach) {
      shape.reach = (p - neck.centre).norm();
      shape.tip = p;
    }
  }
  for (const Triangle& t : dome.mesh.triangle) {
    const std::vector<Vector3d>& at = dome.mesh.position;
    shape.volume +=
        tetrahedronVolume(at[t[0]] - neck.centre, at[t[1]] - neck.centre, at[t[2]] - neck.centre);
    shape.area += vectorArea(dome.mesh, t).norm();
  }
  shape.width = std::max(neck.meanDiameter, widest(dome.mesh, height, shape.height, plane.normal));
  addHull(dome, plane, shape);
  return shape;
}

DomeShape corrected(const DomeShape& shape, const DomeShape& from, const DomeShape& to) {
  DomeShape out = shape;
  for (double DomeShape::*value : kOfTriangles) out.*value += to.*value - from.*value;
  return out;
}

DomeShape extrapolated(const DomeShape& coarse, const DomeShape& fine) {
  DomeShape shape = fine;
  for (double DomeShape::*value : kOfTriangles) shape.*value += (fine.*value - coarse.*value) / 3;
  return shape;
}

namespace {

using Eigen::Vector3d;

constexpr double kCellShare = 0.1;    // edge of the coarse surface's cubes, of the sac's radius
constexpr double kMostSamples = 4e6;  // of the coarse field: a box of 160 cubes along each edge
constexpr int kNudges = 40;           // of a plane on whose sides the rims are not simple
constexpr double kMostNudge = 0.1;    // of the way to the far side

constexpr int kRimRays = 360;      // their polygon lacks 5e-5 of a circle's area
constexpr double kRimStep = 0.25;  // of a cell, along a ray
constexpr int kRimPlanes = 25;
constexpr double kRimPlaneStep = 0.02;  // of a cell: triangles lie 0.01 of a cell inside of a tube
constexpr int kRimHalvings = 24;        // of a step

struct Domes {
  NeckPlane plane;
  DomeSurface coarse, fine;
};

// The domes of both surfaces beyond one plane: the least farther out than the neck where both have
// one rim. A crease of a coarse surface ends farther out.
std::optional<Domes> domesAt(PlaneCutter& coarse, PlaneCutter& fine, const NeckPlane& neck) {
  const double way = fine.farSide().dot(neck.normal) - neck.offset;
  for (int i = 0; i < kNudges; ++i) {
    const NeckPlane plane{neck.normal, neck.offset + kMostNudge * way * i / kNudges};
    std::optional<DomeSurface> one = cutDome(coarse, plane);
    std::optional<DomeSurface> two = one ? cutDome(fine, plane) : std::nullopt;
    if (two) return Domes{plane, std::move(*one), std::move(*two)};
  }
  return std::nullopt;
}

// The rim of a plane on the wall itself, since triangles cut the corner of a neck's crease: the first
// crossings of even rays from the middle of the triangles' rim. Nothing if a ray meets no wall near
// that rim.
std::optional<std::vector<Vector3d>> rimOf(const BoxedField& field, const NeckPlane& plane,
                                           const std::vector<Vector3d>& rim, double cell) {
  Vector3d middle = Vector3d::Zero();
  double farthest = 0;
  for (const Vector3d& p : rim) middle += p / static_cast<double>(rim.size());
  middle -= (plane.normal.dot(middle) - plane.offset) * plane.normal;
  for (const Vector3d& p : rim) farthest = std::max(farthest, (p - middle).norm());
  const auto [u, v] = planeBasis(plane.normal);
  std::vector<Vector3d> out(kRimRays);
  for (int i = 0; i < kRimRays; ++i) {
    const double angle = 2 * std::numbers::pi * i / kRimRays;
    const Vector3d ray = std::cos(angle) * u + std::sin(angle) * v;
    double inside = 0, step = kRimStep * cell, outside = step;
    if (!(field.value(middle) > 0)) return std::nullopt;
    while (field.value(middle + outside * ray) > 0) {
      inside = outside;
      outside += step;
      if (outside > farthest + cell) return std::nullopt;
    }
    for (int k = 0; k < kRimHalvings; ++k) {
      const double t = 0.5 * (inside + outside);
      (field.value(middle + t * ray) > 0 ? inside : outside) = t;
    }
    out[static_cast<std::size_t>(i)] = middle + inside * ray;
  }
  return out;
}

// Puts the rim of a dome onto the wall. The plane may touch a vessel whose wall lies a little beyond
// its triangles: then the rim is that of the next plane that does not.
void putOnWall(const BoxedField& field, const NeckPlane& plane, DomeSurface& dome, double cell) {
  for (int i = 0; i < kRimPlanes; ++i) {
    const double by = kRimPlaneStep * cell * i;
    if (auto rim = rimOf(field, {plane.normal, plane.offset + by}, dome.rim, cell)) {
      for (Vector3d& p : *rim) p -= by * plane.normal;
      dome.rim = std::move(*rim);
      return;
    }
  }
}

}  // namespace

std::optional<SacShape> findSacShape(const BoxedField& field, const NeckPlace& place,
                                     const Eigen::Vector3d& seed, double radius, double shift,
                                     const Progress& progress) {
  double cell = kCellShare * radius;
  const double samples = (field.box.size() / cell).prod();
  if (samples > kMostSamples) cell *= std::cbrt(samples / kMostSamples);
  const SampledField rough(field, cell, nullptr, progress);
  const SampledField smooth(field, 0.5 * cell, &rough, progress);
  const LocalSurface coarse = rough.surface(seed), fine = smooth.surface(seed);
  if (coarse.mesh.triangle.empty() || fine.mesh.triangle.empty()) return std::nullopt;
  PlaneCutter coarseCutter(coarse, place), fineCutter(fine, place);
  std::optional<NeckPlane> neck = findNeck(coarseCutter, progress);
  if (neck) neck = refineNeck(*neck, fineCutter, progress);
  std::optional<Domes> domes = neck ? domesAt(coarseCutter, fineCutter, *neck) : std::nullopt;
  if (!domes) return std::nullopt;
  SacShape out;
  out.neck = domes->plane;
  putOnWall(field, out.neck, domes->fine, cell);
  const DomeShape finer = shapeOf(domes->fine, out.neck);
  out.shape = extrapolated(shapeOf(domes->coarse, out.neck), finer);
  out.moved = out.shape;
  const NeckPlane beyond{out.neck.normal, out.neck.offset + shift};
  if (auto dome = shift > 0 ? cutDome(fineCutter, beyond) : std::nullopt) {
    putOnWall(field, beyond, *dome, cell);
    out.moved = corrected(shapeOf(*dome, beyond), finer, out.shape);
  }
  out.dome = std::move(domes->fine);
  return out;
}

}  // namespace lumen::convert
