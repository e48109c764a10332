// SPDX-License-Identifier: Apache-2.0
// Commands of lumen that other commands have done by lumen itself, in a process of its own.
#pragma once

#include <string>
#include <vector>

#include "converters/base/progress.h"

namespace lumen::app {

/// Runs this program, quietly. Throws Error(Failed) with its message if it does not end with 0, Error(Cancelled).
void runLumen(std::vector<std::string> words, const Progress& progress);

}  // namespace lumen::app
