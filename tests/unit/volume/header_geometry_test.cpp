// SPDX-License-Identifier: Apache-2.0
// Where the voxels of NRRD and MetaImage lie: what their headers say, leave open, or get wrong.
#include <cmath>

#include <gtest/gtest.h>

#include "converters/geometry/far_origin.h"
#include "converters/io/volume/volume_checks.h"
#include "text_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Lines = std::vector<std::string>;

class HeaderGeometry : public TextVolume {
protected:
  static ReadVolumeOptions withSpacing(double mm) {
    ReadVolumeOptions options;
    options.spacing = Vector3d::Constant(mm);
    return options;
  }
  static ReadVolumeOptions withUnit(double mm) {
    ReadVolumeOptions options;
    options.unit = mm;
    return options;
  }
};

const std::string kAxes = "space directions: (0.5,0,0) (0,0.5,0) (0,0,2)";

TEST_F(HeaderGeometry, SpacesBecomeLps) {
  const std::vector<std::pair<std::string, Vector3d>> spaces = {
      {"left-posterior-superior", {1, 1, 1}},
      {"LPS", {1, 1, 1}},
      {"right-anterior-superior", {-1, -1, 1}},
      {"RAS", {-1, -1, 1}},
      {"right anterior superior", {-1, -1, 1}},
      {"left-anterior-superior", {1, -1, 1}},
      {"las", {1, -1, 1}}};
  for (const auto& [space, toLps] : spaces) {
    const Volume v = nrrd({"space: " + space, kAxes, "space origin: (10,20,30)"});
    EXPECT_EQ(v.geometry.spacing, Vector3d(0.5, 0.5, 2)) << space;
    EXPECT_EQ(v.geometry.origin, toLps.cwiseProduct(Vector3d(10, 20, 30))) << space;
    EXPECT_EQ(v.geometry.direction, Matrix3d(toLps.asDiagonal())) << space;
    EXPECT_TRUE(v.assumptions.empty()) << space;
  }
}

TEST_F(HeaderGeometry, ASpaceThatIsNoPatientsIsToldOf) {
  for (const char* space : {"scanner-xyz", "3D-right-handed", "3D-left-handed"})
    expectAssumes(nrrd({std::string("space: ") + space, kAxes}), {space, "LPS"});
}

TEST_F(HeaderGeometry, AMissingSpaceIsAssumedAndReported) {
  const Volume v = nrrd({"spacings: 1 1 1"});
  ASSERT_EQ(v.assumptions.size(), 1U);
  expectRefused(v.assumptions[0], {"states no space", "left, posterior and superior"});
  EXPECT_EQ(v.geometry.direction, Matrix3d::Identity());
}

TEST_F(HeaderGeometry, AMissingSpacingIsAssumedAndReported) {
  for (const Volume& v : {nrrd({}), nrrd({"spacings: nan nan nan"}), meta({"-ElementSpacing"})}) {
    EXPECT_EQ(v.geometry.spacing, Vector3d::Ones());
    expectAssumes(v, {"no spacing", "1 mm", "--spacing"});
  }
}

TEST_F(HeaderGeometry, AStatedSpacingTakesThePlaceOfAnyInTheHeader) {
  for (const Lines& lines : {Lines{}, Lines{"spacings: nan nan nan"}, Lines{"spacings: 0 -1 1e300"},
                             Lines{"spacings: 1 nan 1"}, Lines{"spacings: 2 2 2"}}) {
    const Volume v = nrrd(lines, eightBytes(), withSpacing(0.3));
    EXPECT_EQ(v.geometry.spacing, Vector3d::Constant(0.3));
    EXPECT_TRUE(assumptionsBesideSpace(v).empty());
  }
  EXPECT_EQ(meta({"ElementSpacing = nan 0 1"}, eightBytes(), withSpacing(0.3)).geometry.spacing,
            Vector3d::Constant(0.3));
}

TEST_F(HeaderGeometry, SpacingsThatAreNoDistancesAreRefusedWithTheOption) {
  for (const char* bad : {"0", "-1", "inf", "-inf", "1e-310", "1e300", "1e-9", "2e5"}) {
    expectRefused(nrrdRefusal({std::string("spacings: 1 ") + bad + " 1"}),
                  {"3: ", "axis 2", "--spacing"});
    expectRefused(metaRefusal({std::string("ElementSpacing = 1 1 ") + bad}),
                  {"3: ", "axis 3", "--spacing"});
  }
  expectRefused(metaRefusal({"ElementSpacing = 1 1 nan"}), {"3: ", "axis 3", "--spacing"});
  expectRefused(nrrdRefusal({"spacings: 1 nan 1"}), {"no spacing along axis 2", "--spacing"});
}

TEST_F(HeaderGeometry, NumbersAreWholeWords) {
  for (const char* bad :
       {"1 1 1x", "1 1", "1 1 1 1", "1 1 one", "1 1 0x10", "1 1 1,5", "1 1 --1", "1 1 +-1"}) {
    expectRefused(nrrdRefusal({std::string("spacings: ") + bad}),
                  {"3: ", "spacings is", "3 numbers"});
    expectRefused(metaRefusal({std::string("ElementSpacing = ") + bad}), {"3: ", "3 numbers"});
  }
  const std::vector<std::string> tooLarge = {"3: ", "a spacing of inf", "a positive number"};
  expectRefused(nrrdRefusal({"spacings: 1 1 1e400"}), tooLarge);
  expectRefused(metaRefusal({"ElementSpacing = 1 1 1e400"}), tooLarge);
  EXPECT_EQ(nrrd({"spacings: +1 2e0 .5"}).geometry.spacing, Vector3d(1, 2, 0.5));
}

TEST_F(HeaderGeometry, UnitsAreHonoured) {
  const std::vector<std::pair<std::string, double>> units = {
      {"mm", 1},          {"m", 1e3},     {"cm", 10},         {"um", 1e-3},
      {"Millimeters", 1}, {"meter", 1e3}, {"\xc2\xb5m", 1e-3}};
  for (const auto& [name, mm] : units) {
    const std::string three = "\"" + name + "\" \"" + name + "\" \"" + name + "\"";
    const double one = 0.5 / mm;  // so that it is 0.5 mm
    const std::string n = std::to_string(one);
    const Volume v = nrrd({"space: LPS", "space units: " + three,
                           "space directions: (" + n + ",0,0) (0," + n + ",0) (0,0," + n + ")",
                           "space origin: (" + n + ",0,0)"});
    EXPECT_LT((v.geometry.spacing - Vector3d::Constant(0.5)).norm(), 1e-6) << name;
    EXPECT_NEAR(v.geometry.origin[0], 0.5, 1e-6) << name;
    EXPECT_TRUE(v.assumptions.empty()) << name;
    const Volume w = nrrd({"units: " + three, "spacings: " + n + " " + n + " " + n});
    EXPECT_LT((w.geometry.spacing - Vector3d::Constant(0.5)).norm(), 1e-6) << name;
  }
  EXPECT_EQ(meta({"DistanceUnits = cm"}).geometry.spacing, Vector3d::Constant(10));
}

TEST_F(HeaderGeometry, UnknownUnitsAreAssumedToBeMmAndReported) {
  expectAssumes(nrrd({"space: LPS", kAxes, R"(space units: "foot" "foot" "foot")"}),
                {"space units", "foot", "mm", "--unit"});
  expectAssumes(meta({"DistanceUnits = parsec"}), {"DistanceUnits", "parsec", "mm", "--unit"});
  EXPECT_TRUE(nrrd({"space: LPS", kAxes, R"(space units: "" "" "")"}).assumptions.empty());
}

TEST_F(HeaderGeometry, DifferentUnitsAreRefused) {
  expectRefused(nrrdRefusal({"space: LPS", kAxes, R"(space units: "mm" "mm" "cm")"}),
                {"3: ", "space units", "--unit"});
}

TEST_F(HeaderGeometry, AStatedUnitScalesSpacingAndOrigin) {
  const Volume v = nrrd({"space: LPS", "space directions: (2e-4,0,0) (0,2e-4,0) (0,0,2e-4)",
                         "space origin: (0.1,0,0)", R"(space units: "mm" "mm" "mm")"},
                        eightBytes(), withUnit(1e3));
  EXPECT_LT((v.geometry.spacing - Vector3d::Constant(0.2)).norm(), 1e-12);
  EXPECT_NEAR(v.geometry.origin[0], 100, 1e-9);
  EXPECT_TRUE(v.assumptions.empty());
}

TEST_F(HeaderGeometry, AnUnusualSpacingIsSaidUnlessItIsStated) {
  const Lines metres = {"spacings: 2e-4 2e-4 2e-4"};
  expectAssumes(nrrd(metres), {"0.0002", "unusual", "--unit"});
  EXPECT_TRUE(assumptionsBesideSpace(nrrd(metres, eightBytes(), withUnit(1))).empty());
  expectAssumes(nrrd({"spacings: 0.2 0.2 0.2", R"(units: "m" "m" "m")"}),
                {"200", "unusual", "--unit"});
}

TEST_F(HeaderGeometry, OriginsAndDirectionsAreFinite) {
  for (const char* bad : {"nan", "inf", "1e400", "x"}) {
    const std::string b = bad;
    expectRefused(metaRefusal({"Offset = 0 " + b + " 0"}), {"3: "});
    expectRefused(metaRefusal({"TransformMatrix = 1 0 0 0 " + b + " 0 0 0 1"}), {"3: "});
    expectRefused(nrrdRefusal({"space: LPS", kAxes, "space origin: (0," + b + ",0)"}), {"3: "});
    expectRefused(nrrdRefusal({"space: LPS", "space directions: (1,0,0) (0,1,0) (0,0," + b + ")"}),
                  {"3: "});
  }
  expectAssumes(nrrd({"space: LPS", kAxes, "space origin: (nan,nan,nan)"}), {"origin", "0, 0, 0"});
}

TEST_F(HeaderGeometry, DirectionsMustBeVectorsOfTheSpace) {
  for (const char* bad : {"(1,0,0) (0,1,0)", "(1,0,0) (0,1,0) (0,0)", "(1,0,0) (0,1,0) (0,0,1",
                          "(1,0,0) (0,1,0) none", "1,0,0 0,1,0 0,0,1", "(1,0,0) (0,1,0) (0,0,1,0)",
                          "(1,0,0) (1,0,0) (0,0,1)"})
    expectRefused(nrrdRefusal({"space: LPS", std::string("space directions: ") + bad}), {"3: "});
  expectRefused(nrrdRefusal({"space: up", kAxes}), {"3: ", "space is", "\"up\""});
  expectRefused(nrrdRefusal({kAxes}), {"3: ", "no space"});
  expectRefused(nrrdRefusal({"space: LPS", kAxes, "spacings: 1 1 1"}), {"3: ", "both"});
}

TEST_F(HeaderGeometry, FieldsOfTwoNamesMayAgreeButNotDiffer) {
  EXPECT_EQ(meta({"Offset = 1 2 3", "Position = 1.0 2 3"}).geometry.origin, Vector3d(1, 2, 3));
  expectRefused(metaRefusal({"Offset = 1 2 3", "Origin = 1 2 4"}), {"3: ", "twice"});
  expectRefused(nrrdRefusal({"axis mins: 0 0 0", "axismins: 0 0 1"}), {"3: ", "twice"});
}

TEST_F(HeaderGeometry, AxisMinsArePlacesOfCellsUnlessTheyAreOfNodes) {
  const Lines lines = {"spacings: 1 2 4", "axis mins: 10 20 30"};
  EXPECT_EQ(nrrd(lines).geometry.origin, Vector3d(10.5, 21, 32));
  EXPECT_EQ(nrrd({lines[0], lines[1], "centers: node node node"}).geometry.origin,
            Vector3d(10, 20, 30));
  const Volume ends = nrrd({"axis mins: 0 0 0", "axis maxs: 2 4 8"});
  EXPECT_EQ(ends.geometry.spacing, Vector3d(1, 2, 4));
}

TEST_F(HeaderGeometry, AxesOfOneComponentOrOneTimeAreDropped) {
  const std::vector<Lines> headers = {
      {"dimension: 4", "sizes: 1 2 2 2", "kinds: list space space space", "space: LPS",
       "space directions: none (1,0,0) (0,1,0) (0,0,1)"},
      {"dimension: 4", "sizes: 2 2 1 2", "kinds: domain domain stub domain", "spacings: 1 1 nan 1"},
      {"dimension: 4", "sizes: 2 2 2 1", "spacings: 1 1 1 nan"},
      {"dimension: 4", "sizes: 1 2 2 2", "kinds: time space space space", "space: LPS",
       "space directions: none (1,0,0) (0,1,0) (0,0,1)"}};
  for (const Lines& lines : headers) {
    const Volume v = nrrd(lines);
    EXPECT_EQ(v.geometry.size, (std::array{2, 2, 2}));
    EXPECT_EQ(v.geometry.direction, Matrix3d::Identity());
    EXPECT_EQ(textOf(v), eightBytes());
  }
}

const std::string kAxesOfOne = "(1,0,0) (0,1,0) (0,0,1)";

// Two volumes of eight bytes, one after the other and in turns, as programs write them.
TEST_F(HeaderGeometry, OneOfSeveralVolumesIsChosenWhereverTheirAxisIs) {
  const std::string ordered = "abcdefghABCDEFGH", turns = "aAbBcCdDeEfFgGhH",
                    pairs = "abABcdCDefEFghGH";
  const std::vector<std::pair<Lines, std::string>> files = {
      {{"sizes: 2 2 2 2", "space dimension: 4", "kinds: domain domain domain domain",
        "space directions: (1,0,0,0) (0,1,0,0) (0,0,1,0) (0,0,0,1)", "space origin: (1,2,3,0)"},
       ordered},
      {{"sizes: 2 2 2 2", "space: left-posterior-superior-time",
        "space directions: (1,0,0,0) (0,1,0,0) (0,0,1,0) (0,0,0,0.5)", "space origin: (1,2,3,0)"},
       ordered},
      {{"sizes: 2 2 2 2", "space: LPS", "kinds: domain domain domain list",
        "space directions: " + kAxesOfOne + " none", "space origin: (1,2,3)"},
       ordered},
      {{"sizes: 2 2 2 2", "space: LPS", "kinds: list domain domain domain",
        "space directions: none " + kAxesOfOne, "space origin: (1,2,3)"},
       turns},
      {{"sizes: 2 2 2 2", "space: LPS", "kinds: time domain domain domain",
        "space directions: none " + kAxesOfOne, "space origin: (1,2,3)"},
       turns},
      {{"sizes: 2 2 2 2", "space: LPS", "kinds: vector domain domain domain",
        "space directions: none " + kAxesOfOne, "space origin: (1,2,3)"},
       turns},
      {{"sizes: 2 2 2 2", "space: LPS", "kinds: domain list domain domain",
        "space directions: (1,0,0) none (0,1,0) (0,0,1)", "space origin: (1,2,3)"},
       pairs},
      {{"sizes: 1 2 2 2 2", "space: LPS", "kinds: list time domain domain domain",
        "space directions: none none " + kAxesOfOne, "space origin: (1,2,3)"},
       turns},
      {{"sizes: 2 2 2 2", "kinds: list space space space", "spacings: nan 1 1 1"}, turns}};
  for (const auto& [lines, written] : files) {
    const std::string data = written;
    Lines all = lines;
    all.push_back(lines[0].starts_with("sizes: 1") ? "dimension: 5" : "dimension: 4");
    for (int index = 0; index < 2; ++index) {
      ReadVolumeOptions options;
      options.volumeIndex = index;
      const Volume v = nrrd(all, data, options);
      EXPECT_EQ(textOf(v), index == 0 ? "abcdefgh" : "ABCDEFGH") << lines[1];
      EXPECT_EQ(v.geometry.size, (std::array{2, 2, 2}));
      EXPECT_EQ(v.geometry.spacing, Vector3d(1, 1, 1));
    }
    expectRefused(refusal([&] { (void)nrrd(all, data); }), {"3: ", "volume-index"});
  }
}

TEST_F(HeaderGeometry, SpaceThatMovesWithTimeAndVolumesInTwoPlacesAreRefused) {
  ReadVolumeOptions options;
  options.volumeIndex = 1;
  const auto refused = [&](Lines lines, std::size_t bytes) {
    return refusal([&] { (void)nrrd(lines, std::string(bytes, 'a'), options); });
  };
  expectRefused(refused({"dimension: 4", "sizes: 2 2 2 2", "space dimension: 4",
                         "space directions: (1,0,0,0.5) (0,1,0,0) (0,0,1,0) (0,0,0,1)"},
                        16),
                {"3: ", "space directions"});
  expectRefused(refused({"dimension: 5", "sizes: 2 2 2 2 2", "space: LPS",
                         "kinds: list domain domain domain time",
                         "space directions: none " + kAxesOfOne + " none"},
                        32),
                {"3: ", "5-D"});
}

TEST_F(HeaderGeometry, LayersOfSegmentsAreNamedWhereNoneIsChosen) {
  const Lines lines = {"dimension: 4",
                       "sizes: 2 2 2 2",
                       "space: LPS",
                       "kinds: list domain domain domain",
                       "space directions: none " + kAxesOfOne,
                       "Segment0_Name:=trunk",
                       "Segment0_Layer:=0",
                       "Segment1_Name:=arms",
                       "Segment1_Layer:=1"};
  expectRefused(refusal([&] { (void)nrrd(lines, "aAbBcCdDeEfFgGhH"); }),
                {"3: ", "2 layers of segments (0 with trunk; 1 with arms)", "volume-index"});
}

TEST_F(HeaderGeometry, MatricesOfMetaImageAreAxesOneAfterTheOther) {
  for (const char* name : {"TransformMatrix", "Rotation", "Orientation"}) {
    const Volume v = meta({std::string(name) + " = 0 1 0 -1 0 0 0 0 1"});
    EXPECT_EQ(v.geometry.direction.col(0), Vector3d(0, 1, 0)) << name;
    EXPECT_EQ(v.geometry.direction.col(1), Vector3d(-1, 0, 0)) << name;
  }
}

TEST(FarOrigin, IsMovedByTensOfMetres) {
  VolumeGeometry geometry;
  std::vector<std::string> said;
  geometry.origin = {9999.5, -9999.5, 0};
  moveFarOrigin(geometry, said);
  EXPECT_EQ(geometry.origin, Eigen::Vector3d(9999.5, -9999.5, 0));
  EXPECT_TRUE(said.empty());
  geometry.origin = {10'000'012.25, -25'000.5, 3};
  moveFarOrigin(geometry, said);
  EXPECT_EQ(geometry.origin, Eigen::Vector3d(12.25, -5000.5, 3));
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0],
            "its origin is far from 0: all positions are stated less (10000000, -20000, 0) mm, as "
            "floats would round them there");
}

TEST(FarOrigin, APlaceMayBeStatedInTheInputsCoordinatesOrTheCases) {
  const Eigen::Vector3d about(9800, -5000.5, 3), place(10'100.25, -5100, 50);
  EXPECT_EQ(placeNear(about, place), place);
  EXPECT_EQ(placeNear(about, place + Eigen::Vector3d(10'000'000, -20'000, 0)), place);
}

}  // namespace
}  // namespace lumen::convert
