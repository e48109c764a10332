// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/man_page.h"

#include <algorithm>
#include <sstream>
#include <string_view>
#include <vector>

#include "converters/cli/command_line.h"

namespace lumen::app {

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

constexpr const char* kCommonGroup = "Options";

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
std::string optionTitle(const CLI::Option& option) {
  std::string title;
  const auto add = [&title](const std::string& name) {
    title += (title.empty() ? "" : ", ") + bold(name);
  };
  for (const std::string& name : option.get_snames()) add("-" + name);
  for (const std::string& name : option.get_lnames()) add("--" + name);
  if (option.get_type_size() == 0) return title;
  const std::string& own = option.get_option_text();
  return title + " " + italic(own.empty() ? option.get_type_name() : own);
}

void writeOption(std::ostream& page, const CLI::Option& option) {
  const bool isPositional = option.get_positional();
  page << ".TP\n"
       << (isPositional ? italic(option.get_single_name()) : optionTitle(option)) << "\n"
       << literal(option.get_description()) << ".\n";
  if (!isPositional && option.get_type_size() != 0 && !option.get_default_str().empty())
    page << "Default: " << literal(option.get_default_str()) << ".\n";
}

std::string synopsis(const std::string& name, const std::vector<const CLI::Option*>& options) {
  std::string line = "\\fBlumen " + literal(name) + "\\fR";
  for (const CLI::Option* option : options)
    if (option->get_positional())
      line += " " + italic(option->get_single_name()) +
              (option->get_expected_max() >= CLI::detail::expected_max_vector_size ? "..." : "");
  return line + " [" + italic("OPTION") + "...]\n";
}

/// The options of one group, in the order of the help.
void writeGroup(std::ostream& page, const std::vector<const CLI::Option*>& options,
                const std::string& group) {
  for (const CLI::Option* option : options)
    if (!option->get_positional() && option->get_group() == group) writeOption(page, *option);
}

bool isCommon(const CLI::App& common, const CLI::Option& option) {
  return !option.get_lnames().empty() &&
         common.get_option_no_throw("--" + option.get_lnames().front()) != nullptr;
}

void writeCommand(std::ostream& page, Command& command, const CLI::App& common) {
  CLI::App app;
  CommonOptions values;
  bindOptions(app, command, values);
  std::vector<const CLI::Option*> options;
  std::vector<std::string> groups;
  for (const CLI::Option* option : app.get_options()) {
    if (isCommon(common, *option) || option->get_group().empty()) continue;
    options.push_back(option);
    if (std::find(groups.begin(), groups.end(), option->get_group()) == groups.end())
      groups.push_back(option->get_group());
  }
  page << ".SS " << synopsis(command.name(), options) << literal(command.summary()) << ".\n";
  for (const CLI::Option* option : options)
    if (option->get_positional()) writeOption(page, *option);
  for (const std::string& group : groups) {
    if (group != kCommonGroup) page << ".PP\n" << bold(group) << "\n";
    writeGroup(page, options, group);
  }
  page << ".PP\nExample:\n.PP\n.nf\n" << literal(command.example()) << "\n.fi\n";
}

/// A command with no option of its own: what is left are those that every command has.
class NoCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "COMMAND"; }
  [[nodiscard]] std::string summary() const override { return ""; }
  [[nodiscard]] std::string example() const override { return ""; }
  void bind(CLI::App&) override {}
  int run(Context&) override { return 0; }
};

}  // namespace

std::string manPage() {
  std::ostringstream page;
  page << ".\\\" Made from the options of the program; see converters/cli/man_page.cpp.\n"
       << R"(.TH LUMEN 1 "" "lumen )" << LUMEN_VERSION << R"(" "User Commands")" << kHead;
  NoCommand none;
  CLI::App common;
  CommonOptions values;
  bindOptions(common, none, values);
  page << ".SH COMMANDS\n";
  for (const auto& command : allCommands()) writeCommand(page, *command, common);
  page << ".SH OPTIONS OF EVERY COMMAND\n";
  for (const CLI::Option* option : common.get_options()) writeOption(page, *option);
  page << kTail;
  return page.str();
}

}  // namespace lumen::app
