// SPDX-License-Identifier: Apache-2.0
// Trees drawn into a scan.
#include "converters/stages/phantom/into_scan.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/io/volume/read_volume.h"
#include "converters/stages/phantom/placing.h"
#include "converters/stages/phantom/render.h"
#include "formats/case/case_encoding.h"
#include "formats/case/case_file.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kAir = -1000, kTissue = 40, kBone = 1200, kNoiseOfScan = 6, kRadius = 2.5;
const Vector3d kSigma(0.85, 0.85, 0.67);  // voxels
constexpr int kFiner = 4;                 // drawn in quarters of the voxels' edges
const Vector3d kMiddle(28, 28, 30);       // mm in the grid's frame, of the body
constexpr double kBody = 24, kBoneBall = 6;
const Vector3d kBonePlace(28, 37, 30);

VolumeGeometry scanGrid() {
  VolumeGeometry grid;
  grid.size = {71, 71, 51};
  grid.spacing = {0.8, 0.8, 1.2};
  return grid;
}

// A ball as a scanner shows it, with kSigma.
std::vector<float> ballIn(VolumeGeometry grid, const Vector3d& middle, double radius) {
  Design ball;
  ball.contrast = {1};
  ball.wall = [=](const Vector3d& place) { return (place - middle).norm() - radius; };
  const CellBox cells = grid.cells();
  grid.spacing /= kFiner;
  for (int& n : grid.size) n *= kFiner;
  Progress progress;
  Image image = drawOccupancy(ball, grid, progress);
  blur(image, ((kFiner * kSigma).array().square() - 1.0 / 12).sqrt(), progress);
  std::vector<float> voxels;
  cells.forEach([&](const Cell& cell) {
    voxels.push_back(image.row(kFiner * cell.y(), kFiner * cell.z())[kFiner * cell.x()]);
  });
  return voxels;
}

// A ball of tissue in air with a ball of bone in it, blurred, with noise; turned in space.
Volume makeScan(double noise = kNoiseOfScan) {
  Volume scan;
  scan.geometry = scanGrid();
  static const std::vector<float> body = ballIn(scan.geometry, kMiddle, kBody),
                                  bone = ballIn(scan.geometry, kBonePlace, kBoneBall);
  std::vector<std::int16_t> voxels;
  Random random(7);
  for (std::size_t i = 0; i < body.size(); ++i)
    voxels.push_back(static_cast<std::int16_t>(std::lround(
        kAir + (kTissue - kAir) * static_cast<double>(body[i]) +
        (kBone - kTissue) * static_cast<double>(bone[i]) + noise * countedNormal(random))));
  scan.voxels = std::move(voxels);
  scan.geometry.direction = Vector3d(-1, -1, 1).asDiagonal();
  scan.geometry.origin = {10, 20, -5};
  return scan;
}

// The scan with noise of standard deviation 8 whose neighbours along x are alike.
Volume makeGrainyScan(double sigma) {
  Volume scan = makeScan(0);
  Random random(11);
  Image noise{scan.geometry.cells().size, {}};
  for (std::size_t i = 0; i < scan.geometry.voxelCount(); ++i)
    noise.value.push_back(static_cast<float>(countedNormal(random)));
  Progress progress;
  blur(noise, {sigma, 0, 0}, progress);
  double power = 0;
  for (const float w : gaussianWeights(sigma)) power += static_cast<double>(w * w);
  auto& voxels = std::get<std::vector<std::int16_t>>(scan.voxels);
  for (std::size_t i = 0; i < voxels.size(); ++i)
    voxels[i] = static_cast<std::int16_t>(
        std::lround(voxels[i] + 8 / std::sqrt(power) * static_cast<double>(noise.value[i])));
  return scan;
}

// An SWC file of one straight vessel between two places in the grid's frame.
class SwcFile {
public:
  SwcFile(const std::string& name, const Vector3d& from, const Vector3d& to, double radius)
      : m_path(std::filesystem::path(testing::TempDir()) / name) {
    const VolumeGeometry g = makeGeometry();
    std::ofstream file(m_path);
    for (int i = 0; i <= 10; ++i) {
      const Vector3d p = g.worldFromIndex((from + 0.1 * i * (to - from)).cwiseQuotient(g.spacing));
      file << i + 1 << " 0 " << p.x() << " " << p.y() << " " << p.z() << " " << radius << " "
           << (i == 0 ? -1 : i) << "\n";
    }
  }
  ~SwcFile() { std::filesystem::remove(m_path); }
  SwcFile(const SwcFile&) = delete;
  SwcFile& operator=(const SwcFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return m_path; }

private:
  static VolumeGeometry makeGeometry() {
    VolumeGeometry g = scanGrid();
    g.direction = Vector3d(-1, -1, 1).asDiagonal();
    g.origin = {10, 20, -5};
    return g;
  }
  std::filesystem::path m_path;
};

class IntoScan : public testing::Test {
protected:
  // away from the bone, and through its middle
  const SwcFile m_tube{"into-tube.swc", {14, 20, 30}, {42, 20, 30}, kRadius};
  const SwcFile m_through{"into-bone.swc", {14, 37, 30}, {42, 37, 30}, kRadius};

  static IntoResult draw(const SwcFile& tree, IntoOptions into = {}, std::uint64_t seed = 1,
                         Volume scan = makeScan()) {
    PhantomOptions options;
    options.tree = tree.path();
    options.seed = seed;
    if (!into.move) into.move = Vector3d::Zero();
    Progress progress;
    return drawIntoScan(options, into, std::move(scan), progress);
  }
  static const std::vector<std::int16_t>& voxelsOf(const Volume& volume) {
    return std::get<std::vector<std::int16_t>>(volume.voxels);
  }
  // Mean of the voxels within `reach` mm of the line through y, z along x between two places.
  static double meanAround(const Volume& volume, double y, double from, double to, double reach) {
    double sum = 0, count = 0;
    volume.geometry.cells().forEach([&](const Cell& cell) {
      const Vector3d p = cell.cast<double>().cwiseProduct(volume.geometry.spacing);
      if (p.x() < from || p.x() > to || std::hypot(p.y() - y, p.z() - 30) > reach) return;
      sum += valueAt(volume, volume.geometry.index(cell));
      ++count;
    });
    return sum / count;
  }
};

TEST(ScanLook, MeasuresTheSpreadThatTheVolumeWasBlurredWith) {
  const ScanLook look = measureScan(makeScan(), Progress());
  for (int a = 0; a < 3; ++a) {
    const double blurred = scanGrid().spacing[a] * kSigma[a];
    EXPECT_NEAR(look.spread[a], blurred, 0.05 * blurred) << a;
  }
}

TEST(ScanLook, MeasuresTheNoiseAndTheLevelOfTissue) {
  const ScanLook look = measureScan(makeScan(), Progress());
  EXPECT_NEAR(look.noise, kNoiseOfScan, 0.08 * kNoiseOfScan);
  EXPECT_LT(look.grain.maxCoeff(), 0.05);
  EXPECT_NEAR(look.tissue, kTissue, 2);
}

TEST(ScanLook, AVolumeWithoutAirIsRefused) {
  Volume even = makeScan();
  auto& voxels = std::get<std::vector<std::int16_t>>(even.voxels);
  Random random(3);
  for (std::int16_t& v : voxels)
    v = static_cast<std::int16_t>(std::lround(40 + 6 * countedNormal(random)));
  EXPECT_THROW(measureScan(even, Progress()), Error);
}

TEST_F(IntoScan, TheLumensMiddleIsTheContrastAboveTissue) {
  const IntoResult drawn = draw(m_tube);
  EXPECT_NEAR(meanAround(drawn.phantom.volume, 20, 18, 38, 0.7), drawn.look.tissue + 300, 3);
}

TEST_F(IntoScan, AVesselThroughBoneIsLumenAndBoneStaysBesideIt) {
  const IntoResult drawn = draw(m_through);
  EXPECT_NEAR(meanAround(drawn.phantom.volume, 37, 24, 32, 0.5), drawn.look.tissue + 300, 6);
  const Volume scan = makeScan();
  EXPECT_EQ(meanAround(drawn.phantom.volume, 31.7, 27, 29, 0.5),
            meanAround(scan, 31.7, 27, 29, 0.5));
}

TEST_F(IntoScan, TheAddedIntensityIsTheContrastTimesTheVolume) {
  const Volume scan = makeScan(0);
  const IntoResult drawn = draw(m_tube, {}, 1, makeScan(0));
  double added = 0;
  for (std::size_t i = 0; i < voxelsOf(scan).size(); ++i)
    added += voxelsOf(drawn.phantom.volume)[i] - voxelsOf(scan)[i];
  const double volume = std::numbers::pi * kRadius * kRadius * (28 + 4.0 / 3 * kRadius);
  EXPECT_NEAR(added * scan.geometry.spacing.prod(), 300 * volume, 0.02 * 300 * volume);
}

// Drawn in whole voxels, a wall between two of them would be steeper by an eighth.
TEST_F(IntoScan, AWallBetweenTwoVoxelsIsAsWideAsTheSpread) {
  const SwcFile file("into-wide.swc", {14, 19.6, 30}, {42, 19.6, 30}, 8);  // its wall: y = 34.5
  const IntoResult drawn = draw(file, {}, 1, makeScan(0));
  const auto at = [&](int y) {
    return valueAt(drawn.phantom.volume, drawn.phantom.volume.geometry.index(Cell(35, y, 25)));
  };
  const double voxels = drawn.look.spread.y() / scanGrid().spacing.y();
  EXPECT_NEAR(at(34) - at(35), 300 * std::erf(0.5 / (voxels * std::numbers::sqrt2)), 3);
}

TEST_F(IntoScan, VoxelsBeyondThreeSpreadsStayAsTheyAre) {
  const Volume scan = makeScan();
  const IntoResult drawn = draw(m_tube);
  const TubeTreeDistance wall(drawn.phantom.truth.tree);
  const double far = 3 * drawn.look.spread.maxCoeff() + 0.5 * scan.geometry.spacing.norm();
  std::size_t changed = 0;
  scan.geometry.cells().forEach([&](const Cell& cell) {
    const std::size_t i = scan.geometry.index(cell);
    const bool isEqual = voxelsOf(drawn.phantom.volume)[i] == voxelsOf(scan)[i];
    if (wall.nearest(scan.geometry.position(cell)).distance > far) {
      ASSERT_TRUE(isEqual);
    }
    changed += isEqual ? 0 : 1;
  });
  EXPECT_GT(changed, 500U);
}

TEST_F(IntoScan, EqualSeedsGiveEqualVoxelsAndOthersGiveOtherNoise) {
  const IntoResult first = draw(m_tube), again = draw(m_tube), other = draw(m_tube, {}, 2);
  EXPECT_EQ(voxelsOf(first.phantom.volume), voxelsOf(again.phantom.volume));
  EXPECT_EQ(formats::encodeJson(first.phantom.truth), formats::encodeJson(again.phantom.truth));
  EXPECT_NE(voxelsOf(first.phantom.volume), voxelsOf(other.phantom.volume));
}

TEST_F(IntoScan, TheNoiseOfALumenIsAsGrainyAsTheScans) {
  const SwcFile file("into-wide.swc", {14, 20, 30}, {42, 20, 30}, 8);
  const IntoResult drawn = draw(file, {}, 1, makeGrainyScan(0.7));
  EXPECT_NEAR(drawn.look.noise, 8, 0.08 * 8);
  EXPECT_NEAR(drawn.look.grain.x(), 0.58, 0.05);  // that of the taps
  EXPECT_LT(drawn.look.grain.y(), 0.05);
  const VolumeGeometry& grid = drawn.phantom.volume.geometry;
  double square = 0, alongX = 0, alongY = 0, count = 0;
  const auto noiseAt = [&](const Cell& cell) {
    return valueAt(drawn.phantom.volume, grid.index(cell)) - drawn.look.tissue - 300;
  };
  CellBox{{22, 20, 22}, {25, 10, 7}}.forEach([&](const Cell& cell) {
    const double noise = noiseAt(cell);
    square += noise * noise;
    alongX += noise * noiseAt(cell + Cell::UnitX());
    alongY += noise * noiseAt(cell + Cell::UnitY());
    ++count;
  });
  EXPECT_NEAR(std::sqrt(square / count), drawn.look.noise, 0.1 * drawn.look.noise);
  EXPECT_NEAR(alongX / square, drawn.look.grain.x(), 0.07);
  EXPECT_NEAR(alongY / square, 0, 0.1);
}

TEST_F(IntoScan, VeinsHaveNamesAndAContrastOfTheirOwn) {
  IntoOptions into;
  into.veins = m_through.path();
  into.veinContrast = 100;
  const IntoResult drawn = draw(m_tube, into);
  ASSERT_EQ(drawn.phantom.truth.tree.branches.size(), 2U);
  EXPECT_EQ(drawn.phantom.truth.tree.branches[0].label, "artery-000");
  EXPECT_EQ(drawn.phantom.truth.tree.branches[1].label, "vein-000");
  EXPECT_NEAR(meanAround(drawn.phantom.volume, 20, 18, 38, 0.7), drawn.look.tissue + 300, 3);
  EXPECT_NEAR(meanAround(drawn.phantom.volume, 37, 24, 32, 0.5), drawn.look.tissue + 100, 6);
}

TEST_F(IntoScan, VesselsEndAtTheBody) {
  const SwcFile file("into-long.swc", {-40, 28, 30}, {28, 28, 30}, kRadius);
  const IntoResult drawn = draw(file);
  EXPECT_NEAR(drawn.lost, 44, 1.5);  // the body begins at x = 4
  EXPECT_EQ(drawn.phantom.truth.tree.branches.size(), 1U);
}

TEST_F(IntoScan, AVesselGoesOnThroughAirInTheBody) {
  Volume scan = makeScan();
  scan.geometry.cells().forEach([&](const Cell& cell) {
    const Vector3d p = cell.cast<double>().cwiseProduct(scan.geometry.spacing);
    if ((p - Vector3d(28, 20, 30)).norm() < 5)
      std::get<std::vector<std::int16_t>>(scan.voxels)[scan.geometry.index(cell)] =
          static_cast<std::int16_t>(kAir);
  });
  const IntoResult drawn = draw(m_tube, {}, 1, std::move(scan));
  EXPECT_EQ(drawn.lost, 0);
  EXPECT_NEAR(meanAround(drawn.phantom.volume, 20, 18, 38, 0.7), drawn.look.tissue + 300, 3);
}

TEST_F(IntoScan, ATreeIsMovedIntoTissueByItself) {
  const SwcFile file("into-far.swc", {214, 220, 130}, {242, 220, 130}, kRadius);
  PhantomOptions options;
  options.tree = file.path();
  Progress progress;
  const IntoResult drawn = drawIntoScan(options, {}, makeScan(), progress);
  EXPECT_EQ(drawn.lost, 0);
  const formats::Status valid = formats::validate(drawn.phantom.truth);
  EXPECT_TRUE(valid) << valid.error().text();
}

TEST_F(IntoScan, ATreeOutsideOfTheBodyIsRefused) {
  IntoOptions into;
  into.move = Vector3d(500, 0, 0);
  EXPECT_THROW(draw(m_tube, into), Error);
}

}  // namespace
}  // namespace lumen::convert
