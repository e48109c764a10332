// SPDX-License-Identifier: Apache-2.0
// Phantoms whose measures have closed forms, which their notes state: the truth of `lumen measure`.
// Positions are shares of the extent; radii follow Frame::radiusScale. No axis is parallel to an
// axis of the volume's grid, but where a measure needs it.
//
// A note is named true.BRANCH.MEASURE, with the unit at the end of MEASURE, as in docs/measures.md.
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "converters/stages/phantom/design.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
constexpr double kStraight = std::numbers::pi;  // 180 degrees

class Notes {
public:
  Notes(Design& design, const std::string& branch) : m_design(design), m_branch(branch) {}
  void add(const std::string& measure, double value) {
    m_design.notes[std::string("true.").append(m_branch).append(".").append(measure)] = value;
  }
  void add(const std::string& measure, const std::string& word) {
    m_design.notes[std::string("true.").append(m_branch).append(".").append(measure)] = word;
  }

private:
  Design& m_design;
  std::string m_branch;
};

// The measures of a curve of constant curvature and torsion within a tube of constant radius. Volume
// and area are those between the planes of its ends (Pappus and Guldin).
void noteEvenTube(Notes& notes, double length, double chord, double curvature, double torsion,
                  double radius) {
  notes.add("length_mm", length);
  notes.add("chord_mm", chord);
  notes.add("tortuosity", length / chord - 1);
  notes.add("curvature_per_mm", curvature);
  notes.add("torsion_per_mm", torsion);
  notes.add("radius_mm", radius);
  notes.add("section_area_mm2", kStraight * radius * radius);
  notes.add("volume_mm3", kStraight * radius * radius * length);
  notes.add("wall_area_mm2", 2 * kStraight * radius * length);
}

// Balls of an ellipsoid of revolution: each is the greatest inside whose centre lies at `z` along
// the long axis, from the ellipsoid's centre. Semi-axes `along` >= `across`.
double ballInEllipsoid(double along, double across, double z) {
  const double reach = (along * along - across * across) / along;  // centre of the pole's own ball
  if (std::abs(z) >= reach) return along - std::abs(z);
  return across * std::sqrt(1 - z * z / (along * along - across * across));
}

// A sac on a vessel: an ellipsoid of revolution about the line from the vessel's axis through its
// centre.
struct CutSac {
  double along, across;  // semi-axes, mm
  double centre;         // mm from the axis of the vessel
  double plane;          // neck plane: mm from the axis of the vessel

  [[nodiscard]] double depth() const { return centre - plane; }  // of the plane below the centre
  [[nodiscard]] double height() const { return along + depth(); }
  [[nodiscard]] double neckRadius() const {
    return across * std::sqrt(1 - depth() * depth() / (along * along));
  }
  // The part above the plane: integrals of the circle at z from -depth to along.
  [[nodiscard]] double volume() const {
    const double c = depth(), a = along;
    return kStraight * across * across * ((a + c) - (a * a * a + c * c * c) / (3 * a * a));
  }
  [[nodiscard]] double area() const {
    // 2 pi across * integral of sqrt(1 - e^2 z^2 / a^2) dz over the same range, e the eccentricity
    const double e = std::sqrt(1 - across * across / (along * along));
    if (e < 1e-9) return 2 * kStraight * across * height();
    const auto primitive = [&](double z) {
      const double u = e * z / along;
      return 0.5 * along / e * (u * std::sqrt(1 - u * u) + std::asin(u));
    };
    return 2 * kStraight * across * (primitive(along) + primitive(depth()));
  }

  // The branch from the axis of the vessel, within whose lumen balls of radius `least` lie.
  [[nodiscard]] Path path(const Vector3d& axis, const Vector3d& out, double least) const {
    const double length = centre + (along * along - across * across) / along;
    return sampleCurve([&](double t) -> Vector3d { return axis + t * length * out; },
                       [&](double t) {
                         return std::max(least,
                                         ballInEllipsoid(along, across, t * length - centre));
                       });
  }
};

// `vessel`: mean diameter of the vessels at the neck. The dome is convex. Indices as in
// M. L. Raghavan, B. Ma, R. E. Harbaugh, Quantified aneurysm shape and rupture risk, 2005; the size
// ratio as in S. Dhar et al., Morphology parameters for intracranial aneurysm rupture risk
// assessment, 2008.
void noteSac(Notes& notes, const CutSac& sac, double vessel, double inflow,
             const std::string& position) {
  const double neck = 2 * sac.neckRadius(), width = 2 * sac.across;
  notes.add("neck_diameter_mm", neck);
  notes.add("neck_area_mm2", kStraight * sac.neckRadius() * sac.neckRadius());
  notes.add("height_mm", sac.height());
  notes.add("width_mm", width);
  notes.add("dome_volume_mm3", sac.volume());
  notes.add("dome_area_mm2", sac.area());
  notes.add("aspect_ratio", sac.height() / neck);
  notes.add("size_ratio", sac.height() / vessel);
  notes.add("bottleneck_factor", width / neck);
  notes.add("undulation_index", 0);
  const double index = 1 - std::cbrt(18 * kStraight) * std::pow(sac.volume(), 2.0 / 3) / sac.area();
  notes.add("ellipticity_index", index);
  notes.add("non_sphericity_index", index);
  notes.add("inflow_angle_deg", inflow);
  notes.add("position", position);
}

// A sac above the tangent plane of a straight vessel, which is its neck: any plane nearer to the
// vessel's axis cuts the vessel along its whole length.
Design sacOnTube(const Frame& frame, double along, double across, double neckRadius) {
  const double e = frame.extent, scale = frame.radiusScale();
  const double r = 1.5 * scale;
  CutSac sac{along * scale, across * scale, 0, r};
  const double share = neckRadius * scale / sac.across;
  sac.centre = r + sac.along * std::sqrt(1 - share * share);
  TreeBuilder builder(frame);
  const Vector3d from(0.28 * e, 0.46 * e, 0), to(0.36 * e, 0.54 * e, e);
  const auto root = static_cast<std::int32_t>(
      builder.add("root", formats::kNoParent, straightPath(from, to, constant(r))));
  const Vector3d flow = (to - from).normalized();
  const Vector3d out = (Vector3d(1, 0.2, 0) - Vector3d(1, 0.2, 0).dot(flow) * flow).normalized();
  builder.add("sac", root, sac.path(0.5 * (from + to), out, 0.3 * r),
              formats::BranchKind::Aneurysm);
  Notes notes(builder.design(), "sac");
  noteSac(notes, sac, 2 * r, 90, "side-wall");
  return builder.design();
}

}  // namespace

// A helix of high torsion: both ends are inside of the volume.
Design designCoil(const Frame& frame) {
  const double e = frame.extent, a = 0.16 * e, b = 0.065 * e, turns = 1.75,
               r = 0.8 * frame.radiusScale();
  const double last = 2 * kStraight * turns;
  const Vector3d axis = Vector3d(0.08, 0.05, 1).normalized();
  const auto [u, v] = perpendiculars(axis);
  const Vector3d middle(0.5 * e, 0.5 * e, 0.5 * e);
  const auto position = [&, u = u, v = v](double t) -> Vector3d {
    const double angle = last * t;
    return middle + a * (std::cos(angle) * u + std::sin(angle) * v) +
           b * (angle - 0.5 * last) * axis;
  };
  TreeBuilder builder(frame);
  builder.add("root", formats::kNoParent, sampleCurve(position, constant(r)));
  Notes notes(builder.design(), "root");
  const double square = a * a + b * b;
  noteEvenTube(notes, last * std::sqrt(square), (position(1) - position(0)).norm(), a / square,
               b / square, r);
  return builder.design();
}

// Three quarters of a torus in an oblique plane.
Design designArc(const Frame& frame) {
  const double e = frame.extent, bend = 0.3 * e, r = 1.2 * frame.radiusScale(),
               turn = 1.5 * kStraight;
  const auto [u, v] = perpendiculars(Vector3d(0.3, 0.2, 1).normalized());
  const auto position = [&, u = u, v = v](double t) -> Vector3d {
    return Vector3d(0.5 * e, 0.5 * e, 0.5 * e) +
           bend * (std::cos(turn * t) * u + std::sin(turn * t) * v);
  };
  TreeBuilder builder(frame);
  builder.add("root", formats::kNoParent, sampleCurve(position, constant(r)));
  Notes notes(builder.design(), "root");
  noteEvenTube(notes, turn * bend, (position(1) - position(0)).norm(), 1 / bend, 0, r);
  return builder.design();
}

// A straight cone between the faces z = 0 and z = extent.
Design designCone(const Frame& frame) {
  const double e = frame.extent, r0 = 1.9 * frame.radiusScale(), r1 = 0.9 * frame.radiusScale();
  TreeBuilder builder(frame);
  const Vector3d from(0.42 * e, 0.47 * e, 0), to(0.58 * e, 0.55 * e, e);
  builder.add("root", formats::kNoParent,
              straightPath(from, to, [&](double t) { return r0 + t * (r1 - r0); }));
  Notes notes(builder.design(), "root");
  // the wall touches the balls of the axis where these are smaller than the cone's circles there:
  // the sections' radii are those of the balls over the cosine of the half angle
  const double length = (to - from).norm(), sine = (r0 - r1) / length;
  const double cosine = std::sqrt(1 - sine * sine);
  const double s0 = r0 / cosine, s1 = r1 / cosine, slope = (s0 - s1) / length;
  notes.add("length_mm", length);
  notes.add("tortuosity", 0);
  notes.add("curvature_per_mm", 0);
  notes.add("first_section_area_mm2", kStraight * s0 * s0);
  notes.add("last_section_area_mm2", kStraight * s1 * s1);
  notes.add("first_radius_mm", r0);
  notes.add("last_radius_mm", r1);
  notes.add("taper_per_mm", -(r0 - r1) / length);
  notes.add("volume_mm3", kStraight * length * (s0 * s0 + s0 * s1 + s1 * s1) / 3);
  notes.add("wall_area_mm2", kStraight * (s0 + s1) * length * std::sqrt(1 + slope * slope));
  return builder.design();
}

// A straight tube with elliptic sections. The tree's radii are those of the balls inside.
Design designEllipseTube(const Frame& frame) {
  const double e = frame.extent, a = 1.8 * frame.radiusScale(), b = 1.2 * frame.radiusScale();
  const Vector3d from(0.42 * e, 0.47 * e, 0), to(0.58 * e, 0.55 * e, e);
  const Vector3d along = (to - from).normalized();
  const auto [across, other] = perpendiculars(along);
  const Vector3d u = (std::cos(0.4) * across + std::sin(0.4) * other).normalized();
  const Vector3d v = along.cross(u);
  TreeBuilder builder(frame);
  builder.add("root", formats::kNoParent, straightPath(from, to, constant(b)));
  builder.design().wall = [=](const Vector3d& point) {
    const Vector3d p = point - from;
    const double x = p.dot(u) / a, y = p.dot(v) / b;
    const double k = std::hypot(x, y), slope = std::hypot(x / a, y / b);
    return slope > 0 ? (k - 1) * k / slope : -b;
  };
  Notes notes(builder.design(), "root");
  const double length = (to - from).norm();
  // the perimeter's series in h, exact to 1e-9 for these semi-axes
  const double h = std::pow((a - b) / (a + b), 2);
  const double perimeter =
      kStraight * (a + b) * (1 + h / 4 + h * h / 64 + h * h * h / 256 + 25 * h * h * h * h / 16384);
  notes.add("length_mm", length);
  notes.add("tortuosity", 0);
  notes.add("radius_mm", b);
  notes.add("section_area_mm2", kStraight * a * b);
  notes.add("perimeter_mm", perimeter);
  notes.add("smallest_diameter_mm", 2 * b);
  notes.add("largest_diameter_mm", 2 * a);
  notes.add("circularity", 4 * kStraight * kStraight * a * b / (perimeter * perimeter));
  notes.add("volume_mm3", kStraight * a * b * length);
  notes.add("wall_area_mm2", perimeter * length);
  return builder.design();
}

// A straight trunk that parts into two straight vessels, at 30 and 50 degrees from its direction, in
// one plane. The axes have a corner at the fork; radii follow Murray's law of the exponent 3.
Design designFork(const Frame& frame) {
  const double e = frame.extent, scale = frame.radiusScale();
  const double r0 = 1.4 * scale, r1 = 1.2 * scale, r2 = std::cbrt(r0 * r0 * r0 - r1 * r1 * r1);
  const double one = kStraight / 6, two = 5 * kStraight / 18;
  const Vector3d fork(0.5 * e, 0.49 * e, 0.4 * e), from(0.46 * e, 0.47 * e, 0);
  const Vector3d trunk = (fork - from).normalized();
  const Vector3d side = (Vector3d(1, 0.3, 0) - Vector3d(1, 0.3, 0).dot(trunk) * trunk).normalized();
  const double length = 0.42 * e;
  const Vector3d along1 = std::cos(one) * trunk + std::sin(one) * side;
  const Vector3d along2 = std::cos(two) * trunk - std::sin(two) * side;
  TreeBuilder builder(frame);
  Path path = straightPath(from, fork, constant(r0));
  const Path rest = straightPath(fork, fork + length * along1, constant(r1));
  path.insert(path.end(), rest.begin(), rest.end());
  const auto root = static_cast<std::int32_t>(builder.add("root", formats::kNoParent, path));
  builder.add("b01", root, straightPath(fork, fork + length * along2, constant(r2)));
  Notes notes(builder.design(), "b01");
  notes.add("fork_continuing_in_plane_deg", 30);
  notes.add("fork_branching_in_plane_deg", 50);
  notes.add("fork_out_of_plane_deg", 0);
  notes.add("fork_between_deg", 80);
  notes.add("fork_area_ratio", (r1 * r1 + r2 * r2) / (r0 * r0));
  notes.add("fork_asymmetry", r2 * r2 / (r1 * r1));
  notes.add("fork_murray_exponent", 3);
  notes.add("trunk_radius_mm", r0);
  notes.add("continuing_radius_mm", r1);
  notes.add("branching_radius_mm", r2);
  return builder.design();
}

Design designSacSphere(const Frame& frame) {
  return sacOnTube(frame, 3, 3, 2);
}

Design designSacEllipsoid(const Frame& frame) {
  return sacOnTube(frame, 3.8, 2.6, 1.8);
}

// A ball at the end of a trunk that parts into two vessels of its own width, at right angles to both
// sides. Its neck is the plane across the trunk that touches both: any nearer one cuts them along
// their whole length.
Design designSacFork(const Frame& frame) {
  const double e = frame.extent, r = 1.3 * frame.radiusScale();
  const double ball = 2.8 * frame.radiusScale(), neck = 1.8 * frame.radiusScale();
  const Vector3d fork(0.5 * e, 0.49 * e, 0.45 * e), from(0.46 * e, 0.47 * e, 0);
  const Vector3d trunk = (fork - from).normalized();
  const Vector3d side = (Vector3d(1, 0.3, 0) - Vector3d(1, 0.3, 0).dot(trunk) * trunk).normalized();
  const double length = 0.42 * e;
  const CutSac sac{ball, ball, r + std::sqrt(ball * ball - neck * neck), r};
  TreeBuilder builder(frame);
  Path path = straightPath(from, fork, constant(r));
  const Path rest = straightPath(fork, fork + length * side, constant(r));
  path.insert(path.end(), rest.begin(), rest.end());
  const auto root = static_cast<std::int32_t>(builder.add("root", formats::kNoParent, path));
  builder.add("b01", root, straightPath(fork, fork - length * side, constant(r)));
  builder.add("sac", root, sac.path(fork, trunk, 0.3 * r), formats::BranchKind::Aneurysm);
  Notes notes(builder.design(), "sac");
  noteSac(notes, sac, 2 * r, 0, "bifurcation");
  return builder.design();
}

}  // namespace lumen::convert
