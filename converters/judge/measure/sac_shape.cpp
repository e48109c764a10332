// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/sac_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "converters/base/vectors.h"

namespace lumen::convert {
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
