// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/parser.h"

#include <filesystem>
#include <system_error>

#include "converters/base/error.h"
#include "converters/cli/commands.h"
#include "converters/cli/help_text.h"
#include "converters/cli/usage_error.h"
#include "formats/container/printable.h"

namespace lumen::cli {

namespace {

std::string namesOf(const OptionRow& row) {
  if (row.isArgument) return row.name;
  std::string names = "--" + row.name;
  if (!row.negative.empty()) names += ",!--" + row.negative;
  if (!row.alias.empty()) names += ",--" + row.alias;
  return names;
}

/// A configuration file is read whole, so it must end, and be of a size that people write.
std::string configFault(const std::string& name) {
  constexpr std::uintmax_t kMostBytes = 1 << 20;
  if (std::string fault = fileName()(name); !fault.empty()) return fault;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(name, error);
  if (error || !std::filesystem::exists(status) || std::filesystem::is_directory(status)) return {};
  if (!std::filesystem::is_regular_file(status))
    return "found " + formats::printable(name) + ", which is no regular file, expected one";
  if (std::filesystem::file_size(name, error) > kMostBytes)
    return "found more than 1 MiB in " + formats::printable(name) + ", expected a file of options";
  return {};
}

void setCounts(CLI::Option& option, const OptionRow& row) {
  if (row.repeats)
    option.expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args(row.isArgument);
  else
    option.expected(row.isArgument ? 1 : row.count);
  if (row.delimiter != 0) option.delimiter(row.delimiter);
}

}  // namespace

CommandParser::CommandParser(const engine::Engine& commands, const engine::BoundCommand& command,
                             OptionTable& common)
    : m_commands(commands),
      m_command(command),
      m_app(command.command->summary(), "lumen " + command.command->name()),
      m_config(std::make_shared<CommandConfig>(m_app, commands, command, common)) {
  add(*command.table);
  add(common);
  const OptionRow config = configRow();
  m_app.set_config("--config", "", config.help)
      ->type_name(config.type)
      ->check(CLI::Validator([](std::string& text) { return configFault(text); }, ""));
  m_app.config_formatter(m_config);
}

void CommandParser::add(OptionTable& table) {
  for (OptionRow& row : table.rows()) {
    CLI::Option* const option = addRow(row);
    if (!row.group.empty()) option->group(row.group);
    m_options.emplace_back(&row, option);
  }
  for (const OptionRow& row : table.rows())
    for (const std::string& other : row.excludes)
      if (const OptionRow* const found = table.find(other))
        findOption(row)->excludes(findOption(*found));
}

CLI::Option* CommandParser::addRow(const OptionRow& row) {
  if (row.isFlag()) return m_app.add_flag(namesOf(row), row.help);
  CLI::Option* const option = m_app.add_option(
      namesOf(row), [](const CLI::results_t&) { return true; }, row.help);
  setCounts(*option, row);
  if (row.type.find_first_of(" ,[") == std::string::npos)
    option->type_name(row.type);
  else
    option->option_text(row.type);
  if (!row.defaultText.empty()) option->default_str(row.defaultText);
  option->check(CLI::Validator([&row](std::string& text) { return row.findFault(text); }, ""));
  if (row.isRequired) option->required();
  if (row.isArgument) option->configurable(false);
  return option;
}

CLI::Option* CommandParser::findOption(const OptionRow& row) const {
  for (const auto& [known, option] : m_options)
    if (known == &row) return option;
  return nullptr;
}

void CommandParser::parse(int argc, const char* const* argv) {
  try {
    m_app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    throw;
  } catch (const CLI::ParseError& error) {
    throw usageError(m_app, error, m_commands, m_command, *m_config);
  }
  for (const auto& [row, option] : m_options) {
    if (option->count() == 0) continue;
    row->isPreference = !m_config->placeOf(row->shownName()).empty();
    row->set(option->results());
  }
}

std::string CommandParser::help(const std::string& footer) {
  std::vector<std::string> hidden;
  for (const auto& [row, option] : m_options)
    if (!row->alias.empty()) hidden.push_back(",--" + row->alias);
  m_app.formatter(std::make_shared<HelpFormatter>(std::move(hidden)));
  m_app.footer(footer);
  return m_app.help();
}

}  // namespace lumen::cli
