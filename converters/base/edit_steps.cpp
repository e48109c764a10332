// SPDX-License-Identifier: Apache-2.0
#include "converters/base/edit_steps.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "converters/base/error.h"
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
  std::array<char, 16> number{};
  for (std::size_t n = done.size() + 1; number[0] == 0 || done.contains(number.data()); ++n)
    std::snprintf(number.data(), number.size(), "%04zu", n);
  done[number.data()] = sentence;
}

const formats::Step* lastStep(const formats::Metadata& metadata, const std::string& name) {
  const auto& steps = metadata.steps;
  const auto found = std::find_if(steps.rbegin(), steps.rend(),
                                  [&](const formats::Step& step) { return step.name == name; });
  return found == steps.rend() ? nullptr : &*found;
}

}  // namespace lumen
