// SPDX-License-Identifier: Apache-2.0
// Errors about an input begin with its name.
#pragma once

#include <string>

#include "converters/base/error.h"

namespace lumen::operations {

/// The result of `work`. An Error(InvalidInput) of it gets `name` in front: "head.lumen: ...".
template <class Work>
auto naming(const std::string& name, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::InvalidInput) throw;
    throw invalidInput(name + ": " + error.what());
  }
}

}  // namespace lumen::operations
