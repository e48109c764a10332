// SPDX-License-Identifier: Apache-2.0
// --time: a case with a motion at one time, in place of the case at rest.
#pragma once

#include <optional>
#include <string>

#include "converters/base/option_table.h"
#include "converters/base/progress.h"
#include "formats/case/case.h"

namespace lumen::engine {

/// Adds --time, whose value is stored in `time`, which must outlive the table.
OptionRow& addTimeRow(OptionTable& table, std::optional<double>& time);

/// The case of a file at the time of --time, or as it is without the option. Refuses the option for
/// a case without a motion. Throws Error(InvalidInput) with the file's name.
formats::Case atTime(formats::Case value, const std::optional<double>& time,
                     const std::string& file, const OptionTable& table, Progress& progress);

}  // namespace lumen::engine
