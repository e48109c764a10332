// SPDX-License-Identifier: Apache-2.0
// Declared in centerline_readers.h.
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "converters/base/files.h"
#include "converters/base/length_unit.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/centerline/network.h"
#include "converters/io/vtk/xml_events.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

constexpr std::size_t kMostKeys = 1000;

// Attributes that hold a whole place, as texts such as "(1, 2.5, 3)".
bool isWholePlace(const std::string& name) {
  const std::string word = lowerCase(name);
  return word == "pos" || word == "position" || word == "xyz" || word == "coord" ||
         word == "coords" || word == "coordinates";
}

std::vector<std::string> numbersIn(const std::string& text) {
  constexpr const char* kBetween = " \t\r\n,;()[]";
  std::vector<std::string> words;
  for (std::size_t from = 0; (from = text.find_first_not_of(kBetween, from)) != text.npos;) {
    const std::size_t end = std::min(text.find_first_of(kBetween, from), text.size());
    words.push_back(text.substr(from, end - from));
    from = end;
  }
  return words;
}

class GraphmlReader : XmlEvents {
public:
  GraphmlReader(std::string_view text, const std::string& name) : XmlEvents(text, name) {
    nodes.name = edges.name = name;
    nodes.columns = {"id"};
    edges.columns = {"source", "target"};
  }

  void parse() {
    run("; expected GraphML, as igraph and networkx write it");
    if (!m_isGraph) throw invalidInput(m_name + ": has no <graph>; expected GraphML");
  }

  NetworkTable nodes, edges;
  std::string unit, space;

private:
  struct Key {
    std::string name, fallback;
    bool isOfEdges = false, isOfAll = false;
  };

  void begin(std::string_view tag, const char** attributes) override {
    if (tag == "graph") {
      if (m_isGraph) return refuse("begins a second graph; expected one, as igraph saves it");
      m_isGraph = true;
    } else if (tag == "key") {
      if (m_keys.size() == kMostKeys)
        return refuse("declares more than 1000 attributes; expected those of nodes and edges");
      m_key = std::string(attribute(attributes, "id"));
      const std::string_view owner = attribute(attributes, "for");
      const std::string_view named = attribute(attributes, "attr.name");
      m_keys[m_key] = {named.empty() ? m_key : std::string(named), "", owner == "edge",
                       owner == "all"};
    } else if (tag == "node") {
      open(nodes, {std::string(attribute(attributes, "id"))});
    } else if (tag == "edge") {
      open(edges, {std::string(attribute(attributes, "source")),
                   std::string(attribute(attributes, "target"))});
    } else if (tag == "data" || tag == "default") {
      if (tag == "data") m_key = std::string(attribute(attributes, "key"));
      m_textBegin = tagEnd();
    }
  }

  void open(NetworkTable& table, std::vector<std::string> cells) {
    m_table = &table;
    table.rows.push_back({line(), std::move(cells)});
  }

  void end(std::string_view tag) override {
    if (tag == "node" || tag == "edge") {
      fillDefaults();
      m_table = nullptr;
    }
    if (tag != "data" && tag != "default") return;
    const std::size_t until = std::max(m_textBegin, tagBegin());
    std::string text = trimmed(std::string(m_text.substr(m_textBegin, until - m_textBegin)));
    const auto key = m_keys.find(m_key);
    if (key == m_keys.end()) return;
    if (tag == "default")
      key->second.fallback = std::move(text);
    else if (m_table != nullptr)
      set(key->second.name, std::move(text));
    else
      setOfGraph(lowerCase(key->second.name), std::move(text));
  }

  void setOfGraph(const std::string& name, std::string text) {
    if (name == "unit" || name == "units" || name == "length_unit") unit = std::move(text);
    if (name == "space" || name == "axes" || name == "coordinate_system") space = std::move(text);
  }

  void fillDefaults() {
    const bool isEdge = m_table == &edges;
    for (const auto& [id, key] : m_keys) {
      if (key.fallback.empty() || !(key.isOfAll || key.isOfEdges == isEdge)) continue;
      const std::size_t at = column(key.name);
      const std::vector<std::string>& cells = m_table->rows.back().cells;
      if (at >= cells.size() || cells[at].empty()) set(key.name, key.fallback);
    }
  }

  void set(const std::string& name, std::string text) {
    if (isWholePlace(name)) {
      const std::vector<std::string> numbers = numbersIn(text);
      if (numbers.size() != 3) return;
      for (std::size_t a = 0; a < 3; ++a) set(std::string(1, "xyz"[a]), numbers[a]);
      return;
    }
    const std::size_t at = column(name);
    std::vector<std::string>& cells = m_table->rows.back().cells;
    if (cells.size() <= at) cells.resize(at + 1);
    cells[at] = std::move(text);
  }

  // networkx declares an attribute once for each type that its values have.
  std::size_t column(const std::string& name) {
    std::vector<std::string>& columns = m_table->columns;
    const std::size_t first = m_table == &edges ? 2 : 1;  // those of the elements themselves
    for (std::size_t c = first; c < columns.size(); ++c)
      if (columns[c] == name) return c;
    columns.push_back(name);
    return columns.size() - 1;
  }

  std::map<std::string, Key> m_keys;
  std::string m_key;
  NetworkTable* m_table = nullptr;  // of the open node or edge
  std::size_t m_textBegin = 0;      // where the text of the open element begins
  bool m_isGraph = false;
};

}  // namespace

CenterlineFile parseGraphml(std::string_view text, const std::string& name) {
  const std::string shown = formats::printable(name);
  GraphmlReader reader(text, shown);
  reader.parse();
  CenterlineFile file = treeOfTables(reader.nodes, reader.edges);
  if (const auto unit = millimetresPer(reader.unit)) file.unit = *unit;
  const StatedAxes axes = axesIn(reader.space);
  if (axes == StatedAxes::Ras) file.axes = CenterlineAxes::Ras;
  if (axes == StatedAxes::Lps) file.axes = CenterlineAxes::Lps;
  return file;
}

CenterlineFile readGraphml(const InputFile& file) {
  return parseGraphml(file.read("centerline", kMostText), file.path().string());
}

}  // namespace lumen::convert
