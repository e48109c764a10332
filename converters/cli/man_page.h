// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lumen::cli {

/// The manual page lumen(1) in troff's man macros: every command with every option, taken from the
/// parsers that the command line itself uses.
std::string manPage();

}  // namespace lumen::cli
