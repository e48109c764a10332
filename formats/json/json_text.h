// SPDX-License-Identifier: Apache-2.0
// JSON text (RFC 8259) as a sequence of events. Numbers are passed as text, because their type
// depends on their field; the place of a fault is the first byte that cannot be right.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace lumen::formats {

/// Receives the values, keys and brackets of a text in their order. Reading ends when a function
/// returns false.
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

/// The reason why a text is not JSON, and the first byte that no JSON text could have there.
struct JsonFault {
  std::size_t at = 0;
  std::string message;  ///< "line 2, column 7: found "}", expected a value"; not yet printable
};

/// The fault of a text; nothing if the whole text was read, or if `events` ended it. Strict: UTF-8,
/// no byte order mark, no comment. The depth of nesting is limited by `events`.
std::optional<JsonFault> readJsonText(std::string_view text, JsonEvents& events);

}  // namespace lumen::formats
