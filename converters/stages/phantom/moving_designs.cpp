// SPDX-License-Identifier: Apache-2.0
// Trees that lie in the middle half of the volume, so that there is room for them to move.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "converters/stages/phantom/design.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

// A place on an upright ellipsoid, as a ventricle is to its arteries: an angle about its axis, and a
// height from -1 at the apex to 1 at the base.
Vector3d placeOnEllipsoid(double extent, double angle, double height) {
  const double across = 0.2 * extent * std::sqrt(std::max(0.0, 1.2 - height * height));
  return {0.5 * extent + across * std::cos(angle), 0.5 * extent + across * std::sin(angle),
          extent * (0.5 + 0.2 * height)};
}

struct Course {
  double angle, turn;      // radians: at the start, and to the end
  double height, descent;  // as of placeOnEllipsoid()
  double waves;            // number of the windings on the way
};

Path pathOf(const Course& course, double extent, double from, double to) {
  return sampleCurve(
      [=](double t) {
        const double swing = 0.1 * t * std::sin(2 * std::numbers::pi * course.waves * t);
        return placeOnEllipsoid(extent, course.angle + course.turn * t + swing,
                                course.height - course.descent * t);
      },
      [=](double t) { return from + (to - from) * t; });
}

class HepaticTree {
public:
  explicit HepaticTree(const Frame& frame) : m_frame(frame), m_builder(frame) {}

  Design build() {
    const double e = m_frame.extent, r = 1.3 * m_frame.radiusScale();
    const Vector3d from(0.5 * e, 0.5 * e, 0.25 * e), up(0.1, 0.05, 1);
    grow(formats::kNoParent, from, up.normalized(), Vector3d::UnitX(), 0.18 * e, r, 0);
    return m_builder.design();
  }

private:
  // A vessel that goes on into the wider of two children, the other of which grows from its end.
  void grow(std::int32_t parent, const Vector3d& from, const Vector3d& along,
            const Vector3d& across, double length, double radius, int depth) {
    constexpr int kDepth = 3;
    constexpr double kHalfAngle = 0.62, kNarrower = 0.8;
    const Vector3d side = (across - across.dot(along) * along).normalized();
    const Vector3d end = from + length * along;
    const auto index =
        m_builder.add("b" + std::to_string(m_builder.tree().branches.size()), parent,
                      sampleCurve(
                          [&](double t) -> Vector3d {
                            return from + t * length * along +
                                   0.04 * length * std::sin(2 * std::numbers::pi * t) * side;
                          },
                          [radius](double t) { return radius * (1 - 0.1 * t); }));
    if (depth == kDepth) return;
    const Vector3d next = along.cross(side);
    for (const double sign : {1.0, -1.0})
      grow(static_cast<std::int32_t>(index), end,
           (std::cos(kHalfAngle) * along + sign * std::sin(kHalfAngle) * side).normalized(), next,
           0.72 * length, kNarrower * radius, depth + 1);
  }

  Frame m_frame;
  TreeBuilder m_builder;
};

}  // namespace

// A main artery that winds down a ventricle, and three side branches that part from it along the wall.
Design designCoronary(const Frame& frame) {
  const double e = frame.extent, scale = frame.radiusScale();
  TreeBuilder builder(frame);
  const Course main{-0.9, 2.4, 1.0, 1.9, 2};
  const Path path = pathOf(main, e, 1.2 * scale, 0.6 * scale);
  const auto root = static_cast<std::int32_t>(builder.add("root", formats::kNoParent, path));
  for (const double share : {0.2, 0.42, 0.65}) {
    const auto& start =
        path[static_cast<std::size_t>(share * static_cast<double>(path.size() - 1))];
    const double swing = 0.1 * share * std::sin(2 * std::numbers::pi * main.waves * share);
    const Course side{main.angle + main.turn * share + swing, -1.5,
                      main.height - main.descent * share, 0.75, 1};
    Path branch = pathOf(side, e, 0.75 * start.radius, 0.45 * scale);
    branch.front().position = start.position;
    builder.add("side" + std::to_string(builder.tree().branches.size()), root, branch);
  }
  return builder.design();
}

// A trunk that divides three times.
Design designHepatic(const Frame& frame) {
  return HepaticTree(frame).build();
}

}  // namespace lumen::convert
