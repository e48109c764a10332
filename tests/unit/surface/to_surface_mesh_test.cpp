// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/to_surface_mesh.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "../mesh/synthetic.h"
#include "formats/case/case_field.h"

namespace lumen::convert {
namespace {

/// The wall of a tube of 5 nodes along x at y = 0.05, z = 0.07 and radius 1 from x = 1 to x = 3, and
/// a flat outlet there with a vertex in its middle.
CaseSurface tubeSurface() {
  constexpr std::uint32_t kAround = 16;
  CaseSurface surface;
  surface.groups = {{"wall", FaceKind::Wall}, {"outlet-tube", FaceKind::Outlet}};
  for (std::uint32_t ring = 0; ring < 3; ++ring)
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const double turn = 2 * std::numbers::pi * i / kAround;
      surface.mesh.position.emplace_back(1 + ring, 0.05 + std::cos(turn), 0.07 + std::sin(turn));
      surface.node.push_back(1 + ring);
    }
  const std::uint32_t middle = 3 * kAround;
  surface.mesh.position.emplace_back(3, 0.05, 0.07);
  surface.node.push_back(3);
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const std::uint32_t next = (i + 1) % kAround;
    for (std::uint32_t base = 0; base < 2 * kAround; base += kAround) {
      surface.mesh.triangle.push_back({base + i, base + next, base + kAround + next});
      surface.mesh.triangle.push_back({base + i, base + kAround + next, base + kAround + i});
      surface.group.insert(surface.group.end(), 2, 0);
    }
    surface.mesh.triangle.push_back({middle, 2 * kAround + i, 2 * kAround + next});
    surface.group.push_back(1);
  }
  surface.ends = {{1, 0, 4, {3, 0.05, 0.07}, {1, 0, 0}}};
  return surface;
}

TEST(ToSurfaceMesh, KeepsFacesAndGivesVerticesWhatTheCaseSaysOfThem) {
  formats::Case source = test::tubeCase(5);
  for (std::size_t i = 0; i < 5; ++i) {
    source.tree.radius[i] = 1 + 0.01F * static_cast<float>(i);
    source.tree.inlierRate.push_back(0.1F * static_cast<float>(i));
  }
  const field::BlendedField blended = formats::caseField(source);
  const SeparatedField field(source, blended, {});
  const CaseSurface surface = tubeSurface();
  Progress progress;
  const SurfaceMesh mesh = toSurfaceMesh(surface, field, progress);
  EXPECT_EQ(mesh.triangle, surface.mesh.triangle);
  EXPECT_EQ(mesh.group, surface.group);
  EXPECT_EQ(mesh.groups, surface.groups);
  EXPECT_EQ(mesh.labels, std::vector<std::string>{"tube"});
  for (std::size_t v = 0; v < mesh.position.size(); ++v) {
    const Eigen::Vector3d& p = surface.mesh.position[v];
    for (int a = 0; a < 3; ++a)
      EXPECT_EQ(mesh.position[v][static_cast<std::size_t>(a)], static_cast<float>(p[a]));
    EXPECT_NEAR(mesh.radius[v], 1 + 0.01 * (p.x() - 0.03), 1e-5);
    EXPECT_NEAR(mesh.confidence[v], 0.1 * (p.x() - 0.03), 1e-5);
    EXPECT_EQ(mesh.branch[v], 0U);
    const Eigen::Vector3f normal(mesh.normal[v].data());
    const bool isWithinEnd = v + 1 == mesh.position.size();
    const Eigen::Vector3f outward(0, float(p.y()) - 0.05F, float(p.z()) - 0.07F);
    EXPECT_GT(normal.dot(isWithinEnd ? Eigen::Vector3f(1, 0, 0) : outward), 0.99);
    EXPECT_NEAR(normal.norm(), 1, 1e-5);
  }
}

}  // namespace
}  // namespace lumen::convert
