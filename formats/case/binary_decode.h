// SPDX-License-Identifier: Apache-2.0
// The binary encoding, `.lumen`: from bytes to a case. See spec/lumen.md, from "Container" on.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "formats/case/case.h"
#include "formats/container/expected.h"

namespace lumen::formats {

/// The case that the bytes hold, validated. Never throws for bad input; memory is bounded by the
/// bytes present. Chunks that are not known and not critical are kept in Case::otherChunks; keys
/// that start with "x-" are dropped.
Expected<Case> decodeBinary(std::span<const std::byte> bytes);

/// Decodes a case and adds every issue to `issues`; nothing is returned after an error.
std::optional<Case> decodeBinary(std::span<const std::byte> bytes, IssueList& issues);

}  // namespace lumen::formats
