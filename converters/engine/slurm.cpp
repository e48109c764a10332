// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/slurm.h"

#include <algorithm>
#include <optional>
#include <sstream>

#include "converters/base/error.h"
#include "converters/base/run_program.h"
#include "converters/base/text.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

constexpr unsigned kLongestAnswer = 300;  // s: a controller that is busy answers late

std::optional<convert::ProgramResult> runSlurm(const std::string& name,
                                               std::vector<std::string> arguments,
                                               const Progress& progress) {
  const auto program = convert::installedProgram(name);
  if (!program) return std::nullopt;
  convert::ProgramCall call;
  call.program = *program;
  call.arguments = std::move(arguments);
  call.folder = fs::current_path();
  call.seconds = kLongestAnswer;
  return convert::runProgram(call, progress);
}

}  // namespace

std::string submitJob(const std::vector<std::string>& options, const fs::path& script,
                      const Progress& progress) {
  std::vector<std::string> arguments = {"--parsable"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  arguments.push_back(script.string());
  const auto result = runSlurm("sbatch", arguments, progress);
  if (!result) throw failed("sbatch is not installed here, so nothing can be submitted to Slurm");
  if (result->end != convert::ProgramEnd::Done)
    throw failed("sbatch refuses " + formats::printable(script.string()) + ": " +
                 formats::printable(trimmed(result->errors)));
  const std::string id = result->output.substr(0, result->output.find_first_of(";\n"));
  if (id.empty() || id.find_first_not_of("0123456789") != std::string::npos)
    throw failed("sbatch answers " + formats::printable(trimmed(result->output)) +
                 ", expected the id of a job");
  return id;
}

std::vector<std::string> jobStates(const std::string& id, const Progress& progress) {
  const auto result = runSlurm("squeue", {"--noheader", "--jobs", id, "--format", "%T"}, progress);
  std::vector<std::string> states;
  if (!result || result->end != convert::ProgramEnd::Done) return states;
  std::istringstream words(result->output);
  for (std::string word; words >> word;)
    if (std::find(states.begin(), states.end(), word) == states.end()) states.push_back(word);
  return states;
}

void cancelJob(const std::string& id, const Progress& progress) {
  (void)runSlurm("scancel", {id}, progress);
}

std::string shellWord(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

}  // namespace lumen::engine
