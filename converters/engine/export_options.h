// SPDX-License-Identifier: Apache-2.0
// Rows of the options of exports to simulators, and the targets by name.
#pragma once

#include <string>
#include <vector>

#include "converters/base/options/option_table.h"
#include "converters/base/progress.h"
#include "converters/export/export_case.h"

namespace lumen::engine {

/// Adds the rows of all targets, whose values are stored in `options`.
void addExportRows(OptionTable& table, convert::ExportOptions& options);

/// The texts of the target's options, given or default, as lumen-export.json records them. The
/// table has export rows.
convert::OptionTexts exportOptionTexts(const OptionTable& table,
                                       const convert::ExportTarget& target);

/// Refuses, as refuseUnused(), an option that is given and does nothing for this target: the target
/// does not take it, or takes it beside another that is missing.
void requireTargetOptions(const OptionTable& table, const convert::ExportTarget& target,
                          Progress& progress);

std::vector<std::string> exportTargetNames();

/// The target of that name. Throws Error(Unsupported), with the targets that there are.
const convert::ExportTarget& exportTarget(const std::string& name);

}  // namespace lumen::engine
