// SPDX-License-Identifier: Apache-2.0
// Preconditions of the API, checked in builds without NDEBUG.
#pragma once

namespace lumen::blob {

/// Calls the handler of misuse, or aborts if there is none.
[[maybe_unused]] void reportMisuse(const char* condition, const char* file, int line) noexcept;

}  // namespace lumen::blob

#ifdef NDEBUG
#define BLOB_REQUIRE(condition) static_cast<void>(0)
#else
#define BLOB_REQUIRE(condition) \
  ((condition) ? static_cast<void>(0) : ::lumen::blob::reportMisuse(#condition, __FILE__, __LINE__))
#endif
