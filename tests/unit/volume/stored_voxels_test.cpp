// SPDX-License-Identifier: Apache-2.0
// How the files of NRRD and MetaImage hold voxels, and what is wrong with some.
#include <algorithm>

#include <gtest/gtest.h>
#include <zlib.h>

#include "fixtures.h"
#include "text_volume.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

class StoredVoxels : public TextVolume {
protected:
  [[nodiscard]] std::string packed(const std::string& data) const {
    return gzipped(data, path("packed.gz"));
  }
  static std::string asStream(const std::string& data) {
    uLongf size = compressBound(data.size());
    std::string out(size, '\0');
    compress(reinterpret_cast<Bytef*>(out.data()), &size,
             reinterpret_cast<const Bytef*>(data.data()), data.size());
    out.resize(size);
    return out;
  }
  static std::string reversed(std::string data, std::size_t size) {
    for (std::size_t i = 0; i < data.size(); i += size)
      std::reverse(data.begin() + static_cast<std::ptrdiff_t>(i),
                   data.begin() + static_cast<std::ptrdiff_t>(i + size));
    return data;
  }
  static void expectRest(const Volume& volume) {
    EXPECT_EQ(textOf(volume), eightBytes());
    ASSERT_FALSE(volume.assumptions.empty());
    expectRefused(volume.assumptions.back(), {"goes on", "not read"});
  }
};

const std::string kOne = "spacings: 1 1 1";
const std::vector<std::int16_t> kWide = {-32768, -2, -1, 0, 1, 258, 4660, 32767};

TEST_F(StoredVoxels, EachEncodingOfEachOrderGivesTheSame) {
  const std::string raw = bytes(kWide);
  std::string text, hex;
  for (const auto v : kWide) text += std::to_string(v) + (v == 0 ? "\n" : v > 0 ? ", " : " ");
  for (const char c : raw) {
    constexpr char kDigits[] = "0123456789abcdef";
    hex += {kDigits[static_cast<unsigned char>(c) >> 4], kDigits[c & 15], c == 0 ? '\n' : ' '};
  }
  const auto expectRead = [&](const Lines& lines, const std::string& data) {
    EXPECT_EQ(std::get<1>(nrrd(lines, data).voxels), kWide) << lines.back();
  };
  expectRead({kOne, "type: int16", "encoding: raw"}, raw);
  expectRead({kOne, "type: int16", "endian: big", "encoding: raw"}, reversed(raw, 2));
  expectRead({kOne, "type: int16", "encoding: gzip"}, packed(raw));
  expectRead({kOne, "type: int16", "endian: big", "encoding: gz"}, packed(reversed(raw, 2)));
  expectRead({kOne, "type: int16", "encoding: hex"}, hex);
  expectRead({kOne, "type: int16", "-endian", "encoding: text"}, text);
}

TEST_F(StoredVoxels, ASecondMemberOfGzipGoesOn) {
  EXPECT_EQ(textOf(nrrd({kOne, "encoding: gzip"}, packed("abc") + packed("defgh"))), eightBytes());
}

TEST_F(StoredVoxels, LinesAndBytesAreSkipped) {
  const std::string lines = "one\ntwo\n";
  EXPECT_EQ(textOf(nrrd({kOne, "byte skip: 3"}, "xyz" + eightBytes())), eightBytes());
  EXPECT_EQ(textOf(nrrd({kOne, "line skip: 2", "byteskip: 3"}, lines + "xyz" + eightBytes())),
            eightBytes());
  EXPECT_EQ(textOf(nrrd({kOne, "lineskip: 2", "byte skip: 3", "encoding: gzip"},
                        lines + packed("xyz" + eightBytes()))),
            eightBytes());
  EXPECT_EQ(textOf(nrrd({kOne, "byte skip: -1"}, "xyz" + eightBytes())), eightBytes());
  EXPECT_EQ(textOf(nrrd({kOne, "byte skip: -3"}, "xyz" + eightBytes() + "12")), eightBytes());
  EXPECT_EQ(textOf(nrrd({kOne, "byte skip: -1", "encoding: gzip"}, packed("xyz" + eightBytes()))),
            eightBytes());
  EXPECT_EQ(textOf(meta({"HeaderSize = -1"}, "xyz" + eightBytes())), eightBytes());
}

TEST_F(StoredVoxels, SkipsBeyondTheEndAreTruncations) {
  for (const char* line :
       {"byte skip: 1", "byte skip: 1125899906842624", "byte skip: -2",
        "byte skip: -1125899906842624", "line skip: 1", "line skip: 9000000000000000000"})
    expectRefused(nrrdRefusal({kOne, line}), {"3: ", "v.nrrd", "truncated"});
  expectRefused(nrrdRefusal({kOne, "encoding: gzip", "byte skip: 9"}, packed(eightBytes())),
                {"3: ", "truncated"});
  expectRefused(nrrdRefusal({kOne, "encoding: gzip", "byte skip: -2"}, packed(eightBytes())),
                {"3: ", "truncated"});
}

TEST_F(StoredVoxels, AHeaderIsNotReadAsVoxels) {
  expectRefused(metaRefusal({"HeaderSize = 5"}),
                {"3: ", "HeaderSize is \"5\"", "bytes of the header"});
  expectRefused(metaRefusal({"HeaderSize = -1"}, "abcdefg"), {"3: ", "truncated"});
  const std::string text = metaText({"HeaderSize = 500"});
  EXPECT_EQ(
      textOf(readQuietly(write("v.mha", text.substr(0, text.size() - 8) +
                                            std::string(508 - text.size(), '\n') + eightBytes()))),
      eightBytes());
}

TEST_F(StoredVoxels, CompressedSizesThatAreTooSmallAreReported) {
  std::string noise;
  for (unsigned i = 0; i < 4096; ++i) noise += static_cast<char>(i * i * 7919 >> 5);
  const std::string stream = asStream(noise);
  const auto lines = [](std::size_t size) {
    return Lines{"DimSize = 16 16 16", "CompressedData = True",
                 "CompressedDataSize = " + std::to_string(size)};
  };
  EXPECT_EQ(textOf(meta(lines(stream.size()), stream)), noise);
  EXPECT_EQ(textOf(meta(lines(0), stream)), noise);
  EXPECT_EQ(textOf(meta(lines(stream.size() + 10), stream)), noise);
  for (const std::size_t size : {std::size_t{5}, stream.size() / 2, stream.size() - 1})
    expectRefused(metaRefusal(lines(size), stream), {"3: ", "v.mha"});
  expectRefused(metaRefusal(lines(stream.size() / 2), stream),
                {"of 4096 bytes", "compressed size", std::to_string(stream.size() / 2)});
}

TEST_F(StoredVoxels, DataThatGoesOnIsReported) {
  expectRest(nrrd({kOne}, eightBytes() + "i"));
  expectRest(meta({}, eightBytes() + "i"));
  expectRest(nrrd({kOne, "encoding: gzip"}, packed(eightBytes() + "i")));
  expectRest(meta({"CompressedData = True"}, asStream(eightBytes() + "i")));
  expectRest(nrrd({kOne, "encoding: hex"}, "6162636465666768 69"));
  expectRest(nrrd({kOne, "encoding: ascii"}, "97 98 99 100 101 102 103 104 105"));
  EXPECT_TRUE(assumptionsBesideSpace(nrrd({kOne, "encoding: gzip"}, packed(eightBytes()))).empty());
}

TEST_F(StoredVoxels, DataThatEndsIsRefused) {
  expectRefused(nrrdRefusal({kOne}, "abcdefg"), {"3: ", "truncated"});
  expectRefused(nrrdRefusal({kOne, "encoding: gzip"}, packed("abcdefg")), {"3: ", "7 of 8 bytes"});
  expectRefused(nrrdRefusal({kOne, "encoding: ascii"}, "97 98 99 100 101 102 103            "),
                {"3: ", "7 of 8 bytes"});
  expectRefused(nrrdRefusal({kOne, "encoding: hex"}, "61626364656667 6  "),
                {"3: ", "7 of 8 bytes"});
}

TEST_F(StoredVoxels, DamagedChecksumsAreRefused) {
  std::string data = packed(eightBytes());
  data[data.size() - 6] ^= 1;
  expectRefused(nrrdRefusal({kOne, "encoding: gzip"}, data), {"3: ", "v.nrrd", "damaged"});
}

TEST_F(StoredVoxels, TextMustFitThePixelType) {
  for (const char* bad : {"256", "-1", "1.5", "nan", "x", "1e400", "1e", "0x1"})
    expectRefused(
        nrrdRefusal({kOne, "encoding: ascii"}, std::string("97 98 99 100 101 102 103 ") + bad),
        {"3: ", "v.nrrd", bad, "pixel type"});
  expectRefused(nrrdRefusal({kOne, "encoding: hex"}, "616263646566676g"), {"3: ", "\"g\"", "hexa"});
}

TEST_F(StoredVoxels, WholeNumbersMayBeWrittenAsReals) {
  EXPECT_EQ(textOf(meta({"BinaryData = False"}, "97 98.0 9.9e1 +100 101 102 103 104")),
            eightBytes());
}

TEST_F(StoredVoxels, ScalingIsNotAppliedAndSaysSo) {
  const Volume v = meta({"ElementToIntensityFunctionSlope = 2"});
  EXPECT_EQ(textOf(v), eightBytes());
  expectAssumes(v, {"ElementToIntensityFunction", "not applied"});
}

TEST_F(StoredVoxels, SizesWhoseProductOverflowsAreRefused) {
  for (const char* sizes : {"2147483647 2147483647 2147483647", "65536 65536 65536"}) {
    expectRefused(nrrdRefusal({kOne, std::string("sizes: ") + sizes}), {"3: ", "v.nrrd"});
    expectRefused(metaRefusal({std::string("DimSize = ") + sizes}), {"3: ", "v.mha"});
  }
  for (const char* sizes : {"1000000000000000000 2 2", "99999999999999999999 2 2", "-2 2 2",
                            "2 2 0", "2.5 2 2", "2 2 2x", "2 2 2 2", "2 2"}) {
    expectRefused(nrrdRefusal({kOne, std::string("sizes: ") + sizes}), {"3: ", "sizes is"});
    expectRefused(metaRefusal({std::string("DimSize = ") + sizes}), {"3: ", "DimSize is"});
  }
}

TEST_F(StoredVoxels, DimensionsAreSmallPositiveNumbers) {
  for (const char* bad : {"-1", "0", "17", "2147483648", "1e18", "x", ""}) {
    expectRefused(nrrdRefusal({kOne, std::string("dimension: ") + bad}), {"3: ", "dimension is"});
    expectRefused(metaRefusal({std::string("NDims = ") + bad}), {"3: ", "NDims is"});
  }
}

TEST_F(StoredVoxels, MissingFieldsAreNamed) {
  for (const char* field : {"type", "dimension", "sizes", "encoding"})
    expectRefused(nrrdRefusal({std::string("-") + field}), {"3: ", "no field", field});
  expectRefused(nrrdRefusal({"type: int16", "-endian"}, eightBytes() + eightBytes()),
                {"3: ", "no field endian"});
  for (const char* field : {"NDims", "DimSize", "ElementType"})
    expectRefused(metaRefusal({std::string("-") + field}), {"3: ", "no field", field});
}

TEST_F(StoredVoxels, WhatAHeaderSaysIsPrintedEscaped) {
  for (const std::string& text :
       {nrrdRefusal({"type: \x1b[31m\xff"}), nrrdRefusal({"x\x07y"}),
        metaRefusal({"ElementType = \x1b[31m"}), metaRefusal({"ElementDataFile = \x1b[31m"})}) {
    expectRefused(text, {"3: ", "\\u00"});
    for (const char c : text) EXPECT_GE(static_cast<unsigned char>(c), 0x20U) << text;
  }
}

}  // namespace
}  // namespace lumen::convert
