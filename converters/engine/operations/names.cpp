// SPDX-License-Identifier: Apache-2.0
// lumen names: the names of a case's branches, as a list or a table, and other ones.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/csv_rows.h"
#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/judge/measure/shown_radius.h"
#include "converters/judge/measure/vessel_length.h"
#include "converters/operations/anatomical_names.h"
#include "converters/operations/renamed.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

using formats::CenterlineTree;
using operations::NewName;

constexpr std::uint64_t kMostTable = std::uint64_t{16} << 20;  // bytes

/// Facts by which a person knows a branch.
struct NameRow {
  std::string label, from;
  double length = 0, radius = 0;  ///< mm; the radius is that of its middle node
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
};

std::vector<NameRow> nameRows(const CenterlineTree& tree) {
  const std::vector<double> lengths = convert::vesselLengths(tree).branch;
  std::vector<NameRow> rows;
  for (const formats::Branch& branch : tree.branches) {
    NameRow& row = rows.emplace_back();
    row.label = branch.label;
    if (branch.parentNode != formats::kNoParent)
      row.from = tree.branches[tree.branch[static_cast<std::size_t>(branch.parentNode)]].label;
    row.length = lengths[rows.size() - 1];
    if (branch.nodeCount == 0) continue;
    const std::uint32_t node = branch.firstNode + branch.nodeCount / 2;
    row.radius = double{tree.radius[node]};
    row.middle = toEigen(tree.centre[node]);
  }
  return rows;
}

std::string nameTable(const std::vector<NameRow>& rows) {
  std::string table = "name,new_name,from,length_mm,radius_mm,x_mm,y_mm,z_mm\n";
  for (const NameRow& row : rows)
    table += convert::csvCell(row.label) + ",," + convert::csvCell(row.from) + "," +
             fixedText(row.length, 1) + "," + fixedText(row.radius, 2) + "," +
             fixedText(row.middle.x(), 1) + "," + fixedText(row.middle.y(), 1) + "," +
             fixedText(row.middle.z(), 1) + "\n";
  return table;
}

Json nameRowsJson(const std::vector<NameRow>& rows) {
  Json list = Json::array();
  for (const NameRow& row : rows)
    list.push_back({{"name", row.label},
                    {"from", row.from.empty() ? Json(nullptr) : Json(row.from)},
                    {"length_mm", jsonNumber(row.length)},
                    {"radius_mm", jsonNumber(row.radius)},
                    {"middle", vectorJson(row.middle)}});
  return list;
}

/// `least`: of the radii that the volume shows.
std::string nameText(const std::vector<NameRow>& rows, std::optional<double> least) {
  std::vector<std::vector<std::string>> table{{"name", "from", "length", "radius", "x", "y", "z"}};
  for (const NameRow& row : rows)
    table.push_back(
        {formats::printable(row.label), row.from.empty() ? "-" : formats::printable(row.from),
         fixedText(row.length, 1), convert::shownRadius(row.radius, least, 2),
         fixedText(row.middle.x(), 1), fixedText(row.middle.y(), 1), fixedText(row.middle.z(), 1)});
  return alignColumns(std::move(table)) +
         "Lengths, and radii and places of the middle, in mm, LPS.\n";
}

std::string anatomyText(const std::vector<convert::ArteryStretch>& stretches,
                        const CenterlineTree& tree) {
  if (stretches.empty())
    return "No artery of the circle of Willis and none of the aortic arch is recognised: the first "
           "needs "
           "two carotid arteries side by side as inlets and the first segment of an anterior "
           "cerebral "
           "artery, the second a wide vessel that rises, turns over backwards and to the left, and "
           "descends, with two or more vessels that rise from it.\n";
  std::vector<std::vector<std::string>> table{
      {"name", "probability", "branch", "nodes", "x", "y", "z", "to x", "y", "z"}};
  for (const convert::ArteryStretch& stretch : stretches) {
    std::vector<std::string>& row = table.emplace_back();
    row = {stretch.name, fixedText(stretch.plausibility, 2),
           formats::printable(tree.branches[stretch.branch].label),
           std::to_string(stretch.end - stretch.first)};
    for (const std::uint32_t node : {stretch.first, stretch.end - 1})
      for (const double at : toEigen(tree.centre[node])) row.push_back(fixedText(at, 1));
  }
  return alignColumns(std::move(table)) + "Places of the first and last node in mm, LPS.\n";
}

Json anatomyJson(const std::vector<convert::ArteryStretch>& stretches, const CenterlineTree& tree) {
  Json list = Json::array();
  for (const convert::ArteryStretch& stretch : stretches)
    list.push_back({{"name", stretch.name},
                    {"probability", jsonNumber(stretch.plausibility)},
                    {"branch", tree.branches[stretch.branch].label},
                    {"nodes", stretch.end - stretch.first},
                    {"from", vectorJson(toEigen(tree.centre[stretch.first]))},
                    {"to", vectorJson(toEigen(tree.centre[stretch.end - 1]))}});
  return list;
}

/// The rows of a table whose new name is not empty and another one.
std::vector<NewName> namesOfTable(const InputFile& file) {
  const std::string name = formats::printable(file.name());
  const auto rows = convert::csvRows(file.read("table of names", kMostTable), name);
  if (rows.empty()) throw invalidInput(name + ": is empty; expected a row of names first");
  const auto columnOf = [&](const char* title) {
    const auto& titles = rows.front().cells;
    const auto found = std::find(titles.begin(), titles.end(), title);
    if (found == titles.end())
      throw invalidInput(name + ": line 1: found no column " + title +
                         ", expected name and new_name, as --table writes them");
    return static_cast<std::size_t>(found - titles.begin());
  };
  const std::size_t label = columnOf("name"), becomes = columnOf("new_name");
  std::vector<NewName> names;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const std::vector<std::string>& cells = rows[i].cells;
    if (cells.size() <= label || cells.size() <= becomes || cells[becomes].empty()) continue;
    if (cells[label] != cells[becomes]) names.push_back({cells[label], cells[becomes]});
  }
  return names;
}

class NamesCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "names"; }
  [[nodiscard]] std::string summary() const override {
    return "List the names of a case's vessels, and give them others";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen names head.lumen --table names.csv            # fill in its column new_name\n"
           "  lumen names head.lumen --names names.csv --out named.lumen\n"
           "  lumen names head.lumen --rename A.1=ICA_L --out head.lumen\n"
           "  lumen names head.lumen --anatomy --out named.lumen   # the circle of Willis, the "
           "aortic arch";
  }

  void addRows(OptionTable& table) override {
    table.argument("CASE", &m_input, "Case");
    table.file("table", m_table,
               "Also write the names as comma-separated values, with an empty column new_name");
    table.file("names", m_names,
               "Table with the columns name and new_name; an empty new name keeps the old one");
    table
        .add("rename", &m_renames, "NAME=NEW", "Name of a vessel, and its new one; may be repeated")
        .many()
        .checkedBy(pairText("NAME=NEW, such as A.1=ICA_L"));
    table
        .flag("anatomy", m_isAnatomy,
              "List the arteries of the circle of Willis and of the aortic arch that geometry "
              "shows, with a probability of "
              "0.7 or more; with --out, cut branches where they begin and end, and name them so")
        .without("names")
        .without("rename");
    table.file(
        "out", m_output,
        "Case to write with the new names, " + formatEndings(canWriteCase) + "; may be CASE");
    for (const char* const option : {"names", "rename"}) table.find(option)->onlyWith("out");
    addFormatRow(table, "to", m_to, "--out");
    table.find("to")->onlyWith("out");
  }

  Answer run(const RunContext& context) override {
    requireInput(m_input, "case file");
    requireInScope(*context.table, {}, context.progress);
    const FileFormat* to = nullptr;
    if (!m_output.empty()) {
      requireOrder(m_input, m_output);
      to = &caseOutputFormat(m_output, m_to, "the case with other names");
      if (m_names.empty() && m_renames.empty() && !m_isAnatomy)
        throw Error(
            ErrorKind::Usage,
            m_output.name() + ": nothing to write; expected --rename, --names or --anatomy");
      requireWritable(m_output, convert::ContentKind::Case);
    }
    if (!m_table.empty()) requireWritable(m_table, convert::ContentKind::Other);
    const std::vector<NewName> names = newNames();
    formats::Case value = to == nullptr ? readCase(m_input) : readParentCase(m_input);
    std::vector<convert::ArteryStretch> arteries;
    if (m_isAnatomy) arteries = operations::anatomicalNames(value, m_input.name());
    // as the branches of the input are called
    const Json anatomy = anatomyJson(arteries, value.tree);
    const std::string anatomyRows = m_isAnatomy ? anatomyText(arteries, value.tree) : "";
    std::size_t renamed = names.size();
    if (to != nullptr) {
      if (m_isAnatomy) {
        auto named = operations::anatomicallyNamed(std::move(value), arteries);
        value = std::move(named.value);
        renamed = named.renamed;
      } else {
        value = operations::renamed(std::move(value), names, m_input.name());
      }
      to->writeCase(value, m_output, {}, context.progress);
    }
    const std::vector<NameRow> rows = nameRows(value.tree);
    if (!m_table.empty()) writeText(nameTable(rows), m_table);
    return {Json{{"renamed", renamed}, {"names", nameRowsJson(rows)}, {"anatomy", anatomy}},
            m_isAnatomy ? anatomyRows : nameText(rows, convert::leastShownRadius(value.metadata)),
            0, to == nullptr && m_table.empty()};
  }

private:
  [[nodiscard]] std::vector<NewName> newNames() const {
    std::vector<NewName> names;
    if (!m_names.empty()) names = namesOfTable(m_names);
    for (const std::string& text : m_renames) {
      const std::size_t at = text.find('=');
      names.push_back({text.substr(0, at), text.substr(at + 1)});
    }
    return names;
  }

  InputFile m_input, m_names;
  OutputFile m_output, m_table;
  std::string m_to;
  std::vector<std::string> m_renames;
  bool m_isAnatomy = false;
};

}  // namespace

std::unique_ptr<Command> makeNamesCommand() {
  return std::make_unique<NamesCommand>();
}

}  // namespace lumen::engine
