// SPDX-License-Identifier: Apache-2.0
// Segmentations and structure sets of DICOM as label maps: made by hand, and by other programs (tests/data/dicom).
#include <gtest/gtest.h>

#include "converters/io/labels/label_meaning.h"
#include "converters/io/labels/label_table.h"
#include "dicom_fixture.h"
#include "fixtures.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Slice = DicomSlice;

std::string item(const std::vector<std::string>& elements) {
  std::string all;
  for (const std::string& element : elements) all += element;
  return all;
}

std::string code(int group, int element, const std::string& meaning) {
  return Slice::openSequence(group, element, {Slice::text(8, 0x104, "LO", meaning)});
}

std::string segment(int number, const std::string& label, const std::string& type) {
  return item(
      {Slice::number16(0x62, 4, number), Slice::text(0x62, 5, "LO", label), code(0x62, 0xf, type)});
}

/// A frame at a place along z, of a segment.
std::string frame(int number, double z) {
  return item({Slice::openSequence(0x20, 0x9113,
                                   {Slice::text(0x20, 0x32, "DS", "0\\0\\" + std::to_string(z))}),
               Slice::openSequence(0x62, 0xa, {Slice::number16(0x62, 0xb, number)})});
}

class DicomLabelMaps : public DicomTest {
protected:
  /// A segmentation of 4 x 3 pixels a frame.
  void writeSegments(const std::string& type, int bits, const std::vector<std::string>& frames,
                     const std::string& pixels, const std::string& more = {}) const {
    Slice slice;
    slice.position = "";
    slice.frames = static_cast<int>(frames.size());
    slice.bits = slice.bitsUsed = bits;
    slice.beforePixels =
        more +
        Slice::openSequence(0x62, 2, {segment(1, "Wide", "Artery"), segment(2, "Thin", "Vein")}) +
        Slice::text(0x62, 1, "CS", type) + Slice::number16(0x62, 0xe, 200) +
        Slice::openSequence(0x5200, 0x9230, frames);
    slice.pixelElement = Slice::tag(0x7fe0, 0x10) + "OB" + std::string(2, '\0') +
                         Slice::raw(static_cast<std::uint32_t>(pixels.size())) + pixels;
    write("seg.dcm", slice.bytes());
  }
  [[nodiscard]] Volume map() const {
    return readVolume(path("seg.dcm"), VolumeFormat::Dicom, worded({}), Progress());
  }
  static std::string labelsOf(const Volume& volume) {
    std::string text;
    for (const std::uint8_t label : std::get<std::vector<std::uint8_t>>(volume.voxels))
      text += std::to_string(label);
    return text;
  }
};

// Bits of frames follow one another without a gap, twelve each. Frames at 4 and 6 mm are left out, as
// they are empty; two segments overlap at 2 mm.
TEST_F(DicomLabelMaps, BitsOfSegmentsAreLabelsAndTheSmallerOneWins) {
  writeSegments("BINARY", 1, {frame(1, 2), frame(1, 8), frame(2, 2)},
                std::string("\x0f\x10\x00\x02\x00\x00", 6), Slice::text(0x18, 0x88, "DS", "2"));
  const Volume v = map();
  EXPECT_EQ(v.geometry.size, (std::array{4, 3, 4}));
  EXPECT_NEAR(v.geometry.spacing[2], 2, 1e-12);
  EXPECT_NEAR(v.geometry.origin[2], 2, 1e-12);
  EXPECT_EQ(labelsOf(v),
            "121100000000"
            "000000000000"
            "000000000000"
            "100000000000");
  ASSERT_EQ(v.assumptions.size(), 1U);
  expectRefused(v.assumptions[0], {"overlap in 1 voxel", "smallest"});
}

TEST_F(DicomLabelMaps, NamesAndRolesAreThoseOfTheSegments) {
  writeSegments("BINARY", 1, {frame(1, 2), frame(2, 4)}, std::string("\x0f\x00\x01\x00", 4));
  const std::vector<LabelMeaning> meanings = meaningsOf(ownNames(path("seg.dcm")));
  ASSERT_EQ(meanings.size(), 2U);
  EXPECT_EQ(meanings[0].name, "Wide");
  EXPECT_EQ(meanings[0].role, LabelRole::Artery);
  EXPECT_EQ(meanings[1].role, LabelRole::Vein);
  EXPECT_EQ(meanings[1].roleFrom, "terminology");
}

TEST_F(DicomLabelMaps, SharesOfAHalfAndMoreAreLabels) {
  std::string shares(24, '\0');
  shares[0] = 100;
  shares[1] = 99;
  shares[12] = static_cast<char>(200);
  writeSegments("FRACTIONAL", 8, {frame(1, 2), frame(2, 4)}, shares);
  const Volume v = map();
  EXPECT_EQ(labelsOf(v),
            "100000000000"
            "200000000000");
  expectRefused(v.assumptions.at(0), {"FRACTIONAL", "half"});
}

TEST_F(DicomLabelMaps, PixelsOfALabelMapAreLabelsButItsPadding) {
  std::string labels(24, '\5');
  labels[0] = 1;
  labels[13] = 2;
  writeSegments("LABELMAP", 8, {frame(1, 2), frame(1, 6)}, labels, Slice::number16(0x28, 0x120, 5));
  EXPECT_EQ(labelsOf(map()),
            "100000000000"
            "020000000000");
}

TEST_F(DicomLabelMaps, OneFrameIsAVolumeOfTwoSlices) {
  writeSegments("BINARY", 1, {frame(1, 2)}, std::string("\x0f\x00", 2));
  EXPECT_EQ(map().geometry.size, (std::array{4, 3, 2}));
}

TEST_F(DicomLabelMaps, FaultsAreNamed) {
  writeSegments("OTHER", 1, {frame(1, 2), frame(1, 4)}, std::string(4, '\1'));
  expectRefused(refusal([&] { (void)map(); }),
                {"4: ", "seg.dcm", "(0062,0001)", "OTHER", "BINARY"});
  writeSegments("BINARY", 1, {frame(1, 2), frame(1, 4), frame(1, 4.5)}, std::string(6, '\1'));
  EXPECT_EQ(map().geometry.size[2], 6);
  writeSegments("BINARY", 1, {frame(1, 2), frame(1, 4), frame(1, 4.7)}, std::string(6, '\1'));
  expectRefused(refusal([&] { (void)map(); }), {"3: ", "multiples", "(0020,0032)"});
  writeSegments("BINARY", 1, {frame(0, 2), frame(1, 4)}, std::string(4, '\1'));
  expectRefused(refusal([&] { (void)map(); }), {"3: ", "names no segment", "(0062,000b)"});
  writeSegments("BINARY", 1, {frame(1, 2), frame(1, 4)}, std::string(2, '\1'));
  expectRefused(refusal([&] { (void)map(); }), {"3: ", "truncated", "3 bytes"});
}

TEST_F(DicomLabelMaps, ASegmentationBesideASeriesIsNoChoice) {
  writeSegments("BINARY", 1, {frame(1, 2), frame(1, 4)}, std::string("\x0f\x00\x01\x00", 4));
  Slice slice;
  slice.series = "1.2.3.2";
  slice.columns = 5;
  writeSeries("a", slice, 3);
  EXPECT_EQ(readQuietly(directory()).geometry.size, (std::array{5, 3, 3}));
  EXPECT_EQ(readQuietly(directory(), {"1.2.3.1", {}}).geometry.size, (std::array{4, 3, 2}));
}

// Files of other programs; counts are those of pydicom 3.0.2 and of the dcmqi repository's own conversion to NRRD.
TEST(DicomOfOthers, SegmentationsAreLabelMaps) {
  struct Known {
    const char* file;
    std::array<int, 3> size;
    std::ptrdiff_t voxels;
    const char* name;
  };
  for (const Known& known : {Known{"highdicom-binary.dcm", {16, 16, 3}, 638, "first segment"},
                             Known{"highdicom-fractional.dcm", {16, 16, 3}, 638, "first segment"},
                             Known{"dcmqi-labelmap.dcm", {24, 38, 3}, 630, "Liver"}}) {
    const std::filesystem::path file = std::filesystem::path(LUMEN_TEST_DATA "/dicom") / known.file;
    const Volume v = readVolume(file, VolumeFormat::Dicom, worded({}), Progress());
    EXPECT_EQ(v.geometry.size, known.size) << known.file;
    const auto& labels = std::get<std::vector<std::uint8_t>>(v.voxels);
    EXPECT_EQ(std::count(labels.begin(), labels.end(), 1), known.voxels) << known.file;
    EXPECT_EQ(ownNames(file).names.at(1), known.name);
  }
}

// Three squares of 400 mm, 10 mm apart, and two isocentres.
TEST(DicomOfOthers, AStructureSetWithoutMetaInformationIsALabelMap) {
  const std::filesystem::path file = LUMEN_TEST_DATA "/dicom/pydicom-rtstruct";
  const Volume v = readVolume(file, VolumeFormat::Dicom, worded({}), Progress());
  EXPECT_EQ(v.geometry.size[2], 3);
  EXPECT_NEAR(v.geometry.spacing[2], 10, 1e-9);
  const auto& labels = std::get<std::vector<std::uint8_t>>(v.voxels);
  const double area = static_cast<double>(std::count(labels.begin(), labels.end(), 1)) *
                      v.geometry.spacing[0] * v.geometry.spacing[1] / 3;
  EXPECT_NEAR(area, 410.0 * 310.0, 0.02 * 410 * 310);  // pixels on the border count
  EXPECT_EQ(ownNames(file).names.at(2), "Isocenter 1");
}

// Structure sets.

std::string square(double x, double y, double half, double z, const char* type = "CLOSED_PLANAR") {
  std::string points;
  for (const auto& [i, j] :
       {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}})
    points += (points.empty() ? "" : "\\") + std::to_string(x + half * i) + "\\" +
              std::to_string(y + half * j) + "\\" + std::to_string(z);
  return Slice::text(0x3006, 0x42, "CS", type) + Slice::text(0x3006, 0x50, "DS", points);
}

class StructureSets : public DicomTest {
protected:
  void writeSet(const std::vector<std::string>& contours, const std::string& numbered = "4") const {
    const std::string meta = Slice::uid(2, 2, "1.2.840.10008.5.1.4.1.1.481.3") +
                             Slice::uid(2, 3, "1.2.3.9") +
                             Slice::uid(2, 0x10, "1.2.840.10008.1.2.1");
    const std::string series = Slice::openSequence(
        0x3006, 0x12, {Slice::openSequence(0x3006, 0x14, {Slice::uid(0x20, 0xe, "1.2.3.1")})});
    write("rt.dcm", std::string(128, '\0') + "DICM" + meta + Slice::uid(0x20, 0xe, "1.2.3.8") +
                        Slice::openSequence(0x3006, 0x10, {series}) +
                        Slice::openSequence(0x3006, 0x20,
                                            {Slice::text(0x3006, 0x22, "IS", numbered) +
                                             Slice::text(0x3006, 0x26, "LO", "Aorta")}) +
                        Slice::openSequence(0x3006, 0x39,
                                            {Slice::openSequence(0x3006, 0x40, contours) +
                                             Slice::text(0x3006, 0x84, "IS", numbered)}));
  }
  [[nodiscard]] Volume map(const ReadVolumeOptions& options = {}) const {
    return readVolume(path("rt.dcm"), VolumeFormat::Dicom, worded(options), Progress());
  }
  static std::size_t count(const Volume& volume, int label) {
    const auto& labels = std::get<std::vector<std::uint8_t>>(volume.voxels);
    return static_cast<std::size_t>(std::count(labels.begin(), labels.end(), label));
  }
};

TEST_F(StructureSets, ContoursAreFilledOnTheGridOfTheSeriesBesideThem) {
  Slice slice;
  slice.columns = 40;
  slice.rows = 40;
  slice.spacing = "0.5\\0.5";
  writeSeries("a", slice, 5);  // from (-5, 7, 10), 2 mm apart
  // 8 x 8 mm, with a hole of 4 x 4 mm, in two slices
  writeSet({square(5, 17, 4.1, 12), square(5, 17, 2.1, 12), square(5, 17, 4.1, 14)});
  const Volume v = map();
  EXPECT_EQ(v.geometry.size, (std::array{40, 40, 5}));
  EXPECT_EQ(count(v, 4), 17U * 17U - 9U * 9U + 17U * 17U);
  expectRefused(v.assumptions.at(0), {"series in its folder"});
  EXPECT_EQ(ownNames(path("rt.dcm")).names, (LabelNames{{4, "Aorta"}}));
  EXPECT_EQ(readQuietly(directory()).geometry.size[2], 5);  // the set is no series
}

TEST_F(StructureSets, AGridCanBeStatedAndContoursBetweenItsSlicesReachTheNextOne) {
  writeSet({square(0, 0, 3.1, 0), square(0, 0, 3.1, 3), square(0, 0, 3.1, 6)});
  ReadVolumeOptions options;
  VolumeGeometry grid;
  grid.size = {20, 20, 12};
  grid.origin = Vector3d(-10, -10, -3);
  options.grid = grid;
  const Volume v = map(options);
  EXPECT_EQ(v.geometry.size, grid.size);
  EXPECT_EQ(count(v, 4), 7U * 7U * 9U);  // -1 to 7 mm
}

TEST_F(StructureSets, WithoutImagesTheGridIsAsFineAsThePoints) {
  writeSet({square(0, 0, 1, 0), square(0, 0, 1, 2.5), square(0, 0, 1, 2.5, "POINT")});
  const Volume v = map();
  EXPECT_NEAR(v.geometry.spacing[2], 2.5, 1e-9);
  EXPECT_NEAR(v.geometry.spacing[0], 2, 1e-9);
  ASSERT_EQ(v.assumptions.size(), 2U);
  expectRefused(v.assumptions[0], {"1 of its contours", "left out"});
  expectRefused(v.assumptions[1], {"no series", "2 x 2 x 2.5 mm"});
}

TEST_F(StructureSets, StructuresWithoutANumberOfALabelAreNumberedInTurn) {
  writeSet({square(0, 0, 3, 0), square(0, 0, 3, 1)}, "0");
  EXPECT_GT(count(map(), 1), 0U);
  EXPECT_EQ(ownNames(path("rt.dcm")).names, (LabelNames{{1, "Aorta"}}));
}

TEST_F(StructureSets, ContoursThatAreNoneAreRefused) {
  writeSet({square(0, 0, 3, 0, "POINT")});
  expectRefused(refusal([&] { (void)map(); }), {"3: ", "rt.dcm", "no closed contour (3006,0050)"});
  writeSet({square(0, 0, 0, 0)});
  expectRefused(refusal([&] { (void)map(); }), {"3: ", "enclose nothing"});
  writeSet({Slice::text(0x3006, 0x42, "CS", "CLOSED_PLANAR") +
            Slice::text(0x3006, 0x50, "DS", "1\\2\\3\\4")});
  expectRefused(refusal([&] { (void)map(); }), {"3: ", "(3006,0050)", "x, y and z"});
  writeSet({square(0, 0, 3, 0), Slice::text(0x3006, 0x42, "CS", "CLOSED_PLANAR") +
                                    Slice::text(0x3006, 0x50, "DS", "0\\0\\0\\9\\0\\5\\0\\9\\0")});
  expectRefused(refusal([&] { (void)map(); }), {"3: ", "off the plane", "parallel planes"});
}

}  // namespace
}  // namespace lumen::convert
