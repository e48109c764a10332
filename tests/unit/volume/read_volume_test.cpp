// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/read_volume.h"

#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "fixtures.h"
#include "text_volume.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

class ReadVolume : public FileTest {
protected:
  /// A raw MetaImage of 2 x 2 x 2 voxels.
  fs::path writeMeta(const std::string& type, const std::string& voxels) const {
    return write("v.mha",
                 "ObjectType = Image\nNDims = 3\nBinaryData = True\n"
                 "BinaryDataByteOrderMSB = False\nElementSpacing = 1 1 1\nDimSize = 2 2 2\n"
                 "ElementType = " +
                     type + "\nElementDataFile = LOCAL\n" + voxels);
  }
};

/// Oblique and anisotropic, with distinct sizes.
template <class T>
Volume oblique() {
  Volume volume = makeVolume<T>({5, 4, 3}, [](int i, int j, int k) { return i + 10 * j + 50 * k; });
  volume.geometry.spacing = {0.3, 0.45, 1.25};
  volume.geometry.origin = {-12.5, 33.25, 101.125};
  volume.geometry.direction =
      (Eigen::AngleAxisd(0.3, Vector3d(1, 2, 3).normalized())).toRotationMatrix();
  return volume;
}

double difference(const VolumeGeometry& a, const VolumeGeometry& b) {
  EXPECT_EQ(a.size, b.size);
  return std::max({(a.spacing - b.spacing).cwiseAbs().maxCoeff(),
                   (a.origin - b.origin).cwiseAbs().maxCoeff(),
                   (a.direction - b.direction).cwiseAbs().maxCoeff()});
}

template <class T>
void expectRoundTrip(const fs::path& path) {
  const Volume written = oblique<T>();
  writeAsNamed(written, path);
  const Volume read = readQuietly(path);
  EXPECT_LT(difference(read.geometry, written.geometry), 1e-5) << path;
  EXPECT_EQ(read.voxels, written.voxels) << path;
}

TEST_F(ReadVolume, ObliqueGeometryAndEveryPixelTypeSurviveEachFormat) {
  for (const char* name : {"v.nii", "v.nii.gz", "v.nrrd", "v.mha"}) {
    expectRoundTrip<std::uint8_t>(path(name));
    expectRoundTrip<std::int16_t>(path(name));
    expectRoundTrip<std::uint16_t>(path(name));
    expectRoundTrip<float>(path(name));
  }
}

TEST_F(ReadVolume, LeftHandedAxesSurviveEachFormat) {
  for (const char* name : {"v.nii", "v.nrrd", "v.mha"}) {
    Volume written = oblique<std::uint8_t>();
    written.geometry.direction.col(1) *= -1;
    writeAsNamed(written, path(name));
    EXPECT_LT(difference(readQuietly(path(name)).geometry, written.geometry), 1e-5) << name;
  }
}

TEST_F(ReadVolume, DicomIsNotWritten) {
  expectRefused(
      refusal([&] { (void)encodeVolume(oblique<float>(), VolumeFormat::Dicom, false, "v"); }),
      {"4: ", "v: this format of volumes is not written"});
}

TEST_F(ReadVolume, NamesDoNotMatter) {
  const Progress silent;
  for (const char* name : {"v.nii", "v.nii.gz", "v.nrrd", "v.mha"}) {
    writeAsNamed(oblique<float>(), path(name));
    fs::rename(path(name), path("scan"));
    EXPECT_EQ(readVolume(path("scan"), formatOf(name), {}, silent).voxels, oblique<float>().voxels)
        << name;
  }
}

TEST_F(ReadVolume, AFolderIsNoFileOfAnotherFormat) {
  const Progress silent;
  expectRefused(refusal([&] { (void)readVolume(path(""), VolumeFormat::Nifti, {}, silent); }),
                {"3: ", "folder"});
}

TEST_F(ReadVolume, CompressedFormatsAreCompressed) {
  const auto flat = makeVolume<float>({40, 40, 40}, [](int i, int, int) { return i == 0 ? 1 : 0; });
  for (const char* name : {"v.nii.gz", "v.nrrd", "v.mha"}) {
    writeAsNamed(flat, path(name));
    EXPECT_LT(fs::file_size(path(name)), 20000U) << name;  // raw: 256000
  }
}

TEST_F(ReadVolume, CropKeepsItsBoxAndMovesTheOrigin) {
  const Volume whole = oblique<std::int16_t>();
  writeAsNamed(whole, path("v.nrrd"));
  const Volume part = readQuietly(path("v.nrrd"), {{}, CellBox::between({1, 2, 0}, {3, 3, 1})});
  EXPECT_EQ(part.geometry.size, (std::array{3, 2, 2}));
  EXPECT_EQ(std::get<1>(part.voxels),
            (std::vector<std::int16_t>{21, 22, 23, 31, 32, 33, 71, 72, 73, 81, 82, 83}));
  EXPECT_LT((part.geometry.origin - whole.geometry.worldFromIndex({1, 2, 0})).norm(), 1e-9);
}

TEST_F(ReadVolume, CropOutsideIsRefused) {
  writeAsNamed(oblique<std::uint8_t>(), path("v.nrrd"));
  expectRefused(readRefusal(path("v.nrrd"), {{}, CellBox::between({0, 0, 0}, {4, 4, 2})}),
                {"3: ", "v.nrrd", "crop box goes from 0 to 4 along axis 2", "0 to 3"});
  expectRefused(readRefusal(path("v.nrrd"), {{}, CellBox::between({3, 0, 0}, {2, 3, 2})}),
                {"from 3 to 2"});
  expectRefused(readRefusal(path("v.nrrd"), {{}, CellBox::between({-1, 0, 0}, {2, 3, 2})}),
                {"from -1 to 2"});
}

TEST_F(ReadVolume, VoxelsThatAreNotFiniteArePadding) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float none : {nan, infinity, -infinity}) {
    const Volume volume =
        readQuietly(writeMeta("MET_FLOAT", bytes<float>({1, none, -2.5F, 3, nan, 4, 5, 6})));
    EXPECT_EQ(std::get<std::vector<float>>(volume.voxels),
              (std::vector<float>{1, -2.5F, -2.5F, 3, -2.5F, 4, 5, 6}));
    EXPECT_EQ(volume.padding, (std::array{-2.5F, -2.5F}));
    ASSERT_EQ(volume.assumptions.size(), 1U);
    EXPECT_EQ(volume.assumptions[0],
              "2 of its voxels are not finite (NaN, or infinite); they count as no image, with the "
              "value -2.5");
  }
}

// SPM writes masks so: outside of the mask a float is NaN.
TEST_F(ReadVolume, NotANumberBesideLabelsIsWhatIsAroundThem) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const auto& [one, two] : {std::pair{1.0F, 1.0F}, {1.0F, 2.0F}, {0.9999F, 2.0F}}) {
    const Volume map =
        readQuietly(writeMeta("MET_FLOAT", bytes<float>({nan, nan, one, one, two, two, two, nan})));
    EXPECT_EQ(std::get<std::vector<float>>(map.voxels),
              (std::vector<float>{0, 0, one, one, two, two, two, 0}));
  }
  const Volume grey =
      readQuietly(writeMeta("MET_FLOAT", bytes<float>({nan, 7, 4, 9, 3, 8, 5, nan})));
  EXPECT_EQ(std::get<std::vector<float>>(grey.voxels)[0], 3);
}

TEST_F(ReadVolume, Int8IsWidenedToInt16) {
  const auto v =
      readQuietly(writeMeta("MET_CHAR", bytes<std::int8_t>({-128, 1, 2, 3, 4, 5, 6, 127})));
  EXPECT_EQ(std::get<1>(v.voxels), (std::vector<std::int16_t>{-128, 1, 2, 3, 4, 5, 6, 127}));
}

TEST_F(ReadVolume, WideIntegersBecomeFloats) {
  const auto a =
      readQuietly(writeMeta("MET_INT", bytes<std::int32_t>({-70000, 1, 2, 3, 4, 5, 6, 70000})));
  EXPECT_EQ(std::get<3>(a.voxels), (std::vector<float>{-70000, 1, 2, 3, 4, 5, 6, 70000}));
  const auto b =
      readQuietly(writeMeta("MET_UINT", bytes<std::uint32_t>({4000000000U, 1, 2, 3, 4, 5, 6, 7})));
  EXPECT_EQ(std::get<3>(b.voxels)[0], 4e9F);
  const auto c = readQuietly(
      writeMeta("MET_LONG_LONG", bytes<std::int64_t>({-5000000000, 1, 2, 3, 4, 5, 6, 7})));
  EXPECT_EQ(std::get<3>(c.voxels)[0], -5e9F);
  const auto d = readQuietly(
      writeMeta("MET_ULONG_LONG", bytes<std::uint64_t>({5000000000U, 1, 2, 3, 4, 5, 6, 7})));
  EXPECT_EQ(std::get<3>(d.voxels)[0], 5e9F);
}

TEST_F(ReadVolume, DoublesBecomeFloats) {
  const auto v =
      readQuietly(writeMeta("MET_DOUBLE", bytes<double>({0.5, 1, 2, 3, 4, 5, 6, -7.25})));
  EXPECT_EQ(std::get<3>(v.voxels), (std::vector<float>{0.5F, 1, 2, 3, 4, 5, 6, -7.25F}));
}

TEST_F(ReadVolume, FourthAxisOfOneEntryIsDropped) {
  const auto file = write("v.nrrd",
                          "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 2 2 1\n"
                          "spacings: 1 2 3 1\nencoding: raw\n\nabcdefgh");
  const auto v = readQuietly(file);
  EXPECT_EQ(v.geometry.size, (std::array{2, 2, 2}));
  EXPECT_EQ(v.geometry.spacing, Vector3d(1, 2, 3));
}

TEST_F(ReadVolume, DetachedHeadersAreFollowed) {
  write("v.raw", "abcdefgh");
  const auto nhdr = write("v.nhdr",
                          "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\n"
                          "encoding: raw\ndata file: v.raw\n");
  EXPECT_EQ(std::get<0>(readQuietly(nhdr).voxels)[7], 'h');
  const auto mhd = write("v.mhd",
                         "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
                         "ElementDataFile = v.raw\n");
  EXPECT_EQ(std::get<0>(readQuietly(mhd).voxels)[7], 'h');
  write("v.raw", "abcd");
  expectRefused(readRefusal(nhdr), {"3: ", "v.raw", "truncated"});
  expectRefused(readRefusal(mhd), {"3: ", "v.raw", "truncated"});
  std::filesystem::remove(path("v.raw"));
  expectRefused(readRefusal(nhdr), {"3: ", "v.nhdr", "v.raw"});
  expectRefused(readRefusal(mhd), {"3: ", "v.mhd", "v.raw"});
}

TEST_F(ReadVolume, DigestIsOfTheVoxelBytes) {
  // sha256sum of the eight bytes "abcdefgh"
  const auto v = readQuietly(writeMeta("MET_UCHAR", "abcdefgh"));
  EXPECT_EQ(describeSource(v).sha256,
            "9c56cc51b374c3ba189210d5b6d4bf57790d351c96c47c02190ecf1e430635ab");
}

TEST_F(ReadVolume, DescriptionHoldsTheGeometryRowMajor) {
  const Volume v = oblique<std::uint8_t>();
  const auto source = describeSource(v);
  EXPECT_EQ(source.size, (std::array<std::uint32_t, 3>{5, 4, 3}));
  EXPECT_EQ(source.spacing, (std::array{0.3, 0.45, 1.25}));
  EXPECT_EQ(source.origin, (std::array{-12.5, 33.25, 101.125}));
  EXPECT_EQ(source.direction[1], v.geometry.direction(0, 1));
}

TEST_F(ReadVolume, CancelledProgressStopsIt) {
  Progress progress;
  progress.cancel();
  const auto file = writeMeta("MET_UCHAR", "abcdefgh");
  expectRefused(refusal([&] { (void)readVolume(file, VolumeFormat::MetaImage, {}, progress); }),
                {"130: "});
}

TEST(RealVolume, RotationalAngiogramOpens) {
  const fs::path file = LUMEN_SHARED_DATA "/aneurism-3dra.nrrd";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
  const Volume v = readQuietly(file);
  EXPECT_EQ(v.geometry.size, (std::array{256, 256, 256}));
  EXPECT_EQ(v.voxels.index(), 0U);
  EXPECT_EQ(v.geometry.direction, Eigen::Matrix3d::Identity());
}

TEST(RealVolume, AortaOpens) {
  const fs::path file = LUMEN_SHARED_DATA "/aorta/aorta.mha";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
  const Volume v = readQuietly(file);
  EXPECT_EQ(v.geometry.size, (std::array{157, 393, 34}));
  EXPECT_LT((v.geometry.spacing - Vector3d(0.878906, 0.878906, 1.50009)).norm(), 1e-9);
  EXPECT_LT((v.geometry.origin - Vector3d(-156.445, -24.6094, 0)).norm(), 1e-9);
}

TEST(RealVolume, FistulaOpens) {
  const fs::path file = LUMEN_SHARED_DATA "/avf/avf.nii";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
  const Volume v = readQuietly(file);
  EXPECT_EQ(v.geometry.size, (std::array{74, 93, 20}));
  EXPECT_LT((v.geometry.spacing - Vector3d(0.722656, 0.722656, 1)).norm(), 1e-6);
}

// Files that have shown faults, where they are at hand: what each is answered with.
namespace fs = std::filesystem;

class SharedVolume : public testing::Test {
protected:
  static fs::path file(const char* name) {
    return fs::path(LUMEN_SHARED_DATA).parent_path() / "hostile" / name;
  }
};

TEST_F(SharedVolume, HeadersThatAttackAreRefused) {
  if (!fs::exists(file("a1.mha"))) GTEST_SKIP() << file("a1.mha") << " is absent";
  expectRefused(readRefusal(file("a1.mha")), {"3: ", "%s%s%s%s.raw", "pattern"});
  expectRefused(readRefusal(file("a2.mha")), {"3: ", "s%d.raw 0 47 0", "step"});
  expectRefused(readRefusal(file("a3.mha")), {"3: ", "NDims is \"-1\""});
  expectRefused(readRefusal(file("a5.mha")), {"3: ", "of 221184 bytes", "70000"});
}

TEST_F(SharedVolume, AssumptionsAreReported) {
  if (!fs::exists(file("a7.nrrd"))) GTEST_SKIP() << file("a7.nrrd") << " is absent";
  const Volume metres = readQuietly(file("a7.nrrd"));
  EXPECT_EQ(metres.geometry.spacing, Eigen::Vector3d::Constant(200));
  expectAssumes(metres, {"200", "unusual", "--unit"});
  expectAssumes(readQuietly(file("a8.mha")), {"no spacing", "--spacing"});
  expectAssumes(readQuietly(file("spacings-nan.nrrd")), {"no spacing", "--spacing"});
}

TEST_F(SharedVolume, ASoundOneIsReadWithoutAWord) {
  const fs::path sound = file("track-never-ends.nrrd");
  if (!fs::exists(sound)) GTEST_SKIP() << sound << " is absent";
  const Volume volume = readQuietly(sound);
  EXPECT_EQ(volume.geometry.size, (std::array{221, 221, 221}));
  EXPECT_TRUE(volume.assumptions.empty());
}

}  // namespace
}  // namespace lumen::convert
