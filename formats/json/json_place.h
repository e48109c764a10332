// SPDX-License-Identifier: Apache-2.0
// The only interface to values of JSON texts that other programs or people wrote.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/json/json_value.h"

namespace lumen::formats {

/// Receives the faults of a document. Every fault has a JSON pointer (RFC 6901). A receiver that
/// throws ends the reading; after one that returns, the read gives a default.
class JsonFaults {
public:
  JsonFaults() = default;
  JsonFaults(const JsonFaults&) = default;
  JsonFaults& operator=(const JsonFaults&) = default;

  virtual void wrongType(std::string pointer, JsonValue found, const std::string& expected) = 0;
  virtual void outOfRange(std::string pointer, JsonNumber found, const std::string& expected) = 0;
  virtual void missingKey(std::string objectPointer, std::string_view key) = 0;

protected:
  ~JsonFaults() = default;
};

/// A value and its place. `expected` completes "expected ..." of a fault. The document and the
/// receiver must outlive the place.
class JsonPlace {
public:
  JsonPlace(JsonValue value, JsonFaults& faults, std::string pointer = {})
      : m_value(value), m_faults(&faults), m_pointer(std::move(pointer)) {}

  [[nodiscard]] const JsonValue& value() const { return m_value; }
  [[nodiscard]] const std::string& pointer() const { return m_pointer; }
  /// The pointer of a member or an entry, whether it is there or not.
  [[nodiscard]] std::string pointerTo(std::string_view token) const;

  /// The member `key`; nothing if it is missing. A value that is no object is a fault.
  [[nodiscard]] std::optional<JsonPlace> find(std::string_view key) const;
  /// The member `key`; a missing one is a fault, too.
  [[nodiscard]] std::optional<JsonPlace> require(std::string_view key) const;
  /// An entry of an array; `index` is below its size.
  [[nodiscard]] JsonPlace entry(std::size_t index) const {
    return below(m_value[index], std::to_string(index));
  }
  /// The entries of an array.
  [[nodiscard]] std::vector<JsonPlace> entries(const std::string& expected = "an array") const;
  /// The first key that `known` lacks; nothing if there is none. A value that is no object is a
  /// fault.
  [[nodiscard]] std::optional<JsonPlace> otherThan(std::initializer_list<const char*> known) const;

  [[nodiscard]] double real(const std::string& expected = "a number") const;
  [[nodiscard]] float single() const;
  [[nodiscard]] bool boolean(const std::string& expected = "a boolean") const;
  /// The string; null after a fault.
  [[nodiscard]] const std::string* text(const std::string& expected = "a string") const;
  /// Fills `to` from an array of the same size; `expected` describes it in the fault of another.
  void reals(std::span<double> to, const std::string& expected) const;

  /// An integer of this type. Without `expected`, faults state its range.
  template <class Integer>
  [[nodiscard]] Integer integer(const std::string& expected = {}) const {
    const auto number = m_value.number();
    if (!number || !number->isWhole()) {
      wrongType(expected.empty() ? "an integer, without point and exponent" : expected);
      return Integer{};
    }
    const auto value = number->asInteger<Integer>();
    if (!value)
      m_faults->outOfRange(m_pointer, *number,
                           !expected.empty()
                               ? expected
                               : "an integer from " +
                                     std::to_string(std::numeric_limits<Integer>::min()) + " to " +
                                     std::to_string(std::numeric_limits<Integer>::max()));
    return value.value_or(Integer{});
  }

private:
  void wrongType(const std::string& expected) const {
    m_faults->wrongType(m_pointer, m_value, expected);
  }
  [[nodiscard]] JsonPlace below(JsonValue value, std::string_view token) const {
    return {value, *m_faults, pointerTo(token)};
  }

  JsonValue m_value;
  JsonFaults* m_faults;
  std::string m_pointer;
};

}  // namespace lumen::formats
