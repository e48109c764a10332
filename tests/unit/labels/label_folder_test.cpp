// SPDX-License-Identifier: Apache-2.0
// Folders with a file for each structure, and label maps of others.
#include "converters/io/labels/label_folder.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/io/labels/label_meaning.h"
#include "tests/unit/volume/fixtures.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

/// A cube of 1 from `first` to `last` of an edge of `size` voxels.
Volume cube(int size, int first, int last) {
  return makeVolume<std::uint8_t>({size, size, size}, [=](int i, int j, int k) {
    return std::min({i, j, k}) >= first && std::max({i, j, k}) <= last ? 1 : 0;
  });
}

class LabelFolderTest : public FileTest {
protected:
  void put(const std::string& name, const Volume& volume) { writeAsNamed(volume, path(name)); }
  [[nodiscard]] FolderMap read() const { return readLabelFolder(path(""), {}, Progress()); }
  /// Voxels by the names of the labels.
  static std::map<std::string, std::size_t> voxels(const FolderMap& map) {
    std::map<std::string, std::size_t> named;
    for (const auto& [value, count] : countLabels(map.voxels))
      named[map.table.names.at(value)] = count;
    return named;
  }
};
using Counts = std::map<std::string, std::size_t>;

TEST_F(LabelFolderTest, IsOneMapOfTheNamesOfItsFiles) {
  put("aorta.nii.gz", cube(8, 1, 2));
  put("rib_left_1.nii.gz", cube(8, 5, 6));
  put("spleen.nii.gz", makeVolume<std::uint8_t>({8, 8, 8}, [](int, int, int) { return 0; }));
  write("statistics.json", "{}");
  ASSERT_TRUE(isLabelFolder(path("")));
  const FolderMap map = read();
  EXPECT_EQ(voxels(map), (Counts{{"aorta", 8}, {"rib_left_1", 8}}));
  EXPECT_EQ(map.table.names, (LabelNames{{1, "aorta"}, {2, "rib_left_1"}, {3, "spleen"}}));
  EXPECT_TRUE(map.remarks.empty());
  EXPECT_EQ(map.header.encoding, "3 files");
}

TEST_F(LabelFolderTest, AVesselWinsWhereStructuresOverlapAndThenTheSmallerOne) {
  put("aorta.nii.gz", cube(8, 0, 2));
  put("heart.nii.gz", cube(8, 2, 2));
  put("heart_atrium_left.nii.gz", cube(8, 2, 3));
  const FolderMap map = read();
  // voxel (2, 2, 2) is in all three: that of the atrium, a lumen that is smaller than the aorta
  EXPECT_EQ(voxels(map), (Counts{{"aorta", 26}, {"heart_atrium_left", 8}}));
  ASSERT_EQ(map.remarks.size(), 1U);
  EXPECT_NE(map.remarks.front().find("structures overlap in 2 voxels, aorta and heart"),
            std::string::npos)
      << map.remarks.front();
}

TEST_F(LabelFolderTest, AFileWithAnotherGridIsPlacedByPosition) {
  put("aorta.nii.gz", cube(8, 1, 2));
  Volume coarse = cube(4, 2, 2);  // 2 mm: voxel 2 reaches from 3.5 to 5.5 mm
  coarse.geometry.spacing = {2, 2, 2};
  coarse.geometry.origin = {0.5, 0.5, 0.5};
  put("vena_cava.nii.gz", coarse);
  const FolderMap map = read();
  EXPECT_EQ(voxels(map), (Counts{{"aorta", 8}, {"vena_cava", 8}}));
  EXPECT_EQ(
      std::get<std::vector<std::uint8_t>>(map.voxels.voxels)[map.voxels.geometry.index({4, 5, 4})],
      2);
  coarse.geometry.origin = {96, 0, 0};
  put("vena_cava.nii.gz", coarse);
  const FolderMap apart = read();
  EXPECT_EQ(voxels(apart), (Counts{{"aorta", 8}}));
  ASSERT_EQ(apart.remarks.size(), 1U);
  EXPECT_NE(apart.remarks.front().find("1 voxel lies outside of the grid"), std::string::npos);
}

TEST_F(LabelFolderTest, AVolumeOfSeveralLabelsIsNoStructure) {
  put("aorta.nii.gz", cube(8, 1, 2));
  put("map.nii.gz", makeVolume<std::uint8_t>({8, 8, 8}, [](int i, int, int) { return i / 2; }));
  expectRefused(refusal([&] { (void)read(); }), {"3: ", "map.nii.gz", "has several values"});
}

TEST_F(LabelFolderTest, AFolderThatMayBeOfDicomIsNone) {
  put("aorta.nii.gz", cube(8, 1, 2));
  write("._aorta.nii.gz", "x");
  write("README", "x");
  EXPECT_TRUE(isLabelFolder(path("")));
  EXPECT_EQ(read().table.names.size(), 1U);
  EXPECT_FALSE(isLabelFolder(path("aorta.nii.gz")));
  fs::create_directory(path("dicom"));
  write("dicom/1.2.840.5", std::string(128, '\0') + "DICM");
  EXPECT_FALSE(isLabelFolder(path("")));
}

// Real maps of TotalSegmentator.

class PriorMaps : public FileTest {
protected:
  void SetUp() override {
    if (!fs::is_directory(folder()))
      GTEST_SKIP() << "no " << folder() << ", which is not part of the repository";
  }
  static fs::path folder() { return fs::path(LUMEN_SHARED_DATA) / "prior"; }
};

TEST_F(PriorMaps, NameTheirLabels) {
  std::vector<LabelMeaning> lumens =
      meaningsOf(ownNames(folder() / "T716_aorta_true_false_lumen.nii.gz"));
  ASSERT_EQ(lumens.size(), 2U);
  EXPECT_EQ(lumens[0].role, LabelRole::TrueLumen);
  EXPECT_EQ(lumens[1].role, LabelRole::FalseLumen);
  const fs::path body = folder() / "body-ct-totalsegmentator-part.nii.gz";
  const std::vector<LabelMeaning> total = meaningsOf(ownNames(body));
  EXPECT_EQ(total.size(), 117U);
  for (const LabelMeaning& meaning : total)
    EXPECT_NE(meaning.role, LabelRole::Unknown) << meaning.name;
  EXPECT_EQ(total[51].name, "aorta");
  EXPECT_GT(countLabels(readQuietly(body)).size(), 10U);
}

TEST_F(PriorMaps, AFolderOfTheirsIsOneMap) {
  const std::vector<std::string> names = {"brachiocephalic_trunk",      "celiac_trunk",
                                          "common_carotid_artery_left", "subclavian_artery_left",
                                          "superior_mesenteric_artery", "vertebrae_T12"};
  for (const std::string& name : names)
    fs::create_symlink(folder() / (name + ".nii.gz"), path(name + ".nii.gz"));
  const FolderMap map = readLabelFolder(path(""), {}, Progress());
  const std::vector<LabelMeaning> meanings = meaningsOf(map.table);
  const std::map<std::int64_t, std::size_t> counts = countLabels(map.voxels);
  ASSERT_EQ(meanings.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(meanings[i].name, names[i]);
    EXPECT_EQ(meanings[i].role, i == 5 ? LabelRole::Bone : LabelRole::Artery);
    EXPECT_GT(counts.at(meanings[i].value), 20U) << names[i];
  }
}

}  // namespace
}  // namespace lumen::convert
