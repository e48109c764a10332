// SPDX-License-Identifier: Apache-2.0
// Declared in help_text.h.
#include <algorithm>
#include <sstream>
#include <string_view>
#include <vector>

#include "converters/cli/commands.h"
#include "converters/cli/help_text.h"

namespace lumen::cli {

namespace {

constexpr const char* kHead =
    "\n.SH NAME\n"
    "lumen \\- from an angiography volume to a simulator\\-ready vessel case\n"
    ".SH SYNOPSIS\n"
    ".B lumen\n"
    "\\fICOMMAND\\fR [\\fIARGUMENT\\fR...] [\\fIOPTION\\fR...]\n"
    ".br\n"
    ".B lumen \\-\\-version\n"
    ".br\n"
    ".B lumen\n"
    "[\\fICOMMAND\\fR] \\fB\\-\\-help\\fR\n"
    ".SH DESCRIPTION\n"
    "From a volume and a few clicks,\n"
    ".B lumen\n"
    "tracks vessels, fits a smooth implicit surface along them, and writes a case that a "
    "simulator\n"
    "can query, or a mesh. Lengths are millimetres and coordinates LPS, but for glTF, which is in\n"
    "metres with +Y up. It is not a medical device and not for clinical use.\n"
    ".PP\n"
    "Answers go to standard output, progress and messages to standard error. An output file is\n"
    "either whole or not there.\n";

constexpr const char* kTail =
    ".SH EXIT STATUS\n"
    ".TP\n.B 0\nDone.\n"
    ".TP\n.B 1\nFailed.\n"
    ".TP\n.B 2\nThe command line is wrong.\n"
    ".TP\n.B 3\nAn input is invalid.\n"
    ".TP\n.B 4\nUnsupported.\n"
    ".TP\n.B 130\nInterrupted.\n"
    ".SH FILES\n"
    "The formats of cases, of seeds and of JSON answers are described, with their JSON Schemas, "
    "in\n"
    ".I spec\n"
    "beside the licence in lumen's folder of documentation, such as /usr/local/share/doc/lumen.\n";

/// Text that troff prints as it is: no escapes, no requests, and hyphens that can be copied.
std::string literal(std::string_view text) {
  std::string safe;
  bool lineBegins = true;
  for (const char c : text) {
    if (lineBegins && (c == '.' || c == '\'')) safe += "\\&";
    if (c == '-')
      safe += "\\-";
    else if (c == '\\')
      safe += "\\e";
    else
      safe += c;
    lineBegins = c == '\n';
  }
  return safe;
}

std::string bold(std::string_view text) {
  return "\\fB" + literal(text) + "\\fR";
}

std::string italic(std::string_view text) {
  return "\\fI" + literal(text) + "\\fR";
}

/// "--name N", every spelling of it.
std::string optionTitle(const OptionRow& row) {
  std::string title = bold(row.shownName());
  if (!row.negative.empty()) title += ", " + bold("--" + row.negative);
  return row.isFlag() ? title : title + " " + italic(row.type);
}

void writeOption(std::ostream& page, const OptionRow& row) {
  page << ".TP\n"
       << (row.isArgument ? italic(row.name) : optionTitle(row)) << "\n"
       << literal(row.help) << ".\n";
  if (!row.isArgument && !row.isFlag() && !row.defaultText.empty())
    page << "Default: " << literal(row.defaultText) << ".\n";
}

std::string synopsis(const std::string& name, const OptionTable& table) {
  std::string line = "\\fBlumen " + literal(name) + "\\fR";
  for (const OptionRow& row : table.rows())
    if (row.isArgument) line += " " + italic(row.name) + (row.repeats ? "..." : "");
  return line + " [" + italic("OPTION") + "...]\n";
}

void writeCommand(std::ostream& page, const engine::BoundCommand& bound) {
  const OptionTable& table = *bound.table;
  std::vector<std::string> groups;
  for (const OptionRow& row : table.rows())
    if (!row.isArgument && std::find(groups.begin(), groups.end(), row.group) == groups.end())
      groups.push_back(row.group);
  page << ".SS " << synopsis(bound.command->name(), table) << literal(bound.command->summary())
       << ".\n";
  for (const OptionRow& row : table.rows())
    if (row.isArgument) writeOption(page, row);
  for (const std::string& group : groups) {
    if (!group.empty()) page << ".PP\n" << bold(group) << "\n";
    for (const OptionRow& row : table.rows())
      if (!row.isArgument && row.group == group) writeOption(page, row);
  }
  page << ".PP\nExample:\n.PP\n.nf\n" << literal(bound.command->example()) << "\n.fi\n";
}

}  // namespace

std::string manPage() {
  std::ostringstream page;
  page << ".\\\" Made from the options of the program; see converters/cli/man_page.cpp.\n"
       << R"(.TH LUMEN 1 "" "lumen )" << LUMEN_VERSION << R"(" "User Commands")" << kHead;
  page << ".SH COMMANDS\n";
  const engine::Engine commands = allCommands();
  for (const engine::BoundCommand& bound : commands.commands()) writeCommand(page, bound);
  CommonOptions common;
  OptionTable table;
  common.addRows(table);
  page << ".SH OPTIONS OF EVERY COMMAND\n";
  for (const OptionRow& row : table.rows()) writeOption(page, row);
  writeOption(page, configRow());
  page << kTail;
  return page.str();
}

}  // namespace lumen::cli
