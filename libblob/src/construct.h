// SPDX-License-Identifier: Apache-2.0
// The frame of every construction at the C boundary.
#pragma once

#include "blob.h"

namespace lumen::blob {

/// Runs a step that may allocate and returns its status; only memory can fail with an exception.
template <class Run>
blob_status withinMemory(Run run) noexcept {
#ifdef __cpp_exceptions
  try {
    return run();
  } catch (...) {
    return BLOB_ERROR_MEMORY;
  }
#else
  return run();  // WebAssembly traps when memory runs out
#endif
}

/// Runs a construction of what goes to *made, which is null unless it succeeds.
template <class Object, class Construct>
blob_status construct(Object** made, Construct run) noexcept {
  if (made == nullptr) return BLOB_ERROR_ARGUMENT;
  *made = nullptr;
  return withinMemory(run);
}

}  // namespace lumen::blob
