// SPDX-License-Identifier: Apache-2.0
// Runs a program that is installed, for what lumen does not do itself.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"

namespace lumen::convert {

/// A folder that only this user can read, gone with this. Throws Error(Failed) if there can be none.
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

/// Where the program of this name is, by PATH.
std::optional<std::filesystem::path> installedProgram(const std::string& name);

enum class ProgramEnd { Done, Refused, Crashed, TookTooLong };

struct ProgramCall {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::filesystem::path folder;  ///< where it runs
  unsigned seconds = 0;          ///< that it may take
  std::filesystem::path input;   ///< the file that it reads as standard input; by default nothing
  /// Its standard input is this process's, and what it prints as errors is shown as well as kept: it may ask for a password.
  bool asksUser = false;
  std::filesystem::path log;  ///< what it prints as errors is added to this file instead of kept
};

struct ProgramResult {
  ProgramEnd end = ProgramEnd::Crashed;
  int code = 0;                ///< the exit code of one that was done or refused
  std::string output, errors;  ///< what it printed, of each the first 4 KiB
};

/// Runs a program without a shell until it ends or its time is over; it ends with this process. Refused: it ended with
/// another exit code than 0. Throws Error(Cancelled), and Error(Failed) if no process can be started or `input` not be
/// read, or `log` not be written.
ProgramResult runProgram(const ProgramCall& call, const Progress& progress);

}  // namespace lumen::convert
