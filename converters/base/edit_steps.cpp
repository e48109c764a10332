// SPDX-License-Identifier: Apache-2.0
#include "converters/base/edit_steps.h"

#include <algorithm>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "formats/view/limits.h"

namespace lumen {

void recordEdit(formats::Metadata& metadata, const std::string& sentence) {
  auto& steps = metadata.steps;
  const bool goesOn = !steps.empty() && steps.back().name == kEditStep &&
                      steps.back().parameters.size() < formats::kMaxParameters;
  if (!goesOn) {
    if (steps.size() >= formats::kMaxSteps)
      throw unsupported("the case records " + std::to_string(steps.size()) +
                        " steps, and no case may have more, so that it cannot be edited");
    steps.push_back({kEditStep, "lumen " LUMEN_VERSION, {}});
  }
  auto& done = steps.back().parameters;
  std::string number;
  for (std::size_t n = done.size() + 1; number.empty() || done.contains(number); ++n)
    number = paddedNumber(n, 4);
  done[number] = sentence;
}

std::string parameterText(const formats::ParameterValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* real = std::get_if<double>(&value)) return shownNumber(*real);
  return std::get<std::string>(value);
}

const formats::Step* lastStep(const formats::Metadata& metadata, const std::string& name) {
  const auto& steps = metadata.steps;
  const auto found = std::find_if(steps.rbegin(), steps.rend(),
                                  [&](const formats::Step& step) { return step.name == name; });
  return found == steps.rend() ? nullptr : &*found;
}

}  // namespace lumen
