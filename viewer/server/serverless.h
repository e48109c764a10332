// SPDX-License-Identifier: Apache-2.0
// The page without a server: a folder of files in which the engine is a worker of the page.
#pragma once

#include <cstdint>
#include <filesystem>

namespace lumen::viewer {

/// Writes the folder, which may not exist, or must be empty, and returns the bytes of its files. Throws Error(Failed) if
/// the page or its engine was not built, or the folder cannot be written.
std::uint64_t writeServerless(const std::filesystem::path& folder);

}  // namespace lumen::viewer
