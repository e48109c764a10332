// SPDX-License-Identifier: Apache-2.0
#include "formats/json/json_writer.h"

#include "formats/view/text_rules.h"

namespace lumen::formats {
namespace {

constexpr std::size_t kLineWidth = 100;

void appendFloat(std::string& text, float value) {
  appendNumber(text, value + 0.0f);
}

void appendDouble(std::string& text, double value) {
  const std::size_t start = text.size();
  appendNumber(text, value + 0.0);
  if (text.find_first_of(".e", start) == std::string::npos) text += ".0";
}

void appendVector(std::string& text, const Vec3f& v) {
  text += '[';
  appendFloat(text, v.x);
  text += ',';
  appendFloat(text, v.y);
  text += ',';
  appendFloat(text, v.z);
  text += ']';
}

void appendQuaternion(std::string& text, const std::array<float, 4>& q) {
  for (std::size_t i = 0; i < q.size(); ++i) {
    text += i == 0 ? '[' : ',';
    appendFloat(text, q[i]);
  }
  text += ']';
}

void appendPair(std::string& text, const std::array<std::uint32_t, 2>& pair) {
  text += '[';
  appendNumber(text, pair[0]);
  text += ',';
  appendNumber(text, pair[1]);
  text += ']';
}

void appendText(std::string& to, std::string_view value) {
  constexpr const char* digits = "0123456789abcdef";
  to += '"';
  for (const char c : value) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      to += '\\';
      to += c;
    } else if (byte < 0x20) {
      to += "\\u00";
      to += digits[byte >> 4];
      to += digits[byte & 0xfu];
    } else {
      to += c;
    }
  }
  to += '"';
}

}  // namespace

void JsonWriter::breakLine() {
  if (m_style == JsonStyle::Compact) return;
  m_text += '\n';
  m_text.append(2 * m_levels.size(), ' ');
}

// Writes the separator between this value or key and the previous one.
void JsonWriter::separate() {
  if (m_afterKey || m_levels.empty()) {
    m_afterKey = false;
    return;
  }
  Level& level = m_levels.back();
  if (!level.empty) m_text += ',';
  if (!level.oneLine)
    breakLine();
  else if (!level.empty && m_style == JsonStyle::Readable)
    m_text += ' ';
  level.empty = false;
}

void JsonWriter::begin(char open, char close, bool oneLine) {
  separate();
  m_text += open;
  m_levels.push_back({close, oneLine || (!m_levels.empty() && m_levels.back().oneLine)});
}

void JsonWriter::beginObject(bool oneLine) {
  begin('{', '}', oneLine);
}
void JsonWriter::beginArray(bool oneLine) {
  begin('[', ']', oneLine);
}

void JsonWriter::end() {
  const Level level = m_levels.back();
  m_levels.pop_back();
  if (!level.empty && !level.oneLine) breakLine();
  m_text += level.close;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  separate();
  appendText(m_text, name);
  m_text += ':';
  if (m_style == JsonStyle::Readable) m_text += ' ';
  m_afterKey = true;
  return *this;
}

void JsonWriter::text(std::string_view value) {
  separate();
  appendText(m_text, value);
}

void JsonWriter::boolean(bool value) {
  separate();
  m_text += value ? "true" : "false";
}

void JsonWriter::integer(std::int64_t value) {
  separate();
  appendNumber(m_text, value);
}

void JsonWriter::size(std::uint64_t value) {
  separate();
  appendNumber(m_text, value);
}

void JsonWriter::real(double value) {
  separate();
  appendDouble(m_text, value);
}

void JsonWriter::real(float value) {
  separate();
  appendFloat(m_text, value);
}

template <class Value, class Append>
void JsonWriter::wrapped(std::span<const Value> values, Append append) {
  beginArray(true);
  const std::size_t indent = 2 * m_levels.size();
  const auto lineStart = [this] { return m_text.size() - m_text.rfind('\n') - 1; };
  std::size_t column = m_style == JsonStyle::Readable ? lineStart() : 0;
  bool broken = false;
  std::string item;
  for (const Value& value : values) {
    item.clear();
    append(item, value);
    Level& level = m_levels.back();
    if (!level.empty) m_text += ',';
    const bool fits = column + item.size() + 2 <= kLineWidth;
    if (m_style == JsonStyle::Readable && !fits) {
      breakLine();
      column = indent;
      broken = true;
    } else if (m_style == JsonStyle::Readable && !level.empty) {
      m_text += ' ';
      ++column;
    }
    level.empty = false;
    m_text += item;
    column += item.size() + 1;
  }
  m_levels.back().oneLine = !broken;
  end();
}

void JsonWriter::array(std::span<const float> values) {
  wrapped(values, appendFloat);
}
void JsonWriter::array(std::span<const Vec3f> values) {
  wrapped(values, appendVector);
}
void JsonWriter::array(std::span<const std::int32_t> values) {
  wrapped(values, appendNumber<std::int32_t>);
}
void JsonWriter::array(std::span<const std::uint32_t> values) {
  wrapped(values, appendNumber<std::uint32_t>);
}
void JsonWriter::array(std::span<const std::array<std::uint32_t, 2>> values) {
  wrapped(values, appendPair);
}
void JsonWriter::array(std::span<const std::array<float, 4>> values) {
  wrapped(values, appendQuaternion);
}

void JsonWriter::array(std::span<const double> values) {
  beginArray(true);
  for (const double value : values) real(value);
  end();
}

}  // namespace lumen::formats
