// SPDX-License-Identifier: Apache-2.0
// Another program, run and timed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lumen::reproduce {

struct TimedRun {
  double wall = 0;       ///< seconds
  double processor = 0;  ///< seconds of its own, of all cores together
};

/// Runs `program` with its standard output and error in files, which are overwritten. Throws
/// Error(Failed) unless it exits with 0; the message ends with what it wrote to standard error.
TimedRun runTimed(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                  const std::filesystem::path& out, const std::filesystem::path& err);

/// The whole file. Throws Error(Failed).
std::string readText(const std::filesystem::path& file);

}  // namespace lumen::reproduce
