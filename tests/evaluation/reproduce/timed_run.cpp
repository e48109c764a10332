// SPDX-License-Identifier: Apache-2.0
#include "timed_run.h"

#include <chrono>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "converters/base/error.h"

namespace lumen::reproduce {
namespace {

[[noreturn]] void become(std::vector<std::string> words, const std::filesystem::path& out,
                         const std::filesystem::path& err) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  if (dup2(creat(out.c_str(), 0600), 1) < 0 || dup2(creat(err.c_str(), 0600), 2) < 0) _exit(126);
  execv(argv[0], argv.data());
  _exit(127);
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

TimedRun runTimed(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                  const std::filesystem::path& out, const std::filesystem::path& err) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const auto begin = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) become(words, out, err);
  int status = 0;
  rusage usage{};
  if (child < 0 || wait4(child, &status, 0, &usage) != child)
    throw failed(program.string() + ": cannot be run");
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw failed(program.string() + " " + arguments.at(0) + ": failed: " + readText(err));
  return {wall.count(), seconds(usage.ru_utime) + seconds(usage.ru_stime)};
}

std::string readText(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw failed(file.string() + ": cannot be read");
  return text.str();
}

}  // namespace lumen::reproduce
