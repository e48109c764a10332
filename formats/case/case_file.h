// SPDX-License-Identifier: Apache-2.0
// Cases as files: `.lumen` (binary) and `.lumen.json` (its lossless twin). See spec/lumen.md.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/case/case.h"
#include "formats/container/error_code.h"
#include "formats/container/expected.h"

namespace lumen::formats {

/// Why a file or a case was refused. Broken rules of the model are placed by the JSON pointer that
/// the value has in the JSON encoding, whichever encoding was read.
struct FormatError {
  std::string code;     ///< stable, upper case, such as TRUNCATED or NODE_PARENT: see errorRules()
  std::string place;    ///< "byte 128", a JSON pointer such as /tree/branches/2/label, or "file"
  std::string message;  ///< what was found and what was expected
  [[nodiscard]] std::string text() const { return code + " at " + place + ": " + message; }
};

template <class T>
using Result = Expected<T, FormatError>;

/// Decodes and validates. Never throws for bad input; memory is bounded by the bytes present.
/// What the format ignores (unknown chunks that are not critical, keys that start with "x-") is
/// dropped.
Result<Case> decodeBinary(std::span<const std::byte> bytes);
Result<Case> decodeJson(std::string_view text);

/// Canonical encodings: equal cases give equal bytes (a negative zero is written as zero). The case
/// must pass validate().
std::vector<std::byte> encodeBinary(const Case& value);
std::string encodeJson(const Case& value);

/// The first rule of the format that `value` breaks (sizes, ranges, references, finiteness,
/// labels), or true.
Result<bool> validate(const Case& value);

/// Reads either encoding, chosen by the file's first bytes, not its name. Messages name the file.
Result<Case> readCaseFile(const std::filesystem::path& file);
/// Validates, then writes atomically: JSON if the name ends in ".json", binary otherwise.
Result<bool> writeCaseFile(const Case& value, const std::filesystem::path& file);

/// Writes `bytes` to a temporary file beside `file`, flushes it to disk and renames it over `file`.
/// The old file is untouched unless all of that succeeds; its permissions are kept, and a new file
/// gets those of any newly created one. A symbolic link is followed, so the file that it leads to
/// is replaced. A directory or device is refused.
Result<bool> writeFileAtomically(std::span<const std::byte> bytes,
                                 const std::filesystem::path& file);

}  // namespace lumen::formats
