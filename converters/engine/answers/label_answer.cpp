// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/label_answer.h"

#include <map>

#include "converters/io/labels/label_role.h"
#include "formats/container/printable.h"

namespace lumen::engine {

CountedLabels describeLabels(const operations::LabelPart& map) {
  const std::map<std::int64_t, std::size_t> counts = convert::countLabels(map.voxels);
  CountedLabels labels;
  for (const convert::LabelMeaning& meaning : map.meanings)
    if (const auto found = counts.find(meaning.value); found != counts.end())
      labels.emplace_back(meaning, found->second);
  return labels;
}

std::vector<LabelledMap> describeMaps(const std::vector<operations::LabelPart>& maps) {
  std::vector<LabelledMap> described;
  for (const operations::LabelPart& map : maps)
    described.push_back({map.name, describeLabels(map)});
  return described;
}

Json labelsJson(const CountedLabels& labels) {
  Json list = Json::array();
  for (const auto& [meaning, voxels] : labels) {
    const std::string from = convert::sourcesOf(meaning);
    list.push_back({{"value", meaning.value},
                    {"name", meaning.name.empty() ? Json(nullptr) : Json(meaning.name)},
                    {"role", convert::roleWord(meaning.role)},
                    {"from", from.empty() ? Json(nullptr) : Json(from)},
                    {"voxels", voxels}});
  }
  return list;
}

Json mapsJson(const std::vector<LabelledMap>& maps) {
  Json list = Json::array();
  for (const LabelledMap& map : maps)
    list.push_back({{"name", map.name}, {"labels", labelsJson(map.labels)}});
  return list;
}

std::string labelLines(const CountedLabels& labels) {
  Lines lines(kNarrowColumn);
  for (const auto& [meaning, voxels] : labels) {
    const std::string from = formats::printable(convert::sourcesOf(meaning));
    lines.add("label " + std::to_string(meaning.value),
              (meaning.name.empty() ? "without a name" : formats::printable(meaning.name)) + ": " +
                  convert::roleWord(meaning.role) + (from.empty() ? "" : " (" + from + ")") + ", " +
                  counted(voxels, "voxel", "voxels"));
  }
  return lines.text();
}

std::string mapLines(const std::vector<LabelledMap>& maps) {
  std::string text;
  for (const LabelledMap& map : maps)
    text += formats::printable(map.name) + ": " + counted(map.labels.size(), "label", "labels") +
            "\n" + labelLines(map.labels);
  return text;
}

}  // namespace lumen::engine
