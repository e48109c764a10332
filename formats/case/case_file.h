// SPDX-License-Identifier: Apache-2.0
// Cases as files: `.lumen` (binary) and `.lumen.json` (its lossless twin). See spec/lumen.md. Both
// encodings and the rules come with this header.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "formats/case/case.h"
#include "formats/case/case_encoding.h"
#include "formats/case/validate.h"
#include "formats/container/expected.h"

namespace lumen::formats {

/// Decodes a case of either encoding, which the first bytes determine.
Expected<Case> decodeCase(std::span<const std::byte> bytes);

/// The whole of a regular file that is not empty.
Expected<std::vector<std::byte>> readFileBytes(const std::filesystem::path& file);

/// The case in a file of either encoding, whatever its name. Messages name the file.
Expected<Case> readCaseFile(const std::filesystem::path& file);

enum class CaseEncoding : std::uint8_t { Binary, Json };

/// The bytes of a case in a file, after validation; JSON uses only the points' rounding among the
/// options.
Expected<std::vector<std::byte>> encodeCase(const Case& value, CaseEncoding encoding,
                                            const EncodeOptions& options = {});

/// Writes what encodeCase() gives atomically.
Status writeCaseFile(const Case& value, const std::filesystem::path& file, CaseEncoding encoding,
                     const EncodeOptions& options = {});
/// Validates, then writes atomically: JSON if the name ends in ".json", binary otherwise.
Status writeCaseFile(const Case& value, const std::filesystem::path& file);

constexpr std::size_t kDefaultMaxIssues = 100;

struct ValidationReport {
  std::vector<Issue> issues;  ///< at most `maxIssues`, errors first
  IssueCounts counts;         ///< all issues, listed or not
  [[nodiscard]] bool valid() const { return counts.errors == 0; }
  [[nodiscard]] std::size_t unlisted() const { return counts.total() - issues.size(); }
};

/// All errors and warnings in bytes of either encoding. A part that cannot be understood hides the
/// faults of those that depend on it: a text that is not JSON gives only its first fault.
ValidationReport validateBytes(std::span<const std::byte> bytes,
                               std::size_t maxIssues = kDefaultMaxIssues);

}  // namespace lumen::formats
