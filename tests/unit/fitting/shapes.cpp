// SPDX-License-Identifier: Apache-2.0
#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "converters/base/random.h"

namespace lumen::test {
namespace {

Vec3d operator+(const Vec3d& a, const Vec3d& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Vec3d operator-(const Vec3d& a, const Vec3d& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vec3d operator*(double s, const Vec3d& a) {
  return {s * a.x, s * a.y, s * a.z};
}
double dot(const Vec3d& a, const Vec3d& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
double norm(const Vec3d& a) {
  return std::sqrt(dot(a, a));
}
Vec3d unit(const Vec3d& a) {
  return (1.0 / norm(a)) * a;
}

formats::Vec3f toFloat(const Vec3d& a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}
Vec3d toDouble(const formats::Vec3f& a) {
  return {a.x, a.y, a.z};
}

double distanceToSegment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d ab = b - a, ap = p - a;
  const double t = std::clamp(dot(ap, ab) / dot(ab, ab), 0.0, 1.0);
  return norm(ap - t * ab);
}

Tube straight(const Vec3d& from, const Vec3d& to, double radius) {
  return {{from, to}, radius};
}

Tube arc(double bend, double from, double to, double radius) {
  Tube tube{{}, radius};
  const int steps = static_cast<int>(std::ceil((to - from) / 0.02));
  for (int i = 0; i <= steps; ++i) {
    const double t = from + (to - from) * i / steps;
    tube.line.push_back({bend * std::cos(t), bend * std::sin(t), 0});
  }
  return tube;
}

/// Directions spread evenly over the sphere, turned at random.
std::vector<Vec3d> rayDirections(int count, Random& random) {
  std::vector<Vec3d> rays;
  const double turn = random.uniform(0, 2 * std::numbers::pi), tilt = random.uniform(0, 3);
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
    const double a = turn + i * std::numbers::pi * (3 - std::sqrt(5.0));
    const Vec3d v{r * std::cos(a), r * std::sin(a), z};
    rays.push_back({v.x * std::cos(tilt) - v.z * std::sin(tilt), v.y,
                    v.x * std::sin(tilt) + v.z * std::cos(tilt)});
  }
  return rays;
}

/// Distance along a ray from inside to the wall; at least `limit` if it is farther.
double castRay(const Shape& shape, const Vec3d& from, const Vec3d& ray, double limit) {
  double t = 0;
  for (int i = 0; i < 200 && t < limit; ++i) {
    const double d = -shape.signedDistance(from + t * ray);
    if (d < 1e-9) break;
    t += d;
  }
  return t;
}

/// Where rays from the node meet the wall, cut as the tracker cuts them: inliers of the node's
/// cylinder, in the interval along its axis that holds three quarters of them.
std::vector<formats::Vec3f> wallPoints(const Shape& shape, const Vec3d& centre, const Vec3d& axis,
                                       double radius, const TrackingOptions& options,
                                       Random& random) {
  std::vector<std::pair<double, Vec3d>> inliers;
  for (const Vec3d& ray : rayDirections(options.rays, random)) {
    const double t = castRay(shape, centre, ray, 2.4 * radius);
    if (t < 0.25 * radius || t >= 2.4 * radius) continue;
    const double along = t * dot(ray, axis), across = std::sqrt(t * t - along * along);
    if (std::abs(across - radius) > 0.1 * radius) continue;
    inliers.emplace_back(std::abs(along), centre + t * ray);
  }
  std::sort(inliers.begin(), inliers.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  inliers.resize(inliers.size() * 3 / 4);
  std::vector<formats::Vec3f> points;
  for (const auto& [along, p] : inliers) {
    points.push_back(toFloat(p + options.noise * random.normal() * shape.normal(p)));
  }
  return points;
}

/// One branch along a tube's axis from `from` to `to`, mm of its length.
void addBranch(TrackedShape& out, const Tube& tube, double from, double to, std::int32_t parent,
               const TrackingOptions& options, Random& random) {
  formats::CenterlineTree& tree = out.value.tree;
  formats::PointSets& points = *out.value.points;
  const auto index = static_cast<std::uint32_t>(tree.branches.size());
  formats::Branch branch;
  branch.label = "branch " + std::to_string(index);
  branch.parentNode = parent;
  branch.firstNode = static_cast<std::uint32_t>(tree.nodeCount());
  double start = 0, next = from;
  for (std::size_t i = 0; i + 1 < tube.line.size(); ++i) {
    const Vec3d step = tube.line[i + 1] - tube.line[i], axis = unit(step);
    const double length = norm(step);
    for (; next <= std::min(start + length, to); next += options.spacing * tube.radius) {
      const Vec3d centre = tube.line[i] + (next - start) * axis;
      tree.parent.push_back(
          branch.nodeCount++ == 0 ? parent : static_cast<std::int32_t>(tree.nodeCount()) - 1);
      tree.centre.push_back(toFloat(centre));
      tree.direction.push_back(toFloat(axis));
      tree.radius.push_back(static_cast<float>(tube.radius));
      tree.height.push_back(static_cast<float>(tube.radius));
      tree.branch.push_back(index);
      for (const auto& p : wallPoints(out.shape, centre, axis, tube.radius, options, random)) {
        points.position.push_back(p);
      }
      points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
    }
    start += length;
  }
  tree.branches.push_back(branch);
}

TrackedShape emptyShape() {
  TrackedShape out;
  out.value.metadata.voxelSize = 0.2;
  out.value.points = formats::PointSets{{0}, {}};
  return out;
}

struct Samples {
  const TrackedShape& tracked;
  std::uint32_t fromEnd;
  std::vector<double> distances;
};

/// The node whose power distance to `p` is least.
std::uint32_t owner(const formats::CenterlineTree& tree, const Vec3d& p) {
  std::uint32_t best = 0;
  double least = 1e300;
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
    const Vec3d d = p - toDouble(tree.centre[i]);
    const double power = dot(d, d) - double{tree.radius[i]} * tree.radius[i];
    if (power >= least) continue;
    least = power;
    best = i;
  }
  return best;
}

/// Signed distance along `normal` from p to the surface of the node's model; `limit` if there is
/// none.
double distanceAlong(const formats::BlobbyModels& models, std::uint32_t node, const Vec3d& p,
                     const Vec3d& normal, double limit) {
  const auto inside = [&](double t) {
    return formats::evaluateField(models, node, p + t * normal).f > models.isoLevel;
  };
  const double side = inside(0) ? 1 : -1;
  double near = 0, far = 0.02 * limit;
  while (far < limit && inside(side * far) == (side > 0)) {
    near = far;
    far += 0.02 * limit;
  }
  if (far >= limit) return limit;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (near + far);
    (inside(side * middle) == (side > 0) ? near : far) = middle;
  }
  return side * near;
}

void sampleAt(Samples& out, const Vec3d& p, double limit) {
  const Shape& shape = out.tracked.shape;
  if (std::abs(shape.signedDistance(p)) > 1e-6) return;  // inside another tube
  const formats::CenterlineTree& tree = out.tracked.value.tree;
  const std::uint32_t node = owner(tree, p);
  const formats::Branch& branch = tree.branches[tree.branch[node]];
  const std::uint32_t fromStart = node - branch.firstNode;
  const bool hasParent = branch.parentNode != formats::kNoParent;
  if ((!hasParent && fromStart < out.fromEnd) || branch.nodeCount - 1 - fromStart < out.fromEnd) {
    return;
  }
  out.distances.push_back(
      std::abs(distanceAlong(*out.tracked.value.models, node, p, shape.normal(p), limit)));
}

}  // namespace

std::string kernelName(formats::Kernel kernel) {
  constexpr const char* kNames[] = {"Cauchy", "Gaussian", "Quartic", "SoftObject"};
  return kNames[static_cast<std::size_t>(kernel)];
}

double Shape::signedDistance(const Vec3d& p) const {
  double least = 1e300;
  for (const Tube& tube : tubes) {
    for (std::size_t i = 0; i + 1 < tube.line.size(); ++i) {
      least = std::min(least, distanceToSegment(p, tube.line[i], tube.line[i + 1]) - tube.radius);
    }
  }
  return least;
}

Vec3d Shape::normal(const Vec3d& p) const {
  constexpr double kStep = 1e-5;
  const auto slope = [&](const Vec3d& d) {
    return signedDistance(p + kStep * d) - signedDistance(p - kStep * d);
  };
  return unit({slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})});
}

TrackedShape trackShape(const std::string& name, double radius, const TrackingOptions& options) {
  TrackedShape out = emptyShape();
  Random random(options.seed);
  const double r = radius;
  if (name == "bend") {
    out.shape.tubes = {arc(3 * r, 0, 1.7 * std::numbers::pi, r)};
    addBranch(out, out.shape.tubes[0], 4 * r, 12 * r, formats::kNoParent, options, random);
  } else if (name == "capsule") {
    out.shape.tubes = {straight({0, 0, 0}, {4 * r, 0, 0}, r)};
    addBranch(out, out.shape.tubes[0], 0, 4 * r, formats::kNoParent, options, random);
  } else {
    out.shape.tubes = {straight({-4 * r, 0, 0}, {12 * r, 0, 0}, r)};
    if (name == "bifurcation") {
      const Vec3d slant{0.5, std::sqrt(0.75), 0};
      out.shape.tubes.push_back(
          straight({4 * r, 0, 0}, Vec3d{4 * r, 0, 0} + 9 * r * slant, 0.7 * r));
    }
    addBranch(out, out.shape.tubes[0], 4 * r, 12 * r, formats::kNoParent, options, random);
    if (name == "bifurcation") {
      const auto parent = static_cast<std::int32_t>(std::lround(4 / options.spacing));
      addBranch(out, out.shape.tubes[1], 1.25 * r, 6 * r, parent, options, random);
    }
  }
  return out;
}

formats::Case manyNodes(std::size_t nodes, double noise) {
  TrackedShape out = emptyShape();
  TrackingOptions options;
  options.noise = noise;
  for (std::uint64_t i = 0; out.value.tree.nodeCount() < nodes; ++i) {
    Random random(7, i);
    const double radius = 0.4 + 1.8 * random.uniform() * random.uniform();
    const double bend = radius * random.uniform(3, 12);
    out.shape.tubes = {arc(bend, 0, 5.5, radius)};
    const auto left = static_cast<double>(nodes - out.value.tree.nodeCount());
    const double length = std::min({4.5 * bend, (left - 0.5) * options.spacing * radius});
    addBranch(out, out.shape.tubes[0], 0.4 * bend, 0.4 * bend + length, formats::kNoParent, options,
              random);
  }
  return out.value;
}

std::vector<double> wallDistances(const TrackedShape& tracked, std::uint32_t fromEnd) {
  Samples samples{tracked, fromEnd, {}};
  for (const Tube& tube : tracked.shape.tubes) {
    for (std::size_t i = 0; i + 1 < tube.line.size(); ++i) {
      const Vec3d step = tube.line[i + 1] - tube.line[i], axis = unit(step);
      const Vec3d side = unit(std::abs(axis.z) < 0.9 ? Vec3d{axis.y, -axis.x, 0} : Vec3d{1, 0, 0});
      const Vec3d up{axis.y * side.z - axis.z * side.y, axis.z * side.x - axis.x * side.z,
                     axis.x * side.y - axis.y * side.x};
      const double length = norm(step);
      const int count = std::max(1, static_cast<int>(length / (0.1 * tube.radius)));
      for (int k = 0; k < count; ++k) {
        const Vec3d centre = tube.line[i] + (length * (k + 0.5) / count) * axis;
        for (int a = 0; a < 16; ++a) {
          const double angle = std::numbers::pi * (a + 0.5) / 8;
          sampleAt(samples, centre + tube.radius * (std::cos(angle) * side + std::sin(angle) * up),
                   0.8 * tube.radius);
        }
      }
    }
  }
  return samples.distances;
}

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(std::lround(share * last))];
}

}  // namespace lumen::test
