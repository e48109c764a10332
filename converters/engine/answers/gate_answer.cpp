// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/gate_answer.h"

#include <algorithm>
#include <cmath>

#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/judge/facts/check_facts.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

constexpr int kPlaceDecimals = 2;  // a hundredth of a mm

Json placeJson(const std::optional<convert::GatePlace>& place,
               const formats::CenterlineTree& tree) {
  if (!place) return nullptr;
  const Eigen::Vector3d& p = place->position;
  return {{"measure", place->measure},
          {"position", {p.x(), p.y(), p.z()}},
          {"branch", convert::labelOf(tree, place->node)},
          {"node", place->node}};
}

std::string_view aboutOf(const std::string& measure) {
  for (const convert::GateMeasure& one : convert::gateMeasures())
    if (one.name == measure) return one.about;
  return {};
}

std::string faultText(const convert::GateFault& fault) {
  const std::string found = std::isnan(fault.found) ? "not known" : shownNumber(fault.found);
  return std::string(aboutOf(fault.threshold.measure)) + ": " + found + ", expected at " +
         (fault.threshold.isLeast ? "least " : "most ") + shownNumber(fault.threshold.limit);
}

std::string sentenceOf(const convert::GateVerdict& verdict) {
  if (verdict.passes()) return "passes";
  std::string text = "needs a person";
  for (const convert::GateFault& fault : verdict.faults)
    text += (&fault == &verdict.faults.front() ? ": " : "; ") + faultText(fault);
  return text;
}

bool isPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-_./,:=+@%").find(c) != std::string_view::npos;
}

}  // namespace

std::vector<std::string> viewCommand(const convert::GateVerdict& verdict, const std::string& volume,
                                     const std::string& caseFile) {
  if (!verdict.worst) return {};
  const Eigen::Vector3d& p = verdict.worst->position;
  return {"lumen", "view", volume, caseFile,
          "--at=" + fixedText(p.x(), kPlaceDecimals) + "," + fixedText(p.y(), kPlaceDecimals) +
              "," + fixedText(p.z(), kPlaceDecimals)};
}

Json verdictJson(const convert::GateVerdict& verdict, const formats::CenterlineTree& tree,
                 const std::vector<std::string>& view) {
  Json faults = Json::array();
  for (const convert::GateFault& fault : verdict.faults)
    faults.push_back({{"measure", fault.threshold.measure},
                      {"found", jsonNumber(fault.found)},
                      {"least", fault.threshold.isLeast ? Json(fault.threshold.limit) : Json()},
                      {"most", fault.threshold.isLeast ? Json() : Json(fault.threshold.limit)}});
  return {{"profile", verdict.profile},
          {"passes", verdict.passes()},
          {"sentence", sentenceOf(verdict)},
          {"faults", std::move(faults)},
          {"worst", placeJson(verdict.worst, tree)},
          {"view", view}};
}

std::string verdictText(const convert::GateVerdict& verdict, const formats::CenterlineTree& tree,
                        const std::vector<std::string>& view) {
  const std::string profile = "profile " + formats::printable(verdict.profile) + ": ";
  if (verdict.passes()) return "\n" + profile + "passes\n";
  std::string text = "\n" + profile + "needs a person\n";
  for (const convert::GateFault& fault : verdict.faults) text += "  " + faultText(fault) + "\n";
  if (verdict.worst)
    text += "the worst place is at " + convert::placeText(verdict.worst->position) + ", at " +
            formats::printable(convert::labelOf(tree, verdict.worst->node)) + ":\n  " +
            formats::printable(shellLine(view)) + "\n";
  return text;
}

std::string shellLine(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    line += line.empty() ? "" : " ";
    if (!word.empty() && std::all_of(word.begin(), word.end(), isPlain)) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace lumen::engine
