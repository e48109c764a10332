// SPDX-License-Identifier: Apache-2.0
// Arteries and veins that touch stay two systems: labels alone, and a map beside a grey volume.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/base/vectors.h"
#include "converters/operations/case_of.h"
#include "formats/case/topology.h"
#include "formats/case/validate.h"
#include "formats/case/vessel_system.h"

namespace lumen::operations {
namespace {

using Eigen::Vector3d;
using formats::VesselSystem;

struct DrawnVessel {
  int label = 0;
  double radius = 0;  ///< mm
  std::vector<Vector3d> line;
};

double away(const DrawnVessel& vessel, const Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < vessel.line.size(); ++i) {
    const Vector3d a = vessel.line[i - 1], ab = vessel.line[i] - a;
    const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - a - t * ab).norm());
  }
  return least;
}

/// An artery (label 1) and a vein (2) of two thirds of its width beside it, which touch over 40 % of
/// their 90 mm; a branch of the artery crosses the vein and touches it, too, and so does one of the
/// vein the artery.
const std::vector<DrawnVessel>& drawnVessels() {
  static const std::vector<DrawnVessel> vessels = {
      {1, 4, {{-5, 30, 24}, {95, 30, 24}}},
      {2, 3, {{-5, 58, 24}, {14, 44, 24}, {27, 37, 24}, {63, 37, 24}, {76, 44, 24}, {95, 58, 24}}},
      {1, 2.5, {{45, 30, 24}, {45, 34, 29.5}, {45, 44, 29.5}, {45, 66, 29.5}}},
      {2, 2.2, {{30, 37, 24}, {26, 33, 17.9}, {20, 20, 17.9}, {14, -5, 17.9}}}};
  return vessels;
}

convert::VolumeGeometry drawnGrid() {
  convert::VolumeGeometry geometry;
  geometry.size = {90, 62, 46};
  return geometry;
}

/// The label of the vessel whose wall is deepest below a place; 0 outside of all.
int labelAt(const Vector3d& p) {
  int label = 0;
  double depth = 0;
  for (const DrawnVessel& vessel : drawnVessels())
    if (const double own = vessel.radius - away(vessel, p); own > depth) {
      depth = own;
      label = vessel.label;
    }
  return label;
}

LabelPart drawnLabels() {
  LabelPart map;
  map.name = "map.nrrd";
  map.voxels.geometry = drawnGrid();
  std::vector<std::uint8_t> voxels;
  drawnGrid().cells().forEach([&](const convert::Cell& cell) {
    voxels.push_back(static_cast<std::uint8_t>(labelAt(cell.cast<double>())));
  });
  map.voxels.voxels = std::move(voxels);
  for (const auto& [value, name, role] : {std::tuple{1, "artery", convert::LabelRole::Artery},
                                          std::tuple{2, "vein", convert::LabelRole::Vein}}) {
    convert::LabelMeaning meaning;
    meaning.value = value;
    meaning.name = name;
    meaning.role = role;
    meaning.isStated = true;
    map.meanings.push_back(meaning);
  }
  return map;
}

/// The vessels without their labels: 1000 within, 0 outside, a rim a voxel wide, and noise.
convert::Volume drawnVolume() {
  convert::Volume volume;
  volume.geometry = drawnGrid();
  Random random(3);
  std::vector<std::int16_t> voxels;
  drawnGrid().cells().forEach([&](const convert::Cell& cell) {
    double inside = 0;
    for (const DrawnVessel& vessel : drawnVessels())
      inside = std::max(
          inside, std::clamp(0.5 + vessel.radius - away(vessel, cell.cast<double>()), 0.0, 1.0));
    voxels.push_back(static_cast<std::int16_t>(1000 * inside + 30 * random.normal()));
  });
  volume.voxels = std::move(voxels);
  return volume;
}

/// Edges and links between nodes of systems that are never joined.
std::size_t countJoins(const formats::Case& value) {
  const std::vector<VesselSystem> systems = formats::readNodeSystems(value);
  std::size_t joins = 0;
  for (std::size_t n = 0; n < systems.size(); ++n)
    if (const std::int32_t parent = value.tree.parent[n]; parent >= 0)
      joins += formats::areApart(systems[n], systems[static_cast<std::size_t>(parent)]) ? 1 : 0;
  for (const auto& [a, b] : value.tree.links)
    joins += formats::areApart(systems[a], systems[b]) ? 1 : 0;
  return joins;
}

/// The share of the nodes whose system is that of the drawn vessel whose axis is nearest, in radii.
double shareRight(const formats::Case& value) {
  const std::vector<VesselSystem> systems = formats::readNodeSystems(value);
  std::size_t right = 0;
  for (std::size_t n = 0; n < systems.size(); ++n) {
    const Vector3d p = toEigen(value.tree.centre[n]);
    const auto nearest = std::min_element(drawnVessels().begin(), drawnVessels().end(),
                                          [&](const auto& a, const auto& b) {
                                            return away(a, p) / a.radius < away(b, p) / b.radius;
                                          });
    right +=
        systems[n] == (nearest->label == 1 ? VesselSystem::Artery : VesselSystem::Vein) ? 1 : 0;
  }
  return static_cast<double>(right) / static_cast<double>(systems.size());
}

void expectTwoSystems(const formats::Case& value) {
  ASSERT_TRUE(formats::validate(value));
  EXPECT_EQ(countJoins(value), 0U);
  EXPECT_GE(shareRight(value), 0.99);
  std::size_t roots = 0, vessels = 0;
  double length = 0;
  std::string lengths;
  for (const formats::Branch& branch : value.tree.branches) {
    lengths +=
        branch.label + " " + std::to_string(formats::branchLength(value.tree, branch)) + "\n";
    EXPECT_EQ(branch.kind, formats::BranchKind::Vessel) << branch.label;
    roots += branch.parentNode < 0 ? 1 : 0;
    vessels += formats::branchLength(value.tree, branch) > 1 ? 1 : 0;  // no stub within its parent
    length += formats::branchLength(value.tree, branch);
  }
  EXPECT_EQ(roots, 2U);
  EXPECT_EQ(vessels, 4U) << lengths;
  EXPECT_NEAR(length, 90 + 103 + 32 + 38, 20);
}

TEST(VesselSystems, OfLabelsThatTouchStayTwo) {
  Progress progress;
  Source source;
  source.name = "labels";
  source.labels = drawnLabels();
  expectTwoSystems(caseOf(std::move(source), {}, Context{progress}).value);
}

TEST(VesselSystems, OfLabelsThatTouchHaveTheTreesOfEachLabelAlone) {
  Progress progress;
  const auto centresOf = [&](const std::set<std::int64_t>& chosen) {
    Source source;
    source.name = "labels";
    source.labels = drawnLabels();
    CaseOptions options;
    options.chosenLabels = chosen;
    return caseOf(std::move(source), options, Context{progress}).value.tree.centre;
  };
  std::vector<formats::Vec3f> apart = centresOf({1});
  for (const formats::Vec3f& centre : centresOf({2})) apart.push_back(centre);
  EXPECT_EQ(centresOf({1, 2}), apart);
}

TEST(VesselSystems, OfAVolumeWithAMapStayTwo) {
  Progress progress;
  Source source;
  source.name = "volume";
  source.grey = drawnVolume();
  source.maps.push_back(drawnLabels());
  expectTwoSystems(caseOf(std::move(source), {}, Context{progress}).value);
}

TEST(VesselSystems, AreUnknownWithoutAMap) {
  Progress progress;
  Source source;
  source.name = "volume";
  source.grey = drawnVolume();
  const formats::Case value = caseOf(std::move(source), {}, Context{progress}).value;
  EXPECT_TRUE(formats::knownBranchSystems(value).empty());
  EXPECT_EQ(std::count(value.metadata.extensionsUsed.begin(), value.metadata.extensionsUsed.end(),
                       formats::kSystemExtension),
            0);
}

}  // namespace
}  // namespace lumen::operations
