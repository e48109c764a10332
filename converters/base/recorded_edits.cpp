// SPDX-License-Identifier: Apache-2.0
#include "converters/base/recorded_edits.h"

#include <algorithm>
#include <string_view>

#include "converters/base/edit_steps.h"

namespace lumen {

namespace {

constexpr std::string_view kRequest = "-request";  // behind the number of a sentence

}  // namespace

bool isRequestName(const std::string& parameter) {
  return parameter.ends_with(kRequest);
}

void recordRequest(formats::Metadata& metadata, const std::string& request) {
  if (metadata.steps.empty() || metadata.steps.back().name != kEditStep) return;
  auto& done = metadata.steps.back().parameters;
  const auto last = std::find_if(done.rbegin(), done.rend(),
                                 [](const auto& one) { return !isRequestName(one.first); });
  if (last != done.rend()) done[last->first + std::string(kRequest)] = request;
}

std::vector<RecordedEdit> recordedEdits(const formats::Metadata& metadata) {
  std::vector<RecordedEdit> edits;
  for (const formats::Step& step : metadata.steps) {
    if (step.name != kEditStep) continue;
    for (const auto& [name, value] : step.parameters) {
      if (isRequestName(name)) continue;
      const auto request = step.parameters.find(name + std::string(kRequest));
      const bool isKept = request != step.parameters.end();
      edits.push_back({parameterText(value), isKept ? parameterText(request->second) : ""});
    }
  }
  return edits;
}

}  // namespace lumen
