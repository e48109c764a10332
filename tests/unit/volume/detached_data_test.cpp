// SPDX-License-Identifier: Apache-2.0
// The files that headers of NRRD and MetaImage say their voxels are in.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "text_volume.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

/// A folder "in" of headers, beside which is a folder "out".
class DetachedData : public TextVolume {
protected:
  DetachedData() {
    fs::create_directories(path("in/sub"));
    fs::create_directories(path("out"));
    write("out/v.raw", eightBytes());
  }
  [[nodiscard]] fs::path nhdr(const std::string& dataFile, const Lines& more = {}) const {
    Lines lines = {"spacings: 1 1 1", "data file: " + dataFile};
    lines.insert(lines.begin(), more.begin(), more.end());
    return write("in/v.nhdr", nrrdText(lines, ""));
  }
  [[nodiscard]] fs::path mhd(const std::string& dataFile, const Lines& more = {},
                             const std::string& names = "") const {
    Lines lines = more;
    lines.push_back("ElementDataFile = " + dataFile);
    return write("in/v.mhd", metaText(lines, names));
  }
  /// A list of NRRD, whose names follow at once.
  [[nodiscard]] fs::path list(const std::string& first, const std::string& names) const {
    return write("in/v.nhdr",
                 "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nspacings: 1 1 1\n"
                 "encoding: raw\ndata file: " +
                     first + "\n" + names);
  }
  static void expectVoxels(const fs::path& file, const ReadVolumeOptions& options = {}) {
    EXPECT_EQ(readRefusal(file, options), "") << file;
    EXPECT_EQ(textOf(readQuietly(file, options)), eightBytes()) << file;
  }
  [[nodiscard]] static ReadVolumeOptions allowing(const fs::path& place) {
    ReadVolumeOptions options;
    options.allowedDetached = {place};
    return options;
  }
  void writeSlices() const {
    for (int n = 1; n <= 2; ++n)
      write("in/s00" + std::to_string(n), eightBytes().substr(n == 1 ? 0 : 4, 4));
  }
};

TEST_F(DetachedData, FilesInTheHeadersFolderAndBelowAreRead) {
  write("in/v w.raw", eightBytes());
  write("in/sub/v.raw", eightBytes());
  for (const char* name : {"v w.raw", "./v w.raw", "sub/v.raw", "sub/../v w.raw"}) {
    expectVoxels(nhdr(name));
    expectVoxels(mhd(name));
  }
  expectVoxels(nhdr(path("in/sub/v.raw").string()));
}

TEST_F(DetachedData, FilesElsewhereAreRefusedUnlessAllowed) {
  fs::create_symlink(path("out/v.raw"), path("in/link.raw"));
  fs::create_directory_symlink(path("out"), path("in/folder"));
  for (const std::string& name :
       {std::string("../out/v.raw"), path("out/v.raw").string(), std::string("link.raw"),
        std::string("folder/v.raw"), std::string("sub/../../out/v.raw")}) {
    for (const fs::path& file :
         {nhdr(name), mhd(name), mhd("LIST 3", {}, name + "\n"), list("LIST 3", name + "\n")}) {
      expectRefused(readRefusal(file), {"3: ", file.filename().string(), "outside",
                                        "--allow-detached " + fs::canonical(path("out")).string()});
      EXPECT_EQ(readRefusal(file, allowing(path("in"))).substr(0, 3), "3: ");
      EXPECT_EQ(readRefusal(file, allowing(path("absent"))).substr(0, 3), "3: ");
      expectVoxels(file, allowing(path("out")));
      expectVoxels(file, allowing(path("out/v.raw")));
      expectVoxels(file, allowing(path("")));
    }
  }
}

TEST_F(DetachedData, AFolderWhoseNameBeginsTheSameIsAnotherOne) {
  fs::create_directories(path("in2"));
  write("in2/v.raw", eightBytes());
  expectRefused(readRefusal(nhdr("../in2/v.raw")), {"3: ", "outside"});
  expectRefused(readRefusal(nhdr("../in2/v.raw"), allowing(path("in2/v"))), {"3: ", "outside"});
}

TEST_F(DetachedData, PatternsGoThroughTheSameGate) {
  for (int n = 1; n <= 2; ++n)
    write("out/s" + std::to_string(n), eightBytes().substr(n == 1 ? 0 : 4, 4));
  for (const fs::path& file : {nhdr("../out/s%d 1 2 1"), mhd("../out/s%d 1 2 1")}) {
    expectRefused(readRefusal(file), {"3: ", "outside", "--allow-detached"});
    expectVoxels(file, allowing(path("out")));
  }
}

TEST_F(DetachedData, OnlyRegularFilesAreOpened) {
  ASSERT_EQ(mkfifo(path("in/pipe").c_str(), 0600), 0);
  for (const char* name : {"sub", "pipe"}) {
    expectRefused(readRefusal(nhdr(name)), {"3: ", "not a regular file"});
    expectRefused(readRefusal(mhd(name)), {"3: ", "not a regular file"});
  }
  expectRefused(readRefusal(nhdr("/dev/zero"), allowing("/dev")), {"3: ", "not a regular file"});
  expectRefused(readRefusal(path("in/pipe"), {}), {"3: "});
  fs::rename(path("in/pipe"), path("in/pipe.nrrd"));
  expectRefused(readRefusal(path("in/pipe.nrrd")), {"3: ", "device or a pipe"});
}

TEST_F(DetachedData, ListsAndPatternsOfSlices) {
  writeSlices();
  expectVoxels(list("LIST", "s001\ns002\n"));
  expectVoxels(list("LIST 2", "s001\r\ns002"));
  expectVoxels(mhd("LIST", {}, "s001\ns002\n"));
  expectVoxels(mhd("LIST 2", {}, "s001\ns002"));
  for (const char* pattern : {"s%03d 1 2 1", "s00%d 1 2 1", "s%03i 1 2 1", "s%03u 1 2 1"}) {
    expectVoxels(nhdr(pattern));
    expectVoxels(mhd(pattern));
  }
  expectVoxels(nhdr("s%03d 1 2 1 2"));
  for (const char* pattern : {"s%03d", "s%03d 1", "s%03d 1 2"}) expectVoxels(mhd(pattern));
  EXPECT_EQ(textOf(readQuietly(nhdr("s%03d 2 1 -1"))), "efghabcd");
  write("in/100%", eightBytes());
  expectVoxels(nhdr("100%"));
}

TEST_F(DetachedData, NamesMustBeAsManyAsSlices) {
  writeSlices();
  write("in/s003", "ijkl");
  for (const char* pattern :
       {"s%03d 1 3 1", "s%03d 1 1 1", "s%03d 2 1 1", "s%03d 1 2000000000 1"}) {
    expectRefused(readRefusal(nhdr(pattern)), {"3: ", "files", "expected 2"});
    expectRefused(readRefusal(mhd(pattern)), {"3: ", "files", "expected 2"});
  }
  expectRefused(readRefusal(list("LIST", "s001\n")), {"3: ", "1 files", "expected 2"});
  expectRefused(readRefusal(list("LIST", "s001\ns002\ns003\n")), {"3: ", "3 files"});
  expectRefused(readRefusal(mhd("LIST", {}, "s001\n")), {"3: ", "1 files", "expected 2"});
  expectRefused(readRefusal(mhd("LIST", {}, "")), {"3: ", "0 files", "expected 2"});
}

TEST_F(DetachedData, PatternsHoldOneNumberAndNothingElseToFormat) {
  for (const char* bad :
       {"%s%s%s%s.raw 0 1 1", "s%n 0 1 1", "s%d%d 0 1 1", "s%x 0 1 1", "s%*d 0 1 1",
        "s%99999999999d 0 1 1", "s%ld 0 1 1", "s%-3d 0 1 1", "s%1$d 0 1 1", "s% 0 1 1"}) {
    expectRefused(readRefusal(nhdr(bad)), {"3: ", "expected a pattern with one number"});
    expectRefused(readRefusal(mhd(bad)), {"3: ", "expected a pattern with one number"});
  }
  for (const char* bad : {"s%d 0 1 0", "s%d 0 47 0", "s%d 0 x 1", "s%d 0 1e30 1", "s%d nan 1 1"}) {
    expectRefused(readRefusal(nhdr(bad)), {"3: ", "data file is", "expected"});
    expectRefused(readRefusal(mhd(bad)), {"3: ", "ElementDataFile is", "expected"});
  }
  expectRefused(readRefusal(list("LIST 0", "s001\n")), {"3: ", "data file is"});
  expectRefused(readRefusal(mhd("LIST -1", {}, "s001\n")), {"3: ", "ElementDataFile is"});
}

TEST_F(DetachedData, ADataFileThatIsCompressedMayBeNamedWithoutItsEnding) {
  write("in/z.raw.gz", "");
  expectRefused(readRefusal(mhd("z.raw")), {"3: ", "z.raw.gz"});
}

TEST_F(DetachedData, NamesAreNotCutAtAZero) {
  write("in/v.raw", eightBytes());
  expectRefused(readRefusal(nhdr(std::string("v.raw\0x", 7))), {"3: ", "no name of a file"});
}

}  // namespace
}  // namespace lumen::convert
