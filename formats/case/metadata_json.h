// SPDX-License-Identifier: Apache-2.0
// Metadata is the same JSON object in both encodings: compact in the META chunk, indented in
// `.lumen.json`.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "formats/case/case_file.h"
#include "formats/case/json_writer.h"

namespace lumen::formats {

inline constexpr std::string_view kCoordinateSystem = "LPS";
inline constexpr std::string_view kUnits = "mm";

/// One object, as the next value of `writer`.
void writeMetadata(JsonWriter& writer, const Metadata& metadata);

/// The content of the META chunk.
std::string metadataJson(const Metadata& metadata);

/// The inverse, not yet validated. Errors of syntax are placed from `byteOffset` on. `fullyKnown`
/// is false for a file of a newer minor version, whose unknown keys are ignored.
Result<Metadata> decodeMetadataJson(std::string_view text, std::size_t byteOffset, bool fullyKnown);

}  // namespace lumen::formats
