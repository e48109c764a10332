// SPDX-License-Identifier: Apache-2.0
// The binary encoding, `.lumen`: from a case to bytes.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/case/case.h"
#include "formats/container/expected.h"

namespace lumen::formats {

struct EncodeOptions {
  bool compress = false;  ///< zstd for every chunk that it makes smaller
  /// Bits of a coordinate of a wall point in the points' bounding box, 1 to 30, by Draco; 0: exact.
  int pointBits = 0;
};

/// The canonical bytes: equal cases give equal bytes (a negative zero is written as zero). The case
/// must pass validate(). With options the bytes depend on the versions of zstd and Draco too.
std::vector<std::byte> encodeBinary(const Case& value, const EncodeOptions& options = {});

/// Rounds the wall points as encodeBinary() with these bits does, and records it in the metadata.
/// Nothing happens to a case without points. Throws std::invalid_argument unless bits are 1 to 30.
void quantisePoints(Case& value, int bits);

// The binary encoding, `.lumen`: from bytes to a case. See spec/lumen.md, from "Container" on.

/// The case that the bytes hold, validated. Never throws for bad input; memory is bounded by the
/// bytes present. Chunks that are not known and not critical are kept in Case::otherChunks; keys
/// that start with "x-" are dropped.
Expected<Case> decodeBinary(std::span<const std::byte> bytes);

/// Decodes a case and adds every issue to `issues`; nothing is returned after an error.
std::optional<Case> decodeBinary(std::span<const std::byte> bytes, IssueList& issues);

// The JSON encoding, `.lumen.json`: from a case to text.

/// The canonical text: equal cases give equal texts (a negative zero is written as zero). The case
/// must pass validate().
std::string encodeJson(const Case& value);

// The JSON encoding, `.lumen.json`: from text to a case. See spec/lumen.md, "JSON encoding".

/// The case that the text holds, validated. Never throws for bad input; memory is bounded by the
/// text. Keys that start with "x-" are dropped.
Expected<Case> decodeJson(std::string_view text);

/// Adds every issue of the text to `issues`, too; nothing is returned after an error.
std::optional<Case> decodeJson(std::string_view text, IssueList& issues);

}  // namespace lumen::formats
