// SPDX-License-Identifier: Apache-2.0
// The options of `lumen export`.
#pragma once

#include <CLI/CLI.hpp>

#include "converters/export/target.h"

namespace lumen::app {

void addExportOptions(CLI::App& app, convert::ExportOptions& options);

}  // namespace lumen::app
