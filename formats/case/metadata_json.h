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
#include "formats/json/json_writer.h"

namespace lumen::formats {

inline constexpr std::string_view kCoordinateSystem = "LPS";
inline constexpr std::string_view kUnits = "mm";

/// Content of the metadata object: node arrays are described here; their values are elsewhere.
struct MetadataDocument {
  Metadata metadata;
  std::vector<NodeArray> nodeArrays;
};

/// Writes the metadata object as the next value of `writer`.
void writeMetadata(JsonWriter& writer, const Metadata& metadata,
                   const std::vector<NodeArray>& nodeArrays);

/// The content of the META chunk.
std::string metadataJson(const Metadata& metadata, const std::vector<NodeArray>& nodeArrays);

/// The inverse of metadataJson(), not yet validated. Errors of syntax are placed from `byteOffset`
/// on. `fullyKnown` is false for a file of a newer minor version, whose unknown keys are ignored.
MetadataDocument decodeMetadataJson(std::string_view text, std::size_t byteOffset, bool fullyKnown,
                                    IssueList& issues);

/// Reads the metadata from their JSON object.
MetadataDocument readMetadata(JsonValue value, JsonReadState& state);

/// Checks the rules of the metadata and of the description and values of node arrays.
void checkMetadata(const Metadata& metadata, IssueList& issues);
void checkNodeArrays(const Case& value, IssueList& issues);

/// Reports `code` unless the value at `key` is `expected`, the one text that the format allows.
void requireText(JsonFields& fields, std::string_view key, std::string_view expected,
                 ErrorCode code);

}  // namespace lumen::formats
