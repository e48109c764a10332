// SPDX-License-Identifier: Apache-2.0
// Files of several frames with functional groups, encodings of data sets, and files in place of folders.
#include <algorithm>

#include <gtest/gtest.h>
#include <zlib.h>

#include "dicom_fixture.h"
#include "fixtures.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Slice = DicomSlice;

std::string place(double z) {
  return Slice::openSequence(0x20, 0x9113,
                             {Slice::text(0x20, 0x32, "DS", "0\\0\\" + std::to_string(z))});
}

std::string raw32(int group, int element, std::uint32_t value) {
  return Slice::tag(group, element) + "UL" + Slice::raw<std::uint16_t>(4) + Slice::raw(value);
}

class DicomFrames : public DicomTest {
protected:
  /// Frames of 4 x 3 pixels with these functional groups each; frame n begins with 12 n.
  void writeFrames(const std::string& name, const std::vector<std::string>& groups,
                   Slice slice = {}) const {
    slice.position = "";
    slice.frames = static_cast<int>(groups.size());
    slice.beforePixels += Slice::openSequence(0x5200, 0x9230, groups);
    write(name, slice.bytes());
  }
  static std::uint16_t firstOf(const Volume& volume) {
    return std::get<std::vector<std::uint16_t>>(volume.voxels)[0];
  }
  [[nodiscard]] Volume readFile(const std::string& name,
                                const ReadVolumeOptions& options = {}) const {
    return readVolume(path(name), VolumeFormat::Dicom, worded(options), Progress());
  }
};

TEST_F(DicomFrames, TimesOfOneFileAreListedAndChosenByAnIndex) {
  std::vector<std::string> groups;
  for (const std::uint32_t time : {1U, 2U, 3U})
    for (const double z : {4.0, 2.0})
      groups.push_back(place(z) + Slice::openSequence(0x20, 0x9111, {raw32(0x20, 0x9128, time)}));
  writeFrames("a.dcm", groups);
  for (const auto& input : {path("a.dcm"), directory()}) {
    const auto refused =
        refusal([&] { (void)readVolume(input, VolumeFormat::Dicom, worded({}), Progress()); });
    for (const char* part : {"3 DICOM series", "--series", "--volume-index 0 to 2",
                             "volume 2 of 3 by the temporal position index (0020,9128), 2"})
      EXPECT_NE(refused.find(part), std::string::npos) << part << " is not in " << refused;
    ReadVolumeOptions options;
    options.volumeIndex = 1;
    const Volume v = readVolume(input, VolumeFormat::Dicom, worded(options), Progress());
    EXPECT_EQ(v.geometry.size, (std::array{4, 3, 2}));
    EXPECT_EQ(firstOf(v), 3 * 12);  // the fourth frame, at 2 mm
    options.volumeIndex = 3;
    EXPECT_NE(refusal([&] {
                (void)readVolume(input, VolumeFormat::Dicom, worded(options), Progress());
              }).find("--volume-index 0 to 2"),
              std::string::npos);
  }
}

TEST_F(DicomFrames, StacksOfOneFileAreVolumes) {
  std::vector<std::string> groups;
  for (const char* stack : {"A", "B"})
    for (const double z : {0.0, 1.0, 2.0})
      groups.push_back(place(z + (*stack == 'B' ? 50 : 0)) +
                       Slice::openSequence(0x20, 0x9111, {Slice::text(0x20, 0x9056, "SH", stack)}));
  writeFrames("a.dcm", groups);
  ReadVolumeOptions options;
  options.volumeIndex = 1;
  const Volume v = readFile("a.dcm", options);
  EXPECT_EQ(v.geometry.origin[2], 50);
  EXPECT_EQ(v.geometry.size[2], 3);
  EXPECT_EQ(firstOf(v), 36);
}

TEST_F(DicomFrames, FramesHaveTheirOwnRescaling) {
  const auto scaled = [](double z, const char* slope) {
    return place(z) + Slice::openSequence(0x28, 0x9145,
                                          {Slice::text(0x28, 0x1052, "DS", "-5") +
                                           Slice::text(0x28, 0x1053, "DS", slope)});
  };
  writeFrames("a.dcm", {scaled(0, "1"), scaled(1, "2.5")});
  const Volume v = readFile("a.dcm");
  const auto& voxels = std::get<std::vector<float>>(v.voxels);
  EXPECT_EQ(voxels[1], -4);
  EXPECT_EQ(voxels[13], 13 * 2.5F - 5);
}

TEST_F(DicomFrames, AStackMayLieInSeveralFilesOfFrames) {
  writeFrames("a.dcm", {place(0), place(1)});
  writeFrames("b.dcm", {place(2), place(3), place(4)});
  EXPECT_EQ(readQuietly(directory()).geometry.size[2], 5);
}

TEST_F(DicomFrames, ImagesOfSeveralTypesInOneSeriesAreVolumes) {
  for (const char* type : {"ORIGINAL\\PRIMARY\\M", "ORIGINAL\\PRIMARY\\P"})
    for (int n = 0; n < 3; ++n) {
      Slice slice;
      slice.position = "0\\0\\" + std::to_string(n);
      slice.first = 1000 * (type[17] == 'P' ? 1 : 0) + n;
      slice.before = Slice::text(8, 8, "CS", type);
      write(std::string(1, type[17]) + std::to_string(n), slice.bytes());
    }
  ReadVolumeOptions options;
  options.volumeIndex = 1;
  EXPECT_EQ(firstOf(readQuietly(directory(), options)), 1000);
}

TEST_F(DicomFrames, APartThatWasTakenTwiceIsAVolumeOfItsOwn) {
  for (const int acquisition : {1, 2})
    for (int n = 0; n < (acquisition == 1 ? 5 : 3); ++n) {
      Slice slice;
      slice.position = "0\\0\\" + std::to_string(n);
      slice.first = 1000 * acquisition + n;
      slice.before = Slice::text(0x20, 0x12, "IS", std::to_string(acquisition));
      write(std::to_string(10 * acquisition + n), slice.bytes());
    }
  ReadVolumeOptions options;
  options.volumeIndex = 0;
  EXPECT_EQ(readQuietly(directory(), options).geometry.size[2], 5);
  options.volumeIndex = 1;
  EXPECT_EQ(readQuietly(directory(), options).geometry.size[2], 3);
}

TEST_F(DicomFrames, AnIndexIsForSeriesOfSeveralVolumes) {
  writeSeries("a", {}, 3);
  ReadVolumeOptions options;
  options.volumeIndex = 0;
  EXPECT_NE(readRefusal(directory(), options).find("--volume-index is for those"),
            std::string::npos);
}

TEST_F(DicomFrames, AFileStandsForItsSeriesADirectoryForItsFolder) {
  writeSeries("a", {}, 4);
  Slice other;
  other.series = "1.2.3.2";
  other.columns = 5;
  writeSeries("b", other, 3);
  EXPECT_EQ(readFile("a90.dcm").geometry.size, (std::array{4, 3, 4}));
  EXPECT_EQ(readFile("b90.dcm").geometry.size, (std::array{5, 3, 3}));
  const std::string meta = Slice::uid(2, 2, "1.2.840.10008.1.3.10");
  write("DICOMDIR", std::string(128, '\0') + "DICM" + meta + "whatever follows");
  ReadVolumeOptions options;
  options.series = "2";
  EXPECT_EQ(readFile("DICOMDIR", options).geometry.size, (std::array{5, 3, 3}));
  write("text", "no image");
  expectRefused(refusal([&] { (void)readFile("text"); }), {"3: ", "text", "no file of DICOM"});
  const InputFile inMemory("series", "DICM");
  expectRefused(
      refusal([&] { (void)readVolume(inMemory, VolumeFormat::Dicom, worded({}), Progress()); }),
      {"3: ", "series", "no file of DICOM"});
  expectRefused(refusal([&] {
                  write("report", std::string(128, '\0') + "DICM" +
                                      Slice::uid(2, 2, "1.2.840.10008.5.1.4.1.1.88.11") +
                                      Slice::uid(2, 0x10, "1.2.840.10008.1.2.1") +
                                      Slice::text(8, 0x60, "CS", "SR"));
                  (void)readFile("report");
                }),
                {"3: ", "report", "no pixels", "1.2.840.10008.5.1.4.1.1.88.11", "(0002,0002)"});
}

std::string deflated(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string in = text, out(text.size() + 1000, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(out.size() - stream.avail_out);
  EXPECT_EQ(deflateEnd(&stream), Z_OK);
  return out;
}

TEST_F(DicomFrames, DeflatedDataSetsAreReadAndDamagedOnesRefused) {
  Slice slice;
  slice.syntax = "1.2.840.10008.1.2.1.99";
  for (int n = 0; n < 3; ++n) {
    slice.first = 100 * n;
    slice.position = "0\\0\\" + std::to_string(n);
    const std::string bytes = slice.bytes();
    const std::size_t data = bytes.find(Slice::tag(8, 0x16));
    const std::string packed = deflated(bytes.substr(data));
    write(std::to_string(n), bytes.substr(0, data) + packed);
    if (n == 2) write("damaged", bytes.substr(0, data) + packed.substr(0, packed.size() / 2));
  }
  expectRefused(readRefusal(directory()), {"3: ", "damaged", "1.2.840.10008.1.2.1.99"});
  std::filesystem::remove(path("damaged"));
  const Volume v = readQuietly(directory());
  EXPECT_EQ(std::get<std::vector<std::uint16_t>>(v.voxels)[25], 201);
}

TEST_F(DicomFrames, BitsAboveTheUsedOnesAreLeftOut) {
  for (int n = 0; n < 2; ++n) {
    Slice slice;  // twelve bits, the highest of sixteen
    slice.bitsUsed = 12;
    slice.highBit = 15;
    slice.position = "0\\0\\" + std::to_string(n);
    slice.first = 0x1230 + 0x100 * n;
    write(std::to_string(n), slice.bytes());
  }
  const auto voxels = std::get<std::vector<std::uint16_t>>(readQuietly(directory()).voxels);
  EXPECT_EQ(voxels[0], 0x123);
  EXPECT_EQ(voxels[1], 0x123);  // 0x1231
}

// Frames in several fragments, by a table of their offsets.
TEST_F(DicomFrames, FragmentsOfFramesFollowTheTableOfOffsets) {
  std::vector<std::uint32_t> header(16, 0);
  header[0] = 2;
  header[1] = 64;
  header[2] = 66;
  const std::string high("\xf5\0", 2);
  const auto stream = [&](char first) {
    std::string low = "\x0b";
    for (char n = 0; n < 12; ++n) low += static_cast<char>(first + n);
    return convert::bytes(header) + high + low + std::string(1, '\0');
  };
  const std::string one = stream(1), other = stream(50);
  const auto fragment = [](const std::string& bytes) {
    return Slice::tag(0xfffe, 0xe000) + Slice::raw(static_cast<std::uint32_t>(bytes.size())) +
           bytes;
  };
  const auto fileWith = [&](std::vector<std::uint32_t> offsets) {
    Slice slice;
    slice.syntax = "1.2.840.10008.1.2.5";
    slice.beforePixels = "";
    slice.pixelElement = Slice::tag(0x7fe0, 0x10) + "OB" + std::string(2, '\0') +
                         Slice::raw(0xffffffffU) + fragment(convert::bytes(offsets)) +
                         fragment(one.substr(0, 70)) + fragment(one.substr(70)) + fragment(other) +
                         Slice::tag(0xfffe, 0xe0dd) + Slice::raw(0U);
    writeFrames("a.dcm", {place(0), place(1)}, slice);
  };
  fileWith({0, static_cast<std::uint32_t>(one.size() + 16)});
  const auto voxels = std::get<std::vector<std::uint16_t>>(readFile("a.dcm").voxels);
  EXPECT_EQ(voxels[0], 1);
  EXPECT_EQ(voxels[13], 51);
  fileWith({0, 7});
  expectRefused(refusal([&] { (void)readFile("a.dcm"); }),
                {"3: ", "table of offsets", "7 for frame 2"});
  fileWith({});
  expectRefused(refusal([&] { (void)readFile("a.dcm"); }), {"3: ", "3 fragments", "2 frames"});
}

}  // namespace
}  // namespace lumen::convert
