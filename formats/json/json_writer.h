// SPDX-License-Identifier: Apache-2.0
// Canonical JSON text: one value has one text.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/field/vec3f.h"

namespace lumen::formats {

/// Compact: no white space. Readable: indented by two, with arrays of numbers on lines of about 100
/// bytes.
enum class JsonStyle { Compact, Readable };

/// Numbers are the shortest text that reads back the same. A double always has a '.' or an
/// exponent, which distinguishes it from an integer; a float in an array need not. Negative zero is
/// written as zero.
/// The caller keeps to JSON's grammar; texts must be UTF-8 and numbers finite.
class JsonWriter {
public:
  explicit JsonWriter(JsonStyle style) : m_style(style) {}

  void beginObject(bool oneLine = false);
  void beginArray(bool oneLine = false);
  void end();
  /// Begins a member of an object; its value is written next.
  JsonWriter& key(std::string_view name);
  void text(std::string_view value);
  void boolean(bool value);
  void integer(std::int64_t value);
  void size(std::uint64_t value);
  void real(double value);
  void real(float value);
  void array(std::span<const float> values);
  void array(std::span<const Vec3f> values);
  void array(std::span<const std::int32_t> values);
  void array(std::span<const std::uint32_t> values);
  void array(std::span<const std::array<std::uint32_t, 2>> values);
  void array(std::span<const std::array<float, 4>> values);
  void array(std::span<const double> values);  ///< on one line

  /// The text so far, which is complete once every begin has its end.
  std::string take() { return std::move(m_text); }

private:
  struct Level {
    char close;
    bool oneLine;
    bool empty = true;
  };
  void begin(char open, char close, bool oneLine);
  void separate();
  void breakLine();
  template <class Value, class Append>
  void wrapped(std::span<const Value> values, Append append);

  JsonStyle m_style;
  std::string m_text;
  std::vector<Level> m_levels;
  bool m_afterKey = false;
};

}  // namespace lumen::formats
