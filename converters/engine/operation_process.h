// SPDX-License-Identifier: Apache-2.0
// Operations in processes of their own, so that one that crashes or runs out of memory costs itself
// only.
#pragma once

#include <filesystem>

#include "converters/base/operation.h"
#include "converters/engine/command.h"

namespace lumen::engine {

struct ProcessOptions {
  int threads = 0;      ///< 0: all cores
  bool strict = false;  ///< a warning is an error
};

/// The word after which the program is given the file of an operation.
inline constexpr const char* kOperationWord = "--operation";

/// The program that runs, or the script that starts it: a folder that brings its own C library
/// starts lib/ld-linux*, the loader, by bin/lumen.
std::filesystem::path thisProgram();

/// Runs the operation in a new process of this program, which appends its messages to `log`. Throws
/// Error(Failed) if no process can be started, and Error(Cancelled).
OperationEnd runInProcess(const Operation& operation, const ProcessOptions& options,
                          const std::filesystem::path& log, const Progress& progress);

/// Threads and strictness of a file that runInProcess() wrote. Throws Error(InvalidInput) for
/// another file.
ProcessOptions operationOptions(const std::filesystem::path& file);

/// Runs the operation of a file that runInProcess() wrote, and leaves the operation's end in a file
/// beside it. Returns the exit code. Throws Error(InvalidInput) for another file.
int runOperationFile(const std::filesystem::path& file, const Engine& engine, Surroundings& around);

}  // namespace lumen::engine
