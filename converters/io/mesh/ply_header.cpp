// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/ply_header.h"

#include <array>
#include <charconv>
#include <limits>
#include <system_error>
#include <utility>

#include "converters/base/shown_text.h"
#include "converters/io/vtk/text_cursor.h"

namespace lumen::convert {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes = {{
    {"char", PlyType::Int8},
    {"int8", PlyType::Int8},
    {"uchar", PlyType::Uint8},
    {"uint8", PlyType::Uint8},
    {"short", PlyType::Int16},
    {"int16", PlyType::Int16},
    {"ushort", PlyType::Uint16},
    {"uint16", PlyType::Uint16},
    {"int", PlyType::Int32},
    {"int32", PlyType::Int32},
    {"uint", PlyType::Uint32},
    {"uint32", PlyType::Uint32},
    {"float", PlyType::Float32},
    {"float32", PlyType::Float32},
    {"double", PlyType::Float64},
    {"float64", PlyType::Float64},
}};

class HeaderParser {
public:
  HeaderParser(std::string_view bytes, const std::string& name) : m_text(bytes, name) {}

  PlyHeader parse() {
    if (m_text.restOfLine() != "ply") m_text.refuse("does not begin with \"ply\"; expected PLY");
    bool hasFormat = false;
    for (;;) {
      const std::size_t before = m_text.left(), line = m_text.line();
      const std::string_view word = m_text.wordOfLine();
      if (word == "end_header") break;
      if (word == "format")
        hasFormat = parseFormat();
      else if (word == "element")
        parseElement();
      else if (word == "property")
        parseProperty();
      else if (word == "comment" || word == "obj_info")
        parseComment();
      else if (!word.empty())
        m_text.refuse("found " + quotedText(word) +
                      "; expected format, element, property, comment or end_header");
      if (m_text.line() == line) m_text.restOfLine();
      if (m_text.left() == before) m_text.refuse("the file ends; expected end_header");
    }
    if (!hasFormat) m_text.refuse("the header has no format; expected ascii or binary");
    endLine();
    return std::move(m_header);
  }

private:
  /// Skips one line end only: binary data may begin with bytes that look like another.
  void endLine() {
    const std::size_t line = m_text.line();
    m_text.restOfLine();
    m_header.bytes = m_text.offset();
    m_header.lines = line;
    for (const PlyElement& element : m_header.elements) {
      const std::size_t least = element.leastBytes(m_header.encoding);
      const std::uint64_t room = least > 0 ? m_text.left() / least : m_text.left();
      // the last number of a text has no blank after it
      if (element.count > room + (m_header.encoding == PlyEncoding::Ascii ? 1 : 0))
        refuseMesh(m_text.name(), "line " + std::to_string(line),
                   "the header announces " + std::to_string(element.count) + " of " +
                       quotedText(element.name) + "; expected at most " + std::to_string(room) +
                       ", for which there are bytes");
    }
  }

  /// lumen writes "group 3 inlet" for the faces whose property group is 3.
  void parseComment() {
    const std::string_view comment = m_text.restOfLine();
    m_header.frame.look(comment);
    int number = 0;
    if (!comment.starts_with("group ")) return;
    const std::string_view rest = comment.substr(6);
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    const auto used = static_cast<std::size_t>(end - rest.data());
    if (error == std::errc{} && used + 1 < rest.size() && rest[used] == ' ')
      m_header.groups[number] = rest.substr(used + 1);
  }

  bool parseFormat() {
    const std::string_view word = m_text.wordOfLine();
    if (word == "ascii")
      m_header.encoding = PlyEncoding::Ascii;
    else if (word == "binary_little_endian")
      m_header.encoding = PlyEncoding::LittleEndian;
    else if (word == "binary_big_endian")
      m_header.encoding = PlyEncoding::BigEndian;
    else
      m_text.refuse("the format is " + quotedText(word) +
                    "; expected ascii, binary_little_endian or binary_big_endian");
    return true;
  }

  void parseElement() {
    PlyElement element;
    element.name = m_text.wordOfLine();
    element.count = m_text.parseWhole(m_text.wordOfLine(), "the count of an element",
                                      std::numeric_limits<std::uint64_t>::max());
    m_header.elements.push_back(std::move(element));
  }

  void parseProperty() {
    if (m_header.elements.empty()) m_text.refuse("found a property; expected an element before it");
    PlyProperty property;
    std::string_view word = m_text.wordOfLine();
    property.isList = word == "list";
    if (property.isList) {
      property.countType = typeOf(m_text.wordOfLine());
      if (!isWhole(property.countType))
        m_text.refuse("the count of a list is no whole number; expected a type such as uchar");
      word = m_text.wordOfLine();
    }
    property.type = typeOf(word);
    property.name = m_text.wordOfLine();
    m_header.elements.back().properties.push_back(std::move(property));
  }

  [[nodiscard]] PlyType typeOf(std::string_view word) const {
    for (const auto& [name, type] : kTypes)
      if (word == name) return type;
    m_text.refuse("the type of a property is " + quotedText(word) +
                  "; expected char, uchar, short, ushort, int, uint, float, double or list");
  }

  TextCursor m_text;
  PlyHeader m_header;
};

}  // namespace

std::size_t sizeOf(PlyType type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

std::size_t PlyElement::leastBytes(PlyEncoding encoding) const {
  std::size_t bytes = 0;
  for (const PlyProperty& p : properties)
    bytes += encoding == PlyEncoding::Ascii ? 2 : sizeOf(p.isList ? p.countType : p.type);
  return bytes;
}

PlyHeader parsePlyHeader(std::string_view bytes, const std::string& name) {
  return HeaderParser(bytes, name).parse();
}

}  // namespace lumen::convert
