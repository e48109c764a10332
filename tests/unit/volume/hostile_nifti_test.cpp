// SPDX-License-Identifier: Apache-2.0
// NIfTI headers with a fault in one field: each is refused in one sentence that names the field, or
// read with a warning that names what was assumed.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "fixtures.h"

namespace lumen::convert {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
const std::string kEight = "abcdefgh";

/// A sound header of millimetres, whose fields are set by their place in nifti1.h.
class HeaderBytes {
public:
  HeaderBytes() { m_text[123] = 2; }
  template <class T>
  HeaderBytes& put(std::size_t at, T value) {
    std::memcpy(m_text.data() + at, &value, sizeof(value));
    return *this;
  }
  HeaderBytes& put16(std::size_t at, int value) {
    return put(at, static_cast<std::int16_t>(value));
  }
  HeaderBytes& codes(int qform, int sform) { return put16(252, qform).put16(254, sform); }
  [[nodiscard]] const std::string& text() const { return m_text; }

private:
  std::string m_text = MadeNiftiHeader().text();
};

class HostileNifti : public FileTest {
protected:
  /// Expects that the plain and the compressed file are refused with the same words.
  void expectRefusal(const HeaderBytes& header, std::vector<std::string> words,
                     const ReadVolumeOptions& options = {}) const {
    words.insert(words.begin(), {"3: ", "v.nii"});
    for (const auto& file : files(header.text() + kEight)) {
      expectRefused(readRefusal(file, options), words);
      expectRefused(refusal([&] { (void)headerOf(file, options); }), words);
    }
  }
  /// Reads, with one assumption that has these words, or without any for no words.
  void expectAssumption(const HeaderBytes& header, const std::vector<std::string>& words,
                        const ReadVolumeOptions& options = {}) const {
    for (const auto& file : files(header.text() + kEight)) {
      expectOne(readQuietly(file, options).assumptions, words);
      expectOne(headerOf(file, options).assumptions, words);
    }
  }
  [[nodiscard]] static VolumeHeader headerOf(const std::filesystem::path& file,
                                             const ReadVolumeOptions& options = {}) {
    return readVolumeHeader(file, VolumeFormat::Nifti, worded(options), Progress());
  }
  [[nodiscard]] std::vector<std::filesystem::path> files(const std::string& bytes) const {
    return {write("v.nii", bytes), write("v.nii.gz", gzipped(bytes, path("scratch.gz")))};
  }

private:
  static void expectOne(const std::vector<std::string>& assumptions,
                        const std::vector<std::string>& words) {
    ASSERT_EQ(assumptions.size(), words.empty() ? 0U : 1U);
    if (!words.empty()) expectRefused(assumptions[0], words);
  }
};

TEST_F(HostileNifti, TheHeaderHereIsSoundOtherwise) {
  expectAssumption({}, {});
}

TEST_F(HostileNifti, AnOffsetInsideTheHeaderIsRefused) {
  for (const float offset : {0.0F, 1.0F, 347.0F, 348.0F, 351.0F})
    expectRefusal(HeaderBytes().put(108, offset), {"vox_offset is", "header itself", "352"});
}

TEST_F(HostileNifti, AnOffsetThatIsNoPlaceIsRefused) {
  for (const float offset : {-352.0F, 352.5F, 3e7F, 1e30F, kNan, kInf, -kInf})
    expectRefusal(HeaderBytes().put(108, offset), {"vox_offset is", "a whole number from 352"});
}

TEST_F(HostileNifti, AnOffsetBeyondTheFileIsRefused) {
  expectRefused(readRefusal(write("v.nii", HeaderBytes().put(108, 4000.0F).text() + kEight)),
                {"3: ", "v.nii", "truncated", "8 bytes"});
  const std::string packed =
      gzipped(HeaderBytes().put(108, 4000.0F).text() + kEight, path("scratch.gz"));
  expectRefused(readRefusal(write("v.nii.gz", packed)), {"3: ", "v.nii.gz", "truncated"});
}

TEST_F(HostileNifti, BitsThatContradictTheTypeAreRefused) {
  for (const int bits : {0, 1, 16, -8, 32767})
    expectRefusal(HeaderBytes().put16(72, bits), {"bitpix is", "datatype is 2 (uint8)", "8 bits"});
}

TEST_F(HostileNifti, CountsThatAreNoneAreRefused) {
  for (const int count : {0, -1, -32768})
    for (const std::size_t axis : {1U, 2U, 3U})
      expectRefusal(HeaderBytes().put16(40 + 2 * axis, count),
                    {"dim[" + std::to_string(axis) + "] is", "positive"});
  for (const int dimensions : {0, -1, 8, 768})
    expectRefusal(HeaderBytes().put16(40, dimensions), {"dim[0]", "3"});
}

TEST_F(HostileNifti, APairOfFilesIsUnsupported) {
  std::string text = HeaderBytes().text();
  text[345] = 'i';
  expectRefused(readRefusal(write("v.nii", text + kEight)), {"4: ", "v.nii", ".img", ".nii.gz"});
}

TEST_F(HostileNifti, ScalingThatIsNoNumberIsRefused) {
  for (const float bad : {kNan, kInf, -kInf}) {
    if (std::isinf(bad))
      expectRefusal(HeaderBytes().put(112, bad), {"scl_slope is", "0 where"});
    else  // no scaling, as by other readers
      expectAssumption(HeaderBytes().put(112, bad), {"scl_slope", "NaN"});
    expectRefusal(HeaderBytes().put(112, 2.0F).put(116, bad), {"scl_inter is", "0 where"});
    expectAssumption(HeaderBytes().put(116, bad), {});  // a slope of 0: not scaled
  }
}

TEST_F(HostileNifti, ASpacingThatIsNoneIsRefusedUnlessItIsStated) {
  ReadVolumeOptions options;
  options.spacing = Eigen::Vector3d(0.5, 0.5, 2);
  for (const float bad : {0.0F, -1.0F, kNan, kInf})
    for (const std::size_t axis : {1U, 2U, 3U}) {
      const HeaderBytes header = HeaderBytes().put(76 + 4 * axis, bad);
      expectRefusal(header, {"spacing of", "axis " + std::to_string(axis), "--spacing"});
      expectAssumption(header, {}, options);
      EXPECT_EQ(readQuietly(path("v.nii"), options).geometry.spacing, *options.spacing);
    }
}

TEST_F(HostileNifti, AnUnknownUnitIsTakenAsMillimetresAndSaidSo) {
  for (const int unit : {0, 4, 5, 6, 7}) {
    const HeaderBytes header = HeaderBytes().put(123, static_cast<char>(unit | 8));  // and seconds
    expectAssumption(header, {"xyzt_units is " + std::to_string(unit), "mm", "--unit"});
    ReadVolumeOptions metres;
    metres.unit = 1000;
    expectAssumption(header, {}, metres);
    EXPECT_EQ(readQuietly(path("v.nii"), metres).geometry.spacing[0], 1000);
  }
}

TEST_F(HostileNifti, AnSformWithoutAPlaceIsRefused) {
  for (const float bad : {kNan, kInf, -kInf})
    for (std::size_t n = 0; n < 12; ++n)
      expectRefusal(HeaderBytes().put(280 + 4 * n, bad), {"sform", "not finite"});
  expectRefusal(HeaderBytes().put(280, 0.0F), {"sform", "without a length"});
  expectRefusal(HeaderBytes().put(280, 0.0F).put(296, 1.0F), {"sform", "not orthogonal"});
}

TEST_F(HostileNifti, AQformWithoutAPlaceIsRefused) {
  for (const float bad : {kNan, kInf, -kInf, 2.0F})
    for (std::size_t n = 0; n < 3; ++n)
      expectRefusal(HeaderBytes().codes(1, 0).put(256 + 4 * n, bad), {"qform", "no rotation"});
  for (const float bad : {kNan, kInf, -kInf}) {
    for (std::size_t n = 0; n < 3; ++n)
      expectRefusal(HeaderBytes().codes(1, 0).put(268 + 4 * n, bad), {"qform", "offset"});
    expectRefusal(HeaderBytes().codes(1, 0).put(76, bad), {"qform", "handedness"});
  }
}

TEST_F(HostileNifti, WhereBothTransformsAreWithoutAPlaceBothAreNamed) {
  expectRefusal(HeaderBytes().codes(1, 1).put(256, kNan).put(280, kNan),
                {"sform", "not finite", "qform", "no rotation"});
}

TEST_F(HostileNifti, ATransformWithoutAPlaceGivesWayToTheOther) {
  const HeaderBytes badS = HeaderBytes().codes(1, 1).put(280, kNan).put(268, 5.0F);
  expectAssumption(badS, {"sform", "not finite", "qform is used"});
  EXPECT_EQ(readQuietly(path("v.nii")).geometry.origin[0], -5);
  const HeaderBytes badQ = HeaderBytes().codes(2, 1).put(256, kNan).put(292, 7.0F);
  expectAssumption(badQ, {"qform", "no rotation", "sform is used"});
  EXPECT_EQ(readQuietly(path("v.nii")).geometry.origin[0], -7);
}

TEST_F(HostileNifti, ATransformThatIsNotStatedMayHoldAnything) {
  expectAssumption(HeaderBytes().put(256, kNan).put(272, kInf), {});
  expectAssumption(HeaderBytes().codes(1, 0).put(280, kNan), {});
}

TEST_F(HostileNifti, TransformsThatDisagreeAreToldWithTheOneThatCounts) {
  const HeaderBytes moved = HeaderBytes().codes(1, 1).put(268, 3.0F);
  expectAssumption(moved, {"qform (code 1)", "sform (code 1)", "voxels apart", "sform is used"});
  const HeaderBytes turned = HeaderBytes().codes(1, 2).put(264, 1.0F);
  expectAssumption(turned, {"qform (code 1)", "sform (code 2)", "sform is used"});
  const HeaderBytes older = HeaderBytes().codes(2, 1).put(264, 1.0F);
  expectAssumption(older, {"qform (code 2)", "sform (code 1)", "qform is used"});
  expectAssumption(HeaderBytes().codes(1, 1).put(268, 0.01F), {});  // a hundredth of a voxel
}

TEST_F(HostileNifti, ASpacingOfTheSformThatIsNotPixdimIsReported) {
  const HeaderBytes header = HeaderBytes().put(280, 2.0F);
  expectAssumption(header, {"sform", "(2, 1, 1)", "pixdim", "(1, 1, 1)", "--spacing"});
  ReadVolumeOptions options;
  options.spacing = Eigen::Vector3d(2, 1, 1);
  expectAssumption(header, {}, options);
}

TEST_F(HostileNifti, AVolumeThatIsPlacedNowhereIsReported) {
  expectAssumption(HeaderBytes().codes(0, 0), {"qform_code and sform_code are 0", "origin"});
}

TEST_F(HostileNifti, ExtensionsMustEndBeforeTheVoxels) {
  const auto file = [&](std::int32_t size) {
    std::string text = HeaderBytes().put(108, 384.0F).text();
    text[348] = 1;
    return text + bytes<std::int32_t>({size, 6}) + std::string(24, 'x') + kEight;
  };
  for (const std::int32_t size : {0, 7, -16, 33, 48, 1 << 30, -2147483647 - 1})
    expectRefused(readRefusal(write("v.nii", file(size))),
                  {"3: ", "v.nii", "extension", "byte 352"});
  EXPECT_EQ(std::get<0>(readQuietly(write("v.nii", file(32))).voxels)[0], 'a');
}

TEST_F(HostileNifti, DataBehindTheVoxelsIsReported) {
  for (const auto& file : files(HeaderBytes().text() + kEight + "w"))
    expectRefused(readQuietly(file).assumptions.at(0), {"goes on", "not read"});
}

TEST_F(HostileNifti, AHeaderIsReadWithoutInflatingAVoxel) {
  MadeNiftiHeader large;
  large.dim = {3, 100, 100, 100, 1, 1, 1, 1};
  std::string noise(1'000'000, '\0');
  std::uint32_t state = 1;
  for (char& c : noise) c = static_cast<char>((state = state * 1664525U + 1013904223U) >> 24U);
  std::string packed = gzipped(large.text() + noise, path("scratch.gz"));
  for (std::size_t n = packed.size() / 2; n < packed.size(); ++n) packed[n] = '\x55';
  const VolumeHeader header = headerOf(write("v.nii.gz", packed));
  EXPECT_EQ(header.geometry.size, (std::array{100, 100, 100}));
  EXPECT_EQ(header.voxelBytes, noise.size());
  EXPECT_EQ(header.storedBytes, packed.size());
  EXPECT_EQ(header.storedType, "uint8");
  EXPECT_EQ(header.encoding, "gzip");
  expectRefused(readRefusal(path("v.nii.gz")), {"3: ", "v.nii.gz", "damaged"});
}

TEST_F(HostileNifti, SeveralMembersOfGzipAreOneStream) {
  const std::string whole = HeaderBytes().text() + kEight;
  const std::string packed = gzipped(whole.substr(0, 100), path("scratch.gz")) +
                             gzipped(whole.substr(100, 254), path("scratch.gz")) +
                             gzipped(whole.substr(354), path("scratch.gz"));
  EXPECT_EQ(std::get<0>(readQuietly(write("v.nii.gz", packed)).voxels)[7], 'h');
}

TEST_F(HostileNifti, ADamagedChecksumIsRefused) {
  std::string packed = gzipped(HeaderBytes().text() + kEight, path("scratch.gz"));
  packed[packed.size() - 8] ^= 1;
  expectRefused(readRefusal(write("v.nii.gz", packed)), {"3: ", "v.nii.gz", "damaged"});
}

}  // namespace
}  // namespace lumen::convert
