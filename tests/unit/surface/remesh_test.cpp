// SPDX-License-Identifier: Apache-2.0
#include "converters/surface/remesh.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "../mesh/mesh_facts.h"
#include "../mesh/synthetic.h"
#include "closed_surface.h"
#include "converters/surface/triangle_quality.h"

namespace lumen::convert {
namespace {

using test::factsOf;
using test::FieldOfCase;

// A wide vessel, and a thin one that leaves it at a right angle.
formats::Case forkCase() {
  formats::Case source;
  source.metadata.voxelSize = 0.2;
  test::addVessel(source, "wide", test::straightPath({0.03, 0.05, 0.07}, {0.5, 0, 0}, 11), 1.0,
                  1.0);
  test::addVessel(source, "thin", test::straightPath({2.53, 0.05, 0.77}, {0.02, 0.05, 0.2}, 14),
                  0.3, 0.3, 5);
  test::addModels(source);
  return source;
}

// A ring: a parent, and a child that a link joins to it again.
CaseSurface roughFork(const FieldOfCase& of) {
  return test::closedSurface(of, 0.15, 0.3);
}

void expectClosed(const CaseSurface& surface, std::ptrdiff_t euler) {
  const test::MeshFacts facts = factsOf(surface.mesh);
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(facts.euler, euler);
  EXPECT_GT(facts.volume, 0);
  TriangleMesh copy = surface.mesh;
  separateFans(copy);
  EXPECT_EQ(copy.position.size(), surface.mesh.position.size()) << "a vertex has two fans";
  EXPECT_EQ(surface.node.size(), surface.mesh.position.size());
  EXPECT_EQ(surface.group.size(), surface.mesh.triangle.size());
}

TriangleQuality qualityOf(const CaseSurface& surface, const FieldOfCase& of,
                          const EdgeLength& edge = {}) {
  const TriangleQuality q = triangleQuality(surface.mesh, targetLengths(surface, of.sheet, edge));
  std::printf("triangles %zu, median %.1f, least %.1f, sharp %zu, edges %.2f (%.2f to %.2f)\n",
              q.triangles, q.medianAngle, q.leastAngle, q.sharp, q.edgeMedian, q.edgeLow,
              q.edgeHigh);
  return q;
}

TEST(Remesh, GivesAForkTrianglesForUse) {
  const FieldOfCase of(forkCase());
  CaseSurface surface = roughFork(of);
  EXPECT_GT(qualityOf(surface, of).sharp, 100U);
  Progress progress;
  const RemeshReport report = remesh(surface, of.sheet, {}, progress);
  expectClosed(surface, 2);
  const TriangleQuality quality = qualityOf(surface, of);
  EXPECT_EQ(report.sharp, 0U);
  EXPECT_EQ(report.offField, 0U);
  EXPECT_GE(quality.leastAngle, 15);
  EXPECT_GE(quality.medianAngle, 45);
  EXPECT_NEAR(quality.edgeMedian, 1, 0.1);
}

}  // namespace
}  // namespace lumen::convert
