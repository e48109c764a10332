// SPDX-License-Identifier: Apache-2.0
// Difficult phantoms, with features of patients that small_designs.cpp lacks. Positions are shares
// of the extent; radii follow Frame::radiusScale. Ends lie inside the volume and are round, but for
// those on a face.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "converters/stages/phantom/design.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
constexpr double kTurn = 2 * std::numbers::pi;

// From one point to another past a corner, which is rounded by a parabola over `blend` mm on both
// sides; the radius goes from r0 to r1 over the same way.
struct BentVessel {
  Vector3d from, corner, to;
  double blend, r0, r1;

  [[nodiscard]] double lengthIn() const { return (corner - from).norm(); }
  [[nodiscard]] double length() const { return lengthIn() + (to - corner).norm(); }
  [[nodiscard]] Vector3d at(double t) const {
    const double s = t * length() - lengthIn();
    const Vector3d in = (corner - from).normalized(), out = (to - corner).normalized();
    if (s < -blend) return corner + s * in;
    if (s > blend) return corner + s * out;
    const double w = (s + blend) / (2 * blend);
    return corner - blend * (1 - w) * (1 - w) * in + blend * w * w * out;
  }
  /// Half way round the corner.
  [[nodiscard]] Vector3d middle() const { return at(lengthIn() / length()); }
  [[nodiscard]] Path path() const {
    return sampleCurve([this](double t) { return at(t); },
                       [this](double t) {
                         const double s = (t * length() - lengthIn() + blend) / (2 * blend);
                         return r0 + (r1 - r0) * std::clamp(s, 0.0, 1.0);
                       });
  }
};

// A ball of `radius` around `centre`, seen from a point of the axis to which it is joined: each
// radius is that of the largest ball inside it, or inside the ball of `around` that it begins in,
// and never below `neck`.
Path sacPath(const Vector3d& from, const Vector3d& centre, double radius, double around,
             double neck) {
  const double length = (centre - from).norm();
  return sampleCurve([&](double t) -> Vector3d { return from + t * (centre - from); },
                     [&](double t) {
                       return std::max({neck, around - t * length, radius - (1 - t) * length});
                     });
}

// Appends points `step` apart along the arc of a circle in the x-y plane, from one angle to
// another.
void appendArc(Path& path, const Vector3d& centre, double bend, double from, double to,
               double radius, double step) {
  const int pieces = std::max(2, static_cast<int>(std::abs(to - from) * bend / step));
  for (int i = 1; i <= pieces; ++i) {
    const double angle = from + (to - from) * i / pieces;
    path.push_back({centre + bend * Vector3d(std::cos(angle), std::sin(angle), 0), radius});
  }
}

}  // namespace

// A trunk that parts at 65 degrees to both sides, the wider child going on as "root"; from the
// fork's apex a sac with a wide neck, and on the sac two lobes.
Design designSacLobes(const Frame& frame) {
  const double e = frame.extent, scale = frame.radiusScale();
  const double r0 = 1.3 * scale, r1 = 1.1 * scale, r2 = 0.95 * scale, sac = 2.2 * scale;
  const double turn = 65 * kTurn / 360, reach = 0.4 * e / std::sin(turn);
  const Vector3d fork(0.5 * e, 0.49 * e, 0.4 * e);
  const BentVessel trunk{{0.48 * e, 0.5 * e, 0},
                         fork,
                         fork + reach * Vector3d(std::sin(turn), 0.03, std::cos(turn)),
                         2.5 * r0,
                         r0,
                         r1};
  TreeBuilder builder(frame);
  const auto root =
      static_cast<std::int32_t>(builder.add("root", formats::kNoParent, trunk.path()));
  const Vector3d start = trunk.middle();
  builder.add("b01", root,
              straightPath(start, start + reach * Vector3d(-std::sin(turn), 0.05, std::cos(turn)),
                           constant(r2)));
  const Vector3d centre = fork + 3.7 * scale * Vector3d(-0.06, 0.05, 1).normalized();
  const auto body = static_cast<std::int32_t>(builder.add(
      "sac", root, sacPath(start, centre, sac, 0, 0.9 * scale), formats::BranchKind::Aneurysm));
  const auto addLobe = [&](const std::string& label, const Vector3d& towards, double lobe) {
    const Vector3d lobeCentre = centre + 1.05 * sac * towards.normalized();
    builder.add(label, body, sacPath(centre, lobeCentre, lobe, sac, 0.5 * lobe),
                formats::BranchKind::Aneurysm);
  };
  addLobe("lobe-1", {0.5, 0.4, 0.8}, 1.1 * scale);
  addLobe("lobe-2", {-0.2, -0.9, 0.5}, 0.8 * scale);
  return builder.design();
}

// A bright narrow vessel and a wide one of 55 % of its contrast, which wind together along x with
// their walls touching over seven tenths of the extent and part on both sides.
Design designCompanion(const Frame& frame) {
  const double e = frame.extent, scale = frame.radiusScale();
  const double bright = 0.7 * scale, dark = 1.1 * scale;
  const auto apart = [&](double t) {
    const double beyond = std::max(0.0, std::abs(t - 0.5) - 0.35) / 0.15;
    return bright + dark + 0.2 * e * beyond * beyond;
  };
  const auto path = [&](double side, double radius) {
    return sampleCurve(
        [&, side](double t) {
          return Vector3d(e * t, 0.5 * e + 0.07 * e * std::sin(kTurn * t),
                          0.48 * e + side * 0.5 * apart(t));
        },
        constant(radius));
  };
  TreeBuilder builder(frame);
  builder.add("artery", formats::kNoParent, path(+1, bright));
  const std::uint32_t vein = builder.add("vein", formats::kNoParent, path(-1, dark));
  Design& design = builder.design();
  for (std::size_t n = design.tree.branches[vein].firstNode; n < design.tree.nodeCount(); ++n)
    design.contrast[n] = 0.55F;
  design.notes["companions"] = std::string("artery vein");
  return design;
}

// Four limbs along x, joined by half circles whose axes bend at 3, 2 and 1.5 radii of the vessel.
Design designHairpin(const Frame& frame) {
  const double e = frame.extent, r = 0.8 * frame.radiusScale(), step = 0.1 * frame.voxel;
  const double low = 0.3 * e, high = 0.7 * e;
  Vector3d at(0, 0.28 * e, 0);
  Path path{{at, r}};
  double forwards = 1;  // the sense of the limb along x
  for (const double bends : {3.0, 2.0, 1.5}) {
    const double bend = bends * r;
    const Vector3d corner(forwards > 0 ? high : low, at.y(), 0);
    path.push_back({corner, r});
    const double quarter = 0.25 * kTurn;
    appendArc(path, corner + Vector3d(0, bend, 0), bend, -quarter,
              forwards > 0 ? quarter : -3 * quarter, r, step);
    at = path.back().position;
    forwards = -forwards;
  }
  path.push_back({{0.12 * e, at.y(), 0}, r});
  path = resamplePath(path, step);
  // it climbs, so that no limb lies in one plane of voxels
  for (std::size_t i = 0; i < path.size(); ++i)
    path[i].position.z() =
        e * (0.42 + 0.16 * static_cast<double>(i) / static_cast<double>(path.size() - 1));
  TreeBuilder builder(frame);
  builder.add("root", formats::kNoParent, path);
  return builder.design();
}

// A wide vessel along z, and two narrow ones that leave it at right angles.
Design designRightAngle(const Frame& frame) {
  const double e = frame.extent, scale = frame.radiusScale();
  TreeBuilder builder(frame);
  const auto root = static_cast<std::int32_t>(builder.add(
      "root", formats::kNoParent,
      straightPath({0.45 * e, 0.5 * e, 0}, {0.45 * e, 0.5 * e, e}, constant(2.3 * scale))));
  const auto leave = [&](const std::string& label, double height, const Vector3d& along,
                         double radius) {
    const Vector3d start(0.45 * e, 0.5 * e, height * e);
    builder.add(label, root, straightPath(start, start + 0.42 * e * along, constant(radius)));
  };
  leave("b01", 0.36, Vector3d(1, 0, 0), 0.6 * scale);
  leave("b02", 0.68, Vector3d(0.3, 0.953939201, 0), 1.0 * scale);
  return builder.design();
}

// Three generations, whose contrast falls to 35 % at the end that is farthest from the start.
Design designFading(const Frame& frame) {
  const double e = frame.extent, scale = frame.radiusScale();
  TreeBuilder builder(frame);
  const BentVessel trunk{{0.3 * e, 0.5 * e, 0},
                         {0.4 * e, 0.46 * e, 0.42 * e},
                         {0.28 * e, 0.6 * e, 0.88 * e},
                         2 * scale,
                         1.4 * scale,
                         1.1 * scale};
  const auto root =
      static_cast<std::int32_t>(builder.add("root", formats::kNoParent, trunk.path()));
  const BentVessel child{trunk.middle(),
                         {0.62 * e, 0.4 * e, 0.6 * e},
                         {0.7 * e, 0.5 * e, 0.9 * e},
                         2 * scale,
                         0.95 * scale,
                         0.8 * scale};
  const auto b01 = static_cast<std::int32_t>(builder.add("b01", root, child.path()));
  builder.add("b02", b01,
              straightPath(child.middle(), {0.88 * e, 0.3 * e, 0.66 * e}, constant(0.65 * scale)));
  fadeContrast(builder.design(), 0.65);
  return builder.design();
}

// The bifurcation with x and z exchanged, so that it runs across the slices and the narrow child
// obliquely through them.
Design designThickSlices(const Frame& frame) {
  Design design = designBifurcation(frame);
  for (formats::Vec3f& v : design.tree.centre) std::swap(v.x, v.z);
  for (formats::Vec3f& v : design.tree.direction) std::swap(v.x, v.z);
  return design;
}

}  // namespace lumen::convert
