// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/label_table.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"

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
    return readLabelTable(write(name, text));
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

private:
  fs::path m_folder;
};

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
  const LabelNames names = readLabelTable("topcow");
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

}  // namespace
}  // namespace lumen::convert
