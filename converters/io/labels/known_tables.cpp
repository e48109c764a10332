// SPDX-License-Identifier: Apache-2.0
#include "converters/io/labels/known_tables.h"

#include <span>
#include <stdexcept>

#include "converters/base/embedded_text.h"
#include "converters/io/volume/text_header.h"

namespace lumen::convert {

std::span<const EmbeddedText> labelTableTexts();

namespace {

[[noreturn]] void refuseLine(const EmbeddedText& text, const std::string& line) {
  throw std::logic_error(std::string(text.name) + ": " + line);
}

KnownTable readKnownTable(const EmbeddedText& text) {
  constexpr std::string_view kFolder = "tables/", kEnding = ".txt";
  KnownTable table;
  table.word = text.name.substr(kFolder.size(), text.name.size() - kFolder.size() - kEnding.size());
  for (const std::string& line : splitWords(text.bytes, "\n")) {
    if (line.starts_with('#')) {
      if (table.title.empty()) table.title = line.substr(2);
      continue;
    }
    const std::vector<std::string> cells = splitWords(line, ",");
    const auto value = parseInteger(cells.front());
    if (!value || cells.size() < 2 || cells.size() > 3) refuseLine(text, line);
    const auto role = cells.size() == 3 ? roleOfWord(cells[2]) : roleOfName(cells[1]);
    if (!role || !table.labels.emplace(*value, KnownLabel{cells[1], *role}).second)
      refuseLine(text, line);
  }
  return table;
}

}  // namespace

const std::vector<KnownTable>& knownTables() {
  static const std::vector<KnownTable> tables = [] {
    std::vector<KnownTable> read;
    for (const EmbeddedText& text : labelTableTexts()) read.push_back(readKnownTable(text));
    return read;
  }();
  return tables;
}

const KnownTable* findKnownTable(std::string_view word) {
  for (const KnownTable& table : knownTables())
    if (table.word == word) return &table;
  return nullptr;
}

const KnownName* findKnownName(std::string_view name) {
  static const std::map<std::string, KnownName, std::less<>> names = [] {
    std::map<std::string, KnownName, std::less<>> all;
    for (const KnownTable& table : knownTables())
      for (const auto& [value, label] : table.labels)
        all.emplace(plainName(label.name), KnownName{label.role, table.title});
    return all;
  }();
  const auto found = names.find(plainName(name));
  return found == names.end() ? nullptr : &found->second;
}

}  // namespace lumen::convert
