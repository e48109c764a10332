// SPDX-License-Identifier: Apache-2.0
#include "converters/base/state_folder.h"

#include <cstdlib>

namespace lumen {

namespace fs = std::filesystem;

std::optional<fs::path> stateFolder() {
  const auto folder = [](const char* name) {
    const char* const value = std::getenv(name);
    return fs::path(value == nullptr ? "" : value);
  };
  if (const fs::path state = folder("XDG_STATE_HOME"); state.is_absolute()) return state / "lumen";
  if (const fs::path home = folder("HOME"); home.is_absolute()) return home / ".local/state/lumen";
  return std::nullopt;
}

}  // namespace lumen
