// SPDX-License-Identifier: Apache-2.0
// lumen library list: the cases of a library.
#include "converters/engine/answers/library_answer.h"
#include "converters/engine/operations/operations.h"
#include "converters/library/change.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

class LibraryListCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library list"; }
  [[nodiscard]] std::string summary() const override { return "List the cases of a library"; }
  [[nodiscard]] std::string example() const override {
    return "  lumen library list siphons\n"
           "  lumen library list siphons --json | jq '.cases[].id'";
  }

  void addRows(OptionTable& table) override { table.argument("LIBRARY", &m_folder, "Library"); }

  Answer run(const RunContext& context) override {
    const convert::LibraryFile library = convert::openLibrary(m_folder);
    std::vector<std::vector<std::string>> rows = {
        {"id", "version", "vessels", "mm", "bytes", "licence", "title"}};
    Json cases = Json::array();
    for (const convert::LibraryEntry& entry : library.cases) {
      context.progress.check();
      const convert::CaseRecord record = convert::openRecord(m_folder, entry);
      cases.push_back(caseLineJson(record, entry.bytes));
      rows.push_back({record.id, std::to_string(record.version),
                      std::to_string(record.figures.branches - record.figures.aneurysms),
                      fixedText(record.figures.length, 1), shownBytes(entry.bytes),
                      record.about.licence, record.about.title});
    }
    Json json = librarySummary(library);
    json["cases"] = std::move(cases);
    return {std::move(json),
            formats::printable(library.title) + ", revision " + std::to_string(library.revision) +
                " of " + library.date + ", " + counted(library.cases.size(), "case", "cases") +
                "\n" + (library.cases.empty() ? "" : alignColumns(std::move(rows))),
            0, true};
  }

private:
  std::string m_folder;
};

}  // namespace

std::unique_ptr<Command> makeLibraryListCommand() {
  return std::make_unique<LibraryListCommand>();
}

}  // namespace lumen::engine
