// SPDX-License-Identifier: Apache-2.0
// Jobs of Slurm, by its own programs sbatch, squeue and scancel.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "converters/base/progress.h"

namespace lumen::engine {

/// Submits a script and returns the id of its job. Throws Error(Failed) where sbatch is not
/// installed, or refuses the job, with its message; Error(Cancelled).
std::string submitJob(const std::vector<std::string>& options, const std::filesystem::path& script,
                      const Progress& progress);

/// States of a job's tasks in the queue, in Slurm's words, each once: "PENDING", "RUNNING". Empty
/// where Slurm has forgotten the job, or is not here.
std::vector<std::string> jobStates(const std::string& id, const Progress& progress);

/// Ends a job, if it is in the queue.
void cancelJob(const std::string& id, const Progress& progress);

/// The text as one word of a POSIX shell.
std::string shellWord(const std::string& text);

}  // namespace lumen::engine
