// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/run_lumen.h"

#include <filesystem>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/run_program.h"
#include "converters/base/text.h"

namespace lumen::app {

void runLumen(std::vector<std::string> words, const Progress& progress) {
  constexpr unsigned kMostSeconds = 24 * 3600;
  convert::ProgramCall call;
  call.program = std::filesystem::read_symlink("/proc/self/exe");
  call.arguments = std::move(words);
  call.arguments.emplace_back("--quiet");
  call.folder = std::filesystem::current_path();
  call.seconds = kMostSeconds;
  const convert::ProgramResult result = convert::runProgram(call, progress);
  if (result.end == convert::ProgramEnd::Done) return;
  const std::string text = trimmed(result.errors), head = "lumen: error: ";
  if (text.empty()) throw failed("lumen " + call.arguments.front() + " ended without a word");
  throw failed(text.starts_with(head) ? text.substr(head.size()) : text);
}

}  // namespace lumen::app
