// SPDX-License-Identifier: Apache-2.0
// DICOM series that the tests write themselves: synthetic voxels, explicit little-endian.
#include <gtest/gtest.h>

#include "fixtures.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// One slice of 4 x 3 pixels; pixel (i, j) holds first + i + 4 j.
struct Slice {
  std::string series = "1.2.3.1", description = "Angio", photometric = "MONOCHROME2";
  std::string position = "0\\0\\0", orientation = "1\\0\\0\\0\\1\\0", spacing = "0.5\\0.25";
  std::string slope = "1", intercept = "0";
  int number = 1, first = 0, columns = 4, rows = 3, samples = 1, frames = 1;
  std::string frameSpacing{};

  [[nodiscard]] std::string bytes() const {
    const std::string instance = series + ".9." + std::to_string(number);
    // a CT image, or a multi-frame secondary capture of 16-bit words
    const std::string storage =
        frames == 1 ? "1.2.840.10008.5.1.4.1.1.2" : "1.2.840.10008.5.1.4.1.1.7.3";
    const std::string meta = uid(2, 2, storage) + uid(2, 3, instance) +
                             uid(2, 0x10, "1.2.840.10008.1.2.1") + uid(2, 0x12, "1.2.3");
    std::string data = uid(8, 0x16, storage) + uid(8, 0x18, instance) + text(8, 0x60, "CS", "CT") +
                       text(8, 0x103e, "LO", description) +
                       (frameSpacing.empty() ? "" : text(0x18, 0x88, "DS", frameSpacing)) +
                       uid(0x20, 0xd, "1.2.3") + uid(0x20, 0xe, series) +
                       text(0x20, 0x13, "IS", std::to_string(number));
    if (!position.empty()) data += text(0x20, 0x32, "DS", position);
    data += text(0x20, 0x37, "DS", orientation) + number16(0x28, 2, samples) +
            text(0x28, 4, "CS", photometric);
    if (samples > 1) data += number16(0x28, 6, 0);
    if (frames > 1) data += text(0x28, 8, "IS", std::to_string(frames));
    data += number16(0x28, 0x10, rows) + number16(0x28, 0x11, columns) +
            text(0x28, 0x30, "DS", spacing) + number16(0x28, 0x100, samples > 1 ? 8 : 16) +
            number16(0x28, 0x101, samples > 1 ? 8 : 16) +
            number16(0x28, 0x102, samples > 1 ? 7 : 15) + number16(0x28, 0x103, 0) +
            text(0x28, 0x1052, "DS", intercept) + text(0x28, 0x1053, "DS", slope) + pixels();
    return std::string(128, '\0') + "DICM" + tag(2, 0) + "UL" + raw<std::uint16_t>(4) +
           raw(static_cast<std::uint32_t>(meta.size())) + meta + data;
  }

private:
  template <class T>
  static std::string raw(T value) {
    return convert::bytes<T>({value});
  }
  static std::string tag(int group, int element) {
    return raw(static_cast<std::uint16_t>(group)) + raw(static_cast<std::uint16_t>(element));
  }
  static std::string text(int group, int element, const char* type, std::string value,
                          char pad = ' ') {
    if (value.size() % 2 != 0) value += pad;
    return tag(group, element) + type + raw(static_cast<std::uint16_t>(value.size())) + value;
  }
  static std::string uid(int group, int element, const std::string& value) {
    return text(group, element, "UI", value, '\0');
  }
  static std::string number16(int group, int element, int value) {
    return tag(group, element) + "US" + raw<std::uint16_t>(2) +
           raw(static_cast<std::uint16_t>(value));
  }
  [[nodiscard]] std::string pixels() const {
    std::string values;
    for (int n = 0; n < rows * columns * frames; ++n)
      values += samples > 1 ? std::string(static_cast<std::size_t>(samples), static_cast<char>(n))
                            : raw(static_cast<std::uint16_t>(first + n));
    return tag(0x7fe0, 0x10) + "OW" + raw<std::uint16_t>(0) +
           raw(static_cast<std::uint32_t>(values.size())) + values;
  }
};

class Dicom : public FileTest {
protected:
  /// `count` slices 2 mm apart along z, from z = 10; the file names run against the positions.
  void writeSeries(const std::string& prefix, Slice slice, int count) const {
    for (int n = 0; n < count; ++n) {
      slice.number = n + 1;
      slice.first = 100 * n;
      slice.position = "-5\\7\\" + std::to_string(10 + 2 * n);
      write(prefix + std::to_string(90 - n) + ".dcm", slice.bytes());
    }
  }
  [[nodiscard]] std::filesystem::path directory() const { return path("").parent_path(); }
};

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
  Slice slice;
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
  Slice slice;
  slice.intercept = "-1024";
  writeSeries("a", slice, 3);
  const Volume v = readQuietly(directory());
  EXPECT_EQ(std::visit([](const auto& x) { return static_cast<double>(x[1]); }, v.voxels), -1023);
}

TEST_F(Dicom, SeveralSeriesAreListed) {
  writeSeries("a", {}, 3);
  Slice other;
  other.series = "1.2.3.2";
  other.description = "Mask";
  other.columns = 5;
  writeSeries("b", other, 4);
  const std::string refused = readRefusal(directory());
  for (const char* part :
       {"3: ", "2 DICOM series", "--series", "1: 1.2.3.1 (3 files, Angio, 4 x 3)",
        "2: 1.2.3.2 (4 files, Mask, 5 x 3)"})
    EXPECT_NE(refused.find(part), std::string::npos) << part << " is not in " << refused;
}

TEST_F(Dicom, SeriesIsChosenByNumberOrUid) {
  writeSeries("a", {}, 3);
  Slice other;
  other.series = "1.2.3.2";
  other.columns = 5;
  writeSeries("b", other, 4);
  EXPECT_EQ(readQuietly(directory(), {"1", {}}).geometry.size, (std::array{4, 3, 3}));
  EXPECT_EQ(readQuietly(directory(), {"2", {}}).geometry.size, (std::array{5, 3, 4}));
  EXPECT_EQ(readQuietly(directory(), {"1.2.3.2", {}}).geometry.size, (std::array{5, 3, 4}));
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

TEST_F(Dicom, TwoImagesAtOnePositionAreRefused) {
  writeSeries("a", {}, 3);
  writeSeries("b", {}, 3);
  expectRefused(readRefusal(directory()), {"3: ", "0 mm apart", "one image for each position"});
}

TEST_F(Dicom, SingleSliceIsRefused) {
  writeSeries("a", {}, 1);
  expectRefused(readRefusal(directory()), {"3: ", "3-D"});
}

TEST_F(Dicom, SlicesOfDifferentSizeAreRefused) {
  writeSeries("a", {}, 3);
  Slice other;
  other.columns = 5;
  other.number = 9;
  other.position = "-5\\7\\16";
  write("b.dcm", other.bytes());
  expectRefused(readRefusal(directory()), {"3: ", "differ in size"});
}

TEST_F(Dicom, TiltedStackIsRefused) {
  Slice slice;
  for (int n = 0; n < 4; ++n) {
    slice.number = n + 1;
    slice.position = "0\\" + std::to_string(n) + "\\" + std::to_string(2 * n);
    write(std::to_string(n) + ".dcm", slice.bytes());
  }
  expectRefused(readRefusal(directory()), {"3: ", "tilted"});
}

TEST_F(Dicom, SpacingThatIsNotPositiveIsRefused) {
  for (const char* bad : {"0\\0", "-0.5\\0.5", ""}) {
    Slice slice;
    slice.spacing = bad;
    writeSeries("a", slice, 3);
    expectRefused(readRefusal(directory()), {"3: ", "pixel spacing", "positive"});
  }
}

TEST_F(Dicom, ImageWithoutAPositionIsRefused) {
  Slice slice;
  slice.position = "";
  for (int n = 0; n < 3; ++n) {
    slice.number = n + 1;
    write(std::to_string(n) + ".dcm", slice.bytes());
  }
  expectRefused(readRefusal(directory()), {"3: ", "position"});
}

TEST_F(Dicom, ColourIsRefused) {
  Slice slice;
  slice.samples = 3;
  slice.photometric = "RGB";
  writeSeries("a", slice, 3);
  expectRefused(readRefusal(directory()), {"3: ", "3 components", "one number"});
}

TEST_F(Dicom, MultiFrameFileIsAVolume) {
  Slice slice;
  slice.frames = 5;
  slice.frameSpacing = "0.75";
  write("a.dcm", slice.bytes());
  const Volume v = readQuietly(directory());
  EXPECT_EQ(v.geometry.size, (std::array{4, 3, 5}));
  EXPECT_LT((v.geometry.spacing - Vector3d(0.25, 0.5, 0.75)).norm(), 1e-9);
}

TEST_F(Dicom, FramesWithoutADistanceAreRefused) {
  Slice slice;
  slice.frames = 5;
  write("a.dcm", slice.bytes());
  expectRefused(readRefusal(directory()), {"3: ", "a.dcm", "how far its frames are apart"});
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
