// SPDX-License-Identifier: Apache-2.0
// Networks in tables; declared in network.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/length_unit.h"
#include "converters/base/number_text.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/centerline/network.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

constexpr double kLargestPlace = 1e9;  // far beyond any plausible length
constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();

using Names = std::vector<std::string_view>;

// Names of columns in lower case, with _ for blanks and hyphens; the first that is there counts. They
// are those of Voreen, VesselVio, skan, igraph, networkx and of scripts around these.
const std::array<Names, 3> kPlaces = {{{"x", "pos_x", "x_pos", "coord_x", "x_coord", "posx"},
                                       {"y", "pos_y", "y_pos", "coord_y", "y_coord", "posy"},
                                       {"z", "pos_z", "z_pos", "coord_z", "z_coord", "posz"}}};
const Names kIds = {"id", "node_id", "nodeid"};
const Names kFrom = {"source", "node1id", "node_id_src", "from", "start", "node1", "src"};
const Names kTo = {"target", "node2id", "node_id_dst", "to", "end", "node2", "dst"};
const Names kRadii = {"radius",    "r",           "radius_avg",   "avgradiusavg",
                      "v_radius",  "radii",       "avg_radius",   "mean_radius",
                      "avgradius", "radius_mean", "vertex_radius"};
const Names kDiameters = {"diameter", "d", "diameter_avg", "avg_diameter", "mean_diameter"};
const Names kChords = {"distance", "euclidean_distance"};
const Names kLengths = {"length", "branch_distance"};
const Names kTortuosities = {"tortuosity", "curveness"};

struct ColumnName {
  std::string name;
  double unit = 0;  // mm; 0: not stated
};

// "Radius (um)", "pos-x [mm]".
ColumnName columnName(const std::string& text) {
  ColumnName column{lowerCase(trimmed(text)), 0};
  const std::size_t open = column.name.find_first_of("([");
  if (open != column.name.npos && open > 0) {
    const std::size_t close = std::min(column.name.find_first_of(")]", open), column.name.size());
    column.unit = millimetresPer(column.name.substr(open + 1, close - open - 1)).value_or(0);
    column.name = trimmed(column.name.substr(0, open));
  }
  std::replace_if(
      column.name.begin(), column.name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  return column;
}

struct FoundColumn {
  std::size_t at = kAbsent;
  double unit = 0;
  [[nodiscard]] bool isThere() const { return at != kAbsent; }
};

FoundColumn findColumn(const NetworkTable& table, const Names& names) {
  for (const std::string_view name : names)
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      if (const ColumnName column = columnName(table.columns[c]); column.name == name)
        return {c, column.unit};
  return {};
}

std::array<FoundColumn, 3> placesOf(const NetworkTable& table) {
  return {findColumn(table, kPlaces[0]), findColumn(table, kPlaces[1]),
          findColumn(table, kPlaces[2])};
}

[[noreturn]] void refuseRow(const NetworkTable& table, const NetworkRow& row,
                            const std::string& what) {
  throw invalidInput(table.name + ": line " + std::to_string(row.line) + ": " + what);
}

// The name of a column in a message.
std::string shownName(const NetworkTable& table, FoundColumn column) {
  constexpr std::size_t kShown = 40;
  const std::string& name = table.columns[column.at];
  return name.size() > kShown ? quotedText(name) : formats::printable(name);
}

std::string cellOf(const NetworkRow& row, FoundColumn column) {
  return column.at < row.cells.size() ? trimmed(row.cells[column.at]) : std::string();
}

// NaN for an empty cell.
double numberIn(const NetworkTable& table, const NetworkRow& row, FoundColumn column) {
  const std::string text = cellOf(row, column);
  if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto value = parsedNumber(text);
  if (!value || std::abs(*value) > kLargestPlace)
    refuseRow(table, row,
              shownName(table, column) + " is " + quotedText(text) +
                  "; expected a number from -1e9 to 1e9");
  return *value;
}

// Equal numbers are one id: 7, 7.0.
std::string idOf(const std::string& text) {
  const auto value = parsedNumber(text);
  return value ? exactText(*value) : text;
}

// Radii of rows, in the unit of places; 0 where there is none.
class Radii {
public:
  Radii(const NetworkTable& table, double placeUnit)
      : m_table(table), m_column(findColumn(table, kRadii)) {
    if (!m_column.isThere()) {
      m_column = findColumn(table, kDiameters);
      m_factor = 0.5;
    }
    if (m_column.unit > 0 && placeUnit > 0) m_factor *= m_column.unit / placeUnit;
  }
  [[nodiscard]] bool areThere() const { return m_column.isThere(); }
  [[nodiscard]] double unit() const { return m_column.unit; }
  [[nodiscard]] double of(const NetworkRow& row) const {
    if (!m_column.isThere()) return 0;
    const double value = m_factor * numberIn(m_table, row, m_column);
    return value > 0 ? value : 0;
  }

private:
  const NetworkTable& m_table;
  FoundColumn m_column;
  double m_factor = 1;
};

std::string columnsText(const NetworkTable& table) {
  constexpr std::size_t kShown = 20;
  std::string text;
  for (std::size_t c = 0; c < std::min(kShown, table.columns.size()); ++c)
    text += (c == 0 ? "" : ", ") + table.columns[c];
  return quotedText(text);
}

// The place of each node by its id.
class Nodes {
public:
  Nodes(const NetworkTable& table, Network& network) : m_table(table) {
    const std::array<FoundColumn, 3> places = placesOf(table);
    if (!table.hasPlaces())
      throw invalidInput(table.name + ": has the columns " + columnsText(table) +
                         "; expected x, y and z (or pos_x, pos_y and pos_z) of nodes");
    m_unit = places[0].unit;
    const Radii radii(table, m_unit);
    m_hasRadii = radii.areThere();
    const FoundColumn ids = findColumn(table, kIds);
    for (const NetworkRow& row : table.rows) {
      CurvePoint node{{0, 0, 0}, radii.of(row)};
      for (std::size_t a = 0; a < 3; ++a) {
        const double place = numberIn(table, row, places[a]);
        if (std::isnan(place))
          refuseRow(table, row, "has no " + shownName(table, places[a]) + "; expected a number");
        node.position[static_cast<Eigen::Index>(a)] = place;
      }
      const auto index = static_cast<std::int32_t>(network.nodes.size());
      const std::string id = ids.isThere() ? idOf(cellOf(row, ids)) : idOf(std::to_string(index));
      if (!m_byId.emplace(id, index).second)
        refuseRow(table, row,
                  "the id " + quotedText(id) +
                      " is that of another node, too; expected one node of each id");
      network.nodes.push_back(node);
    }
  }

  [[nodiscard]] std::int32_t at(const NetworkTable& edges, const NetworkRow& row,
                                FoundColumn column) const {
    const std::string id = cellOf(row, column);
    const auto found = m_byId.find(idOf(id));
    if (found == m_byId.end())
      refuseRow(edges, row,
                shownName(edges, column) + " is " + quotedText(id) +
                    "; expected the id of a node of " + m_table.name);
    return found->second;
  }
  [[nodiscard]] double unit() const { return m_unit; }
  [[nodiscard]] bool haveRadii() const { return m_hasRadii; }

private:
  const NetworkTable& m_table;
  double m_unit = 0;
  bool m_hasRadii = false;
  std::map<std::string, std::int32_t> m_byId;
};

// The distance of an edge's nodes, as its own distance or its length and tortuosity state it, and what
// all edges are longer than that.
class Chords {
public:
  explicit Chords(const NetworkTable& edges)
      : m_edges(edges),
        m_chord(findColumn(edges, kChords)),
        m_length(findColumn(edges, kLengths)),
        m_tortuosity(findColumn(edges, kTortuosities)) {}
  double of(const NetworkRow& row) {
    const double length = m_length.isThere() ? numberIn(m_edges, row, m_length) : 0;
    double chord = 0;
    if (m_chord.isThere())
      chord = numberIn(m_edges, row, m_chord);
    else if (m_length.isThere() && m_tortuosity.isThere())
      chord = length / numberIn(m_edges, row, m_tortuosity);
    if (!(chord > 0) || !std::isfinite(chord)) return 0;
    if (length >= chord) {
      m_lengths += length;
      m_chords += chord;
    }
    return chord;
  }
  // A sentence on the part of lengths that straight edges lack; empty for less than a hundredth.
  [[nodiscard]] std::string lossRemark() const {
    if (!(m_lengths > 1.01 * m_chords)) return {};
    return "its edges have no courses, so they are straight, with " +
           shownNumber(100 * m_chords / m_lengths, 3) + " % of their stated length";
  }

private:
  const NetworkTable& m_edges;
  FoundColumn m_chord, m_length, m_tortuosity;
  double m_lengths = 0, m_chords = 0;
};

}  // namespace

bool NetworkTable::hasPlaces() const {
  const std::array<FoundColumn, 3> places = placesOf(*this);
  return std::all_of(places.begin(), places.end(), [](FoundColumn c) { return c.isThere(); });
}

bool NetworkTable::hasEnds() const {
  return findColumn(*this, kFrom).isThere() && findColumn(*this, kTo).isThere();
}

CenterlineFile treeOfTables(const NetworkTable& nodes, const NetworkTable& edges) {
  Network network;
  const Nodes byId(nodes, network);
  if (!edges.hasEnds())
    throw invalidInput(edges.name + ": has the columns " + columnsText(edges) +
                       "; expected source and target (or node1id and node2id) of edges");
  const FoundColumn from = findColumn(edges, kFrom), to = findColumn(edges, kTo);
  const Radii radii(edges, byId.unit());
  Chords chords(edges);
  for (const NetworkRow& row : edges.rows)
    network.edges.push_back({byId.at(edges, row, from),
                             byId.at(edges, row, to),
                             byId.haveRadii() ? 0 : radii.of(row),
                             chords.of(row),
                             {}});
  CenterlineFile file = treeOfNetwork(std::move(network), edges.name);
  file.unit = byId.unit();
  if (std::string loss = chords.lossRemark(); !loss.empty())
    file.remarks.push_back(std::move(loss));
  if (byId.haveRadii() || radii.areThere())
    fillRadii(file, edges.name, "a positive radius of some node or edge");
  else
    file.remarks.push_back("has no radii: nodes have " + columnsText(nodes) + ", edges " +
                           columnsText(edges) +
                           "; expected a column radius or diameter of nodes or edges");
  return file;
}

}  // namespace lumen::convert
