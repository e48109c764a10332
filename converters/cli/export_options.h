// SPDX-License-Identifier: Apache-2.0
// The options of `lumen export`.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "converters/export/export_case.h"

namespace lumen::app {

void addExportOptions(CLI::App& app, convert::ExportOptions& options);

/// What the target's options are, given or not: lumen-export.json records them. `app` has them.
convert::OptionTexts exportOptionTexts(const CLI::App& app, const convert::ExportTarget& target);

std::vector<std::string> exportTargetNames();

/// The target of that name. Throws Error(Unsupported), with the targets that there are.
const convert::ExportTarget& exportTarget(const std::string& name);

}  // namespace lumen::app
