// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/label_answer.h"

#include <algorithm>
#include <array>
#include <map>

#include "converters/base/options/option_name.h"
#include "converters/io/labels/label_role.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

constexpr double kMillilitre = 1e-3;  // of a cubic millimetre

/// Key and words of a reason why voxels of a label are left out, in the order of the reasons.
struct LeftOutWords {
  const char *key, *words;
};
constexpr std::array<LeftOutWords, operations::kLeftOutCount> kLeftOut = {
    LeftOutWords{"no_vessel_ml", "no vessel by a map"},
    LeftOutWords{"fainter_ml", "fainter than the vessels"}, LeftOutWords{"stronger_ml", "stronger"},
    LeftOutWords{"no_wall_ml", "without a wall around it"}};

Json labelJson(const convert::LabelMeaning& meaning, std::size_t voxels) {
  const std::string from = convert::sourcesOf(meaning);
  return {{"value", meaning.value},
          {"name", meaning.name.empty() ? Json(nullptr) : Json(meaning.name)},
          {"role", convert::roleWord(meaning.role)},
          {"from", from.empty() ? Json(nullptr) : Json(from)},
          {"voxels", voxels}};
}

Json mappedJson(const operations::MappedLabel& label) {
  const auto measured = [](bool isThere, double value) {
    return isThere ? jsonNumber(value) : Json(nullptr);
  };
  const bool isFound = !label.branches.empty();
  Json beyond = Json::array();
  for (const operations::BeyondLabel& end : label.beyond)
    beyond.push_back({{"branch", end.branch},
                      {"end", end.isStart ? "start" : "tip"},
                      {"length_mm", jsonNumber(end.length)}});
  Json json = labelJson(label.meaning, label.voxels);
  json["branches"] = label.branches;
  json["length_mm"] = jsonNumber(label.length);
  json["map_wall_mm"] = jsonNumber(label.stated);
  json["least_radius_mm"] = measured(isFound, label.leastRadius);
  json["mean_radius_mm"] = measured(isFound, label.meanRadius);
  json["greatest_radius_mm"] = measured(isFound, label.greatestRadius);
  json["beyond"] = std::move(beyond);
  json["held_share"] = measured(label.heldShare >= 0, label.heldShare);
  json["left_out"] = nullptr;
  for (std::size_t why = 0; label.leftOut && why < kLeftOut.size(); ++why)
    json["left_out"][kLeftOut[why].key] = jsonNumber((*label.leftOut)[why] * kMillilitre);
  json["missing"] = label.missing.empty() ? Json(nullptr) : Json(label.missing);
  json["refused_ml"] = jsonNumber(label.refused * kMillilitre);
  return json;
}

/// "label 3" and "BA: artery (dseg.tsv), 120 voxels".
void addLabel(Lines& lines, const convert::LabelMeaning& meaning, std::size_t voxels,
              const std::string& rest) {
  const std::string from = formats::printable(convert::sourcesOf(meaning));
  lines.add("label " + std::to_string(meaning.value),
            (meaning.name.empty() ? "without a name" : formats::printable(meaning.name)) + ": " +
                convert::roleWord(meaning.role) + (from.empty() ? "" : " (" + from + ")") + ", " +
                counted(voxels, "voxel", "voxels") + rest);
}

/// ", 0.31 ml left out: 0.3 fainter than the vessels, 0.01 stronger"; empty if nothing is.
std::string leftOutText(const operations::MappedLabel& label) {
  std::string text;
  double sum = 0;
  for (std::size_t why = 0; label.leftOut && why < kLeftOut.size(); ++why) {
    const double volume = (*label.leftOut)[why] * kMillilitre;
    if (volume <= 0) continue;
    sum += volume;
    text += (text.empty() ? "" : ", ") + shownFigure(volume) + " " + kLeftOut[why].words;
  }
  return text.empty() ? text : ", " + shownFigure(sum) + " ml left out: " + text;
}

/// "; 31.2 mm, radius 1.4 (0.9 to 1.8) mm, 97 % held, 12.3 mm beyond at the tip", or the reason why
/// it is not found.
std::string mappedText(const operations::MappedLabel& label) {
  if (!label.missing.empty())
    return "; not found: " + formats::printable(label.missing) + leftOutText(label);
  std::string text;
  if (!label.branches.empty()) {
    text = "; " + fixedText(label.length, 1) + " mm";
    if (label.branches.size() > 1)
      text += " in " + std::to_string(label.branches.size()) + " branches";
    text += ", radius " + fixedText(label.meanRadius, 1) + " (" + fixedText(label.leastRadius, 1) +
            " to " + fixedText(label.greatestRadius, 1) + ") mm, " +
            fixedText(100 * label.heldShare, 0) + " % held";
    if (label.stated > 0)
      text += ", " + fixedText(label.stated, 1) + " mm with the wall of the map";
    for (const operations::BeyondLabel& end : label.beyond)
      text += ", " + fixedText(end.length, 1) + " mm beyond at the " +
              (end.isStart ? "start" : "tip") +
              (label.branches.size() > 1 ? " of " + formats::printable(end.branch) : "");
    text += leftOutText(label);
  } else if (label.refused > 0) {
    text = "; " + shownFigure(label.refused * kMillilitre) + " ml as bright as the vessels refused";
  }
  return text;
}

/// A label that a long list passes over: no vessel, and nothing was taken away for it.
bool isPassedOver(const operations::MappedLabel& label) {
  return label.branches.empty() && label.missing.empty() && label.refused <= 0;
}

std::string unlabelledLine(const operations::LabelInventory& inventory) {
  constexpr std::size_t kMostNames = 10;
  const std::vector<std::string>& names = inventory.unlabelled;
  if (names.empty()) return {};
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i)
    text += (i == 0 ? "" : ", ") + formats::printable(names[i]);
  if (names.size() > kMostNames)
    text += " and " + std::to_string(names.size() - kMostNames) + " more";
  return Lines(kNarrowColumn)
      .add("no label", counted(names.size(), "vessel", "vessels") + ", " +
                           fixedText(inventory.unlabelledLength, 1) + " mm: " + text)
      .text();
}

}  // namespace

CountedLabels describeLabels(const operations::LabelPart& map) {
  const std::map<std::int64_t, std::size_t> counts = convert::countLabels(map.voxels);
  CountedLabels labels;
  for (const convert::LabelMeaning& meaning : map.meanings)
    if (const auto found = counts.find(meaning.value); found != counts.end())
      labels.emplace_back(meaning, found->second);
  return labels;
}

Json labelsJson(const CountedLabels& labels) {
  Json list = Json::array();
  for (const auto& [meaning, voxels] : labels) list.push_back(labelJson(meaning, voxels));
  return list;
}

Json inventoryJson(const operations::LabelInventory& inventory) {
  Json list = Json::array();
  for (const operations::MappedLabels& map : inventory.maps) {
    Json labels = Json::array();
    for (const operations::MappedLabel& label : map.labels) labels.push_back(mappedJson(label));
    list.push_back({{"name", map.name}, {"labels", std::move(labels)}});
  }
  return list;
}

Json unlabelledJson(const operations::LabelInventory& inventory) {
  if (inventory.maps.empty()) return nullptr;
  return {{"branches", inventory.unlabelled},
          {"length_mm", jsonNumber(inventory.unlabelledLength)}};
}

std::string labelLines(const CountedLabels& labels) {
  Lines lines(kNarrowColumn);
  for (const auto& [meaning, voxels] : labels) addLabel(lines, meaning, voxels, {});
  return lines.text();
}

std::string inventoryLines(const operations::LabelInventory& inventory) {
  if (inventory.maps.empty()) return {};
  constexpr std::size_t kMostLabels = 20;  // a longer list leaves out labels of which nothing came
  std::string text;
  for (const operations::MappedLabels& map : inventory.maps) {
    const bool isLong = map.labels.size() > kMostLabels;
    std::size_t passed = 0;
    Lines lines(kNarrowColumn);
    for (const operations::MappedLabel& label : map.labels) {
      if (isLong && isPassedOver(label))
        ++passed;
      else
        addLabel(lines, label.meaning, label.voxels, mappedText(label));
    }
    text += formats::printable(map.name) + ": " + counted(map.labels.size(), "label", "labels") +
            "\n" + lines.text();
    if (passed > 0)
      text += "and " + std::to_string(passed) + " more of no vessel; " + kOption.json.shown() +
              " lists all\n";
  }
  return text + unlabelledLine(inventory);
}

}  // namespace lumen::engine
