// SPDX-License-Identifier: Apache-2.0
// The tree of eight boxes a node and its blocks of four triangles give what a scalar look at every
// triangle does, to the last bit.
#include "converters/geometry/triangle_tree.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/geometry/wide_box_tree.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

Vector3d randomPoint(Random& random) {
  const double x = random.uniform(), y = random.uniform();
  return {x, y, random.uniform()};
}

/// Small triangles in a cube of 1 mm; each ninth has no area, each eleventh is the one before it.
TriangleMesh soup(std::uint32_t count, const Vector3d& offset) {
  Random random(11, count);
  TriangleMesh mesh;
  for (std::uint32_t t = 0; t < count; ++t) {
    const Vector3d at = offset + randomPoint(random);
    const double size = 0.3 * random.uniform();
    for (int i = 0; i < 3; ++i) mesh.position.emplace_back(at + size * randomPoint(random));
    if (t % 9 == 8) mesh.position.back() = mesh.position[3 * t];
    if (t % 11 == 10)
      for (std::uint32_t i = 0; i < 3; ++i) mesh.position[3 * t + i] = mesh.position[3 * t + i - 3];
    mesh.triangle.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

/// Moeller and Trumbore's test, as it is published.
std::optional<RayHit> meets(const TriangleMesh& mesh, std::uint32_t t, const Vector3d& origin,
                            const Vector3d& direction) {
  const Vector3d a = mesh.position[mesh.triangle[t][0]];
  const Vector3d ab = mesh.position[mesh.triangle[t][1]] - a;
  const Vector3d ac = mesh.position[mesh.triangle[t][2]] - a;
  const Vector3d across = direction.cross(ac), from = origin - a, q = from.cross(ab);
  const double det = ab.dot(across);
  if (!(std::abs(det) > 0)) return {};
  const double u = from.dot(across) / det, v = direction.dot(q) / det;
  if (!(u >= 0 && v >= 0 && u + v <= 1)) return {};
  return RayHit{ac.dot(q) / det, t, det < 0};
}

std::optional<RayHit> firstOfAll(const TriangleMesh& mesh, const Vector3d& origin,
                                 const Vector3d& direction, double least) {
  std::optional<RayHit> best;
  for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t)
    if (const auto hit = meets(mesh, t, origin, direction); hit && hit->distance >= least)
      if (!best || hit->distance < best->distance) best = hit;
  return best;
}

NearestPoint nearestOfAll(const TriangleMesh& mesh, const Vector3d& point) {
  NearestPoint best;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t) {
    const auto& [a, b, c] = mesh.triangle[t];
    const Vector3d at =
        nearestPointOnTriangle(point, mesh.position[a], mesh.position[b], mesh.position[c]);
    const double squared = (at - point).squaredNorm();
    if (!(squared < least)) continue;
    least = squared;
    best = {std::sqrt(squared), t, at};
  }
  return best;
}

/// Points about the cube, on corners and edges of triangles, and of planes of boxes.
std::vector<Vector3d> places(const TriangleMesh& mesh, const Vector3d& offset) {
  Random random(5, mesh.triangle.size());
  std::vector<Vector3d> out;
  for (int i = 0; i < 40; ++i)
    out.emplace_back(offset + 2 * randomPoint(random) - Vector3d::Constant(0.5));
  for (std::size_t i = 0; i < 10; ++i) {
    const std::size_t v = i * 7 % mesh.position.size(), w = v / 3 * 3 + (v + 1) % 3;
    out.push_back(mesh.position[v]);
    out.emplace_back(0.5 * (mesh.position[v] + mesh.position[w]));
  }
  return out;
}

const std::vector<Vector3d> kOffsets = {Vector3d::Zero(), Vector3d(1000, -2000, 500)};
// one leaf, a node that is not full, several levels
const std::vector<std::uint32_t> kCounts = {1, 4, 5, 33, 700};

TEST(TriangleTree, MeetsTheSameTriangleAsALookAtEach) {
  for (const Vector3d& offset : kOffsets)
    for (const std::uint32_t count : kCounts) {
      const TriangleMesh mesh = soup(count, offset);
      const TriangleTree tree(mesh);
      Random random(3, count);
      int hits = 0;
      for (const Vector3d& from : places(mesh, offset))
        for (int i = 0; i < 20; ++i) {
          Vector3d along = randomPoint(random) - Vector3d::Constant(0.5);
          if (i < 3) along = Vector3d::Unit(i);
          if (i == 3) along = -Vector3d::UnitX();
          along.normalize();
          const double least = i % 4 == 1 ? 0.2 : 0;
          const auto wanted = firstOfAll(mesh, from, along, least);
          const auto found = tree.firstHit(from, along, least);
          ASSERT_EQ(found.has_value(), wanted.has_value());
          if (!wanted) continue;
          ++hits;
          EXPECT_EQ(found->distance, wanted->distance);
          EXPECT_EQ(found->triangle, wanted->triangle);
          EXPECT_EQ(found->leaves, wanted->leaves);
        }
      EXPECT_GT(hits, count < 30 ? 0 : 100);
    }
}

TEST(TriangleTree, FindsTheSamePointAsALookAtEach) {
  for (const Vector3d& offset : kOffsets)
    for (const std::uint32_t count : kCounts) {
      const TriangleMesh mesh = soup(count, offset);
      const TriangleTree tree(mesh);
      for (const Vector3d& from : places(mesh, offset)) {
        const NearestPoint wanted = nearestOfAll(mesh, from), found = tree.nearest(from);
        EXPECT_EQ(found.distance, wanted.distance);
        EXPECT_EQ(found.triangle, wanted.triangle);
        EXPECT_EQ(found.position, wanted.position);
        EXPECT_EQ(tree.nearest(from, 1.01 * wanted.distance + 1e-9).triangle, wanted.triangle);
        if (wanted.distance > 0) {
          EXPECT_TRUE(std::isinf(tree.nearest(from, 0.99 * wanted.distance).distance));
        }
      }
    }
}

TEST(TriangleTree, SeesAsFarAsTheFirstHit) {
  const TriangleMesh mesh = soup(700, Vector3d::Zero());
  const TriangleTree tree(mesh);
  Random random(9, 1);
  for (const Vector3d& from : places(mesh, Vector3d::Zero())) {
    const Vector3d along = (randomPoint(random) - Vector3d::Constant(0.5)).normalized();
    const auto hit = tree.firstHit(from, along, 0);
    if (!hit || !(hit->distance > 1e-6)) continue;
    EXPECT_TRUE(tree.isFree(from, from + 0.999 * hit->distance * along));
    EXPECT_FALSE(tree.isFree(from, from + 1.001 * hit->distance * along));
  }
}

TEST(WideBoxTree, WritesDistancesAtAnyMultipleOfEightBytes) {
  WideNode node;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t k = 0; k < WideNode::kWidth; ++k) {
      node.plane[2 * axis][k] = static_cast<float>(k);
      node.plane[2 * axis + 1][k] = static_cast<float>(k + 1);
    }
  for (std::size_t shift = 0; shift < 4; ++shift) {
    alignas(32) std::array<double, WideNode::kWidth + 4> room{};
    auto& keys = *reinterpret_cast<WideNode::Keys*>(room.data() + shift);
    EXPECT_EQ(boxesNear(node, {0, 0, 0}, 12.5, keys), 0b111U);
    for (std::size_t k = 0; k < WideNode::kWidth; ++k)
      EXPECT_EQ(keys[k], 3.0 * static_cast<double>(k * k));
  }
}

}  // namespace
}  // namespace lumen::convert
