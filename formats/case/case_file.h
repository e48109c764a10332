// SPDX-License-Identifier: Apache-2.0
// Cases as files: `.lumen` (binary) and `.lumen.json` (its lossless twin). See spec/lumen.md.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "formats/case/case.h"

namespace lumen::formats {

/// Why a file or a case was refused.
struct FormatError {
  std::string code;     ///< stable, upper case, such as TRUNCATED or NODE_PARENT_RANGE
  std::string place;    ///< "byte 128", or a JSON pointer such as /branches/2/label
  std::string message;  ///< what was found and what was expected
  [[nodiscard]] std::string text() const { return code + " at " + place + ": " + message; }
};

template <class T>
class [[nodiscard]] Result {
public:
  Result(T value) : m_state(std::move(value)) {}
  Result(FormatError error) : m_state(std::move(error)) {}
  [[nodiscard]] explicit operator bool() const { return m_state.index() == 0; }
  T& operator*() { return std::get<0>(m_state); }
  const T& operator*() const { return std::get<0>(m_state); }
  T* operator->() { return &**this; }
  const T* operator->() const { return &**this; }
  [[nodiscard]] const FormatError& error() const { return std::get<1>(m_state); }

private:
  std::variant<T, FormatError> m_state;
};

/// Decodes and validates. Never throws for bad input; memory is bounded by the bytes present.
Result<Case> decodeBinary(std::span<const std::byte> bytes);
Result<Case> decodeJson(std::string_view text);

/// Canonical encodings: equal cases give equal bytes. The case must pass validate().
std::vector<std::byte> encodeBinary(const Case& value);
std::string encodeJson(const Case& value);

/// The first rule of the format that `value` breaks (sizes, ranges, references, finiteness, labels), or true.
Result<bool> validate(const Case& value);

/// Reads either encoding, chosen by the file's first bytes, not its name.
Result<Case> readCaseFile(const std::filesystem::path& file);
/// Writes atomically, JSON if the name ends in ".json", binary otherwise.
Result<bool> writeCaseFile(const Case& value, const std::filesystem::path& file);

/// Writes `bytes` to a temporary file beside `file`, flushes it to disk and renames it over `file`.
/// The old file is untouched unless all of that succeeds.
Result<bool> writeFileAtomically(std::span<const std::byte> bytes, const std::filesystem::path& file);

}  // namespace lumen::formats
