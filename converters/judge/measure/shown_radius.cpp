// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/shown_radius.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "converters/base/number_text.h"
#include "converters/judge/measure/vessel_measures.h"

namespace lumen::convert {

namespace {

/// `scale`: what the measure is for a radius of 1 mm.
void bound(Measured& measured, double least, double scale = 1) {
  if (measured.absent.empty() && measured.value < scale * least) measured.atMost = scale * least;
}

}  // namespace

double recordedBlur(const formats::Metadata& metadata) {
  double blur = 0;
  for (const formats::Step& step : metadata.steps)
    if (const auto found = step.parameters.find("point-spread"); found != step.parameters.end())
      if (const auto* mm = std::get_if<double>(&found->second)) blur = *mm;
  return blur;
}

std::optional<double> leastShownRadius(const formats::Metadata& metadata) {
  if (const double blur = recordedBlur(metadata); blur > 0)
    return blur * std::sqrt(2 * std::numbers::ln2);
  if (!metadata.source) return std::nullopt;
  const auto& spacing = metadata.source->spacing;
  return 0.5 * *std::max_element(spacing.begin(), spacing.end());
}

std::string shownRadius(double radius, std::optional<double> least, int digits) {
  return least && radius < *least ? "<= " + fixedText(*least, digits) : fixedText(radius, digits);
}

void boundRadii(std::optional<double> least, CaseMeasures& measures) {
  if (!least) return;
  for (StationMeasures& station : measures.stations) {
    bound(station.radius, *least);
    bound(station.leastDiameter, *least, 2);
    bound(station.greatestDiameter, *least, 2);
  }
  for (VesselMeasures& vessel : measures.vessels) {
    bound(vessel.smallestRadius, *least);
    bound(vessel.meanRadius, *least);
  }
  for (PathMeasures& path : measures.paths) {
    bound(path.smallestRadius, *least);
    bound(path.meanRadius, *least);
    bound(path.catheter, *least, 2 * kFrenchPerMm);
  }
  for (NarrowingMeasures& narrowing : measures.narrowings) {
    bound(narrowing.diameter, *least, 2);
    bound(narrowing.healthyDiameter, *least, 2);
  }
}

}  // namespace lumen::convert
