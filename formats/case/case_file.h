// SPDX-License-Identifier: Apache-2.0
// Cases as files: `.lumen` (binary) and `.lumen.json` (its lossless twin). See spec/lumen.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/case/case.h"
#include "formats/container/expected.h"
#include "formats/container/issue.h"

namespace lumen::formats {

/// Why a file or a case was refused. A broken rule of the model has both places in a binary file,
/// and only the pointer elsewhere.
struct FormatError {
  std::string code;     ///< stable, upper case, such as TRUNCATED or NODE_PARENT: see errorRules()
  std::string place;    ///< "byte 128", a JSON pointer such as /tree/branches/2/label, or "file"
  std::string message;  ///< what was found and what was expected
  Severity severity = Severity::Error;
  std::vector<Argument> arguments{};
  std::optional<std::uint64_t> offset{};  ///< bytes from the start of the file
  std::optional<std::string> pointer{};   ///< JSON pointer into the JSON encoding
  [[nodiscard]] std::string text() const;
};

template <class T>
using Result = Expected<T, FormatError>;

/// Decodes and validates. Never throws for bad input; memory is bounded by the bytes present.
/// Chunks that are not known and not critical are kept in Case::otherChunks; keys that start with
/// "x-" are dropped.
Result<Case> decodeBinary(std::span<const std::byte> bytes);
Result<Case> decodeJson(std::string_view text);

struct EncodeOptions {
  bool compress = false;  ///< zstd for every chunk that it makes smaller
  /// Bits of a coordinate of a wall point in the points' bounding box, 1 to 30, by Draco; 0: exact.
  int pointBits = 0;
};

/// Canonical encodings: equal cases give equal bytes (a negative zero is written as zero). The case
/// must pass validate(). With options the bytes depend on the versions of zstd and Draco too.
std::vector<std::byte> encodeBinary(const Case& value, const EncodeOptions& options = {});
std::string encodeJson(const Case& value);

/// Rounds the wall points as encodeBinary() with these bits does, and says so in the metadata.
/// Nothing happens to a case without points. Throws std::invalid_argument unless bits are 1 to 30.
void quantisePoints(Case& value, int bits);

/// The first rule of the format that `value` breaks (sizes, ranges, references, finiteness,
/// labels), or true.
Result<bool> validate(const Case& value);

/// Drops the chunks of others that are wrong once nodes, points or models have changed.
void dropDependentChunks(Case& value);

struct ValidateOptions {
  std::size_t maxIssues = 100;
  bool privacy = false;  ///< look for persons, dates and paths in texts
};

struct ValidationReport {
  std::vector<FormatError> issues;  ///< at most maxIssues
  std::size_t errorCount = 0;       ///< at least this many
  bool complete = true;             ///< false if it stopped at maxIssues: there may be more
  [[nodiscard]] bool valid() const { return errorCount == 0; }
};

/// All that is wrong, or worth a warning, in bytes of either encoding.
ValidationReport validateBytes(std::span<const std::byte> bytes, const ValidateOptions& options);
ValidationReport validateFile(const std::filesystem::path& file, const ValidateOptions& options);

/// Reads either encoding, chosen by the file's first bytes, not its name. Messages name the file.
Result<Case> readCaseFile(const std::filesystem::path& file);
/// Validates, then writes atomically: JSON if the name ends in ".json", binary otherwise.
Result<bool> writeCaseFile(const Case& value, const std::filesystem::path& file);

/// The whole of a regular file that is not empty.
Result<std::vector<std::byte>> readFileBytes(const std::filesystem::path& file);

/// Writes `bytes` to a new file beside `file`, flushes it to disk and renames it over `file`. The
/// old file is untouched unless all of that succeeds; its permissions are kept, and a new file gets
/// those of any newly created one. A symbolic link is followed, so the file that it leads to is
/// replaced. A directory or device is refused. Until its last instant the new file has no name
/// where the file system can do that, so a killed process leaves nothing behind.
Result<bool> writeFileAtomically(std::span<const std::byte> bytes,
                                 const std::filesystem::path& file);

}  // namespace lumen::formats
