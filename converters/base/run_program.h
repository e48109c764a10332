// SPDX-License-Identifier: Apache-2.0
// Runs installed programs, for work that lumen does not do itself.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"

namespace lumen::convert {

/// A folder that only this user can read, removed with this object. Throws Error(Failed) if none
/// can be created.
class PrivateFolder {
public:
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return m_path; }

private:
  std::filesystem::path m_path;
};

/// Path of the program `name`, found by PATH.
std::optional<std::filesystem::path> installedProgram(const std::string& name);

enum class ProgramEnd { Done, Refused, Crashed, TookTooLong };

struct ProgramCall {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::filesystem::path folder;  ///< working folder
  unsigned seconds = 0;          ///< time limit
  std::filesystem::path input;   ///< file on its standard input; empty: no input
  /// Its standard input is this process's, and its standard error is shown and kept: it may ask for
  /// a password.
  bool asksUser = false;
  std::filesystem::path log{};     ///< file to which its standard error is appended instead of kept
  std::filesystem::path output{};  ///< new file for its standard output, which is not kept then
  /// A file that it writes beyond this size is cut off there: it is refused, or crashes.
  std::optional<std::uint64_t> mostFileBytes{};
};

struct ProgramResult {
  ProgramEnd end = ProgramEnd::Crashed;
  int code = 0;                ///< exit code of a program that was done or refused
  std::string output, errors;  ///< standard output and error, the first 4 KiB of each
};

/// Runs a program without a shell until it ends or its time is over; it ends with this process.
/// Refused: its exit code was not 0. Throws Error(Cancelled), and Error(Failed) if no process can
/// be started, `input` cannot be read, or `log` or `output` cannot be written.
ProgramResult runProgram(const ProgramCall& call, const Progress& progress);

}  // namespace lumen::convert
