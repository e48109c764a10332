// SPDX-License-Identifier: Apache-2.0
// What a command reads and writes by name, and what it refuses before any work.
#pragma once

#include <filesystem>
#include <string_view>

#include "formats/case/case_file.h"

namespace lumen::app {

/// A case in either encoding, by its content. Throws Error(InvalidInput) with the file's name and
/// what is wrong in it.
formats::Case readCase(const std::filesystem::path& file);

/// The case, to be changed and written as another: it states the digest of `file`, and has no chunk
/// of others that a change would make wrong.
formats::Case readParentCase(const std::filesystem::path& file);

/// Validates and writes atomically; throws Error(Failed) with the file's name.
void writeCase(const formats::Case& value, const std::filesystem::path& file,
               formats::CaseEncoding encoding, const formats::EncodeOptions& options);

/// Writes atomically; throws Error(Failed) with the file's name.
void writeText(std::string_view text, const std::filesystem::path& file);

/// Throws Error(InvalidInput) if `path` is missing; `what` names its role, such as "seeds file".
void requireInput(const std::filesystem::path& path, std::string_view what);

/// Throws Error(Failed) unless `path` can be created: its folder must exist and take new files, and
/// it must not itself be a folder. Leaves nothing behind.
void requireWritable(const std::filesystem::path& path);

}  // namespace lumen::app
