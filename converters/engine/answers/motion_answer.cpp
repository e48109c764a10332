// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/motion_answer.h"

#include <cstddef>

#include "formats/container/printable.h"

namespace lumen::engine {

Json phasesJson(const operations::MovedCase& moved) {
  Json phases = Json::array();
  for (std::size_t i = 0; i < moved.phases.size(); ++i) {
    const convert::PhaseReport& phase = moved.phases[i];
    phases.push_back({{"time_s", jsonNumber(moved.value.motion->time[i])},
                      {"farthest_mm", jsonNumber(phase.farthest)},
                      {"seen", jsonNumber(phase.seen)},
                      {"correction_mm", jsonNumber(phase.correction)},
                      {"fitted_nodes", phase.fitted}});
  }
  return phases;
}

std::string phaseLines(const operations::MovedCase& moved, const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < moved.phases.size(); ++i)
    text += formats::printable(names[i]) + ": " + fixedText(moved.value.motion->time[i], 3) +
            " s, moved by up to " + fixedText(moved.phases[i].farthest, 2) + " mm, " +
            fixedText(100 * moved.phases[i].seen, 1) + " % of the length seen\n";
  return text;
}

}  // namespace lumen::engine
