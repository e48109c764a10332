// SPDX-License-Identifier: Apache-2.0
// Files that a command reads and writes by name, and refusals before any work.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "converters/base/memory_files.h"
#include "converters/io/content/file_content.h"
#include "formats/case/case_file.h"

namespace lumen::engine {

/// The bytes of a case's file, which may be damaged. Throws Error(InvalidInput) with the file's name.
std::vector<std::byte> readCaseBytes(const InputFile& file);
/// A case in either encoding, by its content. Throws Error(InvalidInput) with the file's name and
/// the fault.
formats::Case readCase(const InputFile& file);
/// A case in either encoding, by its content, with the bytes of the whole file. Throws as
/// readCase().
std::pair<std::vector<std::byte>, formats::Case> readCaseAndBytes(const InputFile& file);

/// The case, to be changed and written as another: it states the digest of `file`, and has no chunk
/// of others that a change would make wrong.
formats::Case readParentCase(const InputFile& file);

/// The bytes of a case's file, after validation. Throws Error(Failed) with the file's name.
std::string encodeCase(const formats::Case& value, const std::filesystem::path& file,
                       formats::CaseEncoding encoding, const formats::EncodeOptions& options);

/// Validates and writes atomically; throws Error(Failed) with the file's name.
void writeCase(const formats::Case& value, const OutputFile& file, formats::CaseEncoding encoding,
               const formats::EncodeOptions& options);

/// Writes atomically; throws Error(Failed) with the file's name.
void writeText(std::string_view text, const OutputFile& file);

/// Throws Error(InvalidInput) if `file` is missing or may not be read; `what` names its role, such
/// as "seeds file".
void requireInput(const InputFile& file, std::string_view what);

/// Throws Error(Usage) if `output` is a file that only an input can be, a volume or seeds, and
/// Error(InvalidInput) if `input` is missing while `output` could be one: they look swapped.
void requireOrder(const InputFile& input, const OutputFile& output);

/// Throws Error(Failed) unless `output` can be created: its folder must exist and take new files, and
/// it must not itself be a folder. Leaves nothing behind. Throws Error(Usage) if `output` is a
/// volume, seeds or a case, and something else is going to be written.
void requireWritable(const OutputFile& output, convert::ContentKind written);

}  // namespace lumen::engine
