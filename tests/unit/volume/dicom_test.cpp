// SPDX-License-Identifier: Apache-2.0
// DICOM series that the tests write themselves: synthetic voxels, explicit little-endian.
#include <gtest/gtest.h>

#include "dicom_fixture.h"
#include "fixtures.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

class Dicom : public DicomTest {};

TEST_F(Dicom, SeriesIsStackedByPosition) {
  writeSeries("a", {}, 4);
  const Volume v = readQuietly(directory());
  EXPECT_EQ(v.geometry.size, (std::array{4, 3, 4}));
  EXPECT_LT((v.geometry.spacing - Vector3d(0.25, 0.5, 2)).norm(), 1e-9);  // DICOM states rows first
  EXPECT_LT((v.geometry.origin - Vector3d(-5, 7, 10)).norm(), 1e-9);
  EXPECT_EQ(v.geometry.direction, Eigen::Matrix3d::Identity());
  const auto& voxels = std::get<std::vector<std::uint16_t>>(v.voxels);
  EXPECT_EQ(voxels[0], 0);
  EXPECT_EQ(voxels[12], 100);
  EXPECT_EQ(voxels[47], 311);
}

TEST_F(Dicom, CoronalSlicesKeepTheirAxes) {
  DicomSlice slice;
  slice.orientation =
      "1\\0\\0\\0\\0\\-1";  // rows to the left, columns to the feet: the normal is +y
  for (int n = 0; n < 3; ++n) {
    slice.number = n + 1;
    slice.first = 100 * n;
    slice.position = "0\\" + std::to_string(20 - 3 * n) + "\\0";
    write(std::to_string(n) + ".dcm", slice.bytes());
  }
  const Volume v = readQuietly(directory());
  EXPECT_LT((v.geometry.direction.col(2) - Vector3d(0, 1, 0)).norm(), 1e-9);
  EXPECT_LT((v.geometry.origin - Vector3d(0, 14, 0)).norm(), 1e-9);
  EXPECT_NEAR(v.geometry.spacing[2], 3, 1e-9);
  EXPECT_EQ(std::get<std::vector<std::uint16_t>>(v.voxels)[0], 200);
}

TEST_F(Dicom, RescaleIsApplied) {
  DicomSlice slice;
  slice.intercept = "-1024";
  writeSeries("a", slice, 3);
  const Volume v = readQuietly(directory());
  EXPECT_EQ(std::visit([](const auto& x) { return static_cast<double>(x[1]); }, v.voxels), -1023);
}

TEST_F(Dicom, PaddingIsRescaledAsTheVoxelsAre) {
  DicomSlice slice;
  slice.slope = "2";
  slice.intercept = "-1024";
  slice.beforePixels = DicomSlice::number16(0x28, 0x120, 7);
  writeSeries("a", slice, 3);
  using Range = std::array<float, 2>;
  EXPECT_EQ(readQuietly(directory()).padding, (Range{-1010, -1010}));
  slice.beforePixels += DicomSlice::number16(0x28, 0x121, 3);  // the other end of the range
  writeSeries("a", slice, 3);
  EXPECT_EQ(readQuietly(directory()).padding, (Range{-1018, -1010}));
  slice.beforePixels = DicomSlice::text(0x28, 0x120, "US", "");
  writeSeries("a", slice, 3);
  EXPECT_FALSE(readQuietly(directory()).padding);
}

TEST_F(Dicom, SeveralSeriesAreListed) {
  writeSeries("a", {}, 3);
  DicomSlice other;
  other.series = "1.2.3.2";
  other.description = "Mask";
  other.columns = 5;
  writeSeries("b", other, 4);
  const std::string refused = readRefusal(directory());
  for (const char* part :
       {"3: ", "2 DICOM series", "--series", "1: 1.2.3.1 (3 files, CT, Angio, 4 x 3)",
        "2: 1.2.3.2 (4 files, CT, Mask, 5 x 3)"})
    EXPECT_NE(refused.find(part), std::string::npos) << part << " is not in " << refused;
}

TEST_F(Dicom, SeriesIsChosenByNumberOrUid) {
  writeSeries("a", {}, 3);
  DicomSlice other;
  other.series = "1.2.3.2";
  other.columns = 5;
  writeSeries("b", other, 4);
  EXPECT_EQ(readQuietly(directory(), {"1", {}}).geometry.size, (std::array{4, 3, 3}));
  EXPECT_EQ(readQuietly(directory(), {"2", {}}).geometry.size, (std::array{5, 3, 4}));
  EXPECT_EQ(readQuietly(directory(), {"1.2.3.2", {}}).geometry.size, (std::array{5, 3, 4}));
}

TEST_F(Dicom, SeriesAreFoundInFoldersBelow) {
  for (const char* name : {"disc/st0/se0", "disc/st0/se1", "disc/.cache"})
    std::filesystem::create_directories(path(name));
  writeSeries("disc/st0/se0/a", {}, 3);
  DicomSlice other;
  other.series = "1.2.3.2";
  other.columns = 5;
  writeSeries("disc/st0/se1/b", other, 4);
  writeSeries("disc/.cache/a", {}, 3);  // not searched: each position would be there twice
  write("disc/DICOMDIR", "no image here");
  const std::string refused = readRefusal(path("disc"));
  for (const char* part : {"2 DICOM series", "1: 1.2.3.1 (3 files, CT, Angio, 4 x 3, in st0/se0)",
                           "2: 1.2.3.2 (4 files, CT, Angio, 5 x 3, in st0/se1)"})
    EXPECT_NE(refused.find(part), std::string::npos) << part << " is not in " << refused;
  EXPECT_EQ(readQuietly(path("disc"), {"1.2.3.2", {}}).geometry.size, (std::array{5, 3, 4}));
}

TEST_F(Dicom, ASeriesMayLieInSeveralFolders) {
  std::filesystem::create_directories(path("disc/a"));
  std::filesystem::create_directories(path("disc/b"));
  writeSeries("disc/a/", {}, 4);
  std::filesystem::rename(path("disc/a/90.dcm"), path("disc/b/90.dcm"));
  EXPECT_EQ(readQuietly(path("disc")).geometry.size, (std::array{4, 3, 4}));
}

TEST_F(Dicom, ADamagedFileInTheFolderOfAnotherSeriesIsNoMatter) {
  for (const char* name : {"disc/a", "disc/b"}) std::filesystem::create_directories(path(name));
  writeSeries("disc/a/", {}, 3);
  const std::string image = DicomSlice().bytes();
  write("disc/b/early.dcm", image.substr(0, 210));  // in a value before its series
  EXPECT_EQ(readQuietly(path("disc")).geometry.size[2], 3);
  write("disc/a/early.dcm", image.substr(0, 210));
  expectRefused(readRefusal(path("disc")), {"early.dcm"});
}

TEST_F(Dicom, UnknownSeriesIsRefusedWithTheListing) {
  writeSeries("a", {}, 3);
  for (const char* wanted : {"2", "0", "1.2.3", "x"}) {
    const std::string refused = readRefusal(directory(), {wanted, {}});
    EXPECT_NE(refused.find("has no series \"" + std::string(wanted) + "\""), std::string::npos)
        << refused;
    EXPECT_NE(refused.find("1: 1.2.3.1"), std::string::npos) << refused;
  }
}

TEST_F(Dicom, DirectoryWithoutImagesIsRefused) {
  write("notes.txt", "no image here");
  expectRefused(readRefusal(directory()), {"3: ", "holds no DICOM images"});
}

TEST_F(Dicom, OtherFilesInTheDirectoryAreIgnored) {
  writeSeries("a", {}, 3);
  write("notes.txt", "no image here");
  EXPECT_EQ(readQuietly(directory()).geometry.size[2], 3);
}

TEST_F(Dicom, MissingSliceIsRefused) {
  writeSeries("a", {}, 6);
  std::filesystem::remove(path("a87.dcm"));
  expectRefused(readRefusal(directory()), {"3: ", "4 mm apart", "regular stack"});
}

TEST_F(Dicom, DifferentImagesAtOnePositionAreRefused) {
  writeSeries("a", {}, 3);
  DicomSlice other;
  other.first = 7;
  other.position = "-5\\7\\12";
  write("b.dcm", other.bytes());
  expectRefused(readRefusal(directory()), {"3: ", "0 mm apart", "one image for each position"});
}

TEST_F(Dicom, CopiesOfSlicesAreLeftOut) {
  writeSeries("a", {}, 3);
  writeSeries("b", {}, 3);
  const Volume volume = readQuietly(directory());
  EXPECT_EQ(volume.geometry.size[2], 3);
  EXPECT_EQ(volume.geometry.spacing[2], 2);
  ASSERT_EQ(volume.assumptions.size(), 1U);
  expectRefused(volume.assumptions[0], {"3 files with the position", "left out"});
}

// Two times of one place in one series; the volumes differ in their first value.
TEST_F(Dicom, VolumesOfSeveralTimesAreListedAndChosen) {
  for (const auto& [element, name] : std::vector<std::pair<std::array<int, 2>, std::string>>{
           {{0x20, 0x12}, "acquisition number (0020,0012)"},
           {{0x20, 0x100}, "temporal position (0020,0100)"},
           {{0x8, 0x32}, "acquisition time (0008,0032)"}}) {
    for (int phase = 1; phase <= 2; ++phase)
      for (int n = 0; n < 3; ++n) {
        DicomSlice slice;
        slice.first = 1000 * phase + 100 * n;
        slice.position = "0\\0\\" + std::to_string(n);
        slice.before = DicomSlice::text(element[0], element[1], "IS", std::to_string(phase));
        write("p" + std::to_string(phase) + std::to_string(n) + ".dcm", slice.bytes());
      }
    const std::string listing = readRefusal(directory());
    EXPECT_NE(listing.find("holds 2 DICOM series; choose one with"), std::string::npos) << listing;
    EXPECT_NE(listing.find("\n  1: 1.2.3.1, volume 1 of 2 by the " + name), std::string::npos)
        << listing;
    for (int phase = 1; phase <= 2; ++phase) {
      ReadVolumeOptions options;
      options.series = std::to_string(phase);
      const Volume volume = readQuietly(directory(), options);
      EXPECT_EQ(volume.geometry.size[2], 3);
      EXPECT_EQ(std::get<2>(volume.voxels)[0], 1000 * phase);
    }
  }
}

TEST_F(Dicom, RoundedPositionsAreARegularStackOfTheirMeanDistance) {
  const auto writeAt = [&](const std::vector<std::string>& places) {
    for (std::size_t n = 0; n < places.size(); ++n) {
      DicomSlice slice;
      slice.first = static_cast<int>(n);
      slice.position = "0\\0\\" + places[n];
      write("s" + std::to_string(n) + ".dcm", slice.bytes());
    }
  };
  // 0.35 mm apart
  writeAt({"0", "0.4", "0.7", "1.1", "1.4", "1.8", "2.1", "2.5", "2.8"});
  const Volume volume = readQuietly(directory());
  EXPECT_NEAR(volume.geometry.spacing[2], 0.35, 1e-12);
  ASSERT_EQ(volume.assumptions.size(), 1U);
  expectRefused(volume.assumptions[0], {"0.3 to 0.4 mm apart", "0.35 mm, is used"});
  // halves are rounded up or down, as floats fall
  writeAt({"26", "26.4", "26.7", "27", "27.4", "27.8", "28.1", "28.4", "28.8"});
  EXPECT_NEAR(readQuietly(directory()).geometry.spacing[2], 0.35, 1e-12);
  // one is missing
  writeAt({"0", "0.4", "0.7", "1.4", "1.8", "2.1", "2.5", "2.8", "3.2"});
  expectRefused(readRefusal(directory()), {"3: ", "regular stack"});
}

TEST_F(Dicom, SingleSliceIsRefused) {
  writeSeries("a", {}, 1);
  expectRefused(readRefusal(directory()), {"3: ", "3-D"});
}

TEST_F(Dicom, SlicesOfDifferentSizeAreRefused) {
  writeSeries("a", {}, 3);
  DicomSlice other;
  other.columns = 5;
  other.number = 9;
  other.position = "-5\\7\\16";
  write("b.dcm", other.bytes());
  expectRefused(readRefusal(directory()), {"3: ", "differ in size"});
}

TEST_F(Dicom, SpacingThatIsNotPositiveIsRefused) {
  for (const char* bad : {"0\\0", "-0.5\\0.5", ""}) {
    DicomSlice slice;
    slice.spacing = bad;
    writeSeries("a", slice, 3);
    expectRefused(readRefusal(directory()), {"3: ", "pixel spacing", "positive"});
  }
}

TEST_F(Dicom, ImageWithoutAPositionIsRefused) {
  DicomSlice slice;
  slice.position = "";
  for (int n = 0; n < 3; ++n) {
    slice.number = n + 1;
    write(std::to_string(n) + ".dcm", slice.bytes());
  }
  expectRefused(readRefusal(directory()), {"3: ", "position"});
}

TEST_F(Dicom, ColourIsRefused) {
  DicomSlice slice;
  slice.samples = 3;
  slice.photometric = "RGB";
  writeSeries("a", slice, 3);
  expectRefused(readRefusal(directory()), {"3: ", "3 components", "one number"});
}

TEST_F(Dicom, MultiFrameFileIsAVolume) {
  DicomSlice slice;
  slice.frames = 5;
  slice.frameSpacing = "0.75";
  write("a.dcm", slice.bytes());
  const Volume v = readQuietly(directory());
  EXPECT_EQ(v.geometry.size, (std::array{4, 3, 5}));
  EXPECT_LT((v.geometry.spacing - Vector3d(0.25, 0.5, 0.75)).norm(), 1e-9);
}

TEST_F(Dicom, FramesWithoutADistanceAreRefused) {
  DicomSlice slice;
  slice.frames = 5;
  write("a.dcm", slice.bytes());
  expectRefused(readRefusal(directory()), {"3: ", "a.dcm", "the distance between its frames"});
}

TEST_F(Dicom, TruncatedImageIsRefused) {
  writeSeries("a", {}, 3);
  truncate(path("a89.dcm"), 10);
  expectRefused(readRefusal(directory()), {"3: ", "a89.dcm", "truncated", "24 bytes"});
}

TEST_F(Dicom, ALengthThatIsTooShortForTheImageIsRefused) {
  writeSeries("a", {}, 3);
  std::string bytes = bytesOf(path("a89.dcm"));
  bytes[bytes.size() - 28] = 20;  // of pixels, instead of 24
  write("a89.dcm", bytes.substr(0, bytes.size() - 4));
  expectRefused(readRefusal(directory()), {"3: ", "a89.dcm", "24 bytes"});
}

}  // namespace
}  // namespace lumen::convert
