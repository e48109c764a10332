// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/run_here.h"

#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include "converters/cli/command_line.h"

namespace lumen::test {

namespace fs = std::filesystem;

namespace {

/// While it lives, the three standard streams are files, and the current folder is another.
class Redirected {
public:
  Redirected(const fs::path& folder, const fs::path& out, const fs::path& err)
      : m_before(fs::current_path()) {
    pthread_sigmask(SIG_SETMASK, nullptr, &m_mask);
    std::fflush(nullptr);
    for (int i = 0; i < 3; ++i) m_kept[static_cast<std::size_t>(i)] = dup(i);
    put(open("/dev/null", O_RDONLY), 0);
    put(creat(out.c_str(), 0600), 1);
    put(err == out ? dup(1) : creat(err.c_str(), 0600), 2);
    fs::current_path(folder);
  }
  ~Redirected() {
    std::fflush(nullptr);
    std::clearerr(stdout);
    for (int i = 0; i < 3; ++i) put(m_kept[static_cast<std::size_t>(i)], i);
    std::error_code ignored;
    fs::current_path(m_before, ignored);
    pthread_sigmask(SIG_SETMASK, &m_mask, nullptr);
  }
  Redirected(const Redirected&) = delete;
  Redirected& operator=(const Redirected&) = delete;

private:
  static void put(int from, int to) {
    if (from < 0 || dup2(from, to) < 0) throw std::runtime_error("no stream");
    close(from);
  }

  fs::path m_before;
  std::array<int, 3> m_kept{};
  sigset_t m_mask{};
};

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (fs::temp_directory_path() / "lumen-cli-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path, ignored);
}

std::string readFile(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

Outcome runHere(const std::vector<std::string>& arguments, const fs::path& folder, bool isMerged) {
  static const TemporaryFolder streams;
  const fs::path out = streams.path / "out", err = isMerged ? out : streams.path / "err";
  std::vector<const char*> argv{"lumen"};
  for (const auto& argument : arguments) argv.push_back(argument.c_str());
  Outcome outcome;
  {
    const Redirected redirected(folder, out, err);
    outcome.code = cli::runCommandLine(static_cast<int>(argv.size()), argv.data());
  }
  outcome.out = readFile(out);
  if (!isMerged) outcome.err = readFile(err);
  return outcome;
}

}  // namespace lumen::test
