// SPDX-License-Identifier: Apache-2.0
// Facts of a volume mesh, as text and as JSON.
#pragma once

#include <optional>
#include <string>

#include "converters/engine/answers/answer_text.h"
#include "converters/stages/volume_mesh/volume_options.h"

namespace lumen::engine {

/// Lines for the answer: cells, their volume and least quality, and where layers are thinner. Empty
/// without a volume mesh.
std::string volumeMeshLines(const std::optional<convert::VolumeMeshReport>& report);

/// The facts as an object; null without a volume mesh.
Json volumeMeshJson(const std::optional<convert::VolumeMeshReport>& report);

}  // namespace lumen::engine
