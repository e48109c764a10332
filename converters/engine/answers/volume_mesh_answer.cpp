// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/volume_mesh_answer.h"

#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"

namespace lumen::engine {

std::string volumeMeshLines(const std::optional<convert::VolumeMeshReport>& report) {
  if (!report) return "";
  std::string text = "cells        ";
  if (report->prisms > 0) text += counted(report->prisms, "prism", "prisms") + " and ";
  text += counted(report->tetrahedra, "tetrahedron", "tetrahedra") + ", " +
          shownNumber(report->volume) + " mm^3, least quality " +
          fixedText(report->leastQuality, 3) + " at " + convert::placeText(report->leastPlace) +
          "\n";
  if (report->prisms > 0 && report->fullLayers < 1)
    text += "layers       of full height at " + fixedText(100 * report->fullLayers, 1) +
            " % of the wall, least " + fixedText(100 * report->leastLayers, 1) + " % of it\n";
  return text;
}

Json volumeMeshJson(const std::optional<convert::VolumeMeshReport>& report) {
  if (!report) return nullptr;
  return {{"points", report->points},
          {"prisms", report->prisms},
          {"tetrahedra", report->tetrahedra},
          {"volume_mm3", report->volume},
          {"surface_volume_mm3", report->surfaceVolume},
          {"least_quality", report->leastQuality},
          {"least_place", vectorJson(report->leastPlace)},
          {"full_layers", report->fullLayers},
          {"least_layers", report->leastLayers}};
}

}  // namespace lumen::engine
