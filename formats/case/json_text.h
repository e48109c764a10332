// SPDX-License-Identifier: Apache-2.0
// JSON text (RFC 8259) as a sequence of events. Numbers come as they are written, because what they
// are depends on their field; places are those of the first byte that cannot be right.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace lumen::formats {

/// Receives what a text has, in its order. Reading ends when a function returns false.
class JsonEvents {
public:
  JsonEvents() = default;
  JsonEvents(const JsonEvents&) = delete;
  JsonEvents& operator=(const JsonEvents&) = delete;
  virtual bool null() = 0;
  virtual bool boolean(bool value) = 0;
  virtual bool string(std::string& value) = 0;
  /// `whole` numbers have neither a point nor an exponent.
  virtual bool number(std::string_view text, bool whole) = 0;
  virtual bool beginObject() = 0;
  virtual bool key(std::string& name) = 0;
  virtual bool endObject() = 0;
  virtual bool beginArray() = 0;
  virtual bool endArray() = 0;

protected:
  ~JsonEvents() = default;
};

/// Why a text is not JSON, and the byte from which on it cannot be.
struct JsonFault {
  std::size_t at = 0;
  std::string message;  ///< "line 2, column 7: found "}", expected a value"; not yet printable
};

/// Nothing if the whole text was read, or if `events` ended it. Strict: UTF-8, no byte order mark,
/// no comment. The depth of nesting is for `events` to limit.
std::optional<JsonFault> readJsonText(std::string_view text, JsonEvents& events);

}  // namespace lumen::formats
