// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/icosphere.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Geometry>

namespace lumen::convert {
namespace {

using Corners = std::array<std::size_t, 3>;

struct Sphere {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Corners> triangles;
};

Sphere icosahedron() {
  const double a = 1.0 / std::sqrt(1.0 + 0.25 * std::pow(1.0 + std::sqrt(5.0), 2));
  const double b = a * 0.5 * (1.0 + std::sqrt(5.0));
  Sphere sphere;
  for (const double s : {1.0, -1.0})
    for (const double t : {1.0, -1.0}) {
      sphere.vertices.emplace_back(0, s * a, t * b);
      sphere.vertices.emplace_back(s * a, t * b, 0);
      sphere.vertices.emplace_back(t * b, 0, s * a);
    }
  // three vertices span a face if they are pairwise neighbours, at the edge length 2 a
  const auto near = [&](std::size_t i, std::size_t j) {
    return (sphere.vertices[i] - sphere.vertices[j]).norm() < 2.1 * a;
  };
  for (std::size_t i = 0; i < 12; ++i)
    for (std::size_t j = i + 1; j < 12; ++j)
      for (std::size_t k = j + 1; k < 12; ++k)
        if (near(i, j) && near(j, k) && near(i, k)) sphere.triangles.push_back({i, j, k});
  return sphere;
}

Sphere subdivide(Sphere sphere) {
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
  const auto middle = [&](std::size_t i, std::size_t j) {
    const auto [entry, isNew] = middles.try_emplace(std::minmax(i, j), sphere.vertices.size());
    if (isNew) sphere.vertices.push_back((sphere.vertices[i] + sphere.vertices[j]).normalized());
    return entry->second;
  };
  std::vector<Corners> triangles;
  for (const auto& [i, j, k] : sphere.triangles) {
    const std::size_t ij = middle(i, j), jk = middle(j, k), ki = middle(k, i);
    triangles.insert(triangles.end(), {{i, ij, ki}, {j, jk, ij}, {k, ki, jk}, {ij, jk, ki}});
  }
  sphere.triangles = std::move(triangles);
  return sphere;
}

std::vector<Eigen::Vector3d> pairOpposites(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<Eigen::Vector3d> paired;
  for (std::size_t i = 0; i < vertices.size(); ++i)
    for (std::size_t j = i + 1; j < vertices.size(); ++j)
      if ((vertices[i] + vertices[j]).norm() < 1e-9) {
        paired.push_back(vertices[i]);
        paired.push_back(-vertices[i]);
      }
  return paired;
}

}  // namespace

std::vector<Eigen::Vector3d> icosphere(int order) {
  Sphere sphere = icosahedron();
  for (int i = 1; i < order; ++i) sphere = subdivide(std::move(sphere));
  return pairOpposites(sphere.vertices);
}

int icosphereOrder(int vertices) {
  for (int order = 1, count = 12; order <= 4; ++order, count = 4 * count - 6)
    if (count == vertices) return order;
  return 0;
}

std::vector<Eigen::Vector3d> axesAround(const Eigen::Vector3d& direction,
                                        const std::vector<Eigen::Vector3d>& sphere) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(sphere.front(), direction);
  std::vector<Eigen::Vector3d> axes;
  axes.reserve(sphere.size() / 2);
  for (std::size_t i = 0; i < sphere.size(); i += 2) {
    const Eigen::Vector3d axis = turn * sphere[i];
    axes.push_back(axis.dot(direction) < 0 ? Eigen::Vector3d(-axis) : axis);
  }
  std::stable_sort(axes.begin(), axes.end(), [&](const auto& a, const auto& b) {
    return a.dot(direction) > b.dot(direction);
  });
  return axes;
}

}  // namespace lumen::convert
