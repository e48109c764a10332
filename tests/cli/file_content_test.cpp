// SPDX-License-Identifier: Apache-2.0
// The kind of a file by its content, and outputs that spare files that cannot be made again.
#include "converters/io/content/file_content.h"

#include "tests/cli/run_lumen.h"

namespace lumen::test {

using convert::ContentKind;

class FileContentTest : public TubeTest {
protected:
  [[nodiscard]] ContentKind kindOf(const std::string& name) const {
    return convert::detectContent(path(name)).kind;
  }
};

TEST_F(FileContentTest, WhatLumenWritesIsRecognised) {
  for (const char* name : {"a.nrrd", "a.nii", "a.nii.gz", "a.mha"}) {
    ASSERT_EQ(lumen({"phantom", "tube", name, "--size", "32"}).code, 0) << name;
    EXPECT_EQ(kindOf(name), ContentKind::Volume) << name;
  }
  EXPECT_EQ(kindOf("seeds.json"), ContentKind::Seeds);
  EXPECT_EQ(kindOf("truth.lumen"), ContentKind::Case);
  ASSERT_EQ(lumen({"convert", "tube.nrrd", "a.lumen", "--seeds", "seeds.json"}).code, 0);
  ASSERT_EQ(lumen({"convert", "a.lumen", "a.lumen.json"}).code, 0);
  EXPECT_EQ(kindOf("a.lumen.json"), ContentKind::Case);
  for (const char* name : {"a.glb", "a.gltf", "a.ply"}) {
    ASSERT_EQ(lumen({"convert", "a.lumen", name}).code, 0) << name;
    EXPECT_EQ(kindOf(name), ContentKind::Mesh) << name;
  }
}

TEST_F(FileContentTest, NothingIsSaidOfWhatIsNotKnown) {
  write("empty", "");
  write("short", "N");
  write("text", "some words");
  for (const char* name : {"empty", "short", "text", "gone", "."})
    EXPECT_EQ(kindOf(name), ContentKind::Unknown) << name;
  EXPECT_EQ(convert::notA(ContentKind::Case, path("text")), "");
  EXPECT_EQ(convert::notA(ContentKind::Case, path("truth.lumen")), "");
}

TEST_F(FileContentTest, NoOutputReplacesAFileOfAnotherKind) {
  const std::vector<std::vector<std::string>> lines = {
      {"convert", "truth.lumen", "tube.nrrd", "--to", "lumen"},
      {"convert", "truth.lumen", "seeds.json"},
      {"convert", "truth.lumen", "truth.lumen", "--to", "stl"},
      {"track", "tube.nrrd", "seeds.json", "--seeds", "seeds.json"},
      {"fit", "truth.lumen", "seeds.json"},
      {"phantom", "tube", "new.nrrd", "--seeds", "truth.lumen"},
      {"phantom", "tube", "new.nrrd", "--truth", "seeds.json"}};
  const std::string volume = read("tube.nrrd"), seeds = read("seeds.json"),
                    truth = read("truth.lumen");
  for (const auto& line : lines) {
    const Outcome refused = lumen(line);
    EXPECT_EQ(refused.code, 2) << line[0] << " " << line[2] << "\n" << refused.err;
  }
  EXPECT_TRUE(read("tube.nrrd") == volume && read("seeds.json") == seeds);
  EXPECT_TRUE(read("truth.lumen") == truth);
  EXPECT_FALSE(exists("new.nrrd"));
}

TEST_F(FileContentTest, TheSameCommandMayBeRepeated) {
  for (int i = 0; i < 2; ++i) {
    make({"phantom", "tube", "tube.nrrd", "--size", "64", "--truth", "truth.lumen", "--seeds",
          "seeds.json"});
    EXPECT_EQ(lumen({"track", "tube.nrrd", "a.lumen", "--seeds", "seeds.json"}).code, 0);
    EXPECT_EQ(lumen({"fit", "a.lumen", "a.lumen"}).code, 0);
    EXPECT_EQ(lumen({"convert", "a.lumen", "a.glb"}).code, 0);
  }
}

}  // namespace lumen::test
