// SPDX-License-Identifier: Apache-2.0
#include "formats/case/atomic_file.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;
using test::codeOf;

ino_t inodeOf(const fs::path& path) {
  struct stat info {};
  EXPECT_EQ(::stat(path.c_str(), &info), 0) << path;
  return info.st_ino;
}

class AtomicOutput : public testing::Test {
protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "lumen-test-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    m_directory = name;
  }
  void TearDown() override { fs::remove_all(m_directory); }

  [[nodiscard]] fs::path path(const std::string& name) const { return m_directory / name; }
  static void put(const fs::path& file, const std::string& content) {
    std::ofstream(file, std::ios::binary) << content;
  }
  [[nodiscard]] std::string get(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] Names names() const {
    Names found;
    for (const auto& entry : fs::directory_iterator(m_directory))
      found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }
  [[nodiscard]] Status write(const std::string& name, const std::string& content,
                             const FileCalls& calls) const {
    return writeFileAtomically(std::as_bytes(std::span(content)), path(name), calls);
  }
  /// A folder with one file, `content` in "f", and an empty folder.
  [[nodiscard]] Status writeFolder(const std::string& name, const std::string& content,
                                   PendingFolder::Existing existing,
                                   const FileCalls& calls = systemCalls()) const {
    auto pending = PendingFolder::beside(path(name), existing, calls);
    if (!pending) return pending.error();
    put(pending->path() / "f", content);
    fs::create_directory(pending->path() / "sub");
    return pending->commit();
  }

  /// A folder of this name as a killed writer leaves it.
  void leaveFolder(const std::string& name) const {
    const auto pending = PendingFolder::beside(path("never"), PendingFolder::Existing::Refuse);
    fs::copy(pending->path().parent_path(), path(name), fs::copy_options::recursive);
  }

private:
  fs::path m_directory;
};

/// Events that reached the disk, in order: inodes that were flushed, and 0 for a rename or an exchange.
struct Journal {
  std::vector<ino_t> steps;
  FileCalls calls = {[this](int descriptor) {
                       struct stat info {};
                       EXPECT_EQ(::fstat(descriptor, &info), 0);
                       steps.push_back(info.st_ino);
                       return systemCalls().flush(descriptor);
                     },
                     systemCalls().permit,
                     [this](const char* from, const char* to) {
                       steps.push_back(0);
                       return systemCalls().rename(from, to);
                     },
                     [this](const char* a, const char* b) {
                       steps.push_back(0);
                       return systemCalls().exchange(a, b);
                     }};
};

int refuse(int code) {
  errno = code;
  return -1;
}

TEST_F(AtomicOutput, FlushesAFileBeforeItsRenameAndTheFolderAfterIt) {
  Journal journal;
  ASSERT_EQ(codeOf(write("a", "x", journal.calls)), "OK");
  EXPECT_EQ(journal.steps, (std::vector<ino_t>{inodeOf(path("a")), 0, inodeOf(path(""))}));
}

TEST_F(AtomicOutput, LeavesTheOldFileIfTheNewOneCannotBeFlushed) {
  put(path("a"), "old");
  FileCalls calls = systemCalls();
  calls.flush = [](int) { return refuse(EIO); };
  EXPECT_EQ(codeOf(write("a", "new", calls)), "IO_WRITE");
  EXPECT_EQ(get("a"), "old");
  EXPECT_EQ(names(), Names{"a"});
}

TEST_F(AtomicOutput, LeavesTheOldFileIfTheNewOneCannotBeRenamed) {
  put(path("a"), "old");
  FileCalls calls = systemCalls();
  calls.rename = [](const char*, const char*) { return refuse(EIO); };
  EXPECT_EQ(codeOf(write("a", "new", calls)), "IO_WRITE");
  EXPECT_EQ(get("a"), "old");
  EXPECT_EQ(names(), Names{"a"});
}

TEST_F(AtomicOutput, IsWrittenWhereTheFileSystemCannotFlush) {
  for (const int code : {EINVAL, ENOSYS, ENOTSUP}) {
    FileCalls calls = systemCalls();
    calls.flush = [code](int) { return refuse(code); };
    EXPECT_EQ(codeOf(write("a", std::to_string(code), calls)), "OK");
    EXPECT_EQ(get("a"), std::to_string(code));
    EXPECT_EQ(codeOf(writeFolder("b", "x", PendingFolder::Existing::Replace, calls)), "OK");
  }
  EXPECT_EQ(names(), (Names{"a", "b"}));
}

TEST_F(AtomicOutput, IsWrittenWhereTheFileSystemHasNoPermissionsToSet) {
  put(path("a"), "old");
  fs::permissions(path("a"), fs::perms(0666));
  for (const int code : {EPERM, ENOTSUP}) {
    FileCalls calls = systemCalls();
    calls.permit = [code](int, mode_t) { return refuse(code); };
    EXPECT_EQ(codeOf(write("a", std::to_string(code), calls)), "OK");
    EXPECT_EQ(get("a"), std::to_string(code));
  }
}

TEST_F(AtomicOutput, IsRefusedRatherThanShownToMorePeopleThanTheOldFile) {
  put(path("a"), "old");
  fs::permissions(path("a"), fs::perms(0600));
  FileCalls calls = systemCalls();
  calls.permit = [](int descriptor, mode_t) {
    EXPECT_EQ(::fchmod(descriptor, 0644), 0);  // as the file system gives every file
    return refuse(EPERM);
  };
  EXPECT_EQ(codeOf(write("a", "new", calls)), "IO_WRITE");
  EXPECT_EQ(get("a"), "old");
  EXPECT_EQ(names(), Names{"a"});
}

TEST_F(AtomicOutput, OfAKilledWriterIsRemovedByTheNextWriteIntoThatFolder) {
  const pid_t writer = ::fork();
  if (writer == 0) {
    const auto file = PendingFile::beside(path("a"));
    const auto folder = PendingFolder::beside(path("b"), PendingFolder::Existing::Refuse);
    put(folder->path() / "f", "half");
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(writer, &status, 0), writer);
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  ASSERT_EQ(names().size(), 2u);
  ASSERT_EQ(codeOf(write("c", "x", systemCalls())), "OK");
  EXPECT_EQ(names(), Names{"c"});
}

TEST_F(AtomicOutput, GivesLibrariesAHiddenNameWithTheEndingOfTheTarget) {
  const auto pending = PendingFile::beside(path("head.v2.nii.gz"));
  ASSERT_TRUE(pending);
  const std::string name = pending->path().filename().string();
  EXPECT_TRUE(name.ends_with(".nii.gz")) << name;
  const fs::path hidden = pending->path().parent_path();
  EXPECT_TRUE(hidden.filename().string().starts_with(".lumen-" + std::to_string(::getpid()) + "-"))
      << hidden;
  EXPECT_EQ(hidden.parent_path(), path("head.v2.nii.gz").parent_path());
}

TEST_F(AtomicOutput, IsFlushedThoughALibraryWroteItByName) {
  Journal journal;
  auto pending = PendingFile::beside(path("a.nrrd"), journal.calls);
  ASSERT_TRUE(pending);
  fs::remove(pending->path());  // a library may write a file of its own
  put(pending->path(), "voxels");
  ASSERT_EQ(codeOf(pending->commit()), "OK");
  EXPECT_EQ(get("a.nrrd"), "voxels");
  EXPECT_EQ(journal.steps.front(), inodeOf(path("a.nrrd")));
}

TEST_F(AtomicOutput, ThatIsNotCommittedIsGone) {
  {
    const auto file = PendingFile::beside(path("a"));
    const auto folder = PendingFolder::beside(path("b"), PendingFolder::Existing::Refuse);
    ASSERT_TRUE(file && folder);
    put(folder->path() / "f", "x");
    EXPECT_EQ(names().size(), 2u);
  }
  EXPECT_TRUE(names().empty());
}

TEST_F(AtomicOutput, OfALivingWriterIsNotTakenForALeftover) {
  auto file = PendingFile::beside(path("a"));
  auto folder = PendingFolder::beside(path("b"), PendingFolder::Existing::Refuse);
  ASSERT_TRUE(file && folder);
  ASSERT_EQ(codeOf(write("c", "x", systemCalls())), "OK");
  EXPECT_EQ(codeOf(file->commit()), "OK");
  EXPECT_EQ(codeOf(folder->commit()), "OK");
  EXPECT_EQ(names(), (Names{"a", "b", "c"}));
}

TEST_F(AtomicOutput, OfThisProcessIsRemovedWhenItIsInterrupted) {
  const auto file = PendingFile::beside(path("a"));
  const auto folder = PendingFolder::beside(path("b"), PendingFolder::Existing::Refuse);
  ASSERT_TRUE(file && folder);
  removeOwnTemporaries();
  EXPECT_TRUE(names().empty());
}

TEST_F(AtomicOutput, OfAnotherWriterWithTheSameProcessIdStaysWhenThisOneIsInterrupted) {
  const std::string other = ".lumen-" + std::to_string(::getpid()) + "-0000000001";
  leaveFolder(other);
  const FileDescriptor open = openForReading(path(other), 0);
  ASSERT_EQ(::flock(open.get(), LOCK_EX), 0);
  const auto file = PendingFile::beside(path("a"));
  ASSERT_TRUE(file);
  removeOwnTemporaries();
  EXPECT_EQ(names(), Names{other});
}

TEST_F(AtomicOutput, AbandonedFoldersAreRemovedToo) {
  leaveFolder(".lumen-1234-0000000000");
  fs::create_directories(path(".lumen-1234-0000000000/meshes"));
  put(path(".lumen-1234-0000000000/meshes/wall.obj"), "half");
  ASSERT_EQ(codeOf(write("a", "x", systemCalls())), "OK");
  EXPECT_EQ(names(), Names{"a"});
}

TEST_F(AtomicOutput, WhatAKillBesideTheProofLeavesIsRemoved) {
  fs::create_directory(path(".lumen-1234-0000000000"));
  fs::create_directory(path(".lumen-1234-0000000001"));
  fs::create_directory(path(".lumen-1234-0000000002"));
  put(path(".lumen-1234-0000000001/.lumen-temporary"), "");
  put(path(".lumen-1234-0000000002/.lumen-temporary"), "lumen writes in");
  ASSERT_EQ(codeOf(write("a", "x", systemCalls())), "OK");
  EXPECT_EQ(names(), Names{"a"});
}

TEST_F(AtomicOutput, FoldersAndFilesOfAPersonStayWhateverTheirNames) {
  for (const char* const folder :
       {".lumen-2024-backup", ".lumen-1234-0000000000", ".lumen-1234-0000000001"})
    fs::create_directories(path(folder) / "old");
  put(path(".lumen-2024-backup/old/head.lumen"), "my corrected case");
  put(path(".lumen-1234-0000000000/.lumen-temporary"), "my notes on it");
  leaveFolder(".lumen-1234-0000000002");
  put(path(".lumen-1234-0000000002/.lumen-temporary"),
      get(".lumen-1234-0000000002/.lumen-temporary") + "and mine");
  fs::create_symlink(path(".lumen-1234-0000000001"), path(".lumen-1234-0000000003"));
  fs::create_directories(path(".lumen-1234-0000000004") / "old");
  put(path(".lumen-1234-0000000004/.lumen-temporary"), "");
  put(path(".lumen-2026-11-29-notes.txt"), "my notes");
  fs::create_directory(path(".lumen-2024-1"));
  Names expected = names();
  ASSERT_EQ(codeOf(write("a", "x", systemCalls())), "OK");
  ASSERT_EQ(codeOf(writeFolder("b", "x", PendingFolder::Existing::Refuse)), "OK");
  expected.insert(expected.end(), {"a", "b"});
  EXPECT_EQ(names(), expected);
  EXPECT_EQ(get(".lumen-2024-backup/old/head.lumen"), "my corrected case");
}

TEST_F(AtomicOutput, FilesOfSimilarNamesStay) {
  for (const char* name : {".lumen-7", ".lumen-notes.txt", ".lumenrc"}) put(path(name), "x");
  ASSERT_EQ(codeOf(write("a", "x", systemCalls())), "OK");
  EXPECT_EQ(names(), (Names{".lumen-7", ".lumen-notes.txt", ".lumenrc", "a"}));
}

TEST_F(AtomicOutput, FlushesAllOfAFolderBeforeItsRename) {
  Journal journal;
  ASSERT_EQ(codeOf(writeFolder("scene", "x", PendingFolder::Existing::Refuse, journal.calls)),
            "OK");
  const auto renamed = std::find(journal.steps.begin(), journal.steps.end(), ino_t{0});
  for (const char* part : {"scene", "scene/f", "scene/sub"})
    EXPECT_NE(std::find(journal.steps.begin(), renamed, inodeOf(path(part))), renamed) << part;
  EXPECT_EQ(journal.steps.back(), inodeOf(path("")));
}

TEST_F(AtomicOutput, ReplacesAFullFolderOnlyWhenToldTo) {
  using Existing = PendingFolder::Existing;
  ASSERT_EQ(codeOf(writeFolder("scene", "old", Existing::Refuse)), "OK");
  put(path("scene/more"), "x");
  EXPECT_EQ(codeOf(writeFolder("scene", "new", Existing::Refuse)), "IO_WRITE");
  EXPECT_EQ(get("scene/f"), "old");
  EXPECT_EQ(codeOf(writeFolder("scene", "new", Existing::Replace)), "OK");
  EXPECT_EQ(get("scene/f"), "new");
  EXPECT_FALSE(fs::exists(path("scene/more")));
  EXPECT_EQ(names(), Names{"scene"});
}

TEST_F(AtomicOutput, ReplacesAnEmptyFolderAndCreatesOneUnderANameThatEndsInASlash) {
  fs::create_directory(path("scene"));
  EXPECT_EQ(codeOf(writeFolder("scene/", "x", PendingFolder::Existing::Refuse)), "OK");
  EXPECT_EQ(codeOf(writeFolder("new/", "x", PendingFolder::Existing::Refuse)), "OK");
  EXPECT_EQ(names(), (Names{"new", "scene"}));
}

TEST_F(AtomicOutput, ReplacesAFolderWhereTheKernelCannotExchangeNames) {
  ASSERT_EQ(codeOf(writeFolder("scene", "old", PendingFolder::Existing::Refuse)), "OK");
  FileCalls calls = systemCalls();
  calls.exchange = [](const char*, const char*) { return refuse(EINVAL); };
  EXPECT_EQ(codeOf(writeFolder("scene", "new", PendingFolder::Existing::Replace, calls)), "OK");
  EXPECT_EQ(get("scene/f"), "new");
  EXPECT_EQ(names(), Names{"scene"});
}

TEST_F(AtomicOutput, HidesTheReplacedFolderBeforeItIsRemoved) {
  ASSERT_EQ(codeOf(writeFolder("scene", "old", PendingFolder::Existing::Refuse)), "OK");
  Names targets;
  FileCalls calls = systemCalls();
  calls.exchange = [](const char*, const char*) { return refuse(EINVAL); };
  calls.rename = [&targets](const char* from, const char* to) {
    const fs::path target(to);
    const std::string above = target.parent_path().filename().string();
    targets.push_back(above.starts_with(".lumen-") ? above : target.filename().string());
    return systemCalls().rename(from, to);
  };
  ASSERT_EQ(codeOf(writeFolder("scene", "new", PendingFolder::Existing::Replace, calls)), "OK");
  ASSERT_EQ(targets.size(), 4u);  // a name that is taken, the old away, the new in place, hidden
  EXPECT_TRUE(targets.back().starts_with(".lumen-")) << targets.back();
}

TEST_F(AtomicOutput, NamesTheOldFolderThatAnInterruptedReplacementLeft) {
  ASSERT_EQ(codeOf(writeFolder("scene", "now", PendingFolder::Existing::Refuse)), "OK");
  fs::create_directory(path("scene.lumen-old"));
  put(path("scene.lumen-old/f"), "precious");
  FileCalls calls = systemCalls();
  calls.exchange = [](const char*, const char*) { return refuse(EINVAL); };
  const Status done = writeFolder("scene", "new", PendingFolder::Existing::Replace, calls);
  ASSERT_EQ(codeOf(done), "IO_WRITE");
  EXPECT_NE(done.error().message.find("scene.lumen-old, which an interrupted replacement left"),
            std::string::npos)
      << done.error().message;
  EXPECT_EQ(get("scene/f"), "now");
  EXPECT_EQ(get("scene.lumen-old/f"), "precious");
}

TEST_F(AtomicOutput, FlushesAFolderByItsFileSystemAndOtherwiseEachFile) {
  ASSERT_EQ(codeOf(writeFolder("scene", "old", PendingFolder::Existing::Refuse)), "OK");
  for (const int code : {0, ENOSYS, EIO}) {
    Journal journal;
    journal.calls.flushSystem = [&](int) {
      journal.steps.push_back(1);
      return code == 0 ? 0 : refuse(code);
    };
    auto pending =
        PendingFolder::beside(path("scene"), PendingFolder::Existing::Replace, journal.calls);
    ASSERT_TRUE(pending);
    put(pending->path() / "f", std::to_string(code));
    const ino_t file = inodeOf(pending->path() / "f"), folder = inodeOf(pending->path());
    EXPECT_EQ(codeOf(pending->commit(PendingFolder::Flush::System)),
              code == EIO ? "IO_WRITE" : "OK");
    std::vector<ino_t> steps = {1};
    if (code == ENOSYS) steps.insert(steps.end(), {file, folder});
    // a rename that finds the name taken, the exchange, the folder around it
    if (code != EIO) steps.insert(steps.end(), {0, 0, inodeOf(path(""))});
    EXPECT_EQ(journal.steps, steps);
    EXPECT_EQ(get("scene/f"), code == EIO ? std::to_string(ENOSYS) : std::to_string(code));
  }
}

TEST_F(AtomicOutput, PutsTheOldFolderBackIfTheNewOneCannotTakeItsPlace) {
  ASSERT_EQ(codeOf(writeFolder("scene", "old", PendingFolder::Existing::Refuse)), "OK");
  int renames = 0;
  FileCalls calls = systemCalls();
  calls.exchange = [](const char*, const char*) { return refuse(ENOSYS); };
  calls.rename = [&renames](const char* from, const char* to) {
    // the first finds the name taken, the second moves the old one away
    return ++renames == 3 ? refuse(EIO) : systemCalls().rename(from, to);
  };
  EXPECT_EQ(codeOf(writeFolder("scene", "new", PendingFolder::Existing::Replace, calls)),
            "IO_WRITE");
  EXPECT_EQ(get("scene/f"), "old");
  EXPECT_EQ(names(), Names{"scene"});
}

TEST_F(AtomicOutput, OfAFolderIsNotPutOverAFile) {
  put(path("a"), "x");
  EXPECT_EQ(codeOf(writeFolder("a", "x", PendingFolder::Existing::Replace)), "IO_WRITE");
  EXPECT_EQ(get("a"), "x");
}

}  // namespace
}  // namespace lumen::formats
