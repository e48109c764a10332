// SPDX-License-Identifier: Apache-2.0
// Common parts of the headers of NRRD and MetaImage: lines of a field and its value.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/input_file.h"

namespace lumen::convert {

/// The words of `text` between characters of `separators`.
std::vector<std::string> splitWords(std::string_view text, std::string_view separators = " \t\r");

/// The whole number that the whole of `text` represents, also as "48.0"; empty for anything else.
std::optional<std::int64_t> parseInteger(std::string_view text);

/// Reads lines at the beginning of a file, within which a header must end.
class HeaderLines {
public:
  /// Throws Error(InvalidInput) if the file cannot be read.
  explicit HeaderLines(const InputFile& file);
  /// The next line without its end; false if there is none.
  bool next(std::string& line);
  /// Total size of the lines read so far, bytes.
  [[nodiscard]] std::uint64_t size() const { return m_at; }

private:
  std::string m_text;
  std::size_t m_at = 0;
};

/// The fields of a header, by names in lower case, and the offset of the data after it.
class TextHeader {
public:
  explicit TextHeader(InputFile file) : m_file(std::move(file)) {}

  /// Throws Error(InvalidInput) if the field already has another value.
  void set(const std::string& name, const std::string& value);

  [[nodiscard]] bool has(const std::string& name) const { return m_fields.contains(name); }
  /// The value, empty if the field is absent.
  [[nodiscard]] const std::string& text(const std::string& name) const;
  /// Throws if the field is absent.
  [[nodiscard]] const std::string& required(const std::string& name) const;
  /// `count` numbers, or none if the field is absent; throws for any other text. NaN and infinity
  /// are numbers.
  [[nodiscard]] std::vector<double> numbers(const std::string& name, std::size_t count) const;
  /// `count` whole numbers within `low` and `high`, in any notation ("48.0"); throws for any other
  /// text.
  [[nodiscard]] std::vector<std::int64_t> integers(const std::string& name, std::size_t count,
                                                   std::int64_t low, std::int64_t high) const;
  [[nodiscard]] std::int64_t integer(const std::string& name, std::int64_t low, std::int64_t high,
                                     std::int64_t absent) const;
  /// "v.nrrd: its field is "value"; expected EXPECTED".
  [[nodiscard]] Error refusal(const std::string& name, const std::string& expected) const;

  [[nodiscard]] const InputFile& file() const { return m_file; }
  [[nodiscard]] const std::filesystem::path& path() const { return m_file.path(); }

  std::uint64_t size = 0;          ///< bytes up to the data
  std::vector<std::string> notes;  ///< keys and values of the user, "KEY:=VALUE"
  std::vector<std::string> files;  ///< lines after a field that announces a list of files

private:
  InputFile m_file;
  std::map<std::string, std::string> m_fields;
};

}  // namespace lumen::convert
