// SPDX-License-Identifier: Apache-2.0
// The capsule and the spiral of Yureidini's thesis, 5.5.2, synthetic: convolution surfaces of equal
// Cauchy blobs along a skeleton. Writes NAME.lumen, the skeleton as a tracked case with wall
// points, to be fitted, and NAME-truth.lumen, the exact surface, for triangle meshes and for
// distances. The thesis' formula 5.35 does not give its figure 5.6: this spiral is
// r = 8 + 1.85 angle, 1.5 turns, of about the same size.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "formats/case/blobby.h"
#include "formats/case/case_file.h"

namespace {

using Eigen::Vector3d;
using lumen::formats::Case;

constexpr double kLevel = 0.1;      // T, mm (thesis table 5.1)
constexpr double kParameter = 0.2;  // Cauchy's s^2
constexpr double kPi = std::numbers::pi;

struct Shape {
  std::vector<Vector3d> skeleton;  // equally spaced, mm
  double radius = 0;               // mm, halfway along
  double width = 0;                // width of each blob, mm

  [[nodiscard]] double value(const Vector3d& p) const {
    double sum = 0;
    for (const Vector3d& c : skeleton)
      sum += width * lumen::formats::evaluateKernel(lumen::formats::Kernel::Cauchy, kParameter,
                                                    (p - c).squaredNorm() / (width * width))
                         .phi;
    return sum;
  }
};

Shape makeShape(const std::string& name) {
  Shape shape;
  shape.radius = name == "capsule" ? 1.25 : 3.6;
  const double spacing = 0.5;
  if (name == "capsule") {
    for (int i = 0; i <= 20; ++i) shape.skeleton.emplace_back(spacing * i, 0, 0);
  } else {
    // from the outer end inwards, in the direction of a pushed tool
    for (double angle = 3 * kPi; angle >= 0;) {
      const double r = 8 + 1.85 * angle;
      shape.skeleton.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
      angle -= spacing / std::hypot(r, 1.85);
    }
  }
  // the width that gives the radius halfway along; the value there grows with the width
  const Vector3d wall =
      shape.skeleton[shape.skeleton.size() / 2] + shape.radius * Vector3d::UnitZ();
  double low = 1e-3, high = 10;
  for (int i = 0; i < 60; ++i) {
    shape.width = 0.5 * (low + high);
    (shape.value(wall) < kLevel ? low : high) = shape.width;
  }
  shape.width = static_cast<float>(shape.width);
  return shape;
}

/// The point where the ray from a point within leaves the surface, to 1e-12 mm.
Vector3d leave(const Shape& shape, const Vector3d& from, const Vector3d& direction) {
  double inside = 0, outside = 2 * shape.radius;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (inside + outside);
    (shape.value(from + middle * direction) > kLevel ? inside : outside) = middle;
  }
  return from + 0.5 * (inside + outside) * direction;
}

Vector3d tangentAt(const Shape& shape, std::size_t i) {
  const std::size_t last = shape.skeleton.size() - 1;
  return (shape.skeleton[std::min(i + 1, last)] - shape.skeleton[i == 0 ? 0 : i - 1]).normalized();
}

/// A ring of points on the surface seen from the skeleton: `at` counts its points, fractions lie
/// between. Rays lean by `lean` towards the skeleton's direction, up to pi/2 either way for the
/// caps.
std::vector<Vector3d> ring(const Shape& shape, double at, double lean, int count) {
  const double last = static_cast<double>(shape.skeleton.size() - 1);
  const auto i = static_cast<std::size_t>(std::clamp(at, 0.0, last - 1));
  const double share = std::clamp(at, 0.0, last) - static_cast<double>(i);
  const Vector3d centre = (1 - share) * shape.skeleton[i] + share * shape.skeleton[i + 1];
  const Vector3d along =
      ((1 - share) * tangentAt(shape, i) + share * tangentAt(shape, i + 1)).normalized();
  const Vector3d side = Vector3d::UnitZ().cross(along);
  std::vector<Vector3d> points;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * kPi * k / count;
    const Vector3d across = std::cos(angle) * side + std::sin(angle) * Vector3d::UnitZ();
    points.push_back(leave(shape, centre, std::cos(lean) * across + std::sin(lean) * along));
  }
  return points;
}

/// Rings from pole to pole (a pole is a ring of one), their points about `edge` mm apart.
std::vector<std::vector<Vector3d>> sweep(const Shape& shape, double edge) {
  const double last = static_cast<double>(shape.skeleton.size() - 1), quarter = kPi / 2;
  const double length = last * (shape.skeleton[1] - shape.skeleton[0]).norm();
  const int around = std::max(6, static_cast<int>(std::lround(2 * kPi * shape.radius / edge)));
  const int along = static_cast<int>(std::lround(length / edge));
  const int cap = std::max(2, around / 4);
  std::vector<std::vector<Vector3d>> rings;
  for (int k = 0; k < cap; ++k)
    rings.push_back(ring(shape, 0, -quarter * (cap - k) / cap, k == 0 ? 1 : around));
  for (int k = 0; k <= along; ++k) rings.push_back(ring(shape, last * k / along, 0, around));
  for (int k = 1; k <= cap; ++k)
    rings.push_back(ring(shape, last, quarter * k / cap, k == cap ? 1 : around));
  return rings;
}

using Triangle = std::array<std::size_t, 3>;

/// Two triangles between two rings at each step around, facing outwards; vertices count from one,
/// as OBJ does.
std::vector<Triangle> trianglesOf(const std::vector<std::vector<Vector3d>>& rings) {
  std::vector<Triangle> triangles;
  std::size_t first = 1;
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
    const std::size_t a = rings[r].size(), b = rings[r + 1].size(), next = first + a;
    for (std::size_t k = 0; k < std::max(a, b); ++k) {
      if (a > 1) triangles.push_back({first + k % a, first + (k + 1) % a, next + (k + 1) % b});
      if (b > 1) triangles.push_back({first + k % a, next + (k + 1) % b, next + k % b});
    }
    first = next;
  }
  return triangles;
}

bool writeMesh(const Shape& shape, const std::string& stem, int wanted) {
  const double length = 0.5 * static_cast<double>(shape.skeleton.size() - 1);
  const double area = 2 * kPi * shape.radius * (length + 2 * shape.radius);
  const auto rings = sweep(shape, std::sqrt(2 * area / wanted));
  std::ofstream file(stem + "-" + std::to_string(wanted) + ".obj");
  file.precision(9);
  for (const auto& points : rings)
    for (const Vector3d& p : points) file << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (const Triangle& t : trianglesOf(rings))
    file << "f " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  return static_cast<bool>(file.flush());
}

lumen::formats::Vec3f toFloat(const Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

void addNode(Case& value, const Vector3d& centre, const Vector3d& direction, double radius,
             double height) {
  auto& tree = value.tree;
  const auto index = static_cast<std::int32_t>(tree.nodeCount());
  tree.centre.push_back(toFloat(centre));
  tree.direction.push_back(toFloat(direction));
  tree.radius.push_back(static_cast<float>(radius));
  tree.height.push_back(static_cast<float>(height));
  tree.parent.push_back(index - 1);
  tree.branch.push_back(0);
}

/// The skeleton as a tracked case. Wall points belong to their nearest skeleton point, as in the
/// thesis.
Case trackedCase(const Shape& shape, const std::string& name) {
  Case value;
  value.metadata.voxelSize = 2 * kLevel;
  value.metadata.note = "synthetic " + name;
  value.tree.branches.emplace_back().label = "root";
  const std::size_t count = shape.skeleton.size();
  std::vector<std::vector<Vector3d>> owned(count);
  for (const auto& points : sweep(shape, std::min(0.15 * shape.radius, 0.3)))
    for (const Vector3d& p : points) {
      const auto nearest = std::ranges::min_element(
          shape.skeleton, {}, [&](const Vector3d& c) { return (p - c).squaredNorm(); });
      owned[static_cast<std::size_t>(nearest - shape.skeleton.begin())].push_back(p);
    }
  value.points.emplace().offset.push_back(0);
  for (std::size_t i = 0; i < count; ++i) {
    double radius = 2 * shape.radius;
    for (const Vector3d& p : owned[i]) radius = std::min(radius, (p - shape.skeleton[i]).norm());
    addNode(value, shape.skeleton[i], tangentAt(shape, i), radius, 0.5);
    for (const Vector3d& p : owned[i]) value.points->position.push_back(toFloat(p));
    value.points->offset.push_back(static_cast<std::uint32_t>(value.points->position.size()));
  }
  value.tree.branches[0].nodeCount = static_cast<std::uint32_t>(count);
  return value;
}

/// The exact surface as a case: every node has all blobs, so the surface is exact at any cursor.
Case truthCase(const Shape& shape, Case value) {
  value.points.reset();
  auto& models = value.models.emplace();
  models.kernelParameter = kParameter;
  models.isoLevel = kLevel;
  models.offset.push_back(0);
  for (std::size_t i = 0; i < value.tree.nodeCount(); ++i) {
    for (const Vector3d& c : shape.skeleton) models.centre.push_back(toFloat(c));
    models.offset.push_back(static_cast<std::uint32_t>(models.centre.size()));
  }
  models.width.assign(models.centre.size(), static_cast<float>(shape.width));
  return value;
}

bool writeCase(const Case& value, const std::string& file) {
  const auto written = lumen::formats::writeCaseFile(value, file);
  if (!written) std::fprintf(stderr, "shapes: %s\n", written.error().text().c_str());
  return static_cast<bool>(written);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc >= 3 ? argv[1] : "";
  if (name != "capsule" && name != "spiral") {
    std::fprintf(stderr, "Usage: catheter_shapes capsule|spiral FOLDER [TRIANGLES]...\n");
    return 2;
  }
  const std::string stem = std::string(argv[2]) + "/" + name;
  const Shape shape = makeShape(name);
  const Case tracked = trackedCase(shape, name);
  bool good = writeCase(tracked, stem + ".lumen") &&
              writeCase(truthCase(shape, tracked), stem + "-truth.lumen");
  for (int i = 3; good && i < argc; ++i)
    good = writeMesh(shape, stem, std::max(100, std::atoi(argv[i])));
  return good ? 0 : 1;
}
