// SPDX-License-Identifier: Apache-2.0
// DICOM files with one fault: the structure of the data set, what its elements say, the pixels.
#include <gtest/gtest.h>

#include "dicom_fixture.h"
#include "fixtures.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr const char* kJpeg = "1.2.840.10008.1.2.4.70";
constexpr const char* kRunLength = "1.2.840.10008.1.2.5";
constexpr const char* kBigEndian = "1.2.840.10008.1.2.2";

class HostileDicom : public DicomTest {
protected:
  /// A series of three of which the second is `bytes`.
  void writeAmongGood(const std::string& bytes) const {
    writeSeries("a", {}, 3);
    write("a89.dcm", bytes);
  }
  void expectFault(const std::string& bytes, std::vector<std::string> words) const {
    writeAmongGood(bytes);
    words.insert(words.begin(), {": ", "a89.dcm"});
    expectRefused(readRefusal(directory()), words);
    expectRefused(refusal([&] { (void)headerOf({}); }), words);
  }
  [[nodiscard]] VolumeHeader headerOf(const ReadVolumeOptions& options) const {
    return readVolumeHeader(directory(), VolumeFormat::Dicom, options, Progress());
  }
  /// The second of a series.
  [[nodiscard]] static DicomSlice second() {
    DicomSlice slice;
    slice.number = 2;
    slice.first = 100;
    slice.position = "-5\\7\\12";
    return slice;
  }
};

TEST_F(HostileDicom, TheSliceHereIsSoundOtherwise) {
  writeAmongGood(second().bytes());
  EXPECT_EQ(readRefusal(directory()), "");
  EXPECT_TRUE(readQuietly(directory()).assumptions.empty());
}

TEST_F(HostileDicom, EveryTruncationIsRefusedOrLeavesTheFileOut) {
  const std::string whole = second().bytes();
  for (std::size_t kept = 1; kept < whole.size(); kept += 3) {
    writeAmongGood(whole.substr(0, kept));
    const std::string refused = readRefusal(directory());
    // without the mark it is no DICOM file, and without pixels no image: then a slice is missing
    EXPECT_TRUE(refused.find("a89.dcm") != std::string::npos ||
                readQuietly(directory()).geometry.size[2] == 2)
        << kept << ": " << refused;
  }
}

TEST_F(HostileDicom, GarbageBehindThePixelsIsRefused) {
  expectFault(second().bytes() + "garbage that is no element", {"damaged at byte"});
}

TEST_F(HostileDicom, ZerosBehindThePixelsArePadding) {
  writeAmongGood(second().bytes() + std::string(1000, '\0'));
  EXPECT_EQ(readQuietly(directory()).geometry.size[2], 3);
}

TEST_F(HostileDicom, LengthsBeyondTheFileAreRefused) {
  for (const std::uint32_t length : {25U, 1000U, 0x7fffffffU, 0xfffffffeU}) {
    std::string bytes = second().bytes();
    std::memcpy(bytes.data() + bytes.size() - 28, &length, 4);
    expectFault(bytes, {"truncated", "24 are there"});
  }
}

TEST_F(HostileDicom, SequencesAreWalkedToABoundedDepth) {
  const auto nested = [](int depth) {
    std::string inner = DicomSlice::uid(8, 0x1150, "1.2");
    for (int n = 0; n < depth; ++n) inner = DicomSlice::openSequence(8, 0x1140, {inner});
    DicomSlice slice = second();
    slice.before = inner;
    return slice.bytes();
  };
  writeAmongGood(nested(16));
  EXPECT_EQ(readRefusal(directory()), "");
  expectFault(nested(17), {"more than 16 sequences"});
  expectFault(nested(20000), {"more than 16 sequences"});
}

TEST_F(HostileDicom, ASequenceWithoutAnEndIsRefused) {
  DicomSlice slice = second();
  const std::string sequence = DicomSlice::openSequence(8, 0x1140, {"", ""});
  for (const std::size_t cut : {8U, 16U, 24U}) {
    slice.before = sequence.substr(0, sequence.size() - cut);
    expectFault(slice.bytes(), {"damaged at byte"});
  }
}

TEST_F(HostileDicom, AnElementTwiceIsRefused) {
  DicomSlice slice = second();
  slice.beforePixels = DicomSlice::number16(0x28, 0x10, 300);
  expectFault(slice.bytes(), {"(0028,0010) occurs twice"});
  slice.beforePixels = slice.pixels();
  expectFault(slice.bytes(), {"pixels twice"});
}

TEST_F(HostileDicom, BitsThatAreNoneAreRefused) {
  for (const auto& [bits, used, high] :
       {std::array{16, 0, 0}, std::array{16, 17, 16}, std::array{16, 12, 16},
        std::array{16, 12, 10}, std::array{12, 12, 11}, std::array{0, 0, 0},
        std::array{64, 64, 63}}) {
    DicomSlice slice = second();
    slice.bits = bits;
    slice.bitsUsed = used;
    slice.highBit = high;
    expectFault(slice.bytes(), {"bit"});
  }
}

TEST_F(HostileDicom, MoreRowsThanPixelsAreRefused) {
  DicomSlice slice = second();
  slice.pixelElement = slice.pixels();
  slice.rows = 60000;
  slice.columns = 60000;
  expectFault(slice.bytes(), {"truncated", "7200000000 bytes", "24"});
}

TEST_F(HostileDicom, PixelsThatAreNotAnnouncedAreReported) {
  writeSeries("a", {}, 3);
  DicomSlice slice = second();
  slice.rows = 6;
  slice.pixelElement = slice.pixels();
  slice.rows = 3;
  write("a89.dcm", slice.bytes());
  expectRefused(readQuietly(directory()).assumptions.at(0), {"a89.dcm", "24 bytes", "left out"});
}

TEST_F(HostileDicom, RescalingThatIsNoneIsRefused) {
  for (const char* bad : {"0", "nan", "inf", "1e300", "1,5", "1\\2"}) {
    DicomSlice slice = second();
    slice.slope = bad;
    expectFault(slice.bytes(), {"resc"});
  }
}

TEST_F(HostileDicom, PlacesThatAreNoneAreRefused) {
  for (const char* bad : {"0\\0", "0\\0\\nan", "0\\0\\inf", "a\\b\\c", "0\\0\\0\\0"}) {
    DicomSlice slice = second();
    slice.position = bad;
    expectFault(slice.bytes(), {"image position (0020,0032)", "3 numbers"});
  }
  for (const char* bad : {"0\\0\\0\\0\\0\\0", "1\\0\\0\\1\\0\\0", "2\\0\\0\\0\\2\\0"}) {
    DicomSlice slice = second();
    slice.orientation = bad;
    expectFault(slice.bytes(), {"orientation", "orthogonal"});
  }
}

TEST_F(HostileDicom, TextsOfAFileArePrintedEscaped) {
  DicomSlice slice = second();
  slice.position = "0\\\x1b[31m\n";
  expectFault(slice.bytes(), {"\\u001b[31m"});
}

TEST_F(HostileDicom, AMissingPixelSpacingCanBeStated) {
  DicomSlice slice;
  ReadVolumeOptions options;
  options.spacing = Vector3d(0.3, 0.4, 2);
  for (const char* bad : {"none", "0\\0", "-1\\1"}) {
    slice.spacing = bad;
    writeSeries("a", slice, 3);
    expectRefused(readRefusal(directory()), {"3: ", "pixel spacing", "positive", "--spacing"});
    EXPECT_EQ(readQuietly(directory(), options).geometry.spacing, *options.spacing);
    EXPECT_EQ(headerOf(options).geometry.spacing, *options.spacing);
  }
}

TEST_F(HostileDicom, ADistanceOfFramesCanBeStated) {
  DicomSlice slice;
  slice.frames = 5;
  write("a.dcm", slice.bytes());
  expectRefused(readRefusal(directory()), {"3: ", "a.dcm", "--spacing"});
  ReadVolumeOptions options;
  options.spacing = Vector3d(0.3, 0.4, 0.5);
  EXPECT_EQ(readQuietly(directory(), options).geometry.spacing, *options.spacing);
}

TEST_F(HostileDicom, FramesWithPositionsAreStackedAsSlicesAre) {
  const auto frames = [&](const std::vector<int>& places) {
    std::vector<std::string> groups;
    for (const int z : places) {
      const auto place = DicomSlice::text(0x20, 0x32, "DS", "0\\0\\" + std::to_string(z));
      groups.push_back(DicomSlice::openSequence(0x20, 0x9113, {place}));
    }
    DicomSlice slice;
    slice.position = "";
    slice.frames = static_cast<int>(places.size());
    slice.beforePixels = DicomSlice::openSequence(0x5200, 0x9230, groups);
    write("a.dcm", slice.bytes());
  };
  frames({14, 12, 10});
  const Volume v = readQuietly(directory());
  EXPECT_EQ(v.geometry.spacing[2], 2);
  EXPECT_EQ(v.geometry.origin[2], 10);
  EXPECT_EQ(std::get<std::vector<std::uint16_t>>(v.voxels)[0], 24);  // the last frame's first
  frames({10, 12, 16, 18, 20});
  expectRefused(readRefusal(directory()), {"3: ", "frame 2", "4 mm apart"});
}

TEST_F(HostileDicom, RunLengthsAreDecodedWithinTheirSegments) {
  const auto withHeader = [](std::vector<std::uint32_t> numbers, const std::string& runs) {
    numbers.resize(16);
    return convert::bytes(numbers) + runs;
  };
  // high bytes: twelve zeros; low bytes: 1 to 12
  const std::string high("\xf5\0", 2), low = "\x0b\1\2\3\4\5\6\7\x08\x09\x0a\x0b\x0c";
  DicomSlice slice = second();
  slice.syntax = kRunLength;
  slice.pixelElement = DicomSlice::fragments({withHeader({2, 64, 66}, high + low)});
  writeAmongGood(slice.bytes());
  EXPECT_EQ(std::get<std::vector<std::uint16_t>>(readQuietly(directory()).voxels)[14], 3);
  for (const std::vector<std::uint32_t>& numbers :
       std::vector<std::vector<std::uint32_t>>{{0, 64, 66},
                                               {1, 64},
                                               {2, 64, 60},
                                               {2, 66, 64},
                                               {2, 64, 9999},
                                               {2, 64, 79},
                                               {2, 0, 66}}) {
    slice.pixelElement = DicomSlice::fragments({withHeader(numbers, high + low)});
    writeAmongGood(slice.bytes());
    expectRefused(readRefusal(directory()), {"3: ", "a89.dcm", "run-length"});
  }
}

TEST_F(HostileDicom, CompressedPixelsThatAreNotOneImageAreRefused) {
  DicomSlice slice = second();
  slice.syntax = kJpeg;
  expectFault(slice.bytes(), {"not in fragments", kJpeg});  // they are plain
  slice.pixelElement = DicomSlice::fragments({});
  expectFault(slice.bytes(), {"0 fragments"});
  const std::string start = "\xff\xd8";
  for (const std::string& stream : {std::string("JPEG"), start, start + std::string(100, '\xff')}) {
    slice.pixelElement = DicomSlice::fragments({stream});
    writeAmongGood(slice.bytes());
    expectRefused(readRefusal(directory()), {"3: ", "a89.dcm", "no sound header"});
  }
}

TEST_F(HostileDicom, ACompressedImageOfAnotherSizeIsRefusedBeforeItIsDecoded) {
  DicomSlice slice = second();
  slice.syntax = kJpeg;
  const std::string huge("\xff\xd8\xff\xc3\0\x0b\x10\xff\xff\xff\xff\x01\x01\x11\0", 15);
  slice.pixelElement = DicomSlice::fragments({huge + "x"});
  writeAmongGood(slice.bytes());
  expectRefused(readRefusal(directory()), {"3: ", "a89.dcm", "65535 x 65535", "4 x 3"});
}

TEST_F(HostileDicom, WhatStopsTheDecoderStopsNothingElse) {
  DicomSlice slice = second();
  slice.syntax = kJpeg;
  const std::string head("\xff\xd8\xff\xc3\0\x0b\x10\0\3\0\4\x01\x01\x11\0", 15);
  for (int n = 0; n < 64; ++n) {
    slice.pixelElement = DicomSlice::fragments({head + std::string(65, static_cast<char>(4 * n))});
    writeAmongGood(slice.bytes());
    expectRefused(readRefusal(directory()), {"3: ", "a89.dcm", "compressed pixels"});
  }
}

TEST_F(HostileDicom, OtherTransferSyntaxesAreUnsupported) {
  for (const char* uid : {"1.2.840.10008.1.2.4.100", "", "x\x1b[1m"}) {
    DicomSlice slice = second();
    slice.syntax = uid;
    expectFault(slice.bytes(), {"4: ", "transfer syntax", "JPEG"});
  }
}

TEST_F(HostileDicom, AnotherByteOrderThanTheSyntaxSaysIsRefused) {
  DicomSlice slice = second();
  slice.syntax = kBigEndian;
  expectFault(slice.bytes(), {"3: "});
}

TEST_F(HostileDicom, ADamagedFileOfAnotherSeriesIsLeftOut) {
  DicomSlice other;
  other.series = "1.2.3.2";
  writeSeries("a", {}, 3);
  const std::string bytes = other.bytes();
  write("b.dcm", bytes.substr(0, bytes.size() - 5));
  EXPECT_EQ(readQuietly(directory()).geometry.size[2], 3);
}

TEST_F(HostileDicom, AnIndexOfTheFolderIsLeftOut) {
  writeSeries("a", {}, 3);
  const std::string meta = DicomSlice::uid(2, 2, "1.2.840.10008.1.3.10");
  write("DICOMDIR", std::string(128, '\0') + "DICM" + meta + "whatever follows");
  EXPECT_EQ(readQuietly(directory()).geometry.size[2], 3);
}

TEST_F(HostileDicom, FilesWithoutTheMarkAreReadAsOldWritersMeantThem) {
  writeAmongGood(second().bytes().substr(132));
  EXPECT_EQ(readQuietly(directory()).geometry.size[2], 3);
}

TEST_F(HostileDicom, AHeaderSaysWhatTheVolumeIs) {
  writeSeries("a", {}, 3);
  const VolumeHeader header = headerOf({});
  EXPECT_EQ(header.geometry.size, (std::array{4, 3, 3}));
  EXPECT_EQ(header.storedType, "uint16");
  EXPECT_EQ(header.encoding, "raw");
  EXPECT_EQ(header.voxelBytes, 72U);
}

}  // namespace
}  // namespace lumen::convert
