// SPDX-License-Identifier: Apache-2.0
// The folder in which lumen keeps what is neither a result nor a setting.
#pragma once

#include <filesystem>
#include <optional>

namespace lumen {

/// $XDG_STATE_HOME/lumen, by default ~/.local/state/lumen, which need not exist. Nothing if neither
/// XDG_STATE_HOME nor HOME is an absolute path: a relative one is to be ignored (XDG Base Directory
/// Specification).
std::optional<std::filesystem::path> stateFolder();

}  // namespace lumen
