// SPDX-License-Identifier: Apache-2.0
// Volumes that lumen writes, read by ITK, as 3D Slicer and ITK-SNAP do.
#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include "converters/io/volume/write_volume.h"
#include "fixtures.h"

namespace lumen::convert {
namespace {

using Type = itk::IOComponentEnum;

class ItkReads : public FileTest {
protected:
  /// Writes a volume of T under this name, and expects that ITK reads the same.
  template <class T, class Io>
  void expectReads(const std::string& name, bool compressed, Type type) const {
    Volume volume = makeVolume<T>({5, 4, 3}, [](int i, int j, int k) { return i + 7 * j - 9 * k; });
    volume.geometry.spacing = {0.3, 0.45, 1.25};
    volume.geometry.origin = {-12.5, 33.25, 1.0 / 3};
    volume.geometry.direction =
        Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    volume.geometry.direction.col(1) *= -1;
    write(name, encodeVolume(volume, formatOf(name), compressed, name));
    expectEqual<Io>(volume, name, type);
  }

  template <class Io>
  void expectEqual(const Volume& volume, const std::string& name, Type type) const {
    const auto io = Io::New();
    io->SetFileName(path(name).string());
    io->ReadImageInformation();
    ASSERT_EQ(io->GetNumberOfDimensions(), 3U) << name;
    EXPECT_EQ(io->GetComponentType(), type) << name;
    EXPECT_EQ(io->GetNumberOfComponents(), 1U) << name;
    itk::ImageIORegion region(3);
    for (unsigned a = 0; a < 3; ++a) {
      EXPECT_EQ(io->GetDimensions(a), static_cast<unsigned>(volume.geometry.size[a])) << name;
      EXPECT_NEAR(io->GetSpacing(a), volume.geometry.spacing[a], 1e-6) << name;
      EXPECT_NEAR(io->GetOrigin(a), volume.geometry.origin[a], 1e-5) << name;
      const std::vector<double> direction = io->GetDirection(a);
      for (unsigned r = 0; r < 3; ++r)
        EXPECT_NEAR(direction[r], volume.geometry.direction(r, a), 1e-5) << name;
      region.SetSize(a, io->GetDimensions(a));
    }
    io->SetIORegion(region);
    std::string bytes(voxelBytes(volume).size(), '\0');
    ASSERT_EQ(static_cast<std::size_t>(io->GetImageSizeInBytes()), bytes.size()) << name;
    io->Read(bytes.data());
    EXPECT_TRUE(bytes == voxelBytes(volume)) << name;
  }

  template <class Io>
  void expectEveryType(const std::string& name, bool compressed) const {
    expectReads<std::uint8_t, Io>(name, compressed, Type::UCHAR);
    expectReads<std::int16_t, Io>(name, compressed, Type::SHORT);
    expectReads<std::uint16_t, Io>(name, compressed, Type::USHORT);
    expectReads<float, Io>(name, compressed, Type::FLOAT);
  }
};

TEST_F(ItkReads, EveryTypeAndObliqueLeftHandedAxesOfNrrd) {
  expectEveryType<itk::NrrdImageIO>("v.nrrd", true);
  expectEveryType<itk::NrrdImageIO>("v.nrrd", false);
}

TEST_F(ItkReads, EveryTypeAndObliqueLeftHandedAxesOfMetaImage) {
  expectEveryType<itk::MetaImageIO>("v.mha", true);
  expectEveryType<itk::MetaImageIO>("v.mha", false);
}

TEST_F(ItkReads, EveryTypeAndObliqueLeftHandedAxesOfNifti) {
  expectEveryType<itk::NiftiImageIO>("v.nii.gz", true);
  expectEveryType<itk::NiftiImageIO>("v.nii", false);
}

TEST_F(ItkReads, AHeaderOfMetaImageWithItsVoxelsBeside) {
  const Volume volume = makeVolume<float>({4, 3, 2}, [](int i, int j, int k) { return i - j * k; });
  write("v.mhd", metaImageHeader(volume, "v.raw"));
  write("v.raw", std::string(voxelBytes(volume)));
  expectEqual<itk::MetaImageIO>(volume, "v.mhd", Type::FLOAT);
}

TEST_F(ItkReads, NotesOfNrrdWithBackslashesAndLines) {
  const Volume volume = makeVolume<float>({4, 3, 2}, [](int i, int, int) { return i; });
  write("v.nrrd", encodeVolume(volume, VolumeFormat::Nrrd, true, "v", {{"key", "a\\b\nc := d"}}));
  const auto io = itk::NrrdImageIO::New();
  io->SetFileName(path("v.nrrd").string());
  io->ReadImageInformation();
  std::string text;
  ASSERT_TRUE(itk::ExposeMetaData(io->GetMetaDataDictionary(), "key", text));
  EXPECT_EQ(text, "a\\b\nc := d");
  EXPECT_EQ(readQuietly(path("v.nrrd")).voxels, volume.voxels);
}

}  // namespace
}  // namespace lumen::convert
