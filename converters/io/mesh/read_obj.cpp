// SPDX-License-Identifier: Apache-2.0
// Declared in mesh_readers.h.
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>
#include <vector>

#include "converters/io/mesh/mesh_builder.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/io/vtk/text_cursor.h"

namespace lumen::convert {
namespace {

class ObjParser {
public:
  ObjParser(std::string_view text, const std::string& name) : m_text(text, name), m_builder(name) {}

  MeshFile parse() {
    for (std::string_view word = m_text.word(); !word.empty(); word = m_text.word()) {
      if (word == "v")
        parsePoint();
      else if (word == "f" || word == "fo")
        parseFace();
      else if (word == "g" || word == "o")
        parseName(word == "g");
      else
        passOver(word);
    }
    checkForward();
    return finishStated(m_builder, m_frame);
  }

private:
  /// The next word of the statement, which continues after a backslash at the end of a line.
  std::string_view argument() {
    std::string_view word = m_text.wordOfLine();
    while (word == "\\") {
      m_text.restOfLine();
      word = m_text.wordOfLine();
    }
    return word;
  }

  void parsePoint() {
    Eigen::Vector3d p;
    for (double& coordinate : p) coordinate = m_text.parseNumber(argument(), "a coordinate");
    m_builder.addPoint(p, [&] { return m_text.place(); });
    m_text.restOfLine();  // a weight, or a colour
  }

  void parseFace() {
    m_corners.clear();
    for (std::string_view word = argument(); !word.empty(); word = argument()) {
      if (word.front() == '#') {
        m_text.restOfLine();
        break;
      }
      m_corners.push_back(indexOf(word));
    }
    if (m_corners.size() < 3)
      m_text.refuse("a face has " + std::to_string(m_corners.size()) +
                    " corners; expected at least 3");
    m_builder.addPolygon(m_corners.data(), m_corners.size());
  }

  /// The index of a corner's point, from 0: "7", "7/2", "7//3", "-1".
  std::uint32_t indexOf(std::string_view word) {
    const std::string_view digits = word.substr(0, word.find('/'));
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    const auto points = static_cast<std::int64_t>(m_builder.points());
    if (error != std::errc{} || end != digits.data() + digits.size() || index == 0 ||
        index < -points || index > std::numeric_limits<std::uint32_t>::max())
      m_text.refuse("a corner of a face is " + quotedText(word) +
                    "; expected the number of a point, from 1 on, or from -1 back to -" +
                    std::to_string(points));
    const std::int64_t from0 = index > 0 ? index - 1 : points + index;
    if (from0 >= points && from0 > m_highest) {
      m_highest = from0;
      m_highestPlace = m_text.place();
    }
    return static_cast<std::uint32_t>(from0);
  }

  void parseName(bool isGroup) {
    const std::string name(m_text.restOfLine());
    (isGroup ? m_group : m_object) = name;
    if (!isGroup) m_group.clear();
    const bool grouped = !m_group.empty() && m_group != "default" && m_group != "off";
    m_builder.beginGroup(grouped ? m_group : m_object);
  }

  void passOver(std::string_view word) {
    const std::string_view rest = m_text.restOfLine();
    if (word.front() == '#' && m_builder.points() == 0) m_frame.look(rest);
    if ((word == "surf" || word == "curv") && !m_curved) {
      m_curved = true;
      m_builder.file.notes.emplace_back("its curved surfaces were passed over");
    }
  }

  /// A face may name a later point; at the end of the file it must exist.
  void checkForward() const {
    if (m_highest >= static_cast<std::int64_t>(m_builder.points()))
      refuseMesh(m_builder.name(), m_highestPlace,
                 "a corner of a face is point " + std::to_string(m_highest + 1) +
                     "; expected at most " + std::to_string(m_builder.points()) +
                     ", the number of points in the file");
  }

  TextCursor m_text;
  MeshBuilder m_builder;
  StatedFrame m_frame;
  std::vector<std::uint32_t> m_corners;
  std::string m_group, m_object;
  std::int64_t m_highest = -1;  // highest point that a face named before its definition
  std::string m_highestPlace;
  bool m_curved = false;
};

}  // namespace

MeshFile parseObj(std::string_view bytes, const std::string& name) {
  return ObjParser(bytes, name).parse();
}

}  // namespace lumen::convert
