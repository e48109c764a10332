// SPDX-License-Identifier: Apache-2.0
// Declared in mesh_readers.h.
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/io/mesh/mesh_builder.h"
#include "converters/io/mesh/ply_header.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/io/vtk/text_cursor.h"

namespace lumen::convert {
namespace {

/// Numbers of the file's body, in order.
class PlyNumbers {
public:
  PlyNumbers(std::string_view body, const PlyHeader& header, const std::string& name)
      : m_body(body),
        m_text(body, name, header.lines + 1),
        m_encoding(header.encoding),
        m_start(header.bytes) {}

  double next(PlyType type, const char* what) {
    if (m_encoding == PlyEncoding::Ascii) return m_text.number(what);
    const std::size_t size = sizeOf(type);
    require(size, what);
    const char* at = m_body.data() + m_at;
    m_at += size;
    const Endian endian = m_encoding == PlyEncoding::BigEndian ? Endian::Big : Endian::Little;
    switch (type) {
      case PlyType::Int8:
        return loadNumber<std::int8_t>(at, endian);
      case PlyType::Uint8:
        return loadNumber<std::uint8_t>(at, endian);
      case PlyType::Int16:
        return loadNumber<std::int16_t>(at, endian);
      case PlyType::Uint16:
        return loadNumber<std::uint16_t>(at, endian);
      case PlyType::Int32:
        return loadNumber<std::int32_t>(at, endian);
      case PlyType::Uint32:
        return loadNumber<std::uint32_t>(at, endian);
      case PlyType::Float32:
        return static_cast<double>(loadNumber<float>(at, endian));
      case PlyType::Float64:
        break;
    }
    return loadNumber<double>(at, endian);
  }

  /// Reads the number of entries of `property`, a list, that follow.
  std::size_t listSize(const PlyProperty& property) {
    const double count = next(property.countType, "the count of a list");
    const std::size_t each = m_encoding == PlyEncoding::Ascii ? 1 : sizeOf(property.type);
    const double room = static_cast<double>(left() / each) + 1;
    if (!(count >= 0 && count <= room && count == std::floor(count)))
      refuseMesh(m_text.name(), "before " + place(),
                 "the count of a list is " + shown(count) + "; expected at most " +
                     std::to_string(left() / each) + ", for which there are bytes");
    return static_cast<std::size_t>(count);
  }

  [[nodiscard]] std::string place() const {
    return m_encoding == PlyEncoding::Ascii ? m_text.place()
                                            : "byte " + std::to_string(m_start + m_at);
  }
  static std::string shown(double value) {
    return value == std::floor(value) && std::abs(value) < 1e15 ? fixedText(value, 0)
                                                                : foundNumber(value);
  }

private:
  [[nodiscard]] std::size_t left() const {
    return m_encoding == PlyEncoding::Ascii ? m_text.left() : m_body.size() - m_at;
  }
  void require(std::size_t size, const char* what) const {
    if (m_body.size() - m_at < size)
      refuseMesh(m_text.name(), place(), "the file ends; expected " + std::string(what));
  }

  std::string_view m_body;
  TextCursor m_text;
  PlyEncoding m_encoding;
  std::size_t m_start;
  std::size_t m_at = 0;
};

class PlyBody {
public:
  PlyBody(const PlyHeader& header, std::string_view bytes, MeshBuilder& builder)
      : m_header(header),
        m_numbers(bytes.substr(header.bytes), header, builder.name()),
        m_builder(builder) {}

  void parse() {
    for (const PlyElement& element : m_header.elements) {
      if (element.name == "vertex")
        parseVertices(element);
      else if (element.name == "face")
        parseFaces(element);
      else
        passOver(element);
    }
    checkForward();
  }

private:
  void parseVertices(const PlyElement& element) {
    std::array<std::optional<std::size_t>, 3> place;
    for (std::size_t p = 0; p < element.properties.size(); ++p)
      for (std::size_t a = 0; a < 3; ++a)
        if (element.properties[p].name == std::string(1, "xyz"[a]) && !element.properties[p].isList)
          place[a] = p;
    if (!place[0] || !place[1] || !place[2])
      refuseMesh(m_builder.name(), "", "its vertices lack x, y or z; expected all three");
    m_builder.file.mesh.position.reserve(static_cast<std::size_t>(element.count));
    std::vector<double> row(element.properties.size(), 0);
    for (std::uint64_t v = 0; v < element.count; ++v) {
      for (std::size_t p = 0; p < row.size(); ++p) {
        const PlyProperty& property = element.properties[p];
        if (property.isList)
          passList(property);
        else
          row[p] = m_numbers.next(property.type, "a coordinate");
      }
      m_builder.addPoint({row[*place[0]], row[*place[1]], row[*place[2]]},
                         [&] { return "vertex " + std::to_string(v); });
    }
  }

  void parseFaces(const PlyElement& element) {
    std::vector<std::uint32_t> corners;
    for (std::uint64_t f = 0; f < element.count; ++f) {
      corners.clear();
      bool any = false;
      double group = 0;
      for (const PlyProperty& property : element.properties) {
        if (property.isList && !any &&
            (property.name == "vertex_indices" || property.name == "vertex_index")) {
          any = true;
          const std::size_t n = m_numbers.listSize(property);
          for (std::size_t i = 0; i < n; ++i) corners.push_back(index(property.type));
        } else if (property.isList) {
          passList(property);
        } else {
          const double value = m_numbers.next(property.type, "a property of a face");
          if (property.name == "group") group = value;
        }
      }
      if (!any)
        refuseMesh(m_builder.name(), "", "its faces have no list vertex_indices; expected one");
      if (corners.size() < 3)
        refuseMesh(m_builder.name(), m_numbers.place(),
                   "face " + std::to_string(f) + " has " + std::to_string(corners.size()) +
                       " corners; expected at least 3");
      if (!m_header.groups.empty()) m_builder.beginGroup(groupName(group));
      m_builder.addPolygon(corners.data(), corners.size());
    }
  }

  std::string groupName(double number) const {
    const bool isSmall = std::abs(number) < 1e9;
    const auto found = m_header.groups.find(isSmall ? static_cast<int>(number) : 0);
    return found == m_header.groups.end() ? std::string() : found->second;
  }

  std::uint32_t index(PlyType type) {
    const double value = m_numbers.next(type, "a corner of a face");
    if (!(value >= 0 && value < 4294967295.0 && value == std::floor(value))) refuseIndex(value);
    const auto found = static_cast<std::uint32_t>(value);
    if (found >= m_builder.points() && found >= m_highest) {
      m_highest = found;
      m_highestPlace = m_numbers.place();
    }
    return found;
  }

  [[noreturn]] void refuseIndex(double value) const {
    refuseMesh(m_builder.name(), "before " + m_numbers.place(),
               "a corner of a face is vertex " + PlyNumbers::shown(value) +
                   "; expected a whole number from 0 to " +
                   std::to_string(m_builder.points() - (m_builder.points() > 0 ? 1 : 0)));
  }

  /// Faces may come before vertices; at the end of the file all must exist.
  void checkForward() const {
    if (!m_highestPlace.empty() && m_highest >= m_builder.points())
      refuseMesh(m_builder.name(), "before " + m_highestPlace,
                 "a corner of a face is vertex " + std::to_string(m_highest) +
                     "; expected less than " + std::to_string(m_builder.points()) +
                     ", the number of vertices");
  }

  void passOver(const PlyElement& element) {
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
      for (const PlyProperty& property : element.properties) {
        if (property.isList)
          passList(property);
        else
          m_numbers.next(property.type, "a number");
      }
  }

  void passList(const PlyProperty& property) {
    const std::size_t n = m_numbers.listSize(property);
    for (std::size_t i = 0; i < n; ++i) m_numbers.next(property.type, "a number of a list");
  }

  const PlyHeader& m_header;
  PlyNumbers m_numbers;
  MeshBuilder& m_builder;
  std::uint32_t m_highest = 0;
  std::string m_highestPlace;
};

}  // namespace

MeshFile parsePly(std::string_view bytes, const std::string& name) {
  MeshBuilder builder(name);
  const PlyHeader header = parsePlyHeader(bytes, name);
  PlyBody(header, bytes, builder).parse();
  return finishStated(builder, header.frame);
}

}  // namespace lumen::convert
