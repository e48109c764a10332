// SPDX-License-Identifier: Apache-2.0
#include "convolution_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_map>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "formats/case/blobby.h"

namespace lumen::reproduce {
namespace {

using std::numbers::pi;

constexpr double kRadius = 1;  // mm
/// Points on the whole surface: of the open capsule about 300 then lie within its box. Yureidini's
/// thesis says 500 for it, of which 300 were left.
constexpr std::size_t kPoints = 300, kOpenPoints = 373;

std::vector<Vector3d> arc(const Vector3d& centre, double from, double turn, int steps) {
  std::vector<Vector3d> points;
  for (int i = 0; i <= steps; ++i) {
    const double t = from + turn * i / steps;
    points.push_back(centre + 4 * Vector3d(std::cos(t), std::sin(t), 0));
  }
  return points;
}

formats::BlobbyModels modelOf(const std::vector<Vector3d>& skeleton,
                              const std::vector<double>& width) {
  formats::BlobbyModels model;
  model.offset = {0, static_cast<std::uint32_t>(skeleton.size())};
  for (std::size_t j = 0; j < skeleton.size(); ++j) {
    const Vector3d& p = skeleton[j];
    model.centre.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    model.width.push_back(static_cast<float>(width[j]));
  }
  return model;
}

/// The common width that puts the surface 1 mm beside the middle of the skeleton.
double commonWidth(const std::vector<Vector3d>& skeleton) {
  const Vector3d beside = skeleton[skeleton.size() / 2] + Vector3d(0, 0, kRadius);
  double low = 1e-3, high = 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const std::vector<double> width(skeleton.size(), middle);
    const formats::BlobbyModels model = modelOf(skeleton, width);
    (ImplicitSurface(model, 0).isInside(beside) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

double distanceTo(const std::vector<Vector3d>& line, const Vector3d& p) {
  double least = 1e300;
  for (const Vector3d& q : line) least = std::min(least, (p - q).squaredNorm());
  return std::sqrt(least);
}

/// Points of the wall of the tubes around two lines, of each outside the other.
std::vector<Vector3d> unionWall(const std::vector<Vector3d>& first,
                                const std::vector<Vector3d>& second) {
  std::vector<Vector3d> wall;
  for (const auto* line : {&first, &second}) {
    const std::vector<Vector3d>& other = line == &first ? second : first;
    for (std::size_t i = 1; i + 1 < line->size(); ++i) {
      const Vector3d axis = ((*line)[i + 1] - (*line)[i - 1]).normalized();
      const Vector3d side = axis.cross(Vector3d::UnitZ());
      for (int k = 0; k < 16; ++k) {
        const double a = pi * k / 8;
        const Vector3d p = (*line)[i] + std::cos(a) * side + std::sin(a) * Vector3d::UnitZ();
        if (distanceTo(other, p) >= kRadius) wall.push_back(p);
      }
    }
  }
  return wall;
}

/// Widths by Gauss-Newton on f = T at `wall`, close to those that they begin with.
std::vector<double> fittedWidths(const std::vector<Vector3d>& skeleton, std::vector<double> width,
                                 const std::vector<Vector3d>& wall) {
  const auto n = static_cast<Eigen::Index>(skeleton.size());
  constexpr double kSlopeScale = 0.2, kPrior = 10;
  const std::vector<double> begin = width;
  for (int round = 0; round < 20; ++round) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Identity(n, n) * kPrior;
    Eigen::VectorXd b(n), row(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto at = static_cast<std::size_t>(j);
      b[j] = kPrior * (begin[at] - width[at]);
    }
    for (const Vector3d& p : wall) {
      double f = 0;
      for (Eigen::Index j = 0; j < n; ++j) {
        const auto at = static_cast<std::size_t>(j);
        const double x = (p - skeleton[at]).squaredNorm() / (width[at] * width[at]);
        const auto v = formats::evaluateKernel(formats::Kernel::Cauchy, 0.2, x);
        f += width[at] * v.phi;
        row[j] = (v.phi - 2 * v.d1 * x) / kSlopeScale;
      }
      a.selfadjointView<Eigen::Lower>().rankUpdate(row);
      b += row * ((0.1 - f) / kSlopeScale);
    }
    const Eigen::VectorXd step = a.selfadjointView<Eigen::Lower>().llt().solve(b);
    for (Eigen::Index j = 0; j < n; ++j) {
      double& w = width[static_cast<std::size_t>(j)];
      w = std::clamp(w + step[j], 0.2 * begin[static_cast<std::size_t>(j)],
                     1.5 * begin[static_cast<std::size_t>(j)]);
    }
  }
  return width;
}

ConvolutionShape measureShape(const std::string& name, const std::vector<Vector3d>& skeleton,
                              std::size_t startBlobs, bool open) {
  const std::vector<double> width(skeleton.size(), commonWidth(skeleton));
  return {name, skeleton, modelOf(skeleton, width), startBlobs, open};
}

ConvolutionShape bifurcation() {
  const auto first = arc(Vector3d::Zero(), -pi / 6, 8 * pi / 9, 100);
  const auto second = arc(Vector3d(2, -4, 0), pi / 6, pi / 3, 100);
  std::vector<double> width(first.size(), commonWidth(first));
  width.resize(first.size() + second.size(), commonWidth(second));
  std::vector<Vector3d> skeleton = first;
  skeleton.insert(skeleton.end(), second.begin(), second.end());
  width = fittedWidths(skeleton, width, unionWall(first, second));
  return {"bifurcation", skeleton, modelOf(skeleton, width), 5, false};
}

std::vector<Vector3d> segment() {
  std::vector<Vector3d> points;
  for (int i = 0; i <= 10; ++i) points.push_back({-4 + 0.4 * i, 0, 0});
  return points;
}

}  // namespace

bool ConvolutionShape::contains(const Vector3d& p) const {
  return !open || (p.x() >= -4.1 && p.x() <= 0 && std::abs(p.y()) <= 1.6 && std::abs(p.z()) <= 1.6);
}

std::vector<Vector3d> ConvolutionShape::samples(Random& random) const {
  ParticleOptions options;
  options.count = open ? kOpenPoints : kPoints;
  options.rounds = 100;
  std::vector<Vector3d> points = sampleSurface(
      surface(), [this](Random& r) { return besideSkeleton(skeleton, r); }, options, random);
  std::erase_if(points, [this](const Vector3d& p) { return !contains(p); });
  return points;
}

std::vector<ConvolutionShape> convolutionShapes() {
  return {measureShape("arc", arc(Vector3d::Zero(), 0, pi, 100), 5, false), bifurcation(),
          measureShape("capsule", segment(), 2, false),
          measureShape("open capsule", segment(), 2, true)};
}

Vector3d besideSkeleton(const std::vector<Vector3d>& skeleton, Random& random) {
  const Vector3d direction(random.normal(), random.normal(), random.normal());
  return skeleton[random.below(static_cast<std::uint32_t>(skeleton.size()))] +
         direction.normalized();
}

namespace {

/// Particles by the cube that they are in; a neighbour within a cube's edge is in one of 27.
class Cubes {
public:
  Cubes(const std::vector<Vector3d>& points, double edge) : m_points(points), m_edge(edge) {
    for (std::size_t i = 0; i < points.size(); ++i) m_members[key(index(points[i]))].push_back(i);
  }

  template <class Action>
  void forNear(const Vector3d& p, const Action& action) const {
    const Eigen::Vector3i centre = index(p);
    for (int n = 0; n < 27; ++n) {
      const Eigen::Vector3i cube = centre + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      const auto found = m_members.find(key(cube));
      if (found == m_members.end()) continue;
      for (const std::size_t i : found->second) action(m_points[i], i);
    }
  }

private:
  [[nodiscard]] Eigen::Vector3i index(const Vector3d& p) const {
    return (p / m_edge).array().floor().cast<int>();
  }
  static std::int64_t key(const Eigen::Vector3i& cube) {
    constexpr std::int64_t kSpan = 1 << 20;
    return (cube.x() * kSpan + cube.y()) * kSpan + cube.z();
  }

  const std::vector<Vector3d>& m_points;
  double m_edge;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> m_members;
};

/// The mean distance of a point's nearest neighbour.
double spacing(const std::vector<Vector3d>& points) {
  double sum = 0;
  for (const Vector3d& p : points) {
    double least = 1e300;
    for (const Vector3d& q : points) {
      if (&p != &q) least = std::min(least, (p - q).squaredNorm());
    }
    sum += std::sqrt(least);
  }
  return sum / static_cast<double>(points.size());
}

/// One step of all particles along the gradient of their repulsion, within the surface.
void repel(const ImplicitSurface& surface, double sigma, double longestStep,
           std::vector<Vector3d>& points) {
  const Cubes cubes(points, 3 * sigma);
  std::vector<Vector3d> moved = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vector3d push = Vector3d::Zero();
    cubes.forNear(points[i], [&](const Vector3d& other, std::size_t j) {
      if (i == j) return;
      const Vector3d offset = points[i] - other;
      push += std::exp(-offset.squaredNorm() / (2 * sigma * sigma)) * offset;
    });
    const Vector3d normal = surface.at(points[i]).gradient.normalized();
    push -= normal * normal.dot(push);
    const double length = push.norm();
    if (length > 0.5 * sigma) push *= 0.5 * sigma / length;
    if (const auto p = surface.project(points[i] + push, longestStep)) moved[i] = *p;
  }
  points = std::move(moved);
}

}  // namespace

std::vector<Vector3d> sampleSurface(const ImplicitSurface& surface,
                                    const std::function<Vector3d(Random&)>& seed,
                                    const ParticleOptions& options, Random& random) {
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < 20 * options.count && points.size() < options.count; ++i) {
    if (const auto p = surface.project(seed(random), options.longestStep)) points.push_back(*p);
  }
  if (points.size() < 2) return points;
  // random points are about half as far from their nearest neighbour as even ones
  const double sigma = 0.6 * 2 * spacing(points);
  for (int round = 0; round < options.rounds; ++round) {
    repel(surface, sigma, options.longestStep, points);
  }
  return points;
}

}  // namespace lumen::reproduce
