// SPDX-License-Identifier: Apache-2.0
// NIfTI files made by hand: what the libraries for it would get wrong or hide.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "fixtures.h"

namespace lumen::convert {
namespace {

class Nifti : public FileTest {};

MadeNiftiHeader header(std::int16_t type, std::int16_t bits) {
  MadeNiftiHeader h;
  h.type = type;
  h.bits = bits;
  return h;
}

TEST_F(Nifti, SformIsReadAsRasAndGivenAsLps) {
  const auto v = readQuietly(write("v.nii", MadeNiftiHeader().text() + "abcdefgh"));
  EXPECT_EQ(v.geometry.direction, Eigen::Matrix3d(Eigen::Vector3d(-1, -1, 1).asDiagonal()));
  EXPECT_EQ(std::get<0>(v.voxels)[7], 'h');
}

TEST_F(Nifti, VoxelsOfACompressedFileAreNotTakenFromItsPlainSibling) {
  write("v.nii", MadeNiftiHeader().text() + "abcdefgh");
  write("v.nii.gz", gzipped(MadeNiftiHeader().text() + "ABCDEFGH", path("scratch.gz")));
  EXPECT_EQ(std::get<0>(readQuietly(path("v.nii.gz")).voxels)[0], 'A');
  EXPECT_EQ(std::get<0>(readQuietly(path("v.nii")).voxels)[0], 'a');
}

TEST_F(Nifti, BigEndianVoxelsAreSwapped) {
  std::string text = header(4, 16).text();
  const auto swap = [&](std::size_t at, std::size_t size, std::size_t count) {
    for (std::size_t n = 0; n < count; ++n, at += size)
      std::reverse(text.begin() + static_cast<std::ptrdiff_t>(at),
                   text.begin() + static_cast<std::ptrdiff_t>(at + size));
  };
  swap(0, 4, 1);
  swap(40, 2, 8);
  swap(70, 2, 2);
  swap(76, 4, 11);  // pixdim, vox_offset, slope, intercept
  swap(254, 2, 1);
  swap(280, 4, 12);
  const std::string voxels("\x01\x02\xff\xfe\0\x03\0\x04\0\x05\0\x06\0\x07\0\x08", 16);
  const auto v = readQuietly(write("v.nii", text + voxels));
  EXPECT_EQ(std::get<1>(v.voxels), (std::vector<std::int16_t>{0x0102, -2, 3, 4, 5, 6, 7, 8}));
}

TEST_F(Nifti, SlopeAndInterceptAreApplied) {
  MadeNiftiHeader h = header(4, 16);
  h.slope = 0.5F;
  h.intercept = -10;
  const auto v =
      readQuietly(write("v.nii", h.text() + bytes<std::int16_t>({0, 1, 2, 3, 4, 5, 6, 40})));
  EXPECT_EQ(std::get<3>(v.voxels), (std::vector<float>{-10, -9.5F, -9, -8.5F, -8, -7.5F, -7, 10}));
}

TEST_F(Nifti, SlopeOfZeroMeansNoScaling) {
  MadeNiftiHeader h = header(4, 16);
  h.intercept = 5;
  const auto v =
      readQuietly(write("v.nii", h.text() + bytes<std::int16_t>({0, 1, 2, 3, 4, 5, 6, 7})));
  EXPECT_EQ(std::get<1>(v.voxels)[7], 7);
}

TEST_F(Nifti, EveryScalarTypeIsRead) {
  const auto eighth = [&](std::int16_t type, std::int16_t bits, const std::string& voxels) {
    const auto v = readQuietly(write("v.nii", header(type, bits).text() + voxels));
    return std::visit([](const auto& x) { return static_cast<double>(x[7]); }, v.voxels);
  };
  EXPECT_EQ(eighth(2, 8, bytes<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 255})), 255);
  EXPECT_EQ(eighth(256, 8, bytes<std::int8_t>({0, 0, 0, 0, 0, 0, 0, -128})), -128);
  EXPECT_EQ(eighth(512, 16, bytes<std::uint16_t>({0, 0, 0, 0, 0, 0, 0, 65535})), 65535);
  EXPECT_EQ(eighth(8, 32, bytes<std::int32_t>({0, 0, 0, 0, 0, 0, 0, -65536})), -65536);
  EXPECT_EQ(eighth(768, 32, bytes<std::uint32_t>({0, 0, 0, 0, 0, 0, 0, 1U << 31})), 0x1p31);
  EXPECT_EQ(eighth(1024, 64, bytes<std::int64_t>({0, 0, 0, 0, 0, 0, 0, -(1LL << 40)})), -0x1p40);
  EXPECT_EQ(eighth(1280, 64, bytes<std::uint64_t>({0, 0, 0, 0, 0, 0, 0, 1ULL << 63})), 0x1p63);
  EXPECT_EQ(eighth(16, 32, bytes<float>({0, 0, 0, 0, 0, 0, 0, 0.25F})), 0.25);
  EXPECT_EQ(eighth(64, 64, bytes<double>({0, 0, 0, 0, 0, 0, 0, -0.125})), -0.125);
}

TEST_F(Nifti, HeaderExtensionIsSkipped) {
  MadeNiftiHeader h;
  std::string text = h.text() + std::string(16, 'x');
  const float offset = 368;
  std::memcpy(text.data() + 108, &offset, 4);
  EXPECT_EQ(std::get<0>(readQuietly(write("v.nii", text + "abcdefgh")).voxels)[0], 'a');
}

/// A header with a quarter turn about z as its qform, and the sform of MadeNiftiHeader, no turn.
std::string bothTransforms(std::int16_t qform, std::int16_t sform) {
  std::string text = MadeNiftiHeader().text();
  const auto put = [&](std::size_t at, const auto& value) {
    std::memcpy(text.data() + at, &value, sizeof(value));
  };
  put(252, qform);
  put(254, sform);
  put(264, std::sqrt(0.5F));  // quatern_d
  return text + "abcdefgh";
}

TEST_F(Nifti, TheTransformWithTheHigherCodeCountsAndTheSformOfEqualOnes) {
  const Eigen::Vector3d plain(-1, 0, 0), turned(0, -1, 0);
  const auto firstAxis = [&](std::int16_t qform, std::int16_t sform) {
    const auto v = readQuietly(write("v.nii", bothTransforms(qform, sform)));
    return Eigen::Vector3d(v.geometry.direction.col(0));
  };
  constexpr std::int16_t kNone = 0, kScanner = 1, kAligned = 2;
  EXPECT_LT((firstAxis(kScanner, kScanner) - plain).norm(), 1e-6);
  EXPECT_LT((firstAxis(kNone, kAligned) - plain).norm(), 1e-6);
  EXPECT_LT((firstAxis(kScanner, kAligned) - plain).norm(), 1e-6);
  EXPECT_LT((firstAxis(kAligned, kAligned) - plain).norm(), 1e-6);
  EXPECT_LT((firstAxis(kAligned, kScanner) - turned).norm(), 1e-6);
  EXPECT_LT((firstAxis(kAligned, kNone) - turned).norm(), 1e-6);
}

TEST_F(Nifti, TheHeaderNamesTheTransformThatPlacesTheVoxels) {
  const auto placedBy = [&](std::int16_t qform, std::int16_t sform) {
    return readVolumeHeader(write("v.nii", bothTransforms(qform, sform)), VolumeFormat::Nifti, {},
                            {})
        .placedBy;
  };
  EXPECT_EQ(placedBy(1, 2), "sform (code 2)");
  EXPECT_EQ(placedBy(2, 1), "qform (code 2)");
  EXPECT_EQ(placedBy(0, 0), "no transform");
}

constexpr std::array<std::int16_t, 6> kCodes = {0, 1, 2, 3, 4, 5};

/// bothTransforms() with the sform of a stack under a gantry tilt.
std::string sheared(std::int16_t qform, std::int16_t sform, float shear) {
  std::string text = bothTransforms(qform, sform);
  std::memcpy(text.data() + 284, &shear, sizeof(shear));
  return text;
}

TEST_F(Nifti, AShearThatTheQformCannotHoldIsResampledWhateverTheCodes) {
  for (const std::int16_t qform : kCodes)
    for (const std::int16_t sform : {kCodes[1], kCodes[2]})
      for (const float shear : {0.01F, 0.27F, -0.27F}) {
        const auto v = readQuietly(write("v.nii", sheared(qform, sform, shear)));
        const auto leans = std::count_if(
            v.assumptions.begin(), v.assumptions.end(),
            [](const std::string& text) { return text.starts_with("its axes lean by "); });
        EXPECT_EQ(leans, 1) << qform << " " << sform << " " << shear;
        EXPECT_NEAR(
            (v.geometry.direction.transpose() * v.geometry.direction - Eigen::Matrix3d::Identity())
                .norm(),
            0, 1e-12);
      }
}

TEST_F(Nifti, AShearedSformOfAnAtlasGivesWayToTheQform) {
  for (const std::int16_t sform : {kCodes[3], kCodes[4], kCodes[5]})
    EXPECT_NEAR(readQuietly(write("v.nii", sheared(1, sform, 0.01F))).geometry.direction(1, 0), -1,
                1e-6);
}

TEST_F(Nifti, AShearWithinHalfAVoxelGivesWayToTheQform) {
  std::string text = sheared(1, 1, 0.01F);
  const float straight = 0;
  std::memcpy(text.data() + 264, &straight, sizeof(straight));  // the qform has no turn either
  text[123] = 2;                                                // mm
  const auto v = readQuietly(write("v.nii", text));
  EXPECT_NEAR(v.geometry.direction(0, 0), -1, 1e-6);
  ASSERT_EQ(v.assumptions.size(), 1U);
  expectRefused(v.assumptions[0], {"sform", "not orthogonal", "qform is used"});
}

TEST_F(Nifti, ASlopeThatIsNotANumberMeansNoScaling) {
  MadeNiftiHeader h = header(4, 16);
  h.slope = h.intercept = std::numeric_limits<float>::quiet_NaN();
  std::string text = h.text();
  text[123] = 2;  // mm
  const auto v = readQuietly(write("v.nii", text + bytes<std::int16_t>({0, 1, 2, 3, 4, 5, 6, 7})));
  EXPECT_EQ(std::get<1>(v.voxels)[7], 7);
  ASSERT_EQ(v.assumptions.size(), 1U);
  EXPECT_NE(v.assumptions[0].find("scl_slope"), std::string::npos);
}

TEST_F(Nifti, WithoutATransformTheAxesAreTheVolumesOwn) {
  const auto v = readQuietly(write("v.nii", bothTransforms(0, 0)));
  EXPECT_EQ(v.geometry.direction, Eigen::Matrix3d::Identity());
  EXPECT_EQ(v.geometry.origin, Eigen::Vector3d::Zero());
}

TEST_F(Nifti, MetresAreTurnedIntoMillimetres) {
  MadeNiftiHeader h;
  h.pixdim = {1, 0.002F, 0.002F, 0.002F, 1, 1, 1, 1};
  std::string text = h.text();
  text[123] = 1;  // xyzt_units: metres
  const float offset = 0.05F;
  std::memcpy(text.data() + 292, &offset, 4);
  const auto v = readQuietly(write("v.nii", text + "abcdefgh"));
  EXPECT_NEAR(v.geometry.spacing[0], 2, 1e-6);
  EXPECT_NEAR(v.geometry.origin[0], -50, 1e-5);
}

TEST_F(Nifti, MoreVoxelsThanAShortCountsAreNotWritten) {
  const auto row = makeVolume<std::uint8_t>({40000, 2, 2}, [](int i, int, int) { return i % 7; });
  expectRefused(refusal([&] { writeAsNamed(row, path("v.nii")); }), {"4: ", "v.nii", "32767"});
  EXPECT_FALSE(std::filesystem::exists(path("v.nii")));
}

TEST_F(Nifti, VoxelsThatAreNotFiniteAreNotTakenForZeros) {
  const auto voxels = [](float last) { return bytes<float>({3, 1, 2, 3, 4, 5, 6, last}); };
  for (const float none : {NAN, INFINITY, -INFINITY}) {
    const Volume read = readQuietly(write("v.nii", header(16, 32).text() + voxels(none)));
    EXPECT_EQ(std::get<std::vector<float>>(read.voxels)[7], 1);
  }
}

}  // namespace
}  // namespace lumen::convert
