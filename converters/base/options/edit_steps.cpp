// SPDX-License-Identifier: Apache-2.0
#include "converters/base/options/edit_steps.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "formats/view/limits.h"

namespace lumen {

namespace {

constexpr const char* kAssumption = "assumption-";

}  // namespace

void addStep(formats::Metadata& metadata, formats::Step step) {
  auto& steps = metadata.steps;
  if (steps.size() >= formats::kMaxSteps)
    throw unsupported("the case records " + std::to_string(steps.size()) +
                      " steps, and no case may have more, so that it cannot be edited");
  steps.push_back(std::move(step));
}

void recordNumbered(formats::Metadata& metadata, const std::string& step,
                    const std::string& sentence) {
  auto& steps = metadata.steps;
  const bool goesOn = !steps.empty() && steps.back().name == step &&
                      steps.back().parameters.size() + 1 < formats::kMaxParameters;  // room for two
  if (!goesOn) addStep(metadata, {step, "lumen " LUMEN_VERSION, {}});
  auto& done = steps.back().parameters;
  std::string number;
  const auto sentences = std::count_if(done.begin(), done.end(),
                                       [](const auto& one) { return !isRequestName(one.first); });
  for (auto n = static_cast<std::size_t>(sentences) + 1; number.empty() || done.contains(number);
       ++n)
    number = paddedNumber(n, 4);
  done[number] = sentence;
}

void recordEdit(formats::Metadata& metadata, const std::string& sentence) {
  recordNumbered(metadata, kEditStep, sentence);
}

void recordAssumptions(formats::Step& step, const std::vector<std::string>& assumptions) {
  for (std::size_t i = 0; i < assumptions.size(); ++i)
    step.parameters[kAssumption + std::to_string(i + 1)] = assumptions[i];
}

std::vector<std::string> recordedAssumptions(const formats::Metadata& metadata) {
  std::vector<std::string> all;
  for (const formats::Step& step : metadata.steps)
    for (const auto& [name, value] : step.parameters) {
      const auto* sentence = std::get_if<std::string>(&value);
      if (sentence != nullptr && name.starts_with(kAssumption) &&
          std::find(all.begin(), all.end(), *sentence) == all.end())
        all.push_back(*sentence);
    }
  return all;
}

std::optional<double> recordedTime(const formats::Metadata& metadata) {
  const formats::Step* const step = lastStep(metadata, kPoseStep);
  if (step == nullptr) return std::nullopt;
  const auto found = step->parameters.find("time");
  if (found == step->parameters.end()) return std::nullopt;
  const auto* const time = std::get_if<double>(&found->second);
  return time == nullptr ? std::nullopt : std::optional(*time);
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
