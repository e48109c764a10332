// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/self_intersections.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>
#include <set>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/geometry/exact_predicates.h"

namespace lumen::convert {
namespace {

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

TriangleMesh two(const Triangle& one, const Triangle& other,
                 const std::vector<Eigen::Vector3d>& position) {
  return {position, {one, other}};
}

bool meets(const TriangleMesh& mesh) {
  return !selfIntersections(mesh).pairs.empty();
}

// Self-intersections that CGAL finds in a manifold, as sorted pairs.
Pairs byCgal(const TriangleMesh& mesh) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  Mesh target;
  for (const Eigen::Vector3d& p : mesh.position) target.add_vertex({p.x(), p.y(), p.z()});
  for (const Triangle& t : mesh.triangle)
    target.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2]));
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> found;
  CGAL::Polygon_mesh_processing::self_intersections(target, std::back_inserter(found));
  std::set<std::array<std::uint32_t, 2>> sorted;
  for (const auto& [a, b] : found)
    sorted.insert({std::min(a.idx(), b.idx()), std::max(a.idx(), b.idx())});
  return {sorted.begin(), sorted.end()};
}

// Whether CGAL's exact intersection of two triangles is more than the `shared` vertices' own.
bool meetByCgal(const TriangleMesh& mesh, const Triangle& one, const Triangle& other) {
  using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
  const auto convert = [&mesh](const Triangle& t) {
    const auto point = [&mesh](std::uint32_t v) {
      return Kernel::Point_3(mesh.position[v].x(), mesh.position[v].y(), mesh.position[v].z());
    };
    return Kernel::Triangle_3(point(t[0]), point(t[1]), point(t[2]));
  };
  const auto shared = std::count_if(one.begin(), one.end(), [&other](std::uint32_t v) {
    return std::count(other.begin(), other.end(), v) > 0;
  });
  const auto common = CGAL::intersection(convert(one), convert(other));
  if (!common) return false;
  if (boost::get<Kernel::Point_3>(&*common) != nullptr) return shared < 1;
  if (boost::get<Kernel::Segment_3>(&*common) != nullptr) return shared < 2;
  return true;
}

// A sphere of `rings` by `around` vertices, each moved by up to `noise` edge lengths.
TriangleMesh noisySphere(std::uint32_t rings, std::uint32_t around, double noise, unsigned seed) {
  std::mt19937 random(seed);
  const auto jitter = [&] { return noise * (double(random()) / 4294967296.0 - 0.5) * 3 / rings; };
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t k = 0; k < around; ++k) {
      const double theta = M_PI * (i + 0.5) / rings, phi = 2 * M_PI * k / around;
      mesh.position.emplace_back(std::sin(theta) * std::cos(phi) + jitter(),
                                 std::sin(theta) * std::sin(phi) + jitter(),
                                 std::cos(theta) + jitter());
    }
  for (std::uint32_t i = 0; i + 1 < rings; ++i)
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t a = i * around + k, b = i * around + (k + 1) % around;
      mesh.triangle.push_back({a, a + around, b});
      mesh.triangle.push_back({b, a + around, b + around});
    }
  return mesh;
}

TEST(Orientation, SeesADisplacementByOneUlp) {
  const Eigen::Vector3d a(0.1, 0.1, 0.1), b(1.1, 0.3, 0.1), c(0.7, 2.1, 0.1);
  Eigen::Vector3d d(12.3, 45.6, 0.1);
  EXPECT_EQ(orientation(a, b, c, d), 0);
  d.z() = std::nextafter(0.1, 1.0);
  EXPECT_EQ(orientation(a, b, c, d), -1);
  d.z() = std::nextafter(0.1, 0.0);
  EXPECT_EQ(orientation(a, b, c, d), 1);
}

TEST(Orientation, IsThatOfIntegersOnObliquePlanes) {
  // Multiples of 2^-40 near 1: the determinant needs 120 bits, which is more than a long double.
  std::mt19937_64 random(1);
  const auto number = [&] {
    return static_cast<std::int64_t>(random() % (1ULL << 30)) + (1LL << 39);
  };
  for (int trial = 0; trial < 2000; ++trial) {
    std::array<std::array<std::int64_t, 3>, 4> p;
    for (auto& point : p)
      for (auto& x : point) x = number();
    // d = a + (b - a) + (c - a), but for one unit: nearly in the plane
    for (std::size_t k = 0; k < 3; ++k) p[3][k] = p[1][k] + p[2][k] - p[0][k];
    p[3][static_cast<std::size_t>(trial) % 3] += trial % 5 - 2;
    std::array<Eigen::Vector3d, 4> q;
    for (std::size_t i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k)
        q[i][k] = std::ldexp(static_cast<double>(p[i][static_cast<std::size_t>(k)]), -40);
    const auto row = [&](std::size_t i, std::size_t k) -> __int128 { return p[i][k] - p[3][k]; };
    __int128 det = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, l = (i + 2) % 3;
      det += row(i, 2) * (row(j, 0) * row(l, 1) - row(j, 1) * row(l, 0));
    }
    ASSERT_EQ(orientation(q[0], q[1], q[2], q[3]), (det > 0) - (det < 0)) << trial;
  }
}

TEST(SelfIntersections, OfATetrahedronThereAreNone) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  EXPECT_TRUE(selfIntersections(mesh).pairs.empty());
}

TEST(SelfIntersections, CrossingAndTouchingTrianglesMeet) {
  const std::vector<Eigen::Vector3d> crossing{{0, 0, 0},  {4, 0, 0}, {0, 4, 0},
                                              {1, 1, -1}, {1, 1, 1}, {3, 3, 1}};
  EXPECT_TRUE(meets(two({0, 1, 2}, {3, 4, 5}, crossing)));
  std::vector<Eigen::Vector3d> touching = crossing;
  touching[3] = {1, 1, 0};
  EXPECT_TRUE(meets(two({0, 1, 2}, {3, 4, 5}, touching)));
  touching[3] = {1, 1, std::numeric_limits<double>::epsilon()};
  EXPECT_FALSE(meets(two({0, 1, 2}, {3, 4, 5}, touching)));
}

TEST(SelfIntersections, CoplanarTrianglesMeetWhereTheyOverlapOrOneHoldsTheOther) {
  std::vector<Eigen::Vector3d> p{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}, {2, 1, 0}, {1, 2, 0}};
  EXPECT_TRUE(meets(two({0, 1, 2}, {3, 4, 5}, p)));
  EXPECT_TRUE(meets(two({3, 4, 5}, {0, 1, 2}, p)));
  for (std::size_t i = 3; i < 6; ++i) p[i].x() += 4;
  EXPECT_FALSE(meets(two({0, 1, 2}, {3, 4, 5}, p)));
}

TEST(SelfIntersections, NeighboursMeetOnlyBeyondWhatTheyShare) {
  const std::vector<Eigen::Vector3d> p{{0, 0, 0},  {1, 0, 0},   {0, 1, 0}, {1, 1, 0}, {0.4, 0.4, 0},
                                       {-1, 0, 1}, {-1, 0, -1}, {2, 1, 1}, {2, 1, -1}};
  EXPECT_FALSE(meets(two({0, 1, 2}, {2, 1, 3}, p)));  // an edge, flat
  EXPECT_TRUE(meets(two({0, 1, 2}, {2, 1, 4}, p)));   // an edge, folded
  EXPECT_FALSE(meets(two({0, 1, 2}, {0, 5, 6}, p)));  // a vertex
  EXPECT_TRUE(meets(two({0, 1, 2}, {0, 7, 8}, p)));   // a vertex, and it runs through
  EXPECT_TRUE(meets(two({0, 1, 2}, {2, 1, 0}, p)));   // twice the same
}

TEST(SelfIntersections, WhatHasNoAreaOrIsNoNumberIsLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(meets(two({0, 1, 2}, {3, 4, 5},
                         {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {1, 1, 3}})));
  EXPECT_FALSE(meets(two({0, 1, 2}, {3, 4, 5},
                         {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {nan, 1, 3}})));
  EXPECT_FALSE(meets(two({0, 1, 2}, {3, 4, 5},
                         {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {1e300, 1, 3}})));
  EXPECT_TRUE(selfIntersections({}).pairs.empty());
}

TEST(SelfIntersections, AreThoseThatCgalFinds) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const TriangleMesh mesh = noisySphere(30, 40, 0.4 * seed, seed);
    const Pairs expected = byCgal(mesh);
    EXPECT_EQ(selfIntersections(mesh).pairs, expected) << seed;
    EXPECT_EQ(expected.empty(), seed == 0) << seed;
  }
}

TEST(SelfIntersections, AreThoseThatCgalFindsOnALattice) {
  // Small integers: hardly a pair that is not degenerate in some way.
  std::mt19937 random(7);
  std::size_t some = 0;
  for (int trial = 0; trial < 60; ++trial) {
    TriangleMesh mesh;
    for (int i = 0; i < 27; ++i) mesh.position.emplace_back(i % 3, i / 3 % 3, i / 9);
    const auto any = [&] { return static_cast<std::uint32_t>(random() % 27); };
    while (mesh.triangle.size() < 12) {
      const Triangle t{any(), any(), any()};
      const Eigen::Vector3d ab = mesh.position[t[1]] - mesh.position[t[0]];
      if (ab.cross(mesh.position[t[2]] - mesh.position[t[0]]).norm() > 0)
        mesh.triangle.push_back(t);
    }
    Pairs expected;
    for (std::uint32_t a = 0; a < 12; ++a)
      for (std::uint32_t b = a + 1; b < 12; ++b)
        if (meetByCgal(mesh, mesh.triangle[a], mesh.triangle[b])) expected.push_back({a, b});
    ASSERT_EQ(selfIntersections(mesh).pairs, expected) << trial;
    some += expected.size();
  }
  EXPECT_GT(some, 1000U);
}

TEST(SelfIntersections, BeyondTheLimitAreCutOffOnAnyNumberOfThreads) {
  const TriangleMesh mesh = noisySphere(60, 80, 3, 1);
  const SelfIntersections all = selfIntersections(mesh);
  EXPECT_TRUE(all.isComplete);
  ASSERT_GT(all.pairs.size(), 1000U);
  EXPECT_TRUE(selfIntersections(mesh, all.pairs.size()).isComplete);
  const SelfIntersections some = selfIntersections(mesh, 1000);
  EXPECT_FALSE(some.isComplete);
  EXPECT_EQ(some.pairs.size(), 1000U);
  const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(selfIntersections(mesh, 1000).pairs, some.pairs);
  EXPECT_EQ(selfIntersections(mesh).pairs, all.pairs);
}

}  // namespace
}  // namespace lumen::convert
