// SPDX-License-Identifier: Apache-2.0
// Outcome of seeds, for the answers of track and convert.
#pragma once

#include <optional>
#include <string>

#include "converters/engine/answers/answer_text.h"
#include "converters/judge/compare/repetition.h"
#include "converters/stages/tracking/track_case.h"

namespace lumen::engine {

/// The agreement of repeated runs; null without any.
Json repetitionJson(const std::optional<convert::Repetition>& repetition,
                    const formats::Case& value);
/// The agreement of repeated runs in sentences, one per line; empty without any.
std::string repetitionLines(const std::optional<convert::Repetition>& repetition);

/// An answer with the members failed_seeds, missed_points, unjoined and ends.
Json withRemarks(Json json, const convert::TrackRemarks& remarks);

/// A line for each end beyond which the lumen is seen to lead on, the longest first, unless there
/// are too many to read.
std::string endLines(const convert::TrackRemarks& remarks);

}  // namespace lumen::engine
