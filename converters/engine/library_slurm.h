// SPDX-License-Identifier: Apache-2.0
// `lumen library build --slurm`: an array of tasks that make rows, and a job that collects them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "converters/engine/library_build.h"

namespace lumen::engine {

struct SlurmArguments {
  std::string list, library;
  int tasks = 0;  ///< of the array; 0: one for each row, as far as Slurm allows
};

/// Jobs of the last submission, as the folder for work remembers them; empty ids where there is
/// none.
struct SlurmJobs {
  std::string array, collect;
};
SlurmJobs submittedJobs(const std::filesystem::path& work);

/// Writes the scripts of both jobs into the folder for work and submits them, for the rows that the
/// library lacks; submits nothing if it lacks none. Throws Error(InvalidInput) as buildLibrary(),
/// and Error(Failed) where Slurm refuses, or jobs of the last submission are in its queue still.
Answer submitBuild(convert::BuildList rows, const SlurmArguments& slurm,
                   const BuildArguments& arguments, const Surroundings& around);

}  // namespace lumen::engine
