// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/time_option.h"

#include <utility>

#include "converters/base/error.h"
#include "converters/engine/scope.h"
#include "converters/stages/editing/posed_case.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

constexpr const char* kTime = "time";
constexpr NumberRange kTimes{-1e9, 1e9};  // s: some thirty years

}  // namespace

OptionRow& addTimeRow(OptionTable& table, std::optional<double>& time) {
  return table
      .add(kTime, &time, "S",
           "Take the case as it stands at this time of its motion, in s; without it, at rest")
      .in(kTimes);
}

formats::Case atTime(formats::Case value, const std::optional<double>& time,
                     const std::string& file, const OptionTable& table, Progress& progress) {
  if (!time) return value;
  if (!value.motion) {
    refuseIdle(*table.find(kTime),
               "is for cases with a motion, and " + formats::printable(file) + " has none",
               progress);
    return value;
  }
  try {
    return convert::posedCase(value, *time, progress);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::InvalidInput) throw;
    throw invalidInput(file + ": " + error.what());
  }
}

}  // namespace lumen::engine
