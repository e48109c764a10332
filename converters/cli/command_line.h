// SPDX-License-Identifier: Apache-2.0
// Running a command from argv to its exit code.
#pragma once

namespace lumen::cli {

/// Parses, runs, and translates everything that is thrown into one line on standard error and an
/// exit code.
int runCommandLine(int argc, const char* const* argv);

}  // namespace lumen::cli
