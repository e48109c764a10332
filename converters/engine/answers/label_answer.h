// SPDX-License-Identifier: Apache-2.0
// Labels of maps in answers: values, names, roles, their sources, and how many voxels have them.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "converters/engine/answers/answer_text.h"
#include "converters/io/labels/label_meaning.h"
#include "converters/operations/label_inventory.h"
#include "converters/operations/source.h"

namespace lumen::engine {

/// The labels that voxels have, each with the number of them.
using CountedLabels = std::vector<std::pair<convert::LabelMeaning, std::size_t>>;

CountedLabels describeLabels(const operations::LabelPart& map);

/// value, name, role, from, voxels of each label.
Json labelsJson(const CountedLabels& labels);
/// name and labels of each map, with what the case has of each label.
Json inventoryJson(const operations::LabelInventory& inventory);
/// The branches on no label and their length; null without maps.
Json unlabelledJson(const operations::LabelInventory& inventory);

/// A line for each label: its value, name, role, the sources of both, and the number of its voxels.
std::string labelLines(const CountedLabels& labels);
/// Lines for each map: the vessels by its labels, with what was found of each; those that were not
/// found, and labels of no vessel as bright as vessels. Empty without any.
std::string inventoryLines(const operations::LabelInventory& inventory);

}  // namespace lumen::engine
