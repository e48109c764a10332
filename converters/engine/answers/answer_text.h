// SPDX-License-Identifier: Apache-2.0
// Answers for standard output: JSON with stable names, and aligned text.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "converters/base/field_word.h"
#include "converters/base/number_text.h"
#include "converters/base/options/option_table.h"
#include "converters/base/progress.h"
#include "converters/base/shown_lines.h"
#include "converters/base/text.h"
#include "converters/operations/context.h"
#include "formats/case/case.h"

namespace lumen::engine {

using Json = nlohmann::ordered_json;

/// The number with the shortest decimal text that reads back as the same float; null if it is not
/// finite.
Json jsonNumber(float value);
Json jsonNumber(double value);

/// [x, y, z].
Json vectorJson(const Eigen::Vector3d& vector);

/// Answer of convert, track and fit: branches, nodes, points, blobs, length_mm.
Json caseSummary(const formats::Case& value);

/// One line for a person: "out.lumen: 3 branches, 210 nodes, 1830 points, 902 blobs, 123.4 mm".
std::string caseLine(const std::string& file, const formats::Case& value);

/// Words fields as options, "--seeds", and their values as the rows of `table` were given them.
FieldWord optionWord(const OptionTable* table = nullptr);

/// The context of an operation on values: messages word its fields as options, and their values as
/// the rows of `table` were given them.
operations::Context operationContext(Progress& progress, const OptionTable* table = nullptr);

}  // namespace lumen::engine
