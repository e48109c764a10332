// SPDX-License-Identifier: Apache-2.0
// Facts of a closed surface, as text and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/base/warning.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/stages/surface/closing/closed_surface.h"
#include "formats/case/case.h"

namespace lumen::engine {

/// Results of examineSurface().
struct SurfaceFindings {
  std::optional<convert::SurfaceReport> report;  ///< absent if there is no surface
  std::vector<Warning> warnings;                 ///< about it, or the reason why there is none
};

/// Makes the closed surface that `lumen convert` makes of a case by default. Finds nothing in a case
/// without models. Takes as long as the surface. Throws Error(Cancelled).
SurfaceFindings examineSurface(const formats::Case& value, Progress& progress);

/// Lines for the answer: triangles, ends, and where vessels overlap and by how much. Empty without
/// a surface.
std::string surfaceLines(const std::optional<convert::SurfaceReport>& report,
                         const formats::Case& value);

/// Warnings as objects with code, text, places and remedy.
Json warningsJson(const std::vector<Warning>& warnings);

/// Facts of a closed surface as an object; null without a surface.
Json surfaceJson(const std::optional<convert::SurfaceReport>& report, const formats::Case& value);

}  // namespace lumen::engine
