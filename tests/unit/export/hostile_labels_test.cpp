// SPDX-License-Identifier: Apache-2.0
// Labels of a case that are markup, or characters that XML forbids, in the files of exports.
#include <algorithm>

#include <gtest/gtest.h>

#include "../mesh/capped_tube.h"
#include "../mesh/synthetic.h"
#include "converters/base/progress.h"
#include "converters/export/export_case.h"
#include "converters/export/shared/text_files.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

constexpr const char* kForbidden = "\xef\xbf\xbe \xef\xbf\xbf";  // U+FFFE, U+FFFF: never in XML

std::vector<std::string> hostileLabels() {
  std::vector<std::string> labels = test::hostileLabels();
  for (const char* const more :
       {kForbidden, "![a](http://b)", "a | b", "# a", "- a", "12. a", "`a` *b* _c_ ~~d~~",
        "<script>alert(1)</script>", "&lt;", "www.a.b", "\xe2\x80\xae\x1b[31m"})
    labels.emplace_back(more);
  return labels;
}

/// A vessel of 30 mm with two labelled ends.
formats::Case vesselOf(const std::string& label) {
  formats::Case value;
  value.metadata.voxelSize = 0.5;
  test::addVessel(value, label, test::straightPath({0, 0, 0}, {2, 0, 0}, 16), 2, 2);
  test::addModels(value);
  return value;
}

std::string fileOf(const std::string& target, const std::string& label, const std::string& name) {
  const auto& targets = exportTargets();
  const auto found = std::find_if(targets.begin(), targets.end(),
                                  [&](const ExportTarget& one) { return one.name == target; });
  ExportOptions options;
  options.sofa.wall = WallKind::Implicit;  // its scene names the branch
  Progress silent;
  const ExportResult result = exportCase(*found, vesselOf(label), options, {}, silent);
  for (const ExportFile& file : result.files)
    if (file.name == name) return file.bytes;
  return "";
}

/// The text that Markdown shows, if no character of it is markup.
std::string shownBy(const std::string& markdown) {
  std::string text;
  for (std::size_t at = 0; at < markdown.size(); ++at) {
    if (markdown[at] == '\\' && at + 1 < markdown.size()) ++at;
    text += markdown[at];
  }
  return text;
}

/// Number of cells of a row of a table.
std::size_t cellsOf(const std::string& row) {
  std::size_t cells = 0;
  for (std::size_t at = 0; at < row.size(); ++at) {
    if (row[at] == '\\')
      ++at;
    else if (row[at] == '|')
      ++cells;
  }
  return cells - 1;
}

}  // namespace

TEST(HostileLabels, ShowAsThemselvesInMarkdown) {
  for (const std::string& label : hostileLabels()) {
    const std::string text = markdownText(label);
    EXPECT_EQ(shownBy(text), formats::printable(label));
    for (const char mark : std::string("<>[]|*`~!&"))
      for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1))
        EXPECT_TRUE(at > 0 && text[at - 1] == '\\') << text;
  }
}

TEST(HostileLabels, StayInTheirCellOfTheTableOfEnds) {
  for (const std::string& label : hostileLabels()) {
    const std::string readme = fileOf("sofa", label, "README.md");
    const std::string name = "| " + markdownText("outlet-" + label) + " |";
    const std::size_t at = readme.find(name);
    ASSERT_NE(at, std::string::npos) << readme;
    EXPECT_EQ(cellsOf(readme.substr(at, readme.find('\n', at) - at)), 4U) << readme;
  }
}

TEST(HostileLabels, HaveNoCharacterInAScenesXmlThatXmlForbids) {
  const std::vector<std::pair<std::string, std::string>> scenes = {{"sofa", "scene.scn"},
                                                                   {"slicer", "scene.mrml"}};
  for (const auto& [target, name] : scenes) {
    const std::string scene = fileOf(target, "a" + std::string(kForbidden) + "<b>\"", name);
    EXPECT_NE(scene.find("a_ _&lt;b&gt;&quot;"), std::string::npos) << scene;
    for (const char* const forbidden : {"\xef\xbf\xbe", "\xef\xbf\xbf"})
      EXPECT_EQ(scene.find(forbidden), std::string::npos) << name;
  }
}

}  // namespace lumen::convert
