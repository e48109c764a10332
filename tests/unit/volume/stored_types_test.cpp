// SPDX-License-Identifier: Apache-2.0
// Stored types, byte orders, scalings and volumes of several: each combination gives its numbers.
#include <algorithm>
#include <cstdint>
#include <numeric>

#include <gtest/gtest.h>

#include "fixtures.h"
#include "text_volume.h"

namespace lumen::convert {
namespace {

constexpr std::size_t kVoxels = 8;

/// A type as NRRD, MetaImage and NIfTI call it, and the place of its type in memory in Voxels.
struct StoredType {
  const char *nrrd, *meta;
  std::int16_t nifti;
  std::size_t size, inMemory;
  /// The bytes of a value, little-endian.
  std::string (*bytes)(double value);
};

template <class T>
std::string bytesAs(double value) {
  return bytes(std::vector<T>{static_cast<T>(value)});
}

const std::vector<StoredType> kTypes = {
    {"int8", "MET_CHAR", 256, 1, 1, bytesAs<std::int8_t>},
    {"uint8", "MET_UCHAR", 2, 1, 0, bytesAs<std::uint8_t>},
    {"int16", "MET_SHORT", 4, 2, 1, bytesAs<std::int16_t>},
    {"uint16", "MET_USHORT", 512, 2, 2, bytesAs<std::uint16_t>},
    {"int32", "MET_INT", 8, 4, 3, bytesAs<std::int32_t>},
    {"uint32", "MET_UINT", 768, 4, 3, bytesAs<std::uint32_t>},
    {"int64", "MET_LONG_LONG", 1024, 8, 3, bytesAs<std::int64_t>},
    {"uint64", "MET_ULONG_LONG", 1280, 8, 3, bytesAs<std::uint64_t>},
    {"float", "MET_FLOAT", 16, 4, 3, bytesAs<float>},
    {"double", "MET_DOUBLE", 64, 8, 3, bytesAs<double>}};

bool isSigned(const StoredType& type) {
  return type.nrrd[0] != 'u';
}

/// Eight values that all types hold; some are negative where a type has those.
std::vector<double> valuesOf(const StoredType& type, double first = 1) {
  std::vector<double> values(kVoxels);
  std::iota(values.begin(), values.end(), first);
  if (isSigned(type)) values[0] = -values[0];
  return values;
}

std::string dataOf(const StoredType& type, bool bigEndian, double first = 1) {
  std::string data;
  for (const double value : valuesOf(type, first)) {
    std::string one = type.bytes(value);
    if (bigEndian) std::reverse(one.begin(), one.end());
    data += one;
  }
  return data;
}

/// A header whose every field has the other byte order.
std::string swappedHeader(const MadeNiftiHeader& header) {
  std::string text = header.text();
  const auto swap = [&](std::size_t at, std::size_t size) {
    std::reverse(text.begin() + static_cast<std::ptrdiff_t>(at),
                 text.begin() + static_cast<std::ptrdiff_t>(at + size));
  };
  swap(0, 4);
  for (std::size_t at = 40; at < 76; at += 2) swap(at, 2);
  for (std::size_t at = 76; at < 120; at += 4) swap(at, 4);
  for (std::size_t at = 252; at < 256; at += 2) swap(at, 2);
  for (std::size_t at = 256; at < 328; at += 4) swap(at, 4);
  return text;
}

class StoredTypes : public TextVolume {
protected:
  static void expectValues(const Volume& volume, const std::vector<double>& expected) {
    std::visit(
        [&](const auto& voxels) {
          ASSERT_EQ(voxels.size(), expected.size());
          for (std::size_t i = 0; i < voxels.size(); ++i)
            EXPECT_EQ(static_cast<double>(voxels[i]), expected[i]) << i;
        },
        volume.voxels);
  }
  static void expectStored(const Volume& volume, const StoredType& type) {
    EXPECT_EQ(volume.voxels.index(), type.inMemory);
    expectValues(volume, valuesOf(type));
  }
  /// Plain and compressed, in both byte orders.
  [[nodiscard]] std::vector<Volume> nifti(const StoredType& type, float slope,
                                          float intercept) const {
    MadeNiftiHeader header;
    header.type = type.nifti;
    header.bits = static_cast<std::int16_t>(8 * type.size);
    header.slope = slope;
    header.intercept = intercept;
    std::vector<Volume> volumes;
    for (const bool big : {false, true}) {
      const std::string text = (big ? swappedHeader(header) : header.text()) + dataOf(type, big);
      volumes.push_back(readQuietly(write("v.nii", text)));
      volumes.push_back(readQuietly(write("v.nii.gz", gzipped(text, path("scratch.gz")))));
    }
    return volumes;
  }
  [[nodiscard]] static ReadVolumeOptions number(int index) {
    ReadVolumeOptions options;
    options.volumeIndex = index;
    return options;
  }
};

TEST_F(StoredTypes, EachInEachByteOrderOfNrrdAndMetaImage) {
  for (const StoredType& type : kTypes)
    for (const bool big : {false, true}) {
      SCOPED_TRACE(std::string(type.nrrd) + (big ? ", big-endian" : ""));
      const std::string data = dataOf(type, big);
      expectStored(nrrd({"spacings: 1 1 1", std::string("type: ") + type.nrrd,
                         std::string("endian: ") + (big ? "big" : "little")},
                        data),
                   type);
      expectStored(meta({std::string("ElementType = ") + type.meta,
                         std::string("ElementByteOrderMSB = ") + (big ? "True" : "False")},
                        data),
                   type);
    }
}

TEST_F(StoredTypes, EachInEachByteOrderOfNifti) {
  for (const StoredType& type : kTypes)
    for (const Volume& volume : nifti(type, 0, 0)) {
      SCOPED_TRACE(type.nrrd);
      expectStored(volume, type);
    }
}

TEST_F(StoredTypes, SlopeAndInterceptOfNiftiApplyToEach) {
  for (const StoredType& type : kTypes) {
    std::vector<double> scaled = valuesOf(type), shifted = scaled;
    for (double& value : scaled) value = 0.5 * value - 3;
    for (double& value : shifted) value += 7;
    for (const Volume& volume : nifti(type, 0.5F, -3)) {
      SCOPED_TRACE(type.nrrd);
      EXPECT_EQ(volume.voxels.index(), 3U);
      expectValues(volume, scaled);
    }
    for (const Volume& volume : nifti(type, 1, 7)) expectValues(volume, shifted);
  }
}

TEST_F(StoredTypes, OneVolumeOfSeveralIsRead) {
  const StoredType& type = kTypes[3];
  MadeNiftiHeader header;
  header.dim = {5, 2, 2, 2, 3, 2, 1, 1};
  header.type = type.nifti;
  header.bits = 16;
  std::string data;
  for (int v = 0; v < 6; ++v) data += dataOf(type, false, 1 + 10 * v);
  write("v.nii", header.text() + data);
  write("v.nii.gz", gzipped(header.text() + data, path("scratch.gz")));
  for (int v = 0; v < 6; ++v) {
    SCOPED_TRACE(v);
    const std::vector<double> expected = valuesOf(type, 1 + 10 * v);
    expectValues(readQuietly(path("v.nii"), number(v)), expected);
    expectValues(readQuietly(path("v.nii.gz"), number(v)), expected);
    expectValues(nrrd({"type: uint16", "dimension: 5", "sizes: 2 2 2 3 2", "spacings: 1 1 1 1 1"},
                      data, number(v)),
                 expected);
    expectValues(meta({"NDims = 5", "DimSize = 2 2 2 3 2", "ElementSpacing = 1 1 1 1 1",
                       "ElementType = MET_USHORT"},
                      data, number(v)),
                 expected);
  }
  EXPECT_EQ(readVolumeHeader(path("v.nii"), VolumeFormat::Nifti, number(1), Progress()).voxelBytes,
            16U);
}

TEST_F(StoredTypes, AVolumeOfSeveralMustBeChosenAmongThem) {
  MadeNiftiHeader header;
  header.dim = {4, 2, 2, 2, 3, 1, 1, 1};
  const auto file = write("v.nii", header.text() + eightBytes() + eightBytes() + eightBytes());
  expectRefused(readRefusal(file), {"3: ", "4-D (2 x 2 x 2 x 3)", "--volume-index 0 to 2"});
  expectRefused(readRefusal(file, number(3)), {"3: ", "no volume 3", "--volume-index 0 to 2"});
  expectRefused(readRefusal(file, number(-1)), {"3: ", "no volume -1"});
}

TEST_F(StoredTypes, AFileOfOneVolumeLeavesNoChoice) {
  expectRefused(nrrdRefusal({"spacings: 1 1 1"}, eightBytes(), number(0)),
                {"3: ", "one volume", "--volume-index"});
}

TEST_F(StoredTypes, AFileThatEndsWithinAnotherVolumeIsRefused) {
  MadeNiftiHeader header;
  header.dim = {4, 2, 2, 2, 2, 1, 1, 1};
  expectRefused(readRefusal(write("v.nii", header.text() + eightBytes() + "abc"), number(0)),
                {"3: ", "truncated"});
}

TEST_F(StoredTypes, AWebPageIsNamedAsOne) {
  for (const char* name : {"v.nii.gz", "v.nii", "v.nrrd", "v.mha"})
    expectRefused(readRefusal(write(name, "\n<!DOCTYPE html>\n<html><title>Log in</title></html>")),
                  {"3: ", name, "web page", "HTML"});
}

TEST_F(StoredTypes, AShortTextIsNoTruncatedNifti) {
  expectRefused(readRefusal(write("v.nii", "404: not found")), {"3: ", "not a NIfTI file"});
  expectRefused(readRefusal(write("v.nii", MadeNiftiHeader().text().substr(0, 100))),
                {"3: ", "truncated"});
}

}  // namespace
}  // namespace lumen::convert
