// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/repair/repair.h"

#include <algorithm>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/geometry/mesh_edges.h"
#include "converters/geometry/unit_guess.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/stages/repair/mesh_report.h"
#include "mesh_shapes.h"

namespace lumen::test {
namespace {

using namespace lumen::convert;

RepairResult repaired(const TriangleMesh& mesh) {
  return repairMesh(mesh, "a.stl", Progress());
}

std::string refusal(const TriangleMesh& mesh) {
  try {
    repaired(mesh);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    return error.what();
  }
  return {};
}

bool says(const RepairResult& result, const std::string& sentence) {
  return std::find(result.repairs.begin(), result.repairs.end(), sentence) != result.repairs.end();
}

std::string all(const RepairResult& result) {
  std::string text;
  for (const std::string& s : result.repairs) text += s + "\n";
  return text;
}

/// By indices: every edge has two triangles that agree, or one.
std::size_t badEdges(const TriangleMesh& mesh, std::size_t* open = nullptr) {
  std::size_t bad = 0;
  forEachEdge(edgeUses(mesh.triangle), [&](std::span<const EdgeUse> edge) {
    if (open != nullptr && edge.size() == 1) ++*open;
    if (edge.size() > 2 || (edge.size() == 2 && startOf(mesh.triangle, edge[0].side) ==
                                                    startOf(mesh.triangle, edge[1].side)))
      ++bad;
  });
  return bad;
}

double volumeOf(const TriangleMesh& mesh) {
  return diagnoseMesh(mesh, Progress()).volume;
}

TEST(Repair, LeavesASoundMeshAsItIs) {
  const TriangleMesh mesh = torus();
  const RepairResult result = repaired(mesh);
  EXPECT_EQ(all(result), "");
  EXPECT_EQ(result.mesh.triangle, mesh.triangle);
  EXPECT_EQ(result.mesh.position, mesh.position);
  EXPECT_EQ(result.components, 1U);
}

TEST(Repair, MergesTheCornersOfATriangleSoup) {
  const RepairResult result = repaired(soup(tetrahedron()));
  EXPECT_TRUE(says(result, "merged 8 duplicate points")) << all(result);
  EXPECT_EQ(result.mesh.position.size(), 4U);
  EXPECT_EQ(result.openings.size(), 0U);
}

TEST(Repair, MergesPointsWithinAMillionthOfTheBox) {
  TriangleMesh mesh = soup(torus());
  for (std::size_t i = 0; i < mesh.position.size(); ++i)
    mesh.position[i].x() += i % 3 == 0 ? 2e-6 : 0;  // the box's diagonal is 11.5
  const RepairResult result = repaired(mesh);
  EXPECT_EQ(result.mesh.position.size(), torus().position.size());
  EXPECT_TRUE(result.openings.empty());
}

TEST(Repair, TurnsTrianglesRound) {
  TriangleMesh mesh = torus();
  for (std::size_t i = 0; i < 40; ++i) turn(mesh.triangle[7 * i]);
  const RepairResult result = repaired(mesh);
  EXPECT_EQ(all(result), "turned 40 triangles round\n");
  EXPECT_EQ(badEdges(result.mesh), 0U);
  EXPECT_NEAR(volumeOf(result.mesh), volumeOf(torus()), 1e-9);
}

TEST(Repair, TurnsWhatIsInsideOutAlsoIfItIsOpen) {
  for (TriangleMesh mesh : {torus(), openTube()}) {
    const double volume = volumeOf(mesh);
    for (Triangle& t : mesh.triangle) turn(t);
    const RepairResult result = repaired(mesh);
    EXPECT_EQ(all(result), "turned 1 part, which was inside out\n");
    EXPECT_NEAR(volumeOf(result.mesh), volume, 1e-9);
  }
}

TEST(Repair, LeavesTheEndsOfAVesselOpen) {
  const RepairResult result = repaired(openTube(2));
  ASSERT_EQ(result.openings.size(), 2U);
  EXPECT_EQ(all(result), "");
  for (const BoundaryLoop& end : result.openings) {
    EXPECT_EQ(end.vertex.size(), 16U);
    // the mean over the sides of a polygon of 16 corners on a circle of radius 2
    EXPECT_NEAR(end.radius, 2 * std::cos(std::numbers::pi / 16), 1e-9);
  }
  EXPECT_NEAR(result.openings[0].centre.z() + result.openings[1].centre.z(), 10, 1e-9);
}

TEST(Repair, LeavesObliqueEndsAndTapersOpen) {
  TriangleMesh mesh = openTube();
  for (Eigen::Vector3d& p : mesh.position) {
    p.z() += p.z() / 10 * p.x();  // the far end is cut at 45 degrees
    p.x() *= 1 + 0.05 * p.z();
    p.y() *= 1 + 0.05 * p.z();
  }
  EXPECT_EQ(repaired(mesh).openings.size(), 2U);
}

TEST(Repair, FillsAHoleInTheWall) {
  TriangleMesh mesh = openTube();
  const double volume = volumeOf(mesh);
  // four quads in a square, half way along the tube
  for (const std::size_t quad : {9U * 16 + 9, 9U * 16 + 8, 8U * 16 + 9, 8U * 16 + 8})
    mesh.triangle.erase(mesh.triangle.begin() + 2 * static_cast<std::ptrdiff_t>(quad),
                        mesh.triangle.begin() + 2 * static_cast<std::ptrdiff_t>(quad) + 2);
  const RepairResult result = repaired(mesh);
  EXPECT_EQ(result.openings.size(), 2U);
  EXPECT_EQ(std::count(result.source.begin(), result.source.end(), RepairResult::kFilled), 6);
  EXPECT_EQ(badEdges(result.mesh), 0U);
  EXPECT_NEAR(volumeOf(result.mesh), volume, 0.01 * volume);
  EXPECT_TRUE(result.repairs.size() == 1 && result.repairs[0].starts_with("filled 1 hole"))
      << all(result);
}

TEST(Repair, ClosesATetrahedronThatLacksAFace) {
  TriangleMesh mesh = tetrahedron();
  mesh.triangle.pop_back();
  const RepairResult result = repaired(mesh);
  EXPECT_EQ(result.mesh.triangle.size(), 4U);
  EXPECT_NEAR(volumeOf(result.mesh), 1.0 / 6, 1e-12);
}

TEST(Repair, GivesAPointOnASideToTheNeighbour) {
  // a sliver closes the crack between the halves of one side and the whole side beside it
  TriangleMesh mesh = tetrahedron();
  mesh.position.emplace_back(0.5, 0, 0);
  mesh.triangle[1] = {0, 4, 3};
  mesh.triangle.push_back({4, 1, 3});
  mesh.triangle.push_back({0, 1, 4});  // no area
  const RepairResult result = repaired(mesh);
  EXPECT_TRUE(says(result, "dropped 1 triangle without area")) << all(result);
  std::size_t open = 0;
  EXPECT_EQ(badEdges(result.mesh, &open), 0U);
  EXPECT_EQ(open, 0U);
  EXPECT_NEAR(volumeOf(result.mesh), 1.0 / 6, 1e-12);
}

TEST(Repair, DropsTrianglesThatAreThereTwice) {
  TriangleMesh mesh = torus();
  mesh.triangle.push_back({mesh.triangle[5][1], mesh.triangle[5][2], mesh.triangle[5][0]});
  mesh.triangle.push_back({mesh.triangle[9][1], mesh.triangle[9][0], mesh.triangle[9][2]});
  const RepairResult result = repaired(mesh);
  EXPECT_EQ(all(result), "dropped 2 triangles that were there twice\n");
  EXPECT_EQ(result.mesh.triangle, torus().triangle);
}

TEST(Repair, CutsTubesApartThatTouchInAnEdge) {
  // two cubes with one edge in common
  TriangleMesh cube;
  for (int i = 0; i < 8; ++i) cube.position.emplace_back(i >> 2 & 1, i >> 1 & 1, i & 1);
  cube.triangle = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                   {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  for (const bool insideOut : {false, true}) {
    TriangleMesh both = joined(cube, cube, {1, 1, 0});
    if (insideOut)
      for (Triangle& t : both.triangle) turn(t);
    const RepairResult result = repaired(both);
    EXPECT_EQ(result.components, 2U);
    EXPECT_EQ(result.mesh.position.size(), 16U);
    EXPECT_EQ(badEdges(result.mesh), 0U);
    EXPECT_TRUE(says(result, "cut 1 edge of more than two triangles")) << all(result);
    EXPECT_NEAR(volumeOf(result.mesh), 2, 1e-12);
  }
}

TEST(Repair, DropsAFlapInTheLumenAndFillsNothing) {
  TriangleMesh mesh = torus();
  const auto tip = static_cast<std::uint32_t>(mesh.position.size());
  mesh.position.emplace_back(3, 0, 0);
  mesh.triangle.push_back({0, 1, tip});
  const RepairResult result = repaired(mesh);
  EXPECT_EQ(result.mesh.triangle, torus().triangle) << all(result);
  EXPECT_EQ(result.mesh.position.size(), torus().position.size());
}

TEST(Repair, DropsDebrisButNoVessel) {
  TriangleMesh crumb = tetrahedron();
  for (Eigen::Vector3d& p : crumb.position) p *= 0.01;
  const TriangleMesh mesh =
      joined(joined(openTube(), crumb, {5, 0, 0}), openTube(0.2, 2), {3, 3, 3});
  const RepairResult result = repaired(mesh);
  EXPECT_EQ(result.components, 2U);
  EXPECT_EQ(all(result), "dropped 1 part smaller than a hundredth of the mesh\n");
}

TEST(Repair, RefusesAMoebiusStrip) {
  const std::string refused = refusal(moebius());
  EXPECT_NE(refused.find("a.stl: the surface cannot be oriented"), std::string::npos) << refused;
}

TEST(Repair, RefusesWhatEnclosesNothing) {
  EXPECT_NE(refusal({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}})
                .find("its one triangle encloses no volume"),
            std::string::npos);
  EXPECT_NE(refusal({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}})
                .find("its 2 triangles enclose no volume"),
            std::string::npos);
}

TEST(Repair, RefusesTrianglesWithoutArea) {
  EXPECT_NE(refusal({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {1, 1, 0}}})
                .find("none of its 2 triangles has an area"),
            std::string::npos);
}

TEST(Repair, KnowsWhereEachTriangleComesFrom) {
  TriangleMesh mesh = torus();
  mesh.triangle.insert(mesh.triangle.begin() + 3, {0, 0, 1});
  const RepairResult result = repaired(mesh);
  ASSERT_EQ(result.source.size(), torus().triangle.size());
  EXPECT_EQ(result.source[2], 2U);
  EXPECT_EQ(result.source[3], 4U);
}

/// Real surfaces; they are not in the repository.
class RealMeshes : public testing::Test {
protected:
  static MeshFile read(const std::string& name, MeshFormat format) {
    return readMesh(std::filesystem::path(LUMEN_SHARED_DATA) / name, format);
  }
  void SetUp() override {
    if (!std::filesystem::exists(LUMEN_SHARED_DATA))
      GTEST_SKIP() << "there is no " << LUMEN_SHARED_DATA;
  }
};

TEST_F(RealMeshes, AnAortaFacesOutwardAfterRepair) {
  const MeshFile file = read("aorta/aorta-surface.stl", MeshFormat::Stl);
  EXPECT_EQ(file.mesh.position.size(), 6468U);
  EXPECT_LT(volumeOf(file.mesh), 0);
  const RepairResult result = repaired(file.mesh);
  EXPECT_EQ(all(result), "turned 1 part, which was inside out\n");
  EXPECT_GT(volumeOf(result.mesh), 0);
}

TEST_F(RealMeshes, AnAortaWithOpenEndsKeepsItsThree) {
  const RepairResult result =
      repaired(read("aorta/aorta-surface-open-ends.stl", MeshFormat::Stl).mesh);
  EXPECT_EQ(result.openings.size(), 3U);
}

TEST_F(RealMeshes, ANeurovascularMeshKeepsItsFourEndsAndLosesItsFlaps) {
  const MeshFile file =
      read("neurovascular/mechanical_thrombectomy_collision_FIX_REMESH.obj", MeshFormat::Obj);
  EXPECT_EQ(diagnoseMesh(file.mesh, Progress()).boundaryLoops.size(), 9U);
  const RepairResult result = repaired(file.mesh);
  EXPECT_EQ(badEdges(result.mesh), 0U);
  ASSERT_EQ(result.openings.size(), 4U);
  for (const BoundaryLoop& end : result.openings) EXPECT_NEAR(end.radius, 5.3, 0.2);
}

TEST_F(RealMeshes, ASoupInMetresBecomesManifold) {
  for (const char* name : {"AbdominalAorta.stl", "AbdominalAorticAneurysm.stl"}) {
    const MeshFile file = read(std::string("aorta-metres/") + name, MeshFormat::Stl);
    EXPECT_FALSE(diagnoseMesh(file.mesh, Progress()).manifold);
    EXPECT_EQ(guessUnit(vesselSize(diagnoseMesh(file.mesh, Progress()))).unit, "m");
    const RepairResult result = repaired(file.mesh);
    std::size_t open = 0;
    EXPECT_EQ(badEdges(result.mesh, &open), 0U);
    EXPECT_EQ(open, 0U);
    EXPECT_EQ(result.components, 1U);
  }
}

}  // namespace
}  // namespace lumen::test
