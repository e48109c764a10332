// SPDX-License-Identifier: Apache-2.0
// Declared in centerline_readers.h.
#include <algorithm>
#include <array>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "converters/base/csv_rows.h"
#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/text.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/centerline/folder_files.h"
#include "converters/io/centerline/network.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

// Words by which the names of a network's two files differ.
constexpr const char* kEdges = "edge";
constexpr std::array<const char*, 3> kNodes = {"node", "vertices", "vertex"};
constexpr const char* kExpected =
    "expected two tables of one network beside each other, such as a_nodes.csv and a_edges.csv, as "
    "Voreen saves them and VesselVio reads them";

// The separator that the first line has most of.
char separatorOf(std::string_view text) {
  const std::string_view head = text.substr(0, std::min(text.find_first_of("\r\n"), text.size()));
  char best = ',';
  for (const char c : {',', ';', '\t'})
    if (std::count(head.begin(), head.end(), c) > std::count(head.begin(), head.end(), best))
      best = c;
  return best;
}

NetworkTable tableOf(const InputFile& file) {
  NetworkTable table;
  table.name = formats::printable(file.path().string());
  const std::string text = file.read("centerline", kMostText);
  const std::string_view marked = withoutByteOrderMark(text);
  std::vector<CsvRow> rows = csvRows(std::string(marked), table.name, separatorOf(marked));
  if (rows.empty()) throw invalidInput(table.name + ": is empty; " + kExpected);
  table.columns = std::move(rows[0].cells);
  for (std::size_t r = 1; r < rows.size(); ++r)
    table.rows.push_back({rows[r].line, std::move(rows[r].cells)});
  return table;
}

bool hasWord(const fs::path& file, const std::string& word) {
  return lowerCase(file.filename().string()).find(word) != std::string::npos;
}

bool namesNodes(const fs::path& file) {
  return std::any_of(kNodes.begin(), kNodes.end(),
                     [&](const char* word) { return hasWord(file, word); });
}

// The name without the words that stand for nodes or edges.
std::string stemOf(const fs::path& file) {
  std::string name = lowerCase(file.filename().string());
  for (const char* word : {"nodes", "node", "vertices", "vertex", "edges", "edge"})
    if (const std::size_t at = name.find(word); at != name.npos) {
      name.replace(at, std::string_view(word).size(), "*");
      break;
    }
  return name;
}

std::vector<InputFile> tablesIn(const InputFile& folder) {
  if (folder.files() != nullptr) return *folder.files();
  std::error_code ignored;
  return filesEndingIn(folder.path(), {".csv", ".tsv"}, ignored);
}

// The tables of the network that `named` belongs to: a file, or a folder.
struct TablePair {
  std::optional<InputFile> nodes, edges;
};

TablePair pairOf(const InputFile& named) {
  TablePair pair;
  const bool isFolder = named.isFolder();
  const fs::path parent = named.path().parent_path();
  std::vector<InputFile> files;
  if (isFolder)
    files = tablesIn(named);
  else if (!named.isInMemory())
    files = tablesIn(parent.empty() ? fs::path(".") : parent);
  const std::string stem = stemOf(named.path());
  for (const InputFile& file : files) {
    if (!isFolder && stemOf(file.path()) != stem) continue;
    const bool isEdges = hasWord(file.path(), kEdges);
    if (!isEdges && !namesNodes(file.path())) continue;
    std::optional<InputFile>& place = isEdges ? pair.edges : pair.nodes;
    if (place)
      throw invalidInput(formats::printable(named.path().string()) +
                         ": several tables may be those of the " + (isEdges ? "edges" : "nodes") +
                         ", such as " + formats::printable(place->path().filename().string()) +
                         " and " + formats::printable(file.path().filename().string()) +
                         "; expected one network in a folder, or the name of one of its tables");
    place = file;
  }
  return pair;
}

// The nodes of skan's table of branches, which has the place of both ends of each: its axes are those of an
// array, z, y and x.
std::optional<NetworkTable> nodesOfBranches(const NetworkTable& edges) {
  std::array<std::array<std::size_t, 4>, 2> columns{};  // id, and places 0 to 2, of both ends
  for (std::size_t end = 0; end < 2; ++end) {
    const std::string at = end == 0 ? "_src" : "_dst";
    const std::array<std::string, 4> names = {"node_id" + at, "coord" + at + "_0",
                                              "coord" + at + "_1", "coord" + at + "_2"};
    for (std::size_t n = 0; n < names.size(); ++n) {
      const auto found =
          std::find_if(edges.columns.begin(), edges.columns.end(), [&](std::string column) {
            std::replace(column.begin(), column.end(), '-', '_');
            return lowerCase(column) == names[n];
          });
      if (found == edges.columns.end()) return {};
      columns[end][n] = static_cast<std::size_t>(found - edges.columns.begin());
    }
  }
  NetworkTable nodes{edges.name, {"id", "z", "y", "x"}, {}};
  for (const NetworkRow& row : edges.rows)
    for (const auto& end : columns) {
      NetworkRow node{row.line, {}};
      for (const std::size_t c : end)
        node.cells.push_back(c < row.cells.size() ? row.cells[c] : std::string());
      nodes.rows.push_back(std::move(node));
    }
  const auto byId = [](const NetworkRow& a, const NetworkRow& b) {
    return a.cells[0] < b.cells[0];
  };
  std::stable_sort(nodes.rows.begin(), nodes.rows.end(), byId);
  nodes.rows.erase(std::unique(nodes.rows.begin(), nodes.rows.end(),
                               [](const NetworkRow& a, const NetworkRow& b) {
                                 return a.cells[0] == b.cells[0];
                               }),
                   nodes.rows.end());
  return nodes;
}

}  // namespace

bool hasGraphTables(const fs::path& folder) {
  bool hasNodes = false, hasEdges = false;
  for (const InputFile& file : tablesIn(folder)) {
    hasEdges = hasEdges || hasWord(file.path(), kEdges);
    hasNodes = hasNodes || namesNodes(file.path());
  }
  return hasNodes && hasEdges;
}

CenterlineFile readGraphCsv(const InputFile& fileOrFolder) {
  const std::string name = formats::printable(fileOrFolder.path().string());
  std::optional<NetworkTable> named;
  if (!fileOrFolder.isFolder()) {
    named = tableOf(fileOrFolder);
    if (const auto nodes = nodesOfBranches(*named)) {
      CenterlineFile file = treeOfTables(*nodes, *named);
      file.remarks.emplace_back(
          "places 0, 1 and 2 of its nodes are taken as z, y and x, as skan writes those of "
          "volumes");
      return file;
    }
    if (!named->hasPlaces() && !named->hasEnds())
      throw invalidInput(name + ": is no table of nodes (x, y, z) or edges (source, target); " +
                         kExpected);
  }
  const TablePair pair = pairOf(fileOrFolder);
  const bool isEdges = named && named->hasEnds();
  const bool hasNodes = pair.nodes || (named && !isEdges), hasEdges = pair.edges || isEdges;
  if (!hasNodes || !hasEdges)
    throw invalidInput(name + ": has the " + (hasNodes ? "nodes" : "edges") +
                       " of a network, but its " + (hasNodes ? "edges" : "nodes") +
                       " are not beside it; " + kExpected);
  return treeOfTables(named && !isEdges ? *named : tableOf(*pair.nodes),
                      isEdges ? *named : tableOf(*pair.edges));
}

}  // namespace lumen::convert
