// SPDX-License-Identifier: Apache-2.0
// Transfers from a server with faults, on the loopback interface.
#include "converters/io/remote/remote_file.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/base/run_program.h"
#include "converters/base/sha256.h"
#include "scripted_server.h"

namespace lumen::convert {

namespace {

const std::string kBody = "0123456789abcdefghij";  // 20 bytes
const std::string kTag = "ETag: \"v1\"\r\n";

std::string answer(const std::string& status, const std::string& fields, const std::string& body) {
  return "HTTP/1.1 " + status + "\r\nConnection: close\r\n" + fields + "\r\n" + body;
}

/// The whole file, of which only the first `sent` bytes come.
Script whole(std::size_t sent, const std::string& body = kBody, const std::string& tag = kTag) {
  return {answer("200 OK", "Content-Length: " + std::to_string(body.size()) + "\r\n" + tag,
                 body.substr(0, sent))};
}

/// The range from `first` on, of which the head states `stated`.
Script range(std::size_t first, const std::string& stated, std::size_t count = kBody.size()) {
  const std::string body = kBody.substr(first, count);
  return {answer("206 Partial Content",
                 "Content-Length: " + std::to_string(body.size()) + "\r\nContent-Range: bytes " +
                     stated + "\r\n" + kTag,
                 body)};
}

class RemoteFileTest : public testing::Test {
protected:
  static void SetUpTestSuite() { setenv("no_proxy", "127.0.0.1", 1); }
  void SetUp() override {
    if (!installedProgram("curl")) GTEST_SKIP() << "curl is not installed";
    m_options.pauseMs = 1;
    m_options.stallSeconds = 1;
  }
  /// The bytes that come, or the error with its exit code.
  [[nodiscard]] std::string fetched(const ScriptedServer& server) {
    try {
      const RemoteFile file = fetchFile(parseRemote(server.address("/a/head.bin?key=secret")),
                                        m_folder.path(), m_options, m_progress);
      std::ostringstream bytes;
      bytes << std::ifstream(file.path, std::ios::binary).rdbuf();
      EXPECT_EQ(file.sha256, sha256(bytes.str()));
      EXPECT_EQ(file.path.filename(), "head.bin");
      EXPECT_EQ(std::distance(std::filesystem::directory_iterator(m_folder.path()), {}), 1);
      return bytes.str();
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find("secret"), std::string::npos) << error.what();
      return std::to_string(static_cast<int>(error.kind())) + " " + error.what();
    }
  }
  void expectFault(const ScriptedServer& server, const std::string& code, const std::string& what) {
    const std::string found = fetched(server);
    EXPECT_TRUE(found.starts_with(code + " " + server.address("/a/head.bin") + ": ")) << found;
    EXPECT_NE(found.find(what), std::string::npos) << found;
  }
  [[nodiscard]] std::optional<RemoteHead> head(const ScriptedServer& server, std::uint64_t count) {
    return fetchHead(parseRemote(server.address("/head.bin")), count, m_folder.path(), m_options,
                     m_progress);
  }

  RemoteOptions m_options;
  PrivateFolder m_folder;
  Progress m_progress;
};

}  // namespace

TEST_F(RemoteFileTest, AWholeFileComesByOneRequest) {
  const ScriptedServer server({whole(20)});
  EXPECT_EQ(fetched(server), kBody);
  ASSERT_EQ(server.requests().size(), 1U);
  EXPECT_TRUE(server.requests()[0].starts_with("GET /a/head.bin?key=secret HTTP/1.1\r\n"));
  EXPECT_NE(server.requests()[0].find("User-Agent: lumen/"), std::string::npos);
}

TEST_F(RemoteFileTest, AnEmptyFileIsAFile) {
  EXPECT_EQ(fetched(ScriptedServer({whole(0, "")})), "");
}

TEST_F(RemoteFileTest, ACutTransferGoesOnWhereItWasCut) {
  const ScriptedServer server({whole(7), range(7, "7-19/20", 5), range(12, "12-19/20")});
  // the second answer states 13 bytes and has 5
  EXPECT_EQ(fetched(server), kBody);
  ASSERT_EQ(server.requests().size(), 3U);
  EXPECT_NE(server.requests()[1].find("Range: bytes=7-\r\n"), std::string::npos);
  EXPECT_NE(server.requests()[1].find("If-Range: \"v1\"\r\n"), std::string::npos);
  EXPECT_NE(server.requests()[2].find("Range: bytes=12-\r\n"), std::string::npos);
}

TEST_F(RemoteFileTest, AServerWithoutRangesSendsTheFileAgain) {
  EXPECT_EQ(fetched(ScriptedServer({whole(7), whole(20)})), kBody);
}

TEST_F(RemoteFileTest, AFileThatChangesMeanwhileIsNotMixedWithTheOldOne) {
  const std::string other = "ABCDEFGHIJKLMNOPQRST";
  EXPECT_EQ(fetched(ScriptedServer({whole(7), whole(20, other, "ETag: \"v2\"\r\n")})), other);
}

TEST_F(RemoteFileTest, AWrongRangeIsDropped) {
  for (const char* stated : {"0-12/20", "8-19/20", "7-19/21", "7-19", "19-7/20", "x"})
    EXPECT_EQ(fetched(ScriptedServer({whole(7), range(7, stated), whole(20)})), kBody) << stated;
}

TEST_F(RemoteFileTest, WrongRangesAgainAndAgainEndIt) {
  std::vector<Script> scripts;
  for (int k = 0; k < 4; ++k) {
    scripts.push_back(whole(7));
    scripts.push_back(range(7, "0-12/20"));
  }
  expectFault(ScriptedServer(scripts), "1", "another range");
}

TEST_F(RemoteFileTest, AFileThatIsShorterThanStatedIsAnError) {
  expectFault(ScriptedServer({whole(7), range(7, "7-19/20", 0), range(7, "7-19/20", 0),
                              range(7, "7-19/20", 0), range(7, "7-19/20", 0)}),
              "1", "breaks off after 7 bytes");
}

TEST_F(RemoteFileTest, ASilentServerIsGivenUp) {
  const std::vector<Script> scripts(4, Script{whole(0).answer, true});
  expectFault(ScriptedServer(scripts), "1", "breaks off after 0 bytes");
}

TEST_F(RemoteFileTest, AServerThatFallsSilentIsAskedAgain) {
  const ScriptedServer server({Script{whole(7).answer, true}, range(7, "7-19/20")});
  EXPECT_EQ(fetched(server), kBody);
}

TEST_F(RemoteFileTest, StatusesAreWorded) {
  expectFault(ScriptedServer({{answer("404 Not Found", "Content-Length: 4\r\n", "gone")}}), "3",
              "no such file (HTTP status 404)");
  expectFault(ScriptedServer({{answer("403 Forbidden", "Content-Length: 0\r\n", "")}}), "3",
              "does not give this file to everybody");
  const Script busy{answer("503 Service Unavailable", "Content-Length: 4\r\n", "busy")};
  EXPECT_EQ(fetched(ScriptedServer({busy, busy, whole(20)})), kBody);
}

TEST_F(RemoteFileTest, RedirectionsStayInTheWeb) {
  const Script toFile{
      answer("302 Found", "Location: file:///etc/hostname\r\nContent-Length: 0\r\n", "")};
  expectFault(ScriptedServer({toFile}), "1", "does not follow");
  const Script again{answer("302 Found", "Location: /a/head.bin\r\nContent-Length: 0\r\n", "")};
  EXPECT_EQ(fetched(ScriptedServer({again, whole(20)})), kBody);
  expectFault(ScriptedServer(std::vector<Script>(6, again)), "1", "again and again");
}

TEST_F(RemoteFileTest, AFileThatIsTooLargeIsRefused) {
  m_options.mostBytes = 10;
  expectFault(ScriptedServer({whole(20)}), "3", "more than 10 bytes");
  // without a length, as many bytes come as the limit on its size lets the program write
  const std::string long_(3 << 20, 'x');
  expectFault(ScriptedServer({{answer("200 OK", "", long_)}}), "3", "more than 10 bytes");
}

TEST_F(RemoteFileTest, NobodyListens) {
  m_options.fruitlessTries = 1;
  EXPECT_NE(fetched(ScriptedServer({})).find("1 http://127.0.0.1"), std::string::npos);
}

TEST_F(RemoteFileTest, AHeadIsNoMoreThanWasAskedFor) {
  const ScriptedServer server({range(0, "0-4/20", 5)});
  const auto found = head(server, 5);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->bytes, "01234");
  EXPECT_EQ(found->whole, 20U);
  EXPECT_NE(server.requests()[0].find("Range: bytes=0-4\r\n"), std::string::npos);
}

TEST_F(RemoteFileTest, AHeadMayBeAllOfAShortFile) {
  const auto found = head(ScriptedServer({whole(20)}), 100);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->bytes, kBody);
  EXPECT_EQ(found->whole, 20U);
}

TEST_F(RemoteFileTest, NoHeadComesFromAServerWithoutRanges) {
  EXPECT_FALSE(head(ScriptedServer({whole(20)}), 5));
  EXPECT_FALSE(head(ScriptedServer({range(0, "0-4/*", 5)}), 5));
}

TEST_F(RemoteFileTest, AHeadOfAnotherRangeIsRefused) {
  m_options.fruitlessTries = 1;
  EXPECT_THROW((void)head(ScriptedServer({range(3, "3-7/20", 5)}), 5), Error);
}

}  // namespace lumen::convert
