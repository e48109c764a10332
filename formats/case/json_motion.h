// SPDX-License-Identifier: Apache-2.0
// The motion of a case in the JSON encoding: its arrays have a row for each time.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/case/case.h"
#include "formats/case/json_fields.h"
#include "formats/json/json_document.h"

namespace lumen::formats {

/// The arrays of a motion while its text is read.
struct MotionRows {
  std::vector<double> time;
  std::vector<std::uint32_t> node;
  PoseRows centre{3, {}, {}}, rotation{4, {}, {}}, factor{1, {}, {}};
};

/// Lets the arrays of "/motion" be read into `rows`, which must outlive the reading.
void addMotionSlots(MotionRows& rows, ArraySlots& slots);

/// The motion, not yet validated but for the lengths of its arrays. Takes `rows` over.
Motion readMotion(JsonValue value, const ArraySlots& slots, MotionRows& rows, JsonReadState& state);

}  // namespace lumen::formats
