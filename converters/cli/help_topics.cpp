// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/help_topics.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>

#include "converters/base/embedded_text.h"
#include "converters/base/shown_lines.h"
#include "converters/base/text.h"

namespace lumen::convert {

std::span<const EmbeddedText> manualPages();

}  // namespace lumen::convert

namespace lumen::cli {

namespace {

/// The topic of a page's file. A topic is named unlike every command and group.
std::string topicOf(std::string_view file) {
  const std::string stem = std::filesystem::path(file).stem().string();
  return stem == "library" ? "libraries" : stem;
}

/// A link or a picture of a page.
struct Link {
  std::string_view text;  ///< within its brackets
  std::size_t end = 0;    ///< behind it
};

/// The link whose text begins at `at`, if there is one.
std::optional<Link> linkAt(std::string_view page, std::size_t at) {
  const std::size_t middle = page.find("](", at);
  const std::size_t end = middle == page.npos ? middle : page.find(')', middle);
  if (end == page.npos) return {};
  const std::string_view text = page.substr(at, middle - at);
  if (text.find('[') != text.npos || text.find("\n\n") != text.npos) return {};
  return Link{text, end + 1};
}

/// The text of a link; that of a page's file is its topic.
std::string_view shownText(std::string_view text) {
  constexpr std::string_view kPage = ".md";
  return text.ends_with(kPage) ? text.substr(0, text.size() - kPage.size()) : text;
}

/// The page without anchors and pictures, and with links as their texts.
std::string withoutLinks(std::string_view page) {
  constexpr std::string_view kAnchor = "<a id=", kAnchorEnd = "</a>\n";
  std::string plain;
  for (std::size_t at = 0; at < page.size();) {
    const std::string_view rest = page.substr(at);
    if (rest.starts_with(kAnchor)) {
      at = std::min(page.find(kAnchorEnd, at), page.size() - kAnchorEnd.size()) + kAnchorEnd.size();
      continue;
    }
    const std::size_t mark = rest.starts_with("![") ? 2 : rest.starts_with('[') ? 1 : 0;
    const std::optional<Link> link = mark > 0 ? linkAt(page, at + mark) : std::nullopt;
    if (mark == 1 && link) plain += shownText(link->text);
    if (!link) plain += rest.front();
    at = link ? link->end : at + 1;
  }
  return plain;
}

}  // namespace

const std::vector<HelpTopic>& helpTopics() {
  static const std::vector<HelpTopic> topics = [] {
    std::vector<HelpTopic> made;
    for (const convert::EmbeddedText& page : convert::manualPages()) {
      const std::string_view first = page.bytes.substr(0, page.bytes.find('\n'));
      made.push_back({topicOf(page.name), std::string(first.substr(2)), page.bytes});
    }
    std::sort(made.begin(), made.end(),
              [](const HelpTopic& a, const HelpTopic& b) { return a.name < b.name; });
    return made;
  }();
  return topics;
}

std::string listOfTopics() {
  constexpr std::size_t kTopicColumn = 16;
  Lines lines(kTopicColumn);
  for (const HelpTopic& topic : helpTopics()) lines.add("  " + topic.name, topic.title);
  return lines.text();
}

std::string topicText(const std::string& name) {
  for (const HelpTopic& topic : helpTopics())
    if (topic.name == name) return withoutLinks(topic.page);
  return {};
}

Error unknownTopic(const std::string& word, const engine::Engine& commands) {
  std::vector<std::string> names;
  for (const HelpTopic& topic : helpTopics()) names.push_back(topic.name);
  for (const auto& [command, table] : commands.commands())
    names.push_back(engine::firstWord(command->name()));
  const std::string meant = didYouMean(word, names);
  return {ErrorKind::Usage, word + ": there is no such command or topic" +
                                (meant.empty() ? "; lumen help lists all" : meant)};
}

}  // namespace lumen::cli
