// SPDX-License-Identifier: Apache-2.0
// DICOM series that are no upright regular stack: gantry tilt, missing slices, blocks of two distances.
#include <cmath>
#include <iterator>
#include <numbers>

#include <gtest/gtest.h>

#include "dicom_fixture.h"
#include "fixtures.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kPixel = 0.5, kStep = 0.75;

std::string decimals(const Vector3d& v) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%.6f\\%.6f\\%.6f", v.x(), v.y(), v.z());
  return text.data();
}

class DicomStacks : public DicomTest {
protected:
  /// Slices of a function, each at its position along z and turned about x by `degrees`, as a gantry is.
  template <class Value>
  void writeTilted(double degrees, const std::vector<double>& places, const Value& value) const {
    const double angle = degrees * std::numbers::pi / 180;
    const Vector3d row(1, 0, 0), column(0, std::cos(angle), std::sin(angle));
    for (std::size_t n = 0; n < places.size(); ++n) {
      const Vector3d first(-8, -9, places[n]);
      DicomSlice slice;
      slice.columns = 34;
      slice.rows = 38;
      slice.spacing = "0.5\\0.5";
      slice.number = static_cast<int>(n);
      slice.position = decimals(first);
      slice.orientation = decimals(row) + "\\" + decimals(column);
      std::vector<std::uint16_t> pixels;
      for (int j = 0; j < slice.rows; ++j)
        for (int i = 0; i < slice.columns; ++i)
          pixels.push_back(static_cast<std::uint16_t>(
              std::lround(value(first + kPixel * (i * row + j * column)))));
      const std::string raw = convert::bytes(pixels);
      slice.pixelElement = DicomSlice::tag(0x7fe0, 0x10) + "OW" + std::string(2, '\0') +
                           DicomSlice::raw(static_cast<std::uint32_t>(raw.size())) + raw;
      write("s" + std::to_string(1000 + n) + ".dcm", slice.bytes());
    }
  }
  static std::vector<double> regular(int count) {
    std::vector<double> places;
    for (int n = 0; n < count; ++n) places.push_back(kStep * n);
    return places;
  }
};

/// A tube along a line, with a soft wall.
double tube(const Vector3d& p) {
  const Vector3d at(1, 2, 12), along = Vector3d(0.3, -0.4, 1).normalized();
  const Vector3d from = p - at;
  const double distance = (from - along * along.dot(from)).norm();
  return 1000 + 3000 / (1 + std::exp((distance - 2.5) / 0.4));
}

TEST_F(DicomStacks, AGantryTiltIsResampledToWhereItsVoxelsAre) {
  for (const double degrees : {15.0, -20.0, 30.0}) {
    writeTilted(degrees, regular(32), tube);
    const Volume v = readQuietly(directory());
    const double cosine = std::cos(degrees * std::numbers::pi / 180);
    EXPECT_LT((v.geometry.spacing - Vector3d(kPixel, kPixel, kStep * cosine)).norm(), 1e-4);
    ASSERT_EQ(v.assumptions.size(), 1U);
    expectRefused(v.assumptions[0], {"lean by " + std::to_string(std::abs(std::lround(degrees))),
                                     "gantry tilt", "upright grid", "no image"});
    ASSERT_TRUE(v.padding);
    const auto& voxels = std::get<std::vector<std::uint16_t>>(v.voxels);
    double worst = 0, sum = 0;
    std::size_t inside = 0;
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      if (static_cast<float>(voxels[i]) <= (*v.padding)[1]) continue;
      const Vector3d p = v.geometry.position(v.geometry.cell(i));
      const double off = voxels[i] - tube(p);
      worst = std::max(worst, std::abs(off));
      sum += off;
      ++inside;
    }
    // the wall rises by 1875 a millimetre: a tenth of a voxel is 94
    EXPECT_LT(worst, 94) << degrees;
    EXPECT_LT(std::abs(sum) / static_cast<double>(inside), 2);
    EXPECT_GT(inside, 32U * 34U * 38U * 9 / 10);
    EXPECT_EQ(readVolumeHeader(directory(), VolumeFormat::Dicom, {}, Progress()).geometry.size,
              v.geometry.size);
  }
}

TEST_F(DicomStacks, PaddingBesideATiltStaysPadding) {
  const auto disc = [](const Vector3d& p) { return p.x() < -4 ? 0.0 : tube(p); };
  writeTilted(15, regular(12), disc);
  for (const auto& file : std::filesystem::directory_iterator(directory())) {
    std::string bytes = bytesOf(file.path());
    bytes.insert(bytes.find(DicomSlice::tag(0x28, 0x1052)), DicomSlice::number16(0x28, 0x120, 0));
    write(file.path().filename().string(), bytes);
  }
  const Volume v = readQuietly(directory());
  EXPECT_EQ(v.padding, (std::array{0.0F, 0.0F}));
  for (const std::uint16_t voxel : std::get<std::vector<std::uint16_t>>(v.voxels))
    EXPECT_TRUE(voxel == 0 || voxel > 990) << voxel;
}

TEST_F(DicomStacks, LabelsUnderATiltStayLabels) {
  writeTilted(15, regular(12), [](const Vector3d& p) { return tube(p) > 2500 ? 7 : 0; });
  const Volume v = readQuietly(directory());
  EXPECT_FALSE(v.padding);
  for (const std::uint16_t voxel : std::get<std::vector<std::uint16_t>>(v.voxels))
    EXPECT_TRUE(voxel == 0 || voxel == 7);
}

TEST_F(DicomStacks, ASliceThatIsShiftedAloneIsRefused) {
  writeSeries("a", {}, 5);
  DicomSlice slice;
  slice.number = 3;
  slice.position = "-4\\7\\14";
  write("a88.dcm", slice.bytes());
  expectRefused(readRefusal(directory()),
                {"3: ", "a88.dcm", "shifted along itself", "(0020,0032)"});
}

TEST_F(DicomStacks, MissingSlicesAreNamedAndFilledIfThatIsStated) {
  writeSeries("a", {}, 9);
  for (const char* gone : {"a88.dcm", "a85.dcm", "a84.dcm"}) std::filesystem::remove(path(gone));
  expectRefused(readRefusal(directory()),
                {"3: ", "3 slices are missing", "1 between a89.dcm and a87.dcm (12 to 16 mm",
                 "2 between a86.dcm and a83.dcm (18 to 24 mm", "--fill-gaps"});
  ReadVolumeOptions options;
  options.fillGaps = true;
  const Volume v = readQuietly(directory(), options);
  EXPECT_EQ(v.geometry.size[2], 9);
  EXPECT_NEAR(v.geometry.spacing[2], 2, 1e-12);
  ASSERT_EQ(v.assumptions.size(), 1U);
  expectRefused(v.assumptions[0],
                {"3 slices are missing", "interpolated between their neighbours"});
  const auto& voxels = std::get<std::vector<std::uint16_t>>(v.voxels);
  for (std::size_t n = 0; n < 9; ++n) EXPECT_EQ(voxels[12 * n], 100 * n);  // as they were
  EXPECT_EQ(readVolumeHeader(directory(), VolumeFormat::Dicom, options, Progress()).resampled,
            v.assumptions[0]);
}

TEST_F(DicomStacks, TwoDistancesAreNamedAndBecomeOneIfThatIsStated) {
  for (int n = 0; n < 10; ++n) {
    DicomSlice slice;
    slice.first = 100 * (n < 6 ? n : 5 + 3 * (n - 5));
    slice.number = n;
    slice.position = "0\\0\\" + std::to_string(n < 6 ? n : 5 + 3 * (n - 5)) + ".5";
    write("s" + std::to_string(n) + ".dcm", slice.bytes());
  }
  expectRefused(readRefusal(directory()),
                {"3: ", "1 mm apart up to s5.dcm, and 3 mm from there on", "--fill-gaps"});
  for (int n = 6; n < 10; ++n) {
    DicomSlice slice;
    slice.first = 100 * 5 + 150 * (n - 5);
    slice.number = n;
    slice.position = "0\\0\\" + std::to_string(5.5 + 1.5 * (n - 5));
    write("s" + std::to_string(n) + ".dcm", slice.bytes());
  }
  expectRefused(
      readRefusal(directory()),
      {"3: ", "slices are 1 mm apart up to s5.dcm, and 1.5 mm from there on", "--fill-gaps"});
  ReadVolumeOptions options;
  options.fillGaps = true;
  const Volume v = readQuietly(directory(), options);
  EXPECT_EQ(v.geometry.size[2], 12);  // 11 mm
  EXPECT_NEAR(v.geometry.spacing[2], 1, 1e-12);
  const auto& voxels = std::get<std::vector<std::uint16_t>>(v.voxels);
  for (std::size_t n = 0; n < 12; ++n) EXPECT_EQ(voxels[12 * n], 100 * n);
  ASSERT_EQ(v.assumptions.size(), 1U);
  expectRefused(v.assumptions[0], {"1 mm apart up to s5.dcm, and 1.5 mm", "12 slices 1 mm apart",
                                   "4 are interpolated"});
}

TEST_F(DicomStacks, MoreIsNotInterpolatedThanIsThere) {
  for (const int z : {0, 1, 2, 30}) {
    DicomSlice slice;
    slice.number = z;
    slice.position = "0\\0\\" + std::to_string(z);
    write("s" + std::to_string(z) + ".dcm", slice.bytes());
  }
  ReadVolumeOptions options;
  options.fillGaps = true;
  expectRefused(readRefusal(directory(), options),
                {"3: ", "4 slices are 1 to 28 mm apart", "more"});
}

TEST_F(DicomStacks, PaddingOfEachSliceIsThatOfTheVolume) {
  writeSeries("a", {}, 3);
  DicomSlice slice;  // the second: another rescaling, and with it another value of padding
  slice.number = 2;
  slice.first = 100;
  slice.position = "-5\\7\\12";
  slice.intercept = "-50";
  slice.beforePixels = DicomSlice::number16(0x28, 0x120, 101);
  write("a89.dcm", slice.bytes());
  slice.number = 1;
  slice.first = 0;
  slice.position = "-5\\7\\10";
  slice.intercept = "0";
  slice.beforePixels = DicomSlice::number16(0x28, 0x120, 3);
  write("a90.dcm", slice.bytes());
  const Volume v = readQuietly(directory());
  EXPECT_EQ(v.padding, (std::array{3.0F, 3.0F}));
  const auto& voxels = std::get<std::vector<float>>(v.voxels);
  EXPECT_EQ(voxels[3], 3);
  EXPECT_EQ(voxels[13], 3);  // stored as 101, rescaled to 51
  EXPECT_EQ(voxels[14], 52);
}

}  // namespace
}  // namespace lumen::convert
