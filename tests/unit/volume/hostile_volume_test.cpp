// SPDX-License-Identifier: Apache-2.0
// Each volume file here has one fault, which must be refused in one sentence.
#include <limits>

#include <gtest/gtest.h>

#include "fixtures.h"
#include "text_volume.h"

namespace lumen::convert {
namespace {

using Lines = std::vector<std::string>;

constexpr const char* kOneApart = "spacings: 1 1 1";

/// A header's lines, the voxels, and words of the refusal.
struct Fault {
  Lines lines;
  std::string voxels;
  Lines words;
};

class HostileVolume : public TextVolume {
protected:
  void expectNrrd(const std::vector<Fault>& faults) const {
    for (Fault fault : faults) {
      fault.words.emplace_back("v.nrrd");
      expectRefused(nrrdRefusal(fault.lines, fault.voxels), fault.words);
    }
  }
  void expectMeta(const std::vector<Fault>& faults) const {
    for (Fault fault : faults) {
      fault.words.emplace_back("v.mha");
      expectRefused(metaRefusal(fault.lines, fault.voxels), fault.words);
    }
  }
  void expectNifti(const MadeNiftiHeader& header, const std::string& voxels, Lines words) const {
    words.insert(words.begin(), {"3: ", "v.nii"});
    expectRefused(readRefusal(write("v.nii", header.text() + voxels)), words);
    expectRefused(
        readRefusal(write("v.nii.gz", gzipped(header.text() + voxels, path("scratch.gz")))), words);
  }
};

const std::string kSound = eightBytes(), kThreeTimes = kSound + kSound + kSound;

TEST_F(HostileVolume, TheHeadersHereAreSoundOtherwise) {
  EXPECT_EQ(metaRefusal({}), "");
  EXPECT_EQ(nrrdRefusal({kOneApart}), "");
  EXPECT_EQ(readRefusal(write("v.nii", MadeNiftiHeader().text() + kSound)), "");
}

TEST_F(HostileVolume, MissingFile) {
  expectRefused(readRefusal(path("absent.nii")), {"3: ", "absent.nii", "no such file"});
}

TEST_F(HostileVolume, EmptyFilesAndTextInsteadOfAHeader) {
  for (const char* name : {"v.nii", "v.nii.gz", "v.nrrd", "v.mha"}) {
    expectRefused(readRefusal(write(name, "")), {"3: ", name});
    expectRefused(readRefusal(write(name, std::string(1000, 'x'))), {"3: ", name, "is not a"});
  }
}

TEST_F(HostileVolume, EachOfNrrdIsNamed) {
  const std::string lps = "space: left-posterior-superior";
  expectNrrd({
      {{"dimension: 2", "sizes: 4 2"}, kSound, {"3: ", "2-D (4 x 2)", "3-D"}},
      {{kOneApart, "sizes: 1 4 2"}, kSound, {"3: ", "1 voxel along axis 1"}},
      {{"dimension: 4", "sizes: 2 2 1 2"}, kSound, {"3: ", "4-D (2 x 2 x 1 x 2)"}},
      {{"dimension: 4", "sizes: 3 2 2 2", "kinds: vector domain domain domain"},
       kThreeTimes,
       {"3: ", "3 components", "one number"}},
      {{lps, "space directions: (1,0,0) (1,0,0) (0,0,1)"},
       kSound,
       {"3: ", "directions", "orthogonal"}},
      {{lps, "space directions: (1,0,0) (0,0,0) (0,0,1)"},
       kSound,
       {"3: ", "spacing of 0", "axis 2"}},
      {{kOneApart}, std::string(8, '\0'), {"3: ", "every voxel is 0"}},
      {{kOneApart}, "abcdefg", {"3: ", "truncated", "8 bytes", "7 bytes"}},
      {{kOneApart, "type: float", "sizes: 60000 60000 60000"}, kSound, {"3: ", "truncated"}},
      {{kOneApart, "encoding: bzip2"}, kSound, {"4: ", "\"bzip2\"", "gzip"}},
  });
  for (const char* encoding : {"raw", "gzip", "hex"})  // skipped bytes do not hide a small file
    expectNrrd({{{kOneApart, "sizes: 60000 60000 60000", "byte skip: 4",
                  std::string("encoding: ") + encoding},
                 kSound,
                 {"3: ", "truncated"}}});
}

TEST_F(HostileVolume, EachOfMetaImageIsNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expectMeta({
      {{"NDims = 2", "DimSize = 4 2", "ElementSpacing = 1 1"},
       kSound,
       {"3: ", "2-D (4 x 2)", "3-D"}},
      {{"DimSize = 4 2 1"}, kSound, {"3: ", "1 voxel along axis 3", "3-D"}},
      {{"NDims = 4", "DimSize = 2 2 1 2", "ElementSpacing = 1 1 1 1"},
       kSound,
       {"3: ", "4-D (2 x 2 x 1 x 2)", "3-D"}},
      {{"ElementNumberOfChannels = 3"}, kThreeTimes, {"3: ", "3 components", "one number"}},
      {{"ElementSpacing = 1 -0.12345678912345 1"}, kSound, {"3: ", "spacing of -0.123456789123 "}},
      {{"TransformMatrix = 1 0 0 1 0 0 0 0 1"}, kSound, {"3: ", "directions", "orthogonal"}},
      {{"TransformMatrix = 0 0 0 0 0 0 0 0 0"}, kSound, {"3: "}},
      {{"TransformMatrix = 1 0 0 0.8 0.6 0 0 0 1"}, kSound, {"3: ", "orthogonal"}},
      {{}, std::string(8, '\7'), {"3: ", "every voxel is 7"}},
      {{"ElementType = MET_FLOAT"},
       bytes<float>({nan, nan, nan, nan, nan, nan, nan, nan}),
       {"3: ", "8 of its voxels are not finite"}},
      {{"ElementType = MET_DOUBLE"},
       bytes<double>({1e300, 1e300, 1e300, 1e300, 1e300, 1e300, 1e300, 1e300}),
       {"3: ", "8 of its voxels are not finite"}},
      {{}, "abcdefg", {"3: ", "truncated", "8 bytes", "7 bytes"}},
      {{"DimSize = 60000 60000 60000"}, kSound, {"3: ", "truncated", "2.16e+14 bytes"}},
  });
  expectRefused(metaRefusal({}, kSound, {"1", {}}), {"3: ", "v.mha", "series"});
}

TEST_F(HostileVolume, EachOfNiftiIsNamed) {
  MadeNiftiHeader flat, rgb, complex, large;
  flat.dim = {2, 4, 2, 1, 1, 1, 1, 1};
  expectNifti(flat, kSound, {"2-D (4 x 2)", "3-D"});
  rgb.type = 128;
  rgb.bits = 24;
  expectNifti(rgb, kThreeTimes, {"3 components", "rgb"});
  complex.type = 32;
  complex.bits = 64;
  expectNifti(complex, std::string(64, 'x'), {"2 components", "complex"});
  large.dim = {3, 30000, 30000, 30000, 1, 1, 1, 1};
  expectNifti(large, kSound, {"truncated"});
  expectRefused(readRefusal(write("v.nii", MadeNiftiHeader().text() + "abcdefg")),
                {"3: ", "v.nii", "truncated", "8 bytes", "7 bytes"});
  std::string second = MadeNiftiHeader().text() + std::string(300, '\0');
  const std::int32_t size = 540;
  std::memcpy(second.data(), &size, 4);
  expectRefused(readRefusal(write("v.nii", second)), {"4: ", "NIfTI-2"});
}

TEST_F(HostileVolume, EveryTruncationAndDamageOfACompressedFile) {
  const Volume volume = makeVolume<std::int16_t>(
      {9, 8, 7}, [](int i, int j, int k) { return (i * 7919 + j * 104729 + k * 1299709) % 30000; });
  for (const char* name : {"v.nii.gz", "v.nrrd", "v.mha"}) {
    writeAsNamed(volume, path(name));
    std::string whole = bytesOf(path(name));
    for (std::size_t kept = 0; kept < whole.size(); kept += kept + 12 < whole.size() ? 11 : 1)
      expectRefused(readRefusal(write(name, whole.substr(0, kept))), {"3: ", name});
    for (std::size_t i = whole.size() - 300; i < whole.size() - 280; ++i) whole[i] = '\x55';
    expectRefused(readRefusal(write(name, whole)), {"3: ", name});
  }
}

TEST_F(HostileVolume, EveryTruncationOfANiftiFile) {
  const std::string whole = MadeNiftiHeader().text() + kSound;
  for (std::size_t kept = 0; kept < whole.size(); ++kept)
    expectRefused(readRefusal(write("v.nii", whole.substr(0, kept))), {"3: ", "v.nii"});
}

}  // namespace
}  // namespace lumen::convert
