// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/base/sha256.h"
#include "converters/library/rows/build_row.h"
#include "tests/unit/library/temporary_folder.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

class RecipeTest : public testing::Test {
protected:
  fs::path write(const std::string& name, const std::string& text) const {
    m_files.write(name, text);
    return m_files.path(name);
  }
  [[nodiscard]] std::string digest(const std::string& name) const {
    return digestOfInput(m_files.path(name), {});
  }

private:
  TemporaryFolder m_files;
};

}  // namespace

TEST_F(RecipeTest, AHeaderThatCannotBeReadHasNoDigest) {
  write("gone.raw", "voxels");
  EXPECT_THROW((void)digest("gone.nhdr"), Error);
}

TEST_F(RecipeTest, AFileIsItsBytesWhateverItsName) {
  write("a.nrrd", "voxels");
  write("b.nrrd", "voxels");
  EXPECT_EQ(digest("a.nrrd"), digestOfFile(write("c.nrrd", "voxels")).sha256);
  EXPECT_EQ(digest("a.nrrd"), digest("b.nrrd"));
  write("b.nrrd", "other voxels");
  EXPECT_NE(digest("a.nrrd"), digest("b.nrrd"));
}

TEST_F(RecipeTest, AFolderIsItsFilesAndTheirNames) {
  write("scan/1.dcm", "one");
  write("scan/2.dcm", "two");
  const std::string before = digest("scan");
  write("scan/2.dcm", "TWO");
  EXPECT_NE(digest("scan"), before);
  write("scan/2.dcm", "two");
  EXPECT_EQ(digest("scan"), before);
  write("scan/3.dcm", "");
  EXPECT_NE(digest("scan"), before);
}

TEST_F(RecipeTest, AHeaderIsAlsoWhatItsVoxelsAreIn) {
  for (const auto& [header, text, data] :
       {std::array<std::string, 3>{"a.nhdr", "data file: far.raw", "far.raw"},
        std::array<std::string, 3>{"b.nhdr", "data file: slice%02d.raw 1 9 1", "slice04.raw"},
        std::array<std::string, 3>{"c.hdr", "binary", "c.img"}}) {
    write(header, text);
    write(data, "voxels");
    const std::string before = digest(header);
    write(data, "others");
    EXPECT_NE(digest(header), before) << header;
    fs::remove(write(data, ""));
  }
}

TEST_F(RecipeTest, WhatTheTreeComesFromAndWhatIsToldAreTwoDigests) {
  BuildRow row;
  row.input = write("a.nrrd", "voxels");
  const Recipe first = makeRecipe(row, "1", "CC0-1.0", {});
  row.about = "{\"title\": \"A\"}";
  const Recipe told = makeRecipe(row, "1", "CC0-1.0", {});
  EXPECT_EQ(told.tree, first.tree);
  EXPECT_NE(told.all, first.all);
  row.options["--rays"] = "42";
  const Recipe tracked = makeRecipe(row, "1", "CC0-1.0", {});
  EXPECT_NE(tracked.tree, told.tree);
  EXPECT_NE(tracked.all, told.all);
  EXPECT_NE(makeRecipe(row, "2", "CC0-1.0", {}).tree, tracked.tree);
  EXPECT_NE(makeRecipe(row, "1", "CC-BY-4.0", {}).all, tracked.all);
}

TEST_F(RecipeTest, WhatCannotBeReadIsAnError) {
  EXPECT_THROW((void)digest("missing.nrrd"), Error);
}

}  // namespace lumen::convert
