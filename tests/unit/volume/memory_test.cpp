// SPDX-License-Identifier: Apache-2.0
// Volumes in memory: bytes under the name of a file.
#include <filesystem>

#include "converters/base/files.h"
#include "converters/io/content/file_content.h"
#include "converters/io/labels/label_table.h"
#include "tests/unit/volume/fixtures.h"

namespace lumen::convert {
namespace {

using VolumeInMemory = FileTest;

Volume readBytes(const std::string& name, const std::string& bytes,
                 const ReadVolumeOptions& options = {}) {
  return readVolume({name, bytes}, formatOf(name), worded(options), Progress());
}

Volume ramp() {
  Volume volume =
      makeVolume<std::int16_t>({40, 30, 20}, [](int i, int j, int k) { return i + 40 * j - k; });
  volume.geometry.spacing = {0.5, 0.25, 2};
  volume.geometry.origin = {-3, 7, 100};
  return volume;
}

TEST_F(VolumeInMemory, IsThatOfItsFile) {
  ReadVolumeOptions cut;
  cut.crop = CellBox{{3, 4, 5}, {20, 10, 8}};
  for (const char* name : {"v.nrrd", "v.nii", "v.nii.gz", "v.mha"}) {
    writeAsNamed(ramp(), path(name));
    const std::string bytes = bytesOf(path(name));
    std::filesystem::remove(path(name));
    for (const ReadVolumeOptions& options : {ReadVolumeOptions{}, cut}) {
      const Volume read = readBytes(name, bytes, options);
      writeNewFile(bytes, path(name));
      const Volume expected = readQuietly(path(name), options);
      std::filesystem::remove(path(name));
      EXPECT_EQ(read.voxels, expected.voxels) << name;
      EXPECT_EQ(read.geometry.origin, expected.geometry.origin) << name;
      EXPECT_EQ(read.geometry.size, expected.geometry.size) << name;
    }
    const VolumeHeader header = readVolumeHeader({name, bytes}, formatOf(name), {}, Progress());
    EXPECT_EQ(header.storedBytes, bytes.size()) << name;
    EXPECT_EQ(detectContent({name, bytes}).kind, ContentKind::Volume) << name;
  }
}

TEST_F(VolumeInMemory, MayConsistOfTwoPieces) {
  for (const char* name : {"v.nrrd", "v.nii", "v.nii.gz", "v.mha"}) {
    writeAsNamed(ramp(), path(name));
    const std::string bytes = bytesOf(path(name));
    const Volume expected = readBytes(name, bytes);
    for (const std::size_t at : {std::size_t{0}, std::size_t{1}, std::size_t{347}, bytes.size() / 2,
                                 bytes.size() - 1, bytes.size()}) {
      const InputFile pieces(name, std::string_view(bytes).substr(0, at),
                             std::string_view(bytes).substr(at));
      EXPECT_EQ(pieces.size(), bytes.size());
      EXPECT_EQ(pieces.read("volume", kAnySize), bytes);
      const Volume read = readVolume(pieces, formatOf(name), worded({}), Progress());
      EXPECT_EQ(read.voxels, expected.voxels) << name << " cut at " << at;
    }
  }
}

TEST_F(VolumeInMemory, ThatEndsTooEarlyIsRefused) {
  for (const char* name : {"v.nrrd", "v.nii", "v.nii.gz", "v.mha"}) {
    writeAsNamed(ramp(), path(name));
    const std::string bytes = bytesOf(path(name));
    for (const std::size_t size : {std::size_t{0}, std::size_t{100}, bytes.size() - 100}) {
      const std::string cut = bytes.substr(0, size);
      expectRefused(refusal([&] { (void)readBytes(name, cut); }), {"3: ", name});
    }
  }
}

TEST_F(VolumeInMemory, OpensNoFileThatItsHeaderNames) {
  // the file is there, and would be read if the header were in a file beside it
  const std::string header =
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: voxels.raw\n";
  write("voxels.raw", "12345678");
  EXPECT_EQ(readRefusal(write("v.nhdr", header)), "");
  const std::string name = path("w.nhdr").string();
  expectRefused(refusal([&] { (void)readBytes(name, header); }),
                {"3: ", "w.nhdr", "voxels.raw", "expected them behind its header"});
  const std::string meta =
      "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = voxels.raw\n";
  EXPECT_EQ(readRefusal(write("v.mhd", meta)), "");
  const std::string metaName = path("w.mhd").string();
  expectRefused(refusal([&] { (void)readBytes(metaName, meta); }),
                {"3: ", "w.mhd", "voxels.raw", "expected them behind its header"});
}

TEST_F(VolumeInMemory, OpensAFileThatIsAllowedByItsWholeName) {
  const std::string voxels = path("voxels.raw").string();
  writeNewFile(std::string(7, '\1') + '\2', voxels);
  const std::string header =
      "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nspacings: 1 1 1\nencoding: raw\ndata "
      "file: ";
  ReadVolumeOptions allowed;
  allowed.allowedDetached = {path("")};
  EXPECT_EQ(readBytes("w.nhdr", header + voxels + "\n", allowed).geometry.voxelCount(), 8U);
  expectRefused(refusal([&] { (void)readBytes("w.nhdr", header + voxels + "\n"); }),
                {"3: ", "w.nhdr", "expected them behind its header"});
  const std::string relative = header + "voxels.raw\n";
  expectRefused(refusal([&] { (void)readBytes("w.nhdr", relative, allowed); }),
                {"3: ", "w.nhdr", "expected them behind its header"});
}

TEST_F(VolumeInMemory, ThatIsNoVolumeIsRefusedByItsContent) {
  expectRefused(refusal([&] { (void)readBytes("v.nrrd", " <html><body>404</body></html>"); }),
                {"3: ", "v.nrrd", "web page"});
}

TEST(SegmentNames, InMemoryAreThoseOfTheHeader) {
  const std::string header = "NRRD0004\nSegment0_LabelValue:=7\nSegment0_Name:=aorta\n\nx";
  EXPECT_EQ(ownNames({"a.seg.nrrd", header}).names, (LabelNames{{7, "aorta"}}));
}

}  // namespace
}  // namespace lumen::convert
