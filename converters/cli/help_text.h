// SPDX-License-Identifier: Apache-2.0
// Help as lumen lays it out.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace lumen::cli {

/// Leaves out the parser's own marks of negated and excluded options.
class HelpFormatter : public CLI::Formatter {
public:
  /// `hidden`: ends of option names that are not shown, ",--color".
  explicit HelpFormatter(std::vector<std::string> hidden = {}) : m_hidden(std::move(hidden)) {
    column_width(36);
  }
  std::string make_option_name(const CLI::Option* option, bool positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_group(std::string group, bool positional,
                         std::vector<const CLI::Option*> options) const override;

private:
  std::vector<std::string> m_hidden;
};

// The versions of the program, of libblob and of the file formats (docs/compatibility.md).

/// "lumen 0.2.0" and an end of line.
std::string versionLine();

/// Answer of `lumen --version --json`, spec/answers/version.schema.json. Equal builds give equal
/// bytes.
std::string versionJson();

/// The manual page lumen(1) in troff's man macros: every command with every option, taken from the
/// parsers that the command line itself uses.
std::string manPage();

}  // namespace lumen::cli
