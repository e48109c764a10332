// SPDX-License-Identifier: Apache-2.0
// The commands of the engine for Python: their rows, their runs, and volumes as arrays.
#pragma once

#include <pybind11/pybind11.h>

namespace lumen::python {

/// Adds `commands`, `run`, `read_volume`, the class Voxels and `version`.
void addEngine(pybind11::module_& module);

}  // namespace lumen::python
