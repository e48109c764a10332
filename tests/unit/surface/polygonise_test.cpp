// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/patches/polygonise.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "../mesh/mesh_facts.h"
#include "../mesh/synthetic.h"
#include "converters/io/mesh/write_gltf.h"
#include "formats/case/blobby.h"
#include "formats/case/case_field.h"

namespace lumen::convert {
namespace {

using test::measureFacts;
using test::toPatch;

Patches patchesOf(const formats::Case& source, double cell = 0) {
  Progress progress;
  return polygonise(source, {cell}, progress);
}

SurfaceMesh polygoniseCase(const formats::Case& source) {
  return patchesOf(source).surface;
}

TriangleMesh onlyPatch(const formats::Case& source) {
  const SurfaceMesh surface = polygoniseCase(source);
  EXPECT_EQ(surface.groups.size(), 1U);
  return toPatch(surface);
}

TEST(Polygonise, ABlobIsASphere) {
  constexpr double kWidth = 0.5, kCell = 0.2;
  const double radius = formats::isoRadius(formats::Kernel::Cauchy, 0.2, kWidth, 0.1);
  const TriangleMesh patch = onlyPatch(test::sphereCase(radius, kWidth));
  const Eigen::Vector3d centre(0.03F, 0.05F, 0.07F);
  for (const Eigen::Vector3d& p : patch.position)
    EXPECT_NEAR((p - centre).norm(), radius, 1e-3 * kCell);
  const test::MeshFacts facts = measureFacts(patch);
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(facts.euler, 2);
  const double volume = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
  const double area = 4 * std::numbers::pi * radius * radius;
  EXPECT_GT(facts.volume, 0.98 * volume);  // chords lie inside
  EXPECT_LT(facts.volume, volume);
  EXPECT_NEAR(facts.area, area, 0.01 * area);
}

TEST(Polygonise, NormalsPointOutwardWithUnitLength) {
  const SurfaceMesh surface = polygoniseCase(test::sphereCase(1.0, 0.43));
  const Eigen::Vector3f centre(0.03F, 0.05F, 0.07F);
  for (std::size_t v = 0; v < surface.position.size(); ++v) {
    const Eigen::Vector3f normal(surface.normal[v].data());
    const Eigen::Vector3f position(surface.position[v].data());
    EXPECT_NEAR(normal.norm(), 1, 1e-6);
    EXPECT_GT(normal.dot((position - centre).normalized()), 0.99999);
  }
}

TEST(Polygonise, PatchesOfATubeMeetOnTheRadicalPlanesAndItsEndsAreFlat) {
  // Nodes at x = 0.03 + i: planes halfway; ends half a height (1) beyond the last nodes.
  const TriangleMesh patch = onlyPatch(test::tubeCase(4));
  const test::MeshFacts facts = measureFacts(patch);
  EXPECT_EQ(facts.badEdges, 0U);
  std::set<std::ptrdiff_t> found;
  for (const std::uint32_t v : facts.boundary) {
    const double x = patch.position[v].x() - 0.03;
    const std::array<double, 5> planes{-1.0, 0.5, 1.5, 2.5, 4.0};
    const auto nearest = std::min_element(planes.begin(), planes.end(), [x](double a, double b) {
      return std::abs(a - x) < std::abs(b - x);
    });
    EXPECT_NEAR(x, *nearest, 2e-4 * 0.2);
    const auto plane = nearest - planes.begin();
    found.insert(plane);
    if (plane != 0 && plane != 4) {
      EXPECT_NEAR(test::offAxis(patch.position[v]), 1.0, 0.04);
    }
  }
  EXPECT_EQ(found.size(), 5U);
}

TEST(Polygonise, ATubeHasItsRadius) {
  const TriangleMesh patch = onlyPatch(test::tubeCase(8));
  for (const Eigen::Vector3d& p : patch.position)
    if (p.x() > 2 && p.x() < 5.5) {
      EXPECT_NEAR(test::offAxis(p), 1.0, 0.03);
    }
}

// A bent parent and a child that leaves it at a right angle, with models that disagree at seams by
// up to 3 % of the radius.
formats::Case disagreeingFork() {
  formats::Case source;
  source.metadata.voxelSize = 0.2;
  std::vector<Eigen::Vector3d> arc;
  for (int i = 0; i < 9; ++i)
    arc.emplace_back(5 * std::sin(0.15 * i), 5 - 5 * std::cos(0.15 * i), 0.07);
  test::addVessel(source, "parent", arc, 1.0, 1.5);
  test::addVessel(source, "child", test::straightPath(arc[4], {0.02, 0.1, 0.7}, 8), 0.6, 1.0, 4);
  test::addModels(source);
  formats::BlobbyModels& models = *source.models;
  for (std::size_t node = 0; node + 1 < models.offset.size(); ++node)
    for (std::uint32_t j = models.offset[node]; j < models.offset[node + 1]; ++j)
      models.width[j] *= 1.0F + 0.03F * static_cast<float>(node % 3);
  return source;
}

std::uint32_t leastPowerIn(const formats::Case& source, const formats::Branch& branch,
                           const field::Vec& p) {
  const auto power = [&](std::uint32_t node) {
    const formats::Vec3f& c = source.tree.centre[node];
    const double r = source.tree.radius[node];
    const field::Vec d = p - field::Vec{c.x, c.y, c.z};
    return dot(d, d) - r * r;
  };
  std::uint32_t best = branch.firstNode;
  for (std::uint32_t i = 1; i < branch.nodeCount; ++i)
    if (power(branch.firstNode + i) < power(best)) best = branch.firstNode + i;
  return best;
}

TEST(Polygonise, VerticesLieOnTheBlendedSurface) {
  const formats::Case source = disagreeingFork();
  const field::BlendedField surface = formats::caseField(source);
  const SurfaceMesh mesh = polygoniseCase(source);
  for (std::size_t v = 0; v < mesh.position.size(); ++v) {
    const Float3& vertex = mesh.position[v];
    const field::Vec p{vertex[0], vertex[1], vertex[2]};
    const std::uint32_t node =
        surface.follow(p, leastPowerIn(source, source.tree.branches[mesh.branch[v]], p));
    const field::Jet<1> f = surface.blended(p, node);
    const double slope = Eigen::Vector3d(f.gradient).norm();
    EXPECT_LT(std::abs(f.value - surface.level()) / slope, 1e-3 * source.tree.radius[node])
        << "at " << p.x << ", " << p.y << ", " << p.z << " near node " << node;
  }
}

// Blobs beyond the vessel's end, as a fit may leave them, do not lengthen it.
TEST(Polygonise, CutsAVesselsFreeEndAndLeavesAnAneurysmsDome) {
  formats::Case source = test::tubeCase(5);
  const auto highest = [](const TriangleMesh& patch) {
    double x = -1e9;
    for (const Eigen::Vector3d& p : patch.position) x = std::max(x, p.x());
    return x;
  };
  EXPECT_NEAR(highest(onlyPatch(source)), 4.03 + 1.0, 1e-4);
  source.tree.branches[0].kind = formats::BranchKind::Aneurysm;
  const TriangleMesh whole = onlyPatch(source);
  EXPECT_GT(highest(whole), 4.03 + 1.2);
}

TEST(Polygonise, KissingVesselsStayTwoGroups) {
  formats::Case source;
  source.metadata.voxelSize = 0.2;
  test::addVessel(source, "left", test::straightPath({0, 0, 0}, {1, 0, 0}, 6), 1.0, 2.0);
  test::addVessel(source, "right", test::straightPath({0.013, 2, 0.017}, {1, 0, 0}, 6), 1.0, 2.0);
  test::addModels(source);
  const SurfaceMesh surface = polygoniseCase(source);
  std::array<std::set<std::array<float, 3>>, 2> points;
  for (std::size_t f = 0; f < surface.triangle.size(); ++f)
    for (const std::uint32_t v : surface.triangle[f]) {
      const std::uint32_t branch = surface.branch[v];
      EXPECT_EQ(branch, surface.group[f]);
      const Float3& p = surface.position[v];
      EXPECT_LT(std::abs(p[1] - 2.0F * static_cast<float>(branch)), 1.05F);
      points.at(branch).insert(p);
    }
  EXPECT_FALSE(points[0].empty());
  EXPECT_FALSE(points[1].empty());
  for (const auto& p : points[0]) EXPECT_FALSE(points[1].contains(p));
  EXPECT_EQ(surface.groups,
            (std::vector<FaceGroup>{{"left", FaceKind::Wall}, {"right", FaceKind::Wall}}));
  EXPECT_EQ(surface.labels, (std::vector<std::string>{"left", "right"}));
}

TEST(Polygonise, VerticesHaveTheRadiusAndTheInlierRateOfTheirPlaceAlongTheVessel) {
  formats::Case source = test::tubeCase(5);
  EXPECT_TRUE(polygoniseCase(source).confidence.empty());
  for (std::size_t i = 0; i < 5; ++i) {
    source.tree.radius[i] = 1 + 0.1F * static_cast<float>(i);
    source.tree.inlierRate.push_back(0.5F + 0.1F * static_cast<float>(i));
  }
  const SurfaceMesh surface = polygoniseCase(source);
  for (std::size_t v = 0; v < surface.position.size(); ++v) {
    const float along = std::clamp(surface.position[v][0] - 0.03F, 0.0F, 4.0F);
    EXPECT_NEAR(surface.radius[v], 1 + 0.1 * along, 1e-5);
    EXPECT_NEAR(surface.confidence[v], 0.5 + 0.1 * along, 1e-5);
  }
}

TEST(Polygonise, DropsWhatDoesNotHangTogetherWithTheNodesLumen) {
  formats::Case source = test::sphereCase(1.0, 0.43);
  source.models->offset = {0, 2};
  source.models->centre.push_back({0.03F, 4.05F, 0.07F});
  source.models->width.push_back(0.43F);
  const TriangleMesh patch = onlyPatch(source);
  EXPECT_EQ(measureFacts(patch).euler, 2);
  for (const Eigen::Vector3d& p : patch.position) EXPECT_LT(p.y(), 2);
}

TEST(Polygonise, ANodeWithoutBlobsIsCoveredByItsNeighbours) {
  formats::Case source = test::tubeCase(5);
  formats::BlobbyModels& models = *source.models;
  const std::uint32_t first = models.offset[2], count = models.offset[3] - first;
  models.centre.erase(models.centre.begin() + first, models.centre.begin() + first + count);
  models.width.erase(models.width.begin() + first, models.width.begin() + first + count);
  for (std::size_t i = 3; i < models.offset.size(); ++i) models.offset[i] -= count;
  const test::MeshFacts whole = measureFacts(onlyPatch(test::tubeCase(5)));
  EXPECT_NEAR(measureFacts(onlyPatch(source)).area, whole.area, 0.02 * whole.area);
}

TEST(Polygonise, AVesselThinnerThanACellStaysInOnePiece) {
  formats::Case source;
  source.metadata.voxelSize = 0.2;
  test::addVessel(source, "thin", test::straightPath({0, 0, 0}, {0.12, 0.03, 0.02}, 20), 0.1, 0.2);
  test::addModels(source);
  const double area = measureFacts(onlyPatch(source)).area;
  const double length = 19 * std::hypot(0.12, 0.03, 0.02) + 0.2;
  EXPECT_NEAR(area, 2 * std::numbers::pi * 0.1 * length, 0.1 * area);
}

TEST(Polygonise, GivesTheSameBytesOnOneThreadAndOnTwo) {
  formats::Case source = test::tubeCase(12);
  test::addVessel(source, "side", test::straightPath({6.03, 1.2, 0.07}, {0, 0.6, 0.1}, 6), 0.5, 1.0,
                  6);
  test::addModels(source);
  std::array<std::string, 2> bytes;
  for (const std::size_t threads : {1U, 2U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    bytes[threads - 1] = encodeGltf(std::array{polygoniseCase(source)}, true, {});
  }
  EXPECT_EQ(bytes[0], bytes[1]);
}

ErrorKind errorOf(const formats::Case& source, double cell) {
  try {
    patchesOf(source, cell);
  } catch (const Error& error) {
    return error.kind();
  }
  return ErrorKind{0};
}

TEST(Polygonise, RefusesACaseWithoutModelsOrWithoutACellSize) {
  formats::Case source = test::tubeCase(3);
  EXPECT_EQ(errorOf(source, -1), ErrorKind::InvalidInput);
  EXPECT_EQ(errorOf(source, 1e-6), ErrorKind::InvalidInput);
  source.metadata.voxelSize.reset();
  EXPECT_EQ(errorOf(source, 0), ErrorKind::InvalidInput);
  EXPECT_EQ(errorOf(source, 0.2), ErrorKind{0});
  source.models.reset();
  EXPECT_EQ(errorOf(source, 0.2), ErrorKind::InvalidInput);
}

/// A tube of 1 mm, and a side branch of 0.1 mm.
formats::Case wideAndThin() {
  formats::Case source;
  source.metadata.voxelSize = 0.1;
  test::addVessel(source, "wide", test::straightPath({0, 0, 0}, {0.5, 0, 0}, 12), 1.0, 1.0);
  test::addVessel(source, "thin", test::straightPath({0, 9, 0}, {0.05, 0, 0}, 12), 0.1, 0.1);
  test::addModels(source);
  return source;
}

TEST(Polygonise, CountsWhatCellsThatAreTooCoarseMiss) {
  for (const double cell : {0.0, 0.4})
    for (const BranchLosses& losses : patchesOf(wideAndThin(), cell).losses) {
      EXPECT_FALSE(losses.any()) << cell;
      EXPECT_EQ(losses.nodes, 12U);
      EXPECT_GT(losses.triangles, 0U);
    }
  const std::vector<BranchLosses> losses = patchesOf(wideAndThin(), 4.0).losses;
  ASSERT_EQ(losses.size(), 2U);
  EXPECT_FALSE(losses[0].any());
  EXPECT_TRUE(losses[1].any());
  EXPECT_NEAR(losses[1].thinnest, 0.1, 1e-6);
  // a cell that the counts lead to keeps all
  for (const BranchLosses& kept : patchesOf(wideAndThin(), coarsestCellFor(0.1)).losses)
    EXPECT_FALSE(kept.any());
}

TEST(Polygonise, CellThatIsTooSmallIsRefusedWithOneThatWillDo) {
  for (const double cell : {1e-9, 1e-6, 1e-4}) {
    std::string message;
    try {
      patchesOf(test::tubeCase(3), cell);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
      message = error.what();
    }
    const std::string words = "expected a cell of ";
    const auto at = message.find(words);
    ASSERT_NE(at, std::string::npos) << cell << message;
    const double enough = std::stod(message.substr(at + words.size()));
    EXPECT_GT(enough, cell);
    EXPECT_LT(enough, 0.01);
    EXPECT_NO_THROW(checkCell(test::tubeCase(3), enough));
  }
}

TEST(Polygonise, StopsWhenCancelled) {
  Progress progress;
  progress.cancel();
  try {
    polygonise(test::tubeCase(3), {}, progress);
    FAIL() << "it went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Cancelled);
  }
}

}  // namespace
}  // namespace lumen::convert
