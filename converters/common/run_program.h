// SPDX-License-Identifier: Apache-2.0
// Runs a program that is installed, for what lumen does not do itself.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/common/progress.h"

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

/// Runs `program` in `folder`, without a shell, without input, its output thrown away, until it ends or `seconds` are over;
/// it ends with this process. Refused: it ended with another exit code than 0. Throws Error(Cancelled), and
/// Error(Failed) if no process can be started.
ProgramEnd runProgram(const std::filesystem::path& program,
                      const std::vector<std::string>& arguments,
                      const std::filesystem::path& folder, unsigned seconds,
                      const Progress& progress);

}  // namespace lumen::convert
