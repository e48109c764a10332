// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "converters/base/random.h"
#include "formats/case/atomic_file.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

namespace fs = std::filesystem;
using test::codeOf;

// The superuser may write everywhere, so tests of permissions act as another user, who gets
// `directory`.
class WithoutPrivileges {
public:
  explicit WithoutPrivileges(const fs::path& directory) {
    if (!m_superuser) return;
    EXPECT_EQ(::chown(directory.c_str(), kNobody, static_cast<gid_t>(-1)), 0);
    EXPECT_EQ(::seteuid(kNobody), 0);
  }
  ~WithoutPrivileges() {
    if (m_superuser) {
      EXPECT_EQ(::seteuid(0), 0);
    }
  }
  WithoutPrivileges(const WithoutPrivileges&) = delete;
  WithoutPrivileges& operator=(const WithoutPrivileges&) = delete;

private:
  static constexpr uid_t kNobody = 65534;
  const bool m_superuser = ::geteuid() == 0;
};

class CaseFile : public testing::Test {
protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "lumen-test-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    m_directory = name;
  }
  void TearDown() override {
    fs::permissions(m_directory, fs::perms::owner_all);
    fs::remove_all(m_directory);
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return m_directory / name; }
  void put(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
  }
  [[nodiscard]] std::string get(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  // Names of what is in the directory, sorted.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(m_directory))
      found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }
  [[nodiscard]] Status write(const std::string& name, const std::string& content) const {
    return writeFileAtomically(std::as_bytes(std::span(content)), path(name));
  }
  [[nodiscard]] mode_t modeOf(const std::string& name) const {
    struct stat info {};
    EXPECT_EQ(::stat(path(name).c_str(), &info), 0);
    return info.st_mode & 07777;
  }

private:
  fs::path m_directory;
};

TEST_F(CaseFile, IsReadBackInBothEncodings) {
  for (const char* name : {"a.lumen", "a.lumen.json"}) {
    ASSERT_EQ(codeOf(writeCaseFile(test::richCase(), path(name))), "OK");
    const auto value = readCaseFile(path(name));
    ASSERT_TRUE(value) << value.error().text();
    EXPECT_EQ(*value, test::richCase());
  }
  EXPECT_EQ(get("a.lumen").substr(1, 5), "LUMEN");
  EXPECT_EQ(get("a.lumen.json").front(), '{');
}

TEST_F(CaseFile, IsRecognisedByItsBytesAndNotItsName) {
  put("text.lumen", "\n  " + encodeJson(test::smallestCase()));
  EXPECT_EQ(codeOf(readCaseFile(path("text.lumen"))), "OK");
}

TEST_F(CaseFile, ThatCannotBeReadIsNamedWithItsReason) {
  put("empty.lumen", "");
  put("other.lumen", "solid cube");
  put("bom.json", "\xef\xbb\xbf{}");
  put("crlf.lumen", "\x8cLUMEN\n\x1a\n rest");
  EXPECT_EQ(codeOf(readCaseFile(path("absent.lumen"))), "IO_MISSING");
  EXPECT_EQ(codeOf(readCaseFile(path("empty.lumen/x"))), "IO_MISSING");
  EXPECT_EQ(codeOf(readCaseFile(path(""))), "IO_NOT_A_FILE");
  EXPECT_EQ(codeOf(readCaseFile("/dev/zero")), "IO_NOT_A_FILE");
  EXPECT_EQ(codeOf(readCaseFile(path("empty.lumen"))), "IO_EMPTY");
  EXPECT_EQ(codeOf(readCaseFile(path("other.lumen"))), "NOT_LUMEN");
  EXPECT_EQ(codeOf(readCaseFile(path("bom.json"))), "JSON_SYNTAX");
  EXPECT_EQ(codeOf(readCaseFile(path("crlf.lumen"))), "MAGIC");
  EXPECT_NE(readCaseFile(path("other.lumen")).error().message.find("other.lumen"),
            std::string::npos);
}

TEST_F(CaseFile, DoesNotHangOnAPipe) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_EQ(codeOf(readCaseFile(path("pipe"))), "IO_NOT_A_FILE");
  EXPECT_EQ(codeOf(write("pipe", "x")), "IO_NOT_A_FILE");
}

TEST_F(CaseFile, IsNotWrittenForAnInvalidCase) {
  Case value = test::smallestCase();
  value.tree.radius[0] = -1;
  EXPECT_EQ(codeOf(writeCaseFile(value, path("a.lumen"))), "RADIUS_RANGE");
  EXPECT_TRUE(names().empty());
}

TEST_F(CaseFile, ReplacesAnOldFileAndLeavesNothingElse) {
  put("a", "old");
  EXPECT_EQ(codeOf(write("a", "new")), "OK");
  EXPECT_EQ(get("a"), "new");
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(CaseFile, MayBeEmptyOrLarge) {
  const std::string large(5'000'000, 'x');
  EXPECT_EQ(codeOf(write("a", "")), "OK");
  EXPECT_EQ(get("a"), "");
  EXPECT_EQ(codeOf(write("a", large)), "OK");
  EXPECT_EQ(get("a"), large);
}

TEST_F(CaseFile, HasThePermissionsOfAnyNewFile) {
  const mode_t old = ::umask(027);
  EXPECT_EQ(codeOf(write("a", "x")), "OK");
  ::umask(old);
  EXPECT_EQ(modeOf("a"), 0640u);
}

TEST_F(CaseFile, KeepsThePermissionsOfTheFileThatItReplaces) {
  put("a", "old");
  ASSERT_EQ(::chmod(path("a").c_str(), 0600), 0);
  EXPECT_EQ(codeOf(write("a", "new")), "OK");
  EXPECT_EQ(modeOf("a"), 0600u);
}

TEST_F(CaseFile, IsWrittenThroughASymbolicLink) {
  fs::create_directory(path("sub"));
  put("sub/target", "old");
  fs::create_symlink("sub/target", path("link"));
  fs::create_symlink("sub/new", path("dangling"));
  EXPECT_EQ(codeOf(write("link", "new")), "OK");
  EXPECT_EQ(codeOf(write("dangling", "made")), "OK");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(get("sub/target"), "new");
  EXPECT_EQ(get("sub/new"), "made");
}

TEST_F(CaseFile, IsNotWrittenThroughALoopOfLinks) {
  fs::create_symlink("b", path("a"));
  fs::create_symlink("a", path("b"));
  EXPECT_EQ(codeOf(write("a", "x")), "IO_WRITE");
}

TEST_F(CaseFile, IsNotWrittenOverADirectoryOrADevice) {
  fs::create_directory(path("sub"));
  EXPECT_EQ(codeOf(write("sub", "x")), "IO_NOT_A_FILE");
  EXPECT_EQ(codeOf(writeFileAtomically({}, "/dev/null")), "IO_NOT_A_FILE");
  EXPECT_EQ(codeOf(write("absent/a", "x")), "IO_WRITE");
  EXPECT_EQ(names(), std::vector<std::string>{"sub"});
}

TEST_F(CaseFile, IsNotWrittenInPlaceOfAnOpenFileAPipeOrASocket) {
  put("log", "precious line\n");
  const int log = ::open(path("log").c_str(), O_RDWR);
  int ends[2], sockets[2];
  ASSERT_EQ(::pipe(ends), 0);
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, sockets), 0);
  for (const int open : {log, ends[1], sockets[0]}) {
    const std::string number = std::to_string(open);
    fs::create_symlink("/dev/fd/" + number, path("link"));
    for (const fs::path& name : {fs::path("/dev/fd/" + number), fs::path("/proc/self/fd/" + number),
                                 fs::path("/proc/thread-self/fd/" + number), path("link")})
      EXPECT_EQ(codeOf(writeFileAtomically({}, name)), "IO_NOT_A_FILE") << name;
    fs::remove(path("link"));
  }
  for (const int open : {log, ends[0], ends[1], sockets[0], sockets[1]}) ::close(open);
  EXPECT_EQ(get("log"), "precious line\n");
}

TEST_F(CaseFile, IsWrittenWithoutTheLeftoversOfWritersThatWereKilled) {
  const pid_t writer = ::fork();
  if (writer == 0) {
    const auto file = PendingFile::beside(path("b"));
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(writer, &status, 0), writer);
  const std::string left = names().at(0);
  fs::create_directory(path(".lumen-1234-0000000006"));
  fs::copy(path(left), path(".lumen-1234-0000000006"));
  put(".lumen-notes", "of somebody else");
  const int locked = ::open(path(".lumen-1234-0000000006").c_str(), O_RDONLY);
  ASSERT_EQ(::flock(locked, LOCK_EX), 0);
  EXPECT_EQ(codeOf(write("a", "x")), "OK");
  ::close(locked);
  EXPECT_EQ(names(), (std::vector<std::string>{".lumen-1234-0000000006", ".lumen-notes", "a"}));
}

// Kills a process at a random moment while it writes one of two contents over and over. The
// environment variable LUMEN_KILLS sets how many times.
TEST_F(CaseFile, IsTheOldOrTheNewOneWheneverTheWriterIsKilled) {
  const char* kills = std::getenv("LUMEN_KILLS");
  const int count = kills == nullptr ? 20 : std::atoi(kills);
  const std::string contents[2] = {std::string(400'000, 'a'), std::string(700'000, 'b')};
  ASSERT_EQ(codeOf(write("f", contents[0])), "OK");
  Random random(11);
  int seen[2] = {0, 0};
  for (int i = 0; i < count; ++i) {
    int written[2];  // a byte for every finished write
    ASSERT_EQ(::pipe(written), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0)
      for (std::size_t k = 1;; ++k)
        if (!write("f", contents[k % 2]) || ::write(written[1], "", 1) != 1) ::_exit(1);
    char byte = 0;
    for (auto writes = random.next() % 3; writes > 0; --writes)
      ASSERT_EQ(::read(written[0], &byte, 1), 1);
    std::this_thread::sleep_for(std::chrono::microseconds(random.next() % 3000));
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    ::close(written[0]);
    ::close(written[1]);
    const std::string found = get("f");
    ASSERT_TRUE(found == contents[0] || found == contents[1]) << found.size();
    ++seen[found == contents[1] ? 1 : 0];
  }
  EXPECT_GT(seen[0], 0);
  EXPECT_GT(seen[1], 0);
  EXPECT_EQ(codeOf(write("f", "last")), "OK");
  EXPECT_EQ(names(), std::vector<std::string>{"f"});
}

// Limits the size of files, so that a write fails half way as on a full disk.
TEST_F(CaseFile, StaysTheOldOneWhenTheDiskIsFull) {
  put("a", "old");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{4096, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto result = write("a", std::string(10000, 'x'));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(codeOf(result), "IO_WRITE");
  EXPECT_EQ(get("a"), "old");
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(CaseFile, StaysTheOldOneInADirectoryThatCannotBeWritten) {
  const WithoutPrivileges guard(path(""));
  put("a", "old");
  fs::permissions(path(""), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(codeOf(write("a", "new")), "IO_WRITE");
  EXPECT_EQ(get("a"), "old");
}

TEST_F(CaseFile, IsNotReplacedIfItIsReadOnly) {
  const WithoutPrivileges guard(path(""));
  put("a", "old");
  ASSERT_EQ(::chmod(path("a").c_str(), 0444), 0);
  EXPECT_EQ(codeOf(write("a", "new")), "IO_WRITE");
  EXPECT_EQ(get("a"), "old");
}

}  // namespace
}  // namespace lumen::formats
