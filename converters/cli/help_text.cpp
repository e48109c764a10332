// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/help_text.h"

#include <algorithm>
#include <string_view>

namespace lumen::cli {

std::string HelpFormatter::make_option_name(const CLI::Option* option, bool positional) const {
  std::string name = CLI::Formatter::make_option_name(option, positional);
  for (std::size_t at = name.find('{'); at != std::string::npos; at = name.find('{', at))
    name.erase(at, name.find('}', at) - at + 1);
  for (const std::string& hidden : m_hidden)
    if (name.ends_with(hidden)) name.erase(name.size() - hidden.size());
  return name;
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  if (option->get_positional()) return " ";
  std::string text = CLI::Formatter::make_option_opts(option);
  text.erase(std::min(text.find(" " + get_label("Excludes") + ":"), text.size()));
  if (const std::string_view many = " ..."; text.ends_with(many))
    text.erase(text.size() - many.size());
  return text;
}

std::string HelpFormatter::make_group(std::string group, bool positional,
                                      std::vector<const CLI::Option*> options) const {
  // a blank line already ends the group before
  const bool first = positional || group == get_label("Options");
  std::string text = CLI::Formatter::make_group(std::move(group), positional, std::move(options));
  if (!first && text.starts_with('\n')) text.erase(0, 1);
  return text;
}

}  // namespace lumen::cli
