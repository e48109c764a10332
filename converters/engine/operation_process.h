// SPDX-License-Identifier: Apache-2.0
// Operations in processes of their own, so that one that crashes or runs out of memory costs itself
// only.
#pragma once

#include <filesystem>

#include "converters/base/options/operation.h"
#include "converters/engine/command.h"

namespace lumen::engine {

/// The word after which the program is given the file of an operation.
inline constexpr const char* kOperationWord = "--operation";

/// Runs the operation in a new process of `context.program`, or in this process where no program is
/// named, with the settings of `context`. Messages are appended to `log`. Throws Error(Failed) if no
/// process can be started or the log cannot be written, and Error(Cancelled).
OperationEnd runApart(const Operation& operation, const RunContext& context,
                      const std::filesystem::path& log);

/// Threads and strictness of a file that runApart() wrote. Throws Error(InvalidInput) for another
/// file.
RunSettings operationSettings(const std::filesystem::path& file);

/// Runs the operation of a file that runApart() wrote, and leaves the operation's end in a file
/// beside it. Returns the exit code. Throws Error(InvalidInput) for another file, and as the
/// operation.
int runOperationFile(const std::filesystem::path& file, const RunContext& context);

}  // namespace lumen::engine
