// SPDX-License-Identifier: Apache-2.0
// The functions of isolated_call.h and run_program.h where a program has no processes, as a WebAssembly module has none.
#include <exception>

#include "converters/base/error.h"
#include "converters/base/isolated_call.h"
#include "converters/base/run_program.h"

namespace lumen::convert {
namespace {

Error noProcess() {
  return unsupported(
      "this build of lumen runs no other programs; the installed program lumen does");
}

}  // namespace

/// Runs `fill` here: a module is isolated as a whole, and its host bounds its memory. A bound that
/// memory reaches is std::bad_alloc, and code that goes astray ends the module with a trap.
IsolatedEnd callIsolated(std::span<std::byte> out, std::size_t /*memory*/, unsigned /*seconds*/,
                         const std::function<bool(std::span<std::byte>)>& fill,
                         const Progress& progress) {
  progress.check();
  try {
    return fill(out) ? IsolatedEnd::Done : IsolatedEnd::Refused;
  } catch (const std::exception&) {
    return IsolatedEnd::Refused;
  }
}

PrivateFolder::PrivateFolder() {
  throw noProcess();
}

PrivateFolder::~PrivateFolder() = default;

std::optional<std::filesystem::path> installedProgram(const std::string& /*name*/) {
  return std::nullopt;
}

ProgramResult runProgram(const ProgramCall& /*call*/, const Progress& /*progress*/) {
  throw noProcess();
}

}  // namespace lumen::convert
