// SPDX-License-Identifier: Apache-2.0
// lumen library remove: cases out of a library.
#include "converters/cli/about_options.h"
#include "converters/cli/command.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/library_report.h"
#include "converters/library/change.h"
#include "formats/container/printable.h"

namespace lumen::app {

namespace {

class LibraryRemoveCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library remove"; }
  [[nodiscard]] std::string summary() const override { return "Remove cases from a library"; }
  [[nodiscard]] std::string example() const override {
    return "  lumen library remove siphons siphon-01 siphon-07";
  }

  void bind(CLI::App& app) override {
    addFile(app, "LIBRARY", m_library, "Library");
    app.add_option("ID", m_ids, "Cases to remove")->required()->check(caseIdText());
    addDayOption(app, m_day);
  }

  int run(Context& context) override {
    const std::string day = revisionDay(m_day);
    convert::openLibrary(m_library);
    const std::filesystem::path library = std::filesystem::canonical(m_library);
    context.interrupts.watchOutput(library);
    convert::LibraryChange change(library, context.progress);
    for (const std::string& id : m_ids) change.remove(id);
    change.commit(day);
    if (context.common.json) {
      Json json = librarySummary(change.library());
      json["gone"] = change.gone();
      answerJson(json);
    } else if (!context.common.quiet) {
      answer(formats::printable(m_library) + ": " +
             counted(change.library().cases.size(), "case", "cases") + " left\n" +
             goneText(change.gone()));
    }
    return 0;
  }

private:
  std::string m_library, m_day;
  std::vector<std::string> m_ids;
};

}  // namespace

std::unique_ptr<Command> makeLibraryRemoveCommand() {
  return std::make_unique<LibraryRemoveCommand>();
}

}  // namespace lumen::app
