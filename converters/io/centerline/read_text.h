// SPDX-License-Identifier: Apache-2.0
// Whole files as text. Private to the sources of centerline.
#pragma once

#include <filesystem>
#include <string>

namespace lumen::convert {

/// The bytes of a file of at most 64 MiB; `format` names it in a message. Throws
/// Error(InvalidInput).
std::string readCenterlineText(const std::filesystem::path& file, const char* format);

}  // namespace lumen::convert
