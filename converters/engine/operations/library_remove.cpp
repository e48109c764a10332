// SPDX-License-Identifier: Apache-2.0
// lumen library remove: cases out of a library.
#include "converters/engine/about_options.h"
#include "converters/engine/answers/library_answer.h"
#include "converters/engine/operations/operations.h"
#include "converters/library/change.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

class LibraryRemoveCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library remove"; }
  [[nodiscard]] std::string summary() const override { return "Remove cases from a library"; }
  [[nodiscard]] std::string example() const override {
    return "  lumen library remove siphons siphon-01 siphon-07";
  }

  void addRows(OptionTable& table) override {
    table.argument("LIBRARY", &m_library, "Library");
    table.argument("ID", &m_ids, "Cases to remove", caseIdText()).many();
    addDayRow(table, m_day);
  }

  Answer run(const RunContext& context) override {
    const std::string day = revisionDay(m_day);
    convert::openLibrary(m_library);
    const std::filesystem::path library = std::filesystem::canonical(m_library);
    convert::LibraryChange change(library, context.progress);
    for (const std::string& id : m_ids) change.remove(id);
    change.commit(day);
    Json json = librarySummary(change.library());
    json["gone"] = change.gone();
    json["origin"] = nullptr;
    json["updated"] = Json::array();
    return {std::move(json), formats::printable(m_library) + ": " +
                                 counted(change.library().cases.size(), "case", "cases") +
                                 " left\n" + goneText(change.gone())};
  }

private:
  std::string m_library, m_day;
  std::vector<std::string> m_ids;
};

}  // namespace

std::unique_ptr<Command> makeLibraryRemoveCommand() {
  return std::make_unique<LibraryRemoveCommand>();
}

}  // namespace lumen::engine
