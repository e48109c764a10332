// SPDX-License-Identifier: Apache-2.0
// Node arrays with one u32 for each node, of which 0 is what holds without the array.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/case/case.h"
#include "formats/container/issue.h"

namespace lumen::formats {

/// Values of an enumeration, which a cast of the values of a vector makes words.
struct Words {
  template <class Iterator>
  Words(Iterator first, Iterator last) {
    std::transform(first, last, std::back_inserter(values),
                   [](const auto value) { return static_cast<std::uint32_t>(value); });
  }
  std::vector<std::uint32_t> values;
};

/// The values of the node array of this name; null if the case has none of u32 with as many values
/// as nodes.
const std::vector<std::uint32_t>* findNodeWords(const Case& value, std::string_view array);

/// One value for each node; 0 without the array.
template <class Value>
std::vector<Value> readNodeWords(const Case& value, std::string_view array) {
  std::vector<Value> out(value.tree.nodeCount(), static_cast<Value>(0));
  if (const std::vector<std::uint32_t>* words = findNodeWords(value, array))
    std::transform(words->begin(), words->end(), out.begin(),
                   [](std::uint32_t word) { return static_cast<Value>(word); });
  return out;
}

/// Replaces the node array of a case by `words`, one for each node, and lists its extension; removes
/// both if all are 0.
void setNodeWords(Case& value, const char* extension, const char* array, Words words);

/// The first fault of a node array whose values are those of a table of the format (spec/lumen.md,
/// extensions): its components, its type, or a value. `place` is the place of its description. Empty
/// if there is none, and for any other array.
std::optional<Issue> nodeWordFault(const NodeArray& array, const std::string& place);

}  // namespace lumen::formats
