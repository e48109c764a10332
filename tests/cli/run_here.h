// SPDX-License-Identifier: Apache-2.0
// lumen's command line in this process: a run costs its work alone, not the loading of libraries.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lumen::test {

struct Outcome {
  int code = -1;  ///< exit code; 1000 + n if signal n ended the process
  std::string out;
  std::string err;
};

/// A folder below that for temporary files, which is gone with the object.
struct TemporaryFolder {
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path path;
};

/// Runs the command line with these arguments in a folder, as a process would, with standard input
/// empty. `isMerged`: `out` has both streams, in the order in which they were written. Folder,
/// streams and blocked signals of this process are those of before afterwards. One run at a time.
Outcome runHere(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                bool isMerged = false);

/// The whole file; empty if there is none.
std::string readFile(const std::filesystem::path& file);

}  // namespace lumen::test
