// SPDX-License-Identifier: Apache-2.0
// The listing of a folder of DICOM, and folders with files that cannot be read.
#include "converters/io/volume/dicom/dicom_series.h"

#include <algorithm>

#include "dicom_fixture.h"
#include "fixtures.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

class DicomListingTest : public DicomTest {
protected:
  /// Two series, a damaged file of the second, one that names no series, and a text.
  void writeMixture() const {
    writeSeries("a", {}, 4);
    DicomSlice other;
    other.series = "1.2.3.2";
    other.description = "Mask";
    other.columns = 300;
    other.rows = 200;
    other.before = DicomSlice::text(0x10, 0x10, "PN", "Somebody^Real");
    writeSeries("b", other, 3);
    other.number = 9;
    const std::string image = other.bytes();
    write("broken.dcm", image.substr(0, image.size() - 10));  // in its pixels
    write("early.dcm", image.substr(0, 210));                 // in a value before its series
    write("notes.txt", "not an image");
  }
  [[nodiscard]] DicomListing list(const ReadVolumeOptions& options = {}) const {
    Progress silent;
    return listDicomSeries(directory(), worded(options), silent);
  }
};

TEST_F(DicomListingTest, SeriesAreDescribedAndFaultyFilesStopNothing) {
  writeMixture();
  const DicomListing listing = list();
  ASSERT_EQ(listing.series.size(), 2U);
  const DicomSeries& first = listing.series[0];
  EXPECT_EQ(first.uid, "1.2.3.1");
  EXPECT_EQ(first.description, "Angio");
  EXPECT_EQ(first.modality, "CT");
  EXPECT_EQ(first.files, 4U);
  EXPECT_EQ(first.size, (std::array{4, 3, 4}));
  EXPECT_LT((first.spacing - Vector3d(0.25, 0.5, 2)).norm(), 1e-9);
  EXPECT_EQ(first.fault, "");
  ASSERT_EQ(listing.faults.size(), 2U);
  EXPECT_NE(listing.faults[0].find("broken.dcm"), std::string::npos) << listing.faults[0];
  EXPECT_NE(listing.faults[1].find("early.dcm"), std::string::npos) << listing.faults[1];
  EXPECT_EQ(listing.others, 1U);
}

TEST_F(DicomListingTest, AFolderInMemoryIsReadAsOneOnDisk) {
  writeMixture();
  std::vector<std::string> bytes;
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(directory())) {
    names.push_back(entry.path().filename().string());
    bytes.push_back(bytesOf(entry.path()));
  }
  std::vector<InputFile> files;
  for (std::size_t n = 0; n < names.size(); ++n) files.emplace_back(names[n], bytes[n]);
  const InputFile folder("dropped", files);
  const ReadVolumeOptions first{.series = "1.2.3.1", .skipFaulty = true};
  const Volume expected = readQuietly(directory(), first);
  Progress silent;
  const DicomListing listing = listDicomSeries(folder, {}, silent);
  EXPECT_EQ(listing.series.size(), 2U);
  EXPECT_EQ(listing.series[1].picture.pixel, list().series[1].picture.pixel);
  ASSERT_EQ(listing.faults.size(), 2U);
  EXPECT_TRUE(listing.faults[0].starts_with("broken.dcm: ")) << listing.faults[0];
  EXPECT_EQ(listing.others, 1U);
  const Volume read = readVolume(folder, VolumeFormat::Dicom, first, Progress());
  EXPECT_EQ(read.voxels, expected.voxels);
  EXPECT_EQ(read.assumptions, expected.assumptions);
  expectRefused(refusal([&] { (void)readVolume(folder, VolumeFormat::Nrrd, {}, Progress()); }),
                {"3: ", "dropped", "is a folder"});
}

TEST_F(DicomListingTest, ThePictureIsTheMiddleSliceAndSmall) {
  writeMixture();
  const DicomListing listing = list();
  const GreyPicture& small = listing.series[0].picture;
  EXPECT_EQ(small.width, 4);
  EXPECT_EQ(small.height, 3);
  EXPECT_EQ(small.pixel.front(), 0);
  EXPECT_EQ(small.pixel.back(), 255);
  const GreyPicture& reduced = listing.series[1].picture;
  EXPECT_EQ(reduced.width, 100);  // every third pixel
  EXPECT_EQ(reduced.height, 67);
  EXPECT_EQ(reduced.pixel.size(), 6700U);
  EXPECT_TRUE(std::is_sorted(reduced.pixel.begin(), reduced.pixel.end()));
}

TEST_F(DicomListingTest, ASeriesThatIsNoVolumeIsListedWithTheReason) {
  writeSeries("a", {}, 1);
  DicomSlice gap;
  gap.series = "1.2.3.2";
  for (const int z : {0, 2, 9}) {
    gap.number = z;
    gap.position = "0\\0\\" + std::to_string(z);
    write("b" + std::to_string(z), gap.bytes());
  }
  const DicomListing listing = list();
  ASSERT_EQ(listing.series.size(), 2U);
  EXPECT_NE(listing.series[0].fault.find("only slice"), std::string::npos);
  EXPECT_NE(listing.series[1].fault.find("mm apart"), std::string::npos);
  EXPECT_EQ(listing.series[1].size, (std::array{4, 3, 3}));
  EXPECT_FALSE(listing.series[1].picture.pixel.empty());
}

TEST_F(DicomListingTest, AStatedSpacingReplacesOneThatIsMissing) {
  DicomSlice slice;
  slice.spacing = "none";
  writeSeries("a", slice, 3);
  EXPECT_NE(list().series[0].fault.find("--spacing"), std::string::npos);
  ReadVolumeOptions options;
  options.spacing = Vector3d(1, 2, 3);
  EXPECT_EQ(list(options).series[0].fault, "");
  EXPECT_EQ(list(options).series[0].spacing, Vector3d(1, 2, 3));
}

TEST_F(DicomListingTest, FaultyFilesAreLeftOutOnDemandAndNamed) {
  writeMixture();
  ReadVolumeOptions options;
  options.series = "1.2.3.2";
  const auto read = [&] {
    return readVolume(directory(), VolumeFormat::Dicom, options, Progress());
  };
  EXPECT_NE(refusal([&] { (void)read(); }).find("broken.dcm"), std::string::npos);
  options.skipFaulty = true;
  const Volume volume = read();
  EXPECT_EQ(volume.geometry.size, (std::array{300, 200, 3}));
  const auto names = [&](const std::string& file) {
    return std::count_if(volume.assumptions.begin(), volume.assumptions.end(),
                         [&](const std::string& a) { return a.find(file) != std::string::npos; });
  };
  EXPECT_EQ(names("broken.dcm"), 1);
  EXPECT_EQ(names("early.dcm"), 1);
}

}  // namespace
}  // namespace lumen::convert
