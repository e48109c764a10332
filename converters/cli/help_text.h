// SPDX-License-Identifier: Apache-2.0
// Help as lumen lays it out.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace lumen::app {

/// Without the parser's own marks: how a switch is negated, what excludes what.
class HelpFormatter : public CLI::Formatter {
public:
  HelpFormatter() { column_width(36); }
  std::string make_option_name(const CLI::Option* option, bool positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_group(std::string group, bool positional,
                         std::vector<const CLI::Option*> options) const override;
};

}  // namespace lumen::app
