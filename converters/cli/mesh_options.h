// SPDX-License-Identifier: Apache-2.0
// How a mesh is made of a case, as command-line options.
#pragma once

#include <CLI/CLI.hpp>

#include "converters/engine/file_format.h"

namespace lumen::app {

void addMeshOptions(CLI::App& app, OutputOptions& output);

}  // namespace lumen::app
