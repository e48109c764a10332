// SPDX-License-Identifier: Apache-2.0
// Each volume file here has one fault, which must be refused in one sentence.
#include <limits>

#include <gtest/gtest.h>

#include "converters/io/volume/write_volume.h"
#include "fixtures.h"
#include "nifti_fixture.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

std::string eight() {
  return "abcdefgh";
}

struct MetaHeader {
  std::string dimensions = "3", size = "2 2 2", spacing = "1 1 1", type = "MET_UCHAR";
  std::string extra{};
  [[nodiscard]] std::string text() const {
    return "ObjectType = Image\nNDims = " + dimensions +
           "\nBinaryData = True\nBinaryDataByteOrderMSB = False\n" + extra +
           "ElementSpacing = " + spacing + "\nDimSize = " + size + "\nElementType = " + type +
           "\nElementDataFile = LOCAL\n";
  }
};

struct NrrdHeader {
  std::string type = "uint8", dimension = "3", sizes = "2 2 2", extra = "spacings: 1 1 1\n";
  std::string encoding = "raw";
  [[nodiscard]] std::string text() const {
    return "NRRD0004\ntype: " + type + "\ndimension: " + dimension + "\nsizes: " + sizes + "\n" +
           extra + "endian: little\nencoding: " + encoding + "\n\n";
  }
};

class HostileVolume : public FileTest {
protected:
  void expectMeta(const MetaHeader& header, const std::string& voxels,
                  std::vector<std::string> words) const {
    words.insert(words.begin(), {"3: ", "v.mha"});
    expectRefused(readRefusal(write("v.mha", header.text() + voxels)), words);
  }
  void expectNrrd(const NrrdHeader& header, const std::string& voxels,
                  std::vector<std::string> words) const {
    words.insert(words.begin(), {"3: ", "v.nrrd"});
    expectRefused(readRefusal(write("v.nrrd", header.text() + voxels)), words);
  }
  void expectNifti(const MadeNiftiHeader& header, const std::string& voxels,
                   std::vector<std::string> words) const {
    words.insert(words.begin(), {"3: ", "v.nii"});
    expectRefused(readRefusal(write("v.nii", header.text() + voxels)), words);
    expectRefused(
        readRefusal(write("v.nii.gz", gzipped(header.text() + voxels, path("scratch.gz")))), words);
  }
};

TEST_F(HostileVolume, TheHeadersHereAreSoundOtherwise) {
  EXPECT_EQ(readRefusal(write("v.mha", MetaHeader().text() + eight())), "");
  EXPECT_EQ(readRefusal(write("v.nrrd", NrrdHeader().text() + eight())), "");
  EXPECT_EQ(readRefusal(write("v.nii", MadeNiftiHeader().text() + eight())), "");
}

TEST_F(HostileVolume, MissingFile) {
  expectRefused(readRefusal(path("absent.nii")), {"3: ", "absent.nii", "no such file"});
}

TEST_F(HostileVolume, EmptyFiles) {
  for (const char* name : {"v.nii", "v.nii.gz", "v.nrrd", "v.mha"})
    expectRefused(readRefusal(write(name, "")), {"3: ", name});
}

TEST_F(HostileVolume, TextInsteadOfAHeader) {
  for (const char* name : {"v.nii", "v.nii.gz", "v.nrrd", "v.mha"})
    expectRefused(readRefusal(write(name, std::string(1000, 'x'))), {"3: ", name, "is not a"});
}

TEST_F(HostileVolume, Nifti2IsUnsupported) {
  MadeNiftiHeader header;
  std::string text = header.text() + std::string(300, '\0');
  const std::int32_t size = 540;
  std::memcpy(text.data(), &size, 4);
  expectRefused(readRefusal(write("v.nii", text)), {"4: ", "NIfTI-2"});
}

TEST_F(HostileVolume, TwoDimensions) {
  expectMeta({"2", "4 2", "1 1"}, eight(), {"2-D (4 x 2)", "3-D"});
  expectNrrd({"uint8", "2", "4 2", ""}, eight(), {"2-D (4 x 2)", "3-D"});
  MadeNiftiHeader nifti;
  nifti.dim = {2, 4, 2, 1, 1, 1, 1, 1};
  expectNifti(nifti, eight(), {"2-D (4 x 2)", "3-D"});
}

TEST_F(HostileVolume, ASingleSlice) {
  expectMeta({"3", "4 2 1"}, eight(), {"1 voxel along axis 3", "3-D"});
  expectNrrd({"uint8", "3", "1 4 2"}, eight(), {"1 voxel along axis 1"});
}

TEST_F(HostileVolume, FourDimensions) {
  expectMeta({"4", "2 2 1 2", "1 1 1 1"}, eight(), {"4-D (2 x 2 x 1 x 2)", "3-D"});
  expectNrrd({"uint8", "4", "2 2 1 2", ""}, eight(), {"4-D (2 x 2 x 1 x 2)"});
  MadeNiftiHeader nifti;
  nifti.dim = {4, 2, 2, 1, 2, 1, 1, 1};
  expectNifti(nifti, eight(), {"4-D (2 x 2 x 1 x 2)"});
}

TEST_F(HostileVolume, SeveralComponents) {
  MetaHeader meta;
  meta.extra = "ElementNumberOfChannels = 3\n";
  expectMeta(meta, eight() + eight() + eight(), {"3 components", "one number"});
  expectNrrd({"uint8", "4", "3 2 2 2", "kinds: vector domain domain domain\n"},
             eight() + eight() + eight(), {"3 components", "one number"});
  MadeNiftiHeader rgb;
  rgb.type = 128;
  rgb.bits = 24;
  expectNifti(rgb, eight() + eight() + eight(), {"3 components", "rgb"});
  MadeNiftiHeader complex;
  complex.type = 32;
  complex.bits = 64;
  expectNifti(complex, std::string(64, 'x'), {"2 components", "complex"});
}

TEST_F(HostileVolume, SpacingsInMessagesHaveTwelveSignificantDigits) {
  MetaHeader meta;
  meta.spacing = "1 -0.12345678912345 1";
  expectMeta(meta, eight(), {"spacing of -0.123456789123 "});
}

TEST_F(HostileVolume, SpacingThatIsNotPositive) {
  for (const char* bad : {"0", "-1", "nan", "inf"}) {
    MetaHeader meta;
    meta.spacing = std::string("1 ") + bad + " 1";
    expectMeta(meta, eight(), {"spacing of", "axis 2", "positive"});
  }
  for (const char* bad : {"0", "-1", "inf"}) {
    NrrdHeader nrrd;
    nrrd.extra = std::string("spacings: 1 1 ") + bad + "\n";
    expectNrrd(nrrd, eight(), {"spacing of", "axis 3", "positive"});
  }
  for (const float bad : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity()}) {
    MadeNiftiHeader nifti;
    nifti.pixdim[1] = bad;
    expectNifti(nifti, eight(), {"spacing of", "axis 1", "positive"});
  }
}

TEST_F(HostileVolume, DirectionsThatSpanNoSpace) {
  MetaHeader meta;
  meta.extra = "TransformMatrix = 1 0 0 1 0 0 0 0 1\n";
  expectMeta(meta, eight(), {"directions", "orthogonal"});
  meta.extra = "TransformMatrix = 0 0 0 0 0 0 0 0 0\n";
  expectMeta(meta, eight(), {"v.mha"});
  NrrdHeader nrrd;
  nrrd.extra = "space: left-posterior-superior\nspace directions: (1,0,0) (1,0,0) (0,0,1)\n";
  expectNrrd(nrrd, eight(), {"directions", "orthogonal"});
  nrrd.extra = "space: left-posterior-superior\nspace directions: (1,0,0) (0,0,0) (0,0,1)\n";
  expectNrrd(nrrd, eight(), {"spacing of 0", "axis 2"});
}

TEST_F(HostileVolume, ShearedAxes) {
  MetaHeader meta;
  meta.extra = "TransformMatrix = 1 0 0 0.1 0.995 0 0 0 1\n";
  expectMeta(meta, eight(), {"orthogonal"});
}

TEST_F(HostileVolume, ConstantVolume) {
  expectMeta({}, std::string(8, '\7'), {"every voxel is 7"});
  expectNrrd({}, std::string(8, '\0'), {"every voxel is 0"});
}

TEST_F(HostileVolume, VoxelsThatAreNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  MetaHeader meta;
  meta.type = "MET_FLOAT";
  expectMeta(meta, bytes<float>({1, 2, nan, 3, nan, 4, 5, 6}), {"2 of its voxels are not finite"});
  meta.type = "MET_DOUBLE";
  expectMeta(meta, bytes<double>({1, 2, 1e300, 3, 3, 4, 5, 6}), {"1 of its voxels are not finite"});
}

TEST_F(HostileVolume, TruncatedRaw) {
  expectMeta({}, "abcdefg", {"truncated", "8 bytes", "7 bytes"});
  expectNrrd({}, "abcdefg", {"truncated", "8 bytes", "7 bytes"});
  expectRefused(readRefusal(write("v.nii", MadeNiftiHeader().text() + "abcdefg")),
                {"3: ", "v.nii", "truncated", "8 bytes", "7 bytes"});
}

TEST_F(HostileVolume, EveryTruncationOfACompressedFile) {
  const Volume volume = makeVolume<std::int16_t>(
      {9, 8, 7}, [](int i, int j, int k) { return (i * 7919 + j * 104729 + k * 1299709) % 30000; });
  for (const char* name : {"v.nii.gz", "v.nrrd", "v.mha"}) {
    writeAsNamed(volume, path(name));
    const std::string whole = bytesOf(path(name));
    for (std::size_t kept = 0; kept < whole.size(); kept += kept + 12 < whole.size() ? 11 : 1)
      expectRefused(readRefusal(write(name, whole.substr(0, kept))), {"3: ", name});
  }
}

TEST_F(HostileVolume, EveryTruncationOfANiftiFile) {
  const std::string whole = MadeNiftiHeader().text() + eight();
  for (std::size_t kept = 0; kept < whole.size(); ++kept)
    expectRefused(readRefusal(write("v.nii", whole.substr(0, kept))), {"3: ", "v.nii"});
}

TEST_F(HostileVolume, DamagedCompressedBytes) {
  const Volume volume = makeVolume<std::int16_t>(
      {9, 8, 7}, [](int i, int j, int k) { return (i * 7919 + j * 104729 + k * 1299709) % 30000; });
  for (const char* name : {"v.nii.gz", "v.nrrd", "v.mha"}) {
    writeAsNamed(volume, path(name));
    std::string damaged = bytesOf(path(name));
    for (std::size_t i = damaged.size() - 300; i < damaged.size() - 280; ++i) damaged[i] = '\x55';
    expectRefused(readRefusal(write(name, damaged)), {"3: ", name});
  }
}

TEST_F(HostileVolume, HeaderThatAnnouncesMoreThanTheFileHolds) {
  expectMeta({"3", "60000 60000 60000"}, eight(), {"truncated", "2.16e+14 bytes"});
  expectNrrd({"float", "3", "60000 60000 60000"}, eight(), {"truncated"});
  MadeNiftiHeader nifti;
  nifti.dim = {3, 30000, 30000, 30000, 1, 1, 1, 1};
  expectNifti(nifti, eight(), {"truncated"});
}

TEST_F(HostileVolume, SkippedBytesDoNotHideASmallFile) {
  NrrdHeader header;
  header.sizes = "60000 60000 60000";
  for (const char* encoding : {"raw", "gzip", "hex"}) {
    header.encoding = encoding;
    header.extra = "spacings: 1 1 1\nbyte skip: 4\n";
    expectNrrd(header, eight(), {"truncated"});
  }
}

TEST_F(HostileVolume, Bzip2IsUnsupported) {
  NrrdHeader header;
  header.encoding = "bzip2";
  expectRefused(readRefusal(write("v.nrrd", header.text() + eight())),
                {"4: ", "v.nrrd", "\"bzip2\"", "gzip"});
}

TEST_F(HostileVolume, SizesThatAreNotPositive) {
  for (const char* size : {"2 0 2", "2 -2 2"}) {
    expectMeta({"3", size}, eight(), {"v.mha"});
    expectNrrd({"uint8", "3", size}, eight(), {"v.nrrd"});
  }
  MadeNiftiHeader nifti;
  nifti.dim[2] = -2;
  expectNifti(nifti, eight(), {"dim[2] is -2"});
}

TEST_F(HostileVolume, SeriesOfAFile) {
  expectRefused(readRefusal(write("v.mha", MetaHeader().text() + eight()), {"1", {}}),
                {"3: ", "v.mha", "series"});
}

}  // namespace
}  // namespace lumen::convert
