// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/anatomy/aortic_arch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/base/vectors.h"
#include "converters/stages/phantom/design.h"

namespace lumen::convert {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using formats::CenterlineTree;

enum class ArchBranches : std::uint8_t {
  Standard,
  CommonOrigin,  ///< of trunk and left carotid artery
  CarotidFromTrunk,
  LeftVertebral,  ///< leaves the arch
  LateRight,      ///< the right subclavian artery leaves the arch last
  TrunkAlone
};

/// An aortic arch of an adult's proportions whose branches have their true names. Lengths in mm,
/// widths are radii over that of the aorta.
struct DrawnArch {
  ArchBranches branches = ArchBranches::Standard;
  double toLeft = 45;  ///< degrees of the arch's plane from backwards
  double radius = 13, bend = 36, ascending = 50,
         lean = 17;  ///< the last: degrees of the ascending aorta
  double neck = 70;  ///< how far vessels are seen above
  double trunk = 0.48, carotid = 0.28, subclavian = 0.36, taper = 0.85, side = 0;
  double trunkLength = 51, vertebral = 0.15;
  bool isFromBelow = false;  ///< the root is the end of the descending aorta

  [[nodiscard]] Vector3d onArch(double degrees) const {
    const double plane = toLeft * std::numbers::pi / 180, a = degrees * std::numbers::pi / 180;
    const Vector3d back{std::sin(plane), std::cos(plane), 0};
    return bend * (-std::cos(a) * back + std::sin(a) * Vector3d::UnitZ());
  }

  [[nodiscard]] CenterlineTree tree() const {
    TreeBuilder builder(Frame{2, 0});
    const std::uint32_t arch = addAorta(builder);
    addRight(builder, arch);
    if (branches != ArchBranches::TrunkAlone) addLeft(builder, arch);
    return builder.tree();
  }

private:
  std::uint32_t add(TreeBuilder& builder, const char* name, std::uint32_t parent,
                    const Vector3d& from, const Vector3d& way, double width) const {
    return builder.add(name, std::int32_t(parent),
                       straightPath(from, from + way, constant(width * radius)));
  }

  std::uint32_t addAorta(TreeBuilder& builder) const {
    const auto turned = [&](Path path) {
      if (isFromBelow) std::reverse(path.begin(), path.end());
      return path;
    };
    const double leaning = lean * std::numbers::pi / 180;
    const Vector3d start =
        onArch(0) - ascending * Vector3d(0, -std::sin(leaning), std::cos(leaning));
    const Vector3d end = onArch(180) - 150 * Vector3d::UnitZ();
    const Path rising = turned(straightPath(start, onArch(0), constant(1.12 * radius))),
               falling = turned(straightPath(onArch(180), end, constant(taper * radius)));
    const auto root = builder.add(isFromBelow ? "descending_aorta" : "ascending_aorta",
                                  formats::kNoParent, isFromBelow ? falling : rising);
    const auto arch =
        builder.add("aortic_arch", std::int32_t(root),
                    turned(sampleCurve([&](double t) { return onArch(180 * t); },
                                       [&](double t) { return radius * (1 - (1 - taper) * t); })));
    builder.add(isFromBelow ? "ascending_aorta" : "descending_aorta", std::int32_t(arch),
                isFromBelow ? rising : falling);
    if (side > 0) add(builder, "side", arch, onArch(30), {60, 0, 0}, side);
    return arch;
  }

  void addRight(TreeBuilder& builder, std::uint32_t arch) const {
    const Vector3d origin = onArch(65);
    if (branches == ArchBranches::LateRight) {
      add(builder, "common_carotid_artery_right", arch, origin, {-32, 2, 44 + neck}, carotid);
      add(builder, "subclavian_artery_right", arch, onArch(140), {-90, 10, 65}, subclavian);
      return;
    }
    const Vector3d fork = origin + trunkLength * Vector3d(-26, 2, 44).normalized();
    const auto stem = add(builder, "brachiocephalic_trunk", arch, origin, fork - origin, trunk);
    add(builder, "common_carotid_artery_right", stem, fork, {-6, 0, neck}, carotid);
    const auto right =
        add(builder, "subclavian_artery_right", stem, fork, {-75, 10, 18}, 0.95 * subclavian);
    add(builder, "vertebral_artery_right", right, fork + Vector3d(-20, 3, 5), {3, 5, neck}, 0.14);
    if (branches == ArchBranches::CarotidFromTrunk)
      add(builder, "common_carotid_artery_left", stem, origin + 0.4 * (fork - origin),
          {38, 2, 20 + neck}, carotid);
  }

  void addLeft(TreeBuilder& builder, std::uint32_t arch) const {
    if (branches != ArchBranches::CarotidFromTrunk)
      add(builder, "common_carotid_artery_left", arch,
          onArch(branches == ArchBranches::CommonOrigin ? 65 : 88), {18, -2, 40 + neck}, carotid);
    const Vector3d dome = onArch(112) + Vector3d(20, 4, 50);
    const auto left =
        add(builder, "subclavian_artery_left", arch, onArch(112), {20, 4, 50}, subclavian);
    add(builder, "subclavian_artery_left", left, dome, {60, 0, 5}, 0.9 * subclavian);
    if (branches == ArchBranches::LeftVertebral)
      add(builder, "vertebral_artery_left", arch, onArch(100), {10, 5, 40 + neck}, vertebral);
    else
      add(builder, "vertebral_artery_left", left, dome, {-3, 5, neck}, 0.14);
  }
};

CenterlineTree movedBy(CenterlineTree tree, const Matrix3d& by) {
  for (formats::Vec3f& centre : tree.centre) {
    const Vector3d to = by * toEigen(centre);
    centre = {float(to.x()), float(to.y()), float(to.z())};
  }
  for (float& radius : tree.radius) radius *= float(std::cbrt(std::abs(by.determinant())));
  return tree;
}

Matrix3d turnAbout(int axis, double degrees) {
  return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vector3d::Unit(axis))
      .toRotationMatrix();
}

Matrix3d mirrored(int axis) {
  Matrix3d mirror = Matrix3d::Identity();
  mirror(axis, axis) = -1;
  return mirror;
}

/// Centres move by up to 1 mm on each axis, and radii change by up to a fifth.
CenterlineTree noisy(CenterlineTree tree, std::uint64_t seed) {
  Random random(seed);
  for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
    const Vector3d to = toEigen(tree.centre[n]) + randomInCube(random);
    tree.centre[n] = {float(to.x()), float(to.y()), float(to.z())};
    tree.radius[n] *= float(1 + 0.2 * randomInCube(random).x());
  }
  return tree;
}

/// The share of each true artery's nodes that has its name, and the number of those that have the name
/// of another one. Where the aorta's parts begin is a matter of definition.
struct ArchShares {
  explicit ArchShares(const CenterlineTree& tree) {
    std::vector<std::string> name(tree.nodeCount());
    for (const ArteryStretch& stretch : nameAorticArch(tree)) {
      EXPECT_GE(stretch.plausibility, kLeastPlausibility);
      for (std::uint32_t n = stretch.first; n < stretch.end; ++n) {
        EXPECT_EQ(tree.branch[n], stretch.branch);
        name[n] = stretch.name;
      }
    }
    std::map<std::string, double> count;
    for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
      const std::string& artery = tree.branches[tree.branch[n]].label;
      count[artery] += 1;
      right[artery] += name[n] == artery ? 1 : 0;
      const bool isPart =
          artery.find("aort") != std::string::npos && name[n].find("aort") != std::string::npos;
      wrong += name[n].empty() || name[n] == artery || isPart ? 0 : 1;
    }
    for (auto& [artery, share] : right) share /= count[artery];
  }

  std::map<std::string, double> right;
  int wrong = 0;
};

void expectAll(const CenterlineTree& tree, double least = 0.6) {
  const ArchShares shares(tree);
  EXPECT_EQ(shares.wrong, 0);
  for (const auto& [artery, share] : shares.right)
    if (artery.starts_with("vertebral"))
      EXPECT_EQ(share, 0) << artery;
    else
      EXPECT_GT(share, artery == "aortic_arch" ? 0.3 : least) << artery;
}

TEST(AorticArch, EachArteryOfAnArchHasItsName) {
  expectAll(DrawnArch{}.tree());
  expectAll(DrawnArch{.ascending = 15}.tree());
  expectAll(DrawnArch{.isFromBelow = true}.tree());
}

TEST(AorticArch, EachArteryOfAVariantHasItsName) {
  for (const auto branches :
       {ArchBranches::CommonOrigin, ArchBranches::CarotidFromTrunk, ArchBranches::LeftVertebral})
    expectAll(DrawnArch{.branches = branches}.tree());
}

TEST(AorticArch, ATurnedBodyHasNoWrongName) {
  for (const auto branches : {ArchBranches::Standard, ArchBranches::CommonOrigin,
                              ArchBranches::CarotidFromTrunk, ArchBranches::LeftVertebral})
    for (int axis = 0; axis < 3; ++axis)
      for (const double degrees : {-15.0, 15.0}) {
        const CenterlineTree tree = DrawnArch{.branches = branches}.tree();
        // a left carotid artery of the trunk that leans to the right is not known
        if (branches == ArchBranches::CarotidFromTrunk && axis == 1 && degrees < 0)
          EXPECT_EQ(ArchShares(movedBy(tree, turnAbout(axis, degrees))).wrong, 0);
        else
          expectAll(movedBy(tree, turnAbout(axis, degrees)));
      }
}

TEST(AorticArch, AMirroredArchHasNoName) {
  const CenterlineTree tree = movedBy(DrawnArch{}.tree(), mirrored(0));
  EXPECT_TRUE(nameAorticArch(tree).empty());
  for (int axis = 0; axis < 3; ++axis)
    for (const double degrees : {-15.0, 15.0})
      EXPECT_TRUE(nameAorticArch(movedBy(tree, turnAbout(axis, degrees))).empty());
  EXPECT_TRUE(nameAorticArch(movedBy(DrawnArch{}.tree(), mirrored(1))).empty());
  EXPECT_TRUE(nameAorticArch(movedBy(DrawnArch{}.tree(), mirrored(2))).empty());
}

TEST(AorticArch, NoiseTakesNoName) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    expectAll(noisy(DrawnArch{}.tree(), seed), 0.3);  // where names end by length
}

TEST(AorticArch, ARightSubclavianArteryThatIsLastLeavesTheBranchesUnnamed) {
  const CenterlineTree tree = DrawnArch{.branches = ArchBranches::LateRight}.tree();
  const ArchShares shares(tree);
  EXPECT_EQ(shares.wrong, 0);
  EXPECT_EQ(shares.right.at("common_carotid_artery_right"), 0);
  EXPECT_GT(shares.right.at("descending_aorta"), 0.9);
}

TEST(AorticArch, OtherVesselsHaveNoName) {
  EXPECT_TRUE(nameAorticArch({}).empty());
  EXPECT_TRUE(nameAorticArch(designWillis({0.2, 51}, {}).tree).empty());
  EXPECT_TRUE(nameAorticArch(designBifurcation({0.2, 51}).tree).empty());
  EXPECT_TRUE(nameAorticArch(DrawnArch{.branches = ArchBranches::TrunkAlone}.tree()).empty());
}

TEST(AorticArch, AVolumeThatEndsLowHasNoRightCarotidArtery) {
  const ArchShares shares(DrawnArch{.neck = 5}.tree());
  EXPECT_EQ(shares.wrong, 0);
  EXPECT_EQ(shares.right.at("common_carotid_artery_right"), 0);
  EXPECT_GT(shares.right.at("brachiocephalic_trunk"), 0.8);
}

bool isNamed(const DrawnArch& arch, const char* artery) {
  const auto stretches = nameAorticArch(arch.tree());
  return std::any_of(stretches.begin(), stretches.end(),
                     [&](const ArteryStretch& stretch) { return stretch.name == artery; });
}

/// The value of a proportion at which an artery gets or loses its name, between two others.
TEST(AorticArch, NamesEndWhereProportionsAreUnusual) {
  struct Edge {
    double DrawnArch::*proportion;
    const char* artery;
    double named, unnamed;
  };
  const char *const arch = "aortic_arch", *const trunk = "brachiocephalic_trunk",
                    *const carotid = "common_carotid_artery_left",
                    *const subclavian = "subclavian_artery_left";
  const std::vector<Edge> edges = {
      {&DrawnArch::toLeft, arch, 3, 0},
      {&DrawnArch::toLeft, arch, 87, 91},
      {&DrawnArch::bend, arch, 15, 13},
      {&DrawnArch::bend, arch, 80, 93},
      {&DrawnArch::radius, arch, 6, 3},
      {&DrawnArch::radius, arch, 25, 30},
      {&DrawnArch::ascending, "ascending_aorta", 80, 100},
      {&DrawnArch::taper, arch, 1.4, 1.6},
      {&DrawnArch::side, arch, 0.72, 0.82},
      {&DrawnArch::trunk, trunk, 0.22, 0.18},
      {&DrawnArch::trunk, trunk, 0.7, 0.8},
      {&DrawnArch::trunkLength, "common_carotid_artery_right", 65, 80},
      {&DrawnArch::carotid, carotid, 0.11, 0.08},
      {&DrawnArch::carotid, carotid, 0.45, 0.52},
      {&DrawnArch::subclavian, subclavian, 0.13, 0.1},
      {&DrawnArch::subclavian, subclavian, 0.55, 0.62},
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    DrawnArch drawn;
    drawn.*edges[i].proportion = edges[i].named;
    EXPECT_TRUE(isNamed(drawn, edges[i].artery)) << i;
    drawn.*edges[i].proportion = edges[i].unnamed;
    EXPECT_FALSE(isNamed(drawn, edges[i].artery)) << i;
  }
}

}  // namespace
}  // namespace lumen::convert
