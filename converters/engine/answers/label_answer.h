// SPDX-License-Identifier: Apache-2.0
// Labels of maps in answers: values, names, roles, their sources, and how many voxels have them.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "converters/engine/answers/answer_text.h"
#include "converters/io/labels/label_meaning.h"
#include "converters/operations/source.h"

namespace lumen::engine {

/// The labels that voxels have, each with the number of them.
using CountedLabels = std::vector<std::pair<convert::LabelMeaning, std::size_t>>;

struct LabelledMap {
  std::string name;
  CountedLabels labels;
};

CountedLabels describeLabels(const operations::LabelPart& map);
std::vector<LabelledMap> describeMaps(const std::vector<operations::LabelPart>& maps);

/// value, name, role, from, voxels of each label.
Json labelsJson(const CountedLabels& labels);
/// name and labels of each map.
Json mapsJson(const std::vector<LabelledMap>& maps);

/// A line for each label: its value, name, role, the sources of both, and the number of its voxels.
std::string labelLines(const CountedLabels& labels);
/// The same of all maps, each under its name; empty without any.
std::string mapLines(const std::vector<LabelledMap>& maps);

}  // namespace lumen::engine
