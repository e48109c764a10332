// SPDX-License-Identifier: Apache-2.0
// Metadata is the same JSON object in both encodings: compact in the META chunk, indented in
// `.lumen.json`.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "formats/case/case.h"
#include "formats/case/json_fields.h"
#include "formats/case/json_writer.h"

namespace lumen::formats {

inline constexpr std::string_view kCoordinateSystem = "LPS";
inline constexpr std::string_view kUnits = "mm";

/// What the metadata object says: the node arrays are described, their values are elsewhere.
struct MetadataDocument {
  Metadata metadata;
  std::vector<NodeArray> nodeArrays;
};

/// One object, as the next value of `writer`.
void writeMetadata(JsonWriter& writer, const Metadata& metadata,
                   const std::vector<NodeArray>& nodeArrays);

/// The content of the META chunk.
std::string metadataJson(const Metadata& metadata, const std::vector<NodeArray>& nodeArrays);

/// The inverse, not yet validated. Errors of syntax are placed from `byteOffset` on. `fullyKnown`
/// is false for a file of a newer minor version, whose unknown keys are ignored.
MetadataDocument decodeMetadataJson(std::string_view text, std::size_t byteOffset, bool fullyKnown,
                                    IssueList& issues);

/// The object itself.
MetadataDocument readMetadata(JsonValue value, JsonReadState& state);

/// The rules of the metadata and of the description and values of node arrays.
void checkMetadata(const Metadata& metadata, IssueList& issues);
void checkNodeArrays(const Case& value, IssueList& issues);

/// The value at `key` must be the one text that the format allows.
void requireText(JsonFields& fields, std::string_view key, std::string_view expected,
                 ErrorCode code);

}  // namespace lumen::formats
