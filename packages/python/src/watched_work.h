// SPDX-License-Identifier: Apache-2.0
// Long work for Python: on a thread of its own, while the caller's thread lets go of Python's lock,
// hands progress to a function of Python, and looks for Ctrl-C.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "converters/base/progress.h"

namespace lumen::python {

/// Messages of work, in their order.
struct Messages {
  std::vector<std::string> warnings, details;
};

struct Watch {
  /// None, or a function of (stage, units done, units in all or 0), called by the caller's thread.
  pybind11::object report = pybind11::none();
  int threads = 0;      ///< 0: all cores
  bool strict = false;  ///< a warning is an error
};

/// Does the work and returns its messages. An exception of Python, such as KeyboardInterrupt or one
/// of `report`, cancels the work and is raised when that has ended. Raises lumen.Error for
/// lumen::Error, and MemoryError.
Messages runWatched(const Watch& watch, const std::function<void(Progress&)>& work);

}  // namespace lumen::python
