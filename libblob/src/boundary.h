// SPDX-License-Identifier: Apache-2.0
// The C boundary: preconditions, which builds without NDEBUG check, and the frame of every
// construction.
#pragma once

#include "blob.h"

namespace lumen::blob {

/// Calls the handler of misuse, or aborts if there is none.
[[maybe_unused]] void reportMisuse(const char* condition, const char* file, int line) noexcept;

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

#ifdef NDEBUG
#define BLOB_REQUIRE(condition) static_cast<void>(0)
#else
#define BLOB_REQUIRE(condition) \
  ((condition) ? static_cast<void>(0) : ::lumen::blob::reportMisuse(#condition, __FILE__, __LINE__))
#endif
