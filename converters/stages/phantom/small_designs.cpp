// SPDX-License-Identifier: Apache-2.0
// The phantoms that show one difficulty each. Positions are shares of the extent; radii follow
// Frame::radiusScale. Every end is round. A vessel that leaves the volume has its last node on the
// plane of the outermost voxel centres, which it meets at about a right angle, so that its round
// end lies outside and it looks cut flat.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "converters/stages/phantom/design.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

// 0 below 0, 1 above 1, with two continuous derivatives in between.
double smoothStep(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10 + x * (6 * x - 15));
}

// 1 at |x| = 0, falling smoothly to 0 at |x| = 1.
double bump(double x) {
  return std::abs(x) < 1 ? 0.5 * (1 + std::cos(std::numbers::pi * x)) : 0.0;
}

// An arc that enters at the face z = 0 and leaves at z = extent, bulging towards +x by `sagitta`,
// with both ends along z.
Path bow(const Frame& frame, double sagitta, const std::function<double(double)>& radius) {
  const double e = frame.extent;
  return sampleCurve(
      [=](double t) {
        return Vector3d(0.4 * e + sagitta * 0.5 * (1 - std::cos(2 * std::numbers::pi * t)),
                        0.48 * e + 0.03 * e * std::cos(std::numbers::pi * t), e * t);
      },
      radius);
}

}  // namespace

Design designTube(const Frame& frame) {
  const double e = frame.extent;
  TreeBuilder builder(frame);
  const Vector3d from(0.42 * e, 0.47 * e, 0), to(0.58 * e, 0.55 * e, e);
  builder.add("root", formats::kNoParent, straightPath(from, to, constant(frame.radiusScale())));
  return builder.design();
}

// Two turns about the z axis with both ends inside the volume.
Design designHelix(const Frame& frame) {
  const double e = frame.extent;
  TreeBuilder builder(frame);
  builder.add("root", formats::kNoParent,
              sampleCurve(
                  [&](double t) {
                    const double angle = 4 * std::numbers::pi * t;
                    return Vector3d(0.5 * e + 0.28 * e * std::cos(angle),
                                    0.5 * e + 0.28 * e * std::sin(angle), e * (0.14 + 0.72 * t));
                  },
                  constant(0.8 * frame.radiusScale())));
  const double bend = 0.28 * e, climb = 0.72 * e / (4 * std::numbers::pi);
  const double square = bend * bend + climb * climb;
  auto& notes = builder.design().notes;
  notes["true.root.length_mm"] = 4 * std::numbers::pi * std::sqrt(square);
  notes["true.root.curvature_per_mm"] = bend / square;
  notes["true.root.torsion_per_mm"] = climb / square;
  return builder.design();
}

// A trunk of radius r0 that parts into r1 and r2 with r0^3 = r1^3 + r2^3 (Murray, 1926), 70 degrees
// apart. The larger child continues the trunk: both are the branch "root", the smaller child is
// "b01".
Design designBifurcation(const Frame& frame) {
  const double e = frame.extent, scale = frame.radiusScale();
  const double r0 = 1.4 * scale, r1 = 1.2 * scale, r2 = std::cbrt(r0 * r0 * r0 - r1 * r1 * r1);
  const Vector3d fork(0.5 * e, 0.49 * e, 0.38 * e);
  const double turn = 27 * std::numbers::pi / 180, turn2 = 43 * std::numbers::pi / 180;
  const Vector3d along1(std::sin(turn), 0.02, std::cos(turn));
  const Vector3d along2(-std::sin(turn2), 0.06, std::cos(turn2));
  const Vector3d from(0.48 * e, 0.5 * e, 0);
  // the trunk bends into the larger child over two trunk radii on both sides of the fork
  const double in = (fork - from).norm(), out = (e - fork.z()) / along1.z(), blend = 2 * r0;
  const Vector3d trunk = (fork - from) / in;
  const auto position = [&](double t) -> Vector3d {
    const double s = t * (in + out) - in;
    if (s < -blend) return fork + s * trunk;
    if (s > blend) return fork + s * along1;
    const double w = (s + blend) / (2 * blend);
    return fork - blend * (1 - w) * (1 - w) * trunk + blend * w * w * along1;
  };
  const auto radius = [&](double t) {
    return r0 + (r1 - r0) * smoothStep((t * (in + out) - in + r0) / (2 * r0));
  };
  TreeBuilder builder(frame);
  const std::uint32_t root = builder.add("root", formats::kNoParent, sampleCurve(position, radius));
  // on the axis where the bend is half done
  const Vector3d start = position(in / (in + out));
  const double length = 0.45 * e / std::sin(turn2);
  builder.add(
      "b01", static_cast<std::int32_t>(root),
      sampleCurve([&](double t) -> Vector3d { return start + t * length * along2; }, constant(r2)));
  return builder.design();
}

// Two vessels along x whose axes are r1 + r2 apart over a quarter of the extent and part on both
// sides.
Design designKissing(const Frame& frame) {
  const double e = frame.extent, r1 = 0.9 * frame.radiusScale(), r2 = 0.75 * frame.radiusScale();
  const auto apart = [&](double t) {
    return r1 + r2 + 0.5 * e * smoothStep((std::abs(t - 0.5) - 0.125) / 0.375);
  };
  const auto path = [&](double side, double radius) {
    return sampleCurve(
        [&, side](double t) {
          return Vector3d(e * t, 0.5 * e + side * 0.5 * apart(t),
                          0.47 * e + 0.05 * e * std::cos(2 * std::numbers::pi * t));
        },
        constant(radius));
  };
  TreeBuilder builder(frame);
  builder.add("root", formats::kNoParent, path(+1, r1));
  builder.add("root2", formats::kNoParent, path(-1, r2));
  builder.design().notes["kissing"] = std::string("root root2");
  return builder.design();
}

// A curved parent with a sphere on the outside of its bend, joined by a narrow neck.
Design designAneurysm(const Frame& frame) {
  const double e = frame.extent, scale = frame.radiusScale();
  const double radius = 1.0 * scale, sac = 2.6 * scale, neck = 0.7 * scale;
  TreeBuilder builder(frame);
  const Path parent = bow(frame, 0.13 * e, constant(radius));
  const std::uint32_t root = builder.add("root", formats::kNoParent, parent);
  const Vector3d start = parent[parent.size() / 2].position;
  const Vector3d out = Vector3d(1, 0.15, 0.1).normalized();
  const double length = radius + 0.5 * scale + sac;
  // the radius of the largest ball on the axis that stays inside
  builder.add("aneurysm", static_cast<std::int32_t>(root),
              sampleCurve([&](double t) -> Vector3d { return start + t * length * out; },
                          [&](double t) { return std::max(neck, sac - (1 - t) * length); }),
              formats::BranchKind::Aneurysm);
  return builder.design();
}

// The radius narrows to 45 % over a length of six radii.
Design designStenosis(const Frame& frame) {
  const double e = frame.extent, r = 1.4 * frame.radiusScale();
  TreeBuilder builder(frame);
  builder.add("root", formats::kNoParent, bow(frame, 0.1 * e, [=](double t) {
                return r * (1 - 0.55 * bump((t - 0.5) * e / (3 * r)));
              }));
  auto& notes = builder.design().notes;
  notes["true.root.stenosis_diameter_degree"] = 0.55;
  notes["true.root.stenosis_area_degree"] = 1 - 0.45 * 0.45;
  notes["true.root.stenosis_smallest_radius_mm"] = 0.45 * r;
  notes["true.root.stenosis_at_share"] = 0.5;
  return builder.design();
}

// A winding vessel whose contrast falls to 35 % over four and a half diameters, twice.
Design designDropout(const Frame& frame) {
  const double e = frame.extent, r = 0.7 * frame.radiusScale();
  TreeBuilder builder(frame);
  builder.add("root", formats::kNoParent,
              sampleCurve(
                  [&](double t) {
                    return Vector3d(e * t, 0.5 * e + 0.24 * e * std::cos(2 * std::numbers::pi * t),
                                    0.5 * e + 0.06 * e * std::cos(std::numbers::pi * t));
                  },
                  constant(r)));
  Design& design = builder.design();
  const double height = static_cast<double>(design.tree.height[0]);
  const double length = height * static_cast<double>(design.tree.nodeCount() - 1);
  const double half = 4.5 * r, edge = r;
  for (std::size_t n = 0; n < design.tree.nodeCount(); ++n) {
    double loss = 0;
    for (const double middle : {0.33 * length, 0.7 * length}) {
      const double from = std::abs(height * static_cast<double>(n) - middle) - half;
      loss = std::max(loss, 1 - smoothStep(0.5 + 0.5 * from / edge));
    }
    design.contrast[n] = static_cast<float>(1 - 0.65 * loss);
  }
  return design;
}

}  // namespace lumen::convert
