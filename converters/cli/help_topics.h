// SPDX-License-Identifier: Apache-2.0
// Parts of the manual that `lumen help TOPIC` prints: pages of docs/, which the program holds.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "converters/base/error.h"
#include "converters/engine/command.h"

namespace lumen::cli {

struct HelpTopic {
  std::string name;       ///< one word, such as "volumes"
  std::string title;      ///< the page's first line
  std::string_view page;  ///< Markdown
};

/// All topics by their names.
const std::vector<HelpTopic>& helpTopics();

/// Lines with the names and titles of all topics.
std::string listOfTopics();

/// A page as text for a terminal: links without their targets, no pictures. Empty for the name of
/// no topic.
std::string topicText(const std::string& name);

/// The error for a word after `lumen help` that is neither a command nor a topic, with a suggestion.
Error unknownTopic(const std::string& word, const engine::Engine& commands);

}  // namespace lumen::cli
