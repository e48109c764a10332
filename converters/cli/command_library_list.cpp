// SPDX-License-Identifier: Apache-2.0
// lumen library list: what is in a library.
#include "converters/cli/command.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/library_report.h"
#include "converters/library/change.h"
#include "formats/container/printable.h"

namespace lumen::app {

namespace {

class LibraryListCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library list"; }
  [[nodiscard]] std::string summary() const override { return "Tell what is in a library"; }
  [[nodiscard]] std::string example() const override {
    return "  lumen library list siphons\n"
           "  lumen library list siphons --json | jq '.cases[].id'";
  }

  void bind(CLI::App& app) override { addFile(app, "LIBRARY", m_folder, "Library"); }

  int run(Context& context) override {
    const convert::LibraryFile library = convert::openLibrary(m_folder);
    std::vector<std::vector<std::string>> rows = {
        {"id", "version", "vessels", "mm", "bytes", "licence", "title"}};
    Json cases = Json::array();
    for (const convert::LibraryEntry& entry : library.cases) {
      context.progress.check();
      const convert::CaseRecord record = convert::openRecord(m_folder, entry);
      if (context.common.json)
        cases.push_back(caseLineJson(record, entry.bytes));
      else
        rows.push_back({record.id, std::to_string(record.version),
                        std::to_string(record.figures.branches - record.figures.aneurysms),
                        fixed(record.figures.length, 1), bytesText(entry.bytes),
                        record.about.licence, record.about.title});
    }
    if (context.common.json) {
      Json json = librarySummary(library);
      json["cases"] = std::move(cases);
      answerJson(json);
    } else {
      answer(formats::printable(library.title) + ", revision " + std::to_string(library.revision) +
             " of " + library.date + ", " + counted(library.cases.size(), "case", "cases") + "\n" +
             (library.cases.empty() ? "" : alignColumns(std::move(rows))));
    }
    return 0;
  }

private:
  std::string m_folder;
};

}  // namespace

std::unique_ptr<Command> makeLibraryListCommand() {
  return std::make_unique<LibraryListCommand>();
}

}  // namespace lumen::app
