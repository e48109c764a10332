// SPDX-License-Identifier: Apache-2.0
// Tables of labels in files, and maps that name their labels themselves.
#include "converters/io/labels/label_table.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "tests/unit/volume/fixtures.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

class LabelTableTest : public ::testing::Test {
protected:
  void SetUp() override {
    m_folder = fs::path(::testing::TempDir()) /
               ("label-table-" +
                std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::create_directories(m_folder);
  }
  void TearDown() override { fs::remove_all(m_folder); }

  fs::path write(const std::string& name, const std::string& text) {
    std::ofstream(m_folder / name, std::ios::binary) << text;
    return m_folder / name;
  }
  LabelNames read(const std::string& name, const std::string& text) {
    return readLabelTable(write(name, text)).names;
  }
  /// The message without the folder; empty if the table is read.
  std::string refusal(const std::string& name, const std::string& text) {
    try {
      (void)read(name, text);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
      std::string message = error.what();
      const std::string folder = m_folder.string() + "/";
      if (const auto at = message.find(folder); at != message.npos)
        message.erase(at, folder.size());
      return message;
    }
    return "";
  }

  fs::path folder() const { return m_folder; }

private:
  fs::path m_folder;
};

LabelNames segmentNames(const fs::path& file) {
  return ownNames(file).names;
}

const LabelNames kTwo = {{1, "BA"}, {12, "left ICA"}};

TEST_F(LabelTableTest, EveryFormatGivesTheSameNames) {
  EXPECT_EQ(read("a.json", R"({"0": "background", "1": "BA", "12": "left ICA"})"), kTwo);
  EXPECT_EQ(read("a.csv", "1,BA\n12,left ICA\n"), kTwo);
  EXPECT_EQ(read("b.csv", "\xEF\xBB\xBFLabelValue,Color_R,Name\r\n12,3,\"left ICA\"\r\n1,4,BA\r\n"),
            kTwo);
  EXPECT_EQ(read("a.ctbl",
                 "# Color table file a.ctbl\n# 3 values\n0 Background 0 0 0 0\n"
                 "1 BA 216 101 79 255\n12 left_ICA 241 214 145 255\n"),
            kTwo);
}

TEST_F(LabelTableTest, TopcowHasThirteenClasses) {
  const LabelNames names = readLabelTable("topcow").names;
  EXPECT_EQ(names.size(), 13U);
  EXPECT_EQ(names.at(1), "BA");
  EXPECT_EQ(names.at(10), "Acom");
  EXPECT_EQ(names.at(15), "3rd-A2");
  EXPECT_FALSE(names.contains(13));
}

TEST_F(LabelTableTest, SegmentsOfSlicerNameThemselves) {
  const std::string head = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n";
  EXPECT_EQ(
      segmentNames(write("a.seg.nrrd",
                         head + "Segment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Name:=BA\n"
                                "Segment11_Name:=left ICA\nSegment11_LabelValue:=12\n"
                                "Segment2_LabelValue:=1\nSegment2_Layer:=1\nSegment2_Name:=x\n"
                                "Segmentation_ContainedRepresentationNames:=Binary labelmap|\n\n"
                                "Segment3_LabelValue:=7\nSegment3_Name:=data\n")),
      kTwo);
  EXPECT_TRUE(segmentNames(write("b.nrrd", head + "\nx")).empty());
  EXPECT_TRUE(segmentNames(write("c.nii", "Segment0_LabelValue:=1\n")).empty());
  EXPECT_THROW(
      (void)segmentNames(write("d.nrrd", head + "Segment0_LabelValue:=1\nSegment0_Name:=a\n"
                                                "Segment1_LabelValue:=1\nSegment1_Name:=b\n"
                                                "\n")),
      Error);
}

TEST_F(LabelTableTest, MessagesStatePlaceAndExpectation) {
  EXPECT_EQ(refusal("a.csv", "1,BA\n1,PCA\n"),
            "a.csv: line 2: names the label 1 twice, expected each once");
  EXPECT_EQ(refusal("a.csv", "value,name\nx,BA\n"),
            "a.csv: line 2: found the label \"x\", expected a whole number from 0 to 16777216");
  EXPECT_EQ(
      refusal("a.csv", "artery,colour\n"),
      "a.csv: line 1: found \"artery\", expected a row LABEL,NAME, or a header with the columns "
      "value and name");
  EXPECT_EQ(refusal("a.csv", "1\n"), "a.csv: line 1: found 1 cell, expected a label and a name");
  EXPECT_EQ(refusal("a.csv", "1,\n"), "a.csv: line 1: the label 1 has no name; expected one");
  EXPECT_EQ(refusal("a.csv", "-1,BA\n"),
            "a.csv: line 1: found the label \"-1\", expected a whole number from 0 to 16777216");
  EXPECT_EQ(refusal("a.csv", "0,background\n"),
            "a.csv: names no label but 0; expected names of labels");
  EXPECT_EQ(refusal("a.ctbl", "# Color table file\n1 left ICA 1 2 3 4\n"),
            "a.ctbl: line 2: found \"1 left ICA 1 2 3 4\", expected a label, a name and four "
            "numbers of a colour");
  EXPECT_NE(refusal("a.json", R"({"1": 5})").find("at \"/1\""), std::string::npos);
  EXPECT_NE(refusal("a.json", R"({"BA": "1"})").find("found the label \"BA\""), std::string::npos);
  EXPECT_NE(refusal("a.json", R"({"1": "a", "1": "b"})"), "");
  EXPECT_NE(refusal("a.json", R"({"1": "a", "01": "b"})"), "");
  EXPECT_NE(refusal("a.csv", "1," + std::string(256, 'x') + "\n"), "");
  EXPECT_NE(refusal("a.csv", ""), "");
}

TEST_F(LabelTableTest, TablesAreRecognisedByTheirContent) {
  const std::string snap =
      "################################################\n"
      "# ITK-SnaP Label Description File\n"
      "    0     0    0    0        0  0  0    \"Clear Label\"\n"
      "    1   255    0    0        1  1  1    \"BA\"\n"
      "   12     0  255    0      0.5  1  1    \"left ICA\"\n";
  EXPECT_EQ(read("snap.any", snap), kTwo);
  const LabelNames freeSurfer = {{4, "Left-Lateral-Ventricle"}, {30, "Left-vessel"}};
  EXPECT_EQ(read("lut.any",
                 "#No. Label Name:                R   G   B   A\n0 Unknown 0 0 0 0\n\n"
                 "4   Left-Lateral-Ventricle  120 18  134 0\n30  Left-vessel 160 32 240 0\n"),
            freeSurfer);
  EXPECT_EQ(read("dseg.any", "index\tname\tcolor\n1\tBA\t#ff0000\n12\tleft ICA\tn/a\n"), kTwo);
  EXPECT_EQ(read("new.any", R"({"channel_names": {"0": "CT"}, "numTraining": 3,
      "labels": {"background": 0, "BA": 1, "left ICA": [12], "whole": [1, 12]}})"),
            kTwo);
  EXPECT_EQ(read("old.any", R"({"labels": {"0": "background", "1": "BA", "12": "left ICA"}})"),
            kTwo);
}

TEST_F(LabelTableTest, AColumnOfRolesStatesThem) {
  const LabelTable table =
      readLabelTable(write("r.csv", "value,name,role\n1,left lumen,vein\n2,x,\n"));
  EXPECT_EQ(table.from, "r.csv");
  const std::map<std::int64_t, LabelRole> stated = {{1, LabelRole::Vein}};
  EXPECT_EQ(table.roles, stated);
  EXPECT_NE(refusal("r.csv", "value,name,role\n1,x,arterie\n")
                .find("line 2: found the role \"arterie\", expected unknown, vessel"),
            std::string::npos);
}

TEST_F(LabelTableTest, TheTerminologyOfASegmentShowsItsRole) {
  const LabelTable table = ownNames(write(
      "a.seg.nrrd",
      "NRRD0004\ntype: uchar\nSegment0_LabelValue:=1\nSegment0_Name:=Segment_1\n"
      "Segment0_Tags:=Segmentation.Status:inprogress|TerminologyEntry:Segmentation category and "
      "type - 3D Slicer General Anatomy list~SCT^85756007^Tissue~SCT^29092000^Vein~^^~Anatomic "
      "codes~^^~^^|\n\n"));
  EXPECT_EQ(table.names.at(1), "Segment_1");
  EXPECT_EQ(table.roles.at(1), LabelRole::Vein);
}

TEST_F(LabelTableTest, ANiftiNamesItsLabelsInAnExtension) {
  const std::string xml =
      "<CaretExtension><LabelTable>\n<Label Key=\"1\" Red=\"0\"><![CDATA[BA]]></Label>\n"
      "<Label Key=\"12\" Red=\"1\">left ICA</Label><Label Key=\"x\">y</Label></LabelTable>";
  std::string head = MadeNiftiHeader().text().substr(0, 348);
  const auto offset = static_cast<float>(352 + 8 + xml.size());
  std::memcpy(head.data() + 108, &offset, sizeof(offset));
  std::string extension(12, '\0');
  extension[0] = 1;
  extension[4] = static_cast<char>(8 + xml.size());
  extension[5] = static_cast<char>((8 + xml.size()) >> 8U);
  const fs::path file = write("named.nii", head + extension + xml + "abcdefgh");
  EXPECT_EQ(ownNames(file).names, kTwo);
  EXPECT_EQ(ownNames(file).from, "its header");
  EXPECT_TRUE(ownNames(write("bare.nii", MadeNiftiHeader().text() + "abcdefgh")).names.empty());
}

TEST_F(LabelTableTest, TablesBesideAMapAreFoundByTheirNames) {
  const auto beside = [&](const std::string& map) {
    std::vector<std::string> names;
    for (const InputFile& file : tablesBeside(folder() / map))
      names.push_back(fs::relative(file.path(), folder()).string());
    return names;
  };
  using Names = std::vector<std::string>;
  write("a_dseg.tsv", "");
  write("b.tsv", "");
  EXPECT_EQ(beside("a_dseg.nii.gz"), Names{"a_dseg.tsv"});
  EXPECT_EQ(beside("b.nii.gz"), Names{});
  write("dataset.json", "");
  write("dseg.tsv", "");
  EXPECT_EQ(beside("a_dseg.nii.gz"), (Names{"a_dseg.tsv", "dseg.tsv", "dataset.json"}));
  EXPECT_EQ(beside("b.nii.gz"), Names{"dataset.json"});
  EXPECT_EQ(beside("labelsTr/b.nii.gz"), Names{"dataset.json"});
  EXPECT_EQ(beside("other/b.nii.gz"), Names{});
  EXPECT_TRUE(tablesBeside({fs::path("a_dseg.nii"), std::string_view("x")}).empty());
}

}  // namespace
}  // namespace lumen::convert
