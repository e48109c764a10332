// SPDX-License-Identifier: Apache-2.0
// Declared in centerline_readers.h.
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/shown_text.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/centerline/network.h"
#include "converters/io/centerline/tree_of_lines.h"
#include "converters/io/vtk/text_cursor.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

constexpr double kLargestVmv = 1e9;  // far beyond any plausible length
constexpr std::uint64_t kLargestVertexId = 2147483647;

class VmvParser {
public:
  VmvParser(std::string_view text, const std::string& name) : m_cursor(text, name) {
    lines.isDirected = false;
  }

  void parse() {
    bool hasVertices = false, hasStrands = false;
    for (std::string_view word; !(word = nextWord()).empty();) {
      if (word == "$VERT_LIST_BEGIN") {
        hasVertices = true;
        readVertices();
      } else if (word == "$STRANDS_LIST_BEGIN") {
        if (!hasVertices)
          m_cursor.refuse("begins strands before $VERT_LIST_BEGIN; expected vertices first");
        hasStrands = true;
        readStrands();
      }
    }
    if (!hasVertices || !hasStrands)
      m_cursor.refuse(std::string("ends without ") +
                      (hasVertices ? "$STRANDS_LIST_BEGIN" : "$VERT_LIST_BEGIN") +
                      "; expected vertices and strands, as VessMorphoVis reads them");
  }

  LineSet lines;

private:
  // The next word; lines with a # are comments.
  std::string_view nextWord() {
    std::string_view word = m_cursor.word();
    while (word.starts_with('#')) {
      m_cursor.restOfLine();
      word = m_cursor.word();
    }
    return word;
  }

  double number(std::string_view word, const char* what) {
    const double value = m_cursor.parseNumber(word, what);
    if (!(std::abs(value) <= kLargestVmv))
      m_cursor.refuse(std::string(what) + " is " + quotedText(std::string(word)) +
                      "; expected -1e9 to 1e9");
    return value;
  }

  // Rows of an id, a place, a radius, and maybe values of simulations.
  void readVertices() {
    for (std::string_view word; (word = nextWord()) != "$VERT_LIST_END"; m_cursor.restOfLine()) {
      if (word.empty()) m_cursor.refuse("ends within the vertices; expected $VERT_LIST_END");
      const std::uint64_t id = m_cursor.parseWhole(word, "the id of a vertex", kLargestVertexId);
      CenterlinePoint point;
      for (int a = 0; a < 3; ++a)
        point.position[a] = number(m_cursor.wordOfLine(), "a coordinate of a vertex");
      point.radius = std::max(0.0, number(m_cursor.wordOfLine(), "the radius of a vertex"));
      if (!m_byId.emplace(id, static_cast<std::int32_t>(lines.points.size())).second)
        m_cursor.refuse("has the id " + std::to_string(id) +
                        " again; expected one vertex of each id");
      lines.points.push_back(point);
    }
  }

  // Rows of an id and the ids of vertices.
  void readStrands() {
    for (std::string_view word; (word = nextWord()) != "$STRANDS_LIST_END";) {
      if (word.empty()) m_cursor.refuse("ends within the strands; expected $STRANDS_LIST_END");
      m_cursor.parseWhole(word, "the id of a strand", kLargestVertexId);
      std::vector<std::int32_t> line;
      while (!(word = m_cursor.wordOfLine()).empty()) {
        const std::uint64_t id =
            m_cursor.parseWhole(word, "a vertex of a strand", kLargestVertexId);
        const auto vertex = m_byId.find(id);
        if (vertex == m_byId.end())
          m_cursor.refuse("has the vertex " + std::to_string(id) +
                          " in a strand, which $VERT_LIST_BEGIN does not list");
        line.push_back(vertex->second);
      }
      if (!line.empty()) lines.lines.push_back(std::move(line));
    }
  }

  TextCursor m_cursor;
  std::map<std::uint64_t, std::int32_t> m_byId;
};

}  // namespace

CenterlineFile parseVmv(std::string_view text, const std::string& name) {
  const std::string shown = formats::printable(name);
  VmvParser parser(text, shown);
  parser.parse();
  CenterlineFile file = treeOfGraph(parser.lines, shown);
  if (file.points.empty())
    throw invalidInput(shown +
                       ": has no strand with a length; expected strands of at least two "
                       "vertices");
  takeOwnFrame(text, file);
  fillRadii(file, shown, "the fifth number of a vertex");
  return file;
}

CenterlineFile readVmv(const InputFile& file) {
  return parseVmv(file.read("centerline", kMostText), file.path().string());
}

}  // namespace lumen::convert
