// SPDX-License-Identifier: Apache-2.0
// The commands of the engine for Python: their rows, their runs, and surfaces by their options.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

namespace lumen::python {

/// Options of a command by name, as texts.
using Options = std::vector<std::pair<std::string, std::vector<std::string>>>;

/// Adds `commands`, `run` and `version`.
void addEngine(pybind11::module_& module);
/// Adds `mesh_of`.
void addSurfaces(pybind11::module_& module);

}  // namespace lumen::python
