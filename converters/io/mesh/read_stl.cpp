// SPDX-License-Identifier: Apache-2.0
// Declared in mesh_readers.h.
#include <algorithm>
#include <cstdint>
#include <string>

#include "converters/base/text.h"
#include "converters/io/mesh/mesh_builder.h"
#include "converters/io/mesh/read_mesh.h"
#include "converters/io/vtk/text_cursor.h"

namespace lumen::convert {
namespace {

constexpr std::string_view kSolid = "solid";
constexpr std::size_t kHeader = 80, kBeforeFacets = 84, kFacet = 50, kNormal = 12;

/// True for "solid" in letters of any case. Binary headers in capitals have zeros within 84 bytes.
bool startsAsText(std::string_view bytes) {
  std::string_view text = withoutByteOrderMark(bytes);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  const std::string_view word = text.substr(0, kSolid.size());
  if (lowerCase(std::string(word)) != kSolid) return false;
  return word == kSolid || bytes.substr(0, kBeforeFacets).find('\0') == bytes.npos;
}

std::uint64_t countOf(std::string_view bytes) {
  return loadNumber<std::uint32_t>(bytes.data() + kHeader, Endian::Little);
}

bool isBinary(std::string_view bytes) {
  if (bytes.size() >= kBeforeFacets && bytes.size() == kBeforeFacets + kFacet * countOf(bytes))
    return true;
  return !startsAsText(bytes);
}

MeshFile parseBinary(std::string_view bytes, MeshBuilder& builder) {
  if (bytes.size() < kBeforeFacets)
    refuseMesh(builder.name(), "",
               "has " + std::to_string(bytes.size()) +
                   " bytes; expected STL, which has at least 84, or begins with \"solid\"");
  const std::uint64_t count = countOf(bytes);
  const std::uint64_t room = (bytes.size() - kBeforeFacets) / kFacet;
  if (count > room)
    refuseMesh(builder.name(), "byte 80",
               "the count is " + std::to_string(count) + " triangles; expected at most " +
                   std::to_string(room) + ", for which there are bytes");
  const std::size_t used = kBeforeFacets + kFacet * static_cast<std::size_t>(count);
  if (used < bytes.size())
    builder.file.notes.push_back(std::to_string(bytes.size() - used) +
                                 " bytes behind the last triangle were passed over");
  builder.file.mesh.triangle.reserve(static_cast<std::size_t>(count));
  for (std::size_t at = kBeforeFacets; at < used; at += kFacet) {
    Triangle t{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t corner = at + kNormal * (c + 1);
      Eigen::Vector3d p;
      for (std::size_t a = 0; a < 3; ++a)
        p[static_cast<Eigen::Index>(a)] =
            static_cast<double>(loadNumber<float>(bytes.data() + corner + 4 * a, Endian::Little));
      t[c] = builder.addShared(p, [&] { return "byte " + std::to_string(corner); });
    }
    builder.addTriangle(t);
  }
  StatedFrame frame;
  frame.look(bytes.substr(0, kHeader));
  return finishStated(builder, frame);
}

class AsciiStl {
public:
  AsciiStl(std::string_view text, MeshBuilder& builder)
      : m_text(text, builder.name()), m_builder(builder) {}

  MeshFile parse() {
    for (std::string word = next(); !word.empty(); word = next()) {
      if (word != "solid") m_text.refuse("found " + quotedText(word) + "; expected \"solid\"");
      const std::string_view name = m_text.restOfLine();
      m_frame.look(name);
      m_builder.beginGroup(name);
      parseFacets();
    }
    return finishStated(m_builder, m_frame);
  }

private:
  std::string next() { return lowerCase(std::string(m_text.word())); }
  void expect(const char* expected) {
    const std::string word = next();
    if (word != expected)
      m_text.refuse((word.empty() ? std::string("the file ends") : "found " + quotedText(word)) +
                    "; expected \"" + expected + "\"");
  }
  void parseFacets() {
    for (;;) {
      const std::string word = next();
      if (word == "endsolid") break;
      if (word != "facet")
        m_text.refuse((word.empty() ? std::string("the file ends") : "found " + quotedText(word)) +
                      "; expected \"facet\" or \"endsolid\"");
      parseFacet();
    }
    m_text.restOfLine();  // the name again
  }
  void parseFacet() {
    m_text.restOfLine();  // the normal, which may be no number
    expect("outer");
    expect("loop");
    Triangle t{};
    for (std::uint32_t& corner : t) {
      expect("vertex");
      Eigen::Vector3d p;
      for (double& coordinate : p) coordinate = m_text.number("a coordinate");
      corner = m_builder.addShared(p, [&] { return m_text.place(); });
    }
    expect("endloop");
    expect("endfacet");
    m_builder.addTriangle(t);
  }

  TextCursor m_text;
  MeshBuilder& m_builder;
  StatedFrame m_frame;
};

}  // namespace

MeshFile parseStl(std::string_view bytes, const std::string& name) {
  MeshBuilder builder(name);
  return isBinary(bytes) ? parseBinary(bytes, builder) : AsciiStl(bytes, builder).parse();
}

}  // namespace lumen::convert
