// SPDX-License-Identifier: Apache-2.0
// `lumen library build --status`: the state of every row of a list, while it is made or afterwards.
#pragma once

#include <string>
#include <vector>

#include "converters/engine/library_build.h"

namespace lumen::engine {

/// Reads notes and the library, no inputs, and asks Slurm for the jobs of the last submission.
/// Throws Error(InvalidInput) for a folder that is no library.
Answer buildStatus(const convert::BuildList& rows, const std::string& library,
                   const BuildArguments& arguments, const Surroundings& around);

}  // namespace lumen::engine
