// SPDX-License-Identifier: Apache-2.0
// lumen library init: a library without cases.
#include "converters/cli/about_options.h"
#include "converters/cli/command.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/library_report.h"
#include "converters/library/change.h"
#include "formats/container/printable.h"

namespace lumen::app {

namespace {

class LibraryInitCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library init"; }
  [[nodiscard]] std::string summary() const override { return "Make a library without cases"; }
  [[nodiscard]] std::string example() const override {
    return "  lumen library init siphons --title \"Carotid siphons\" --publisher \"A hospital\" "
           "--licence CC-BY-4.0";
  }

  void bind(CLI::App& app) override {
    addFile(app, "LIBRARY", m_folder, "Folder to make; it may not exist, or must be empty");
    app.add_option("--title", m_library.title, "Title")
        ->type_name("TEXT")
        ->required()
        ->check(textOf(1, 255));
    app.add_option("--licence", m_library.licence,
                   "Licence of what the library itself adds, and of cases that state none: an SPDX "
                   "expression such as CC-BY-4.0")
        ->type_name("SPDX")
        ->required()
        ->check(licence());
    app.add_option("--description", m_library.description, "Description")
        ->type_name("TEXT")
        ->check(textOf(0, 4096));
    app.add_option("--publisher", m_library.publisher, "Who publishes it")
        ->type_name("TEXT")
        ->check(textOf(0, 255));
    app.add_option("--id", m_library.id, "The library's id [a random one]")
        ->type_name("UUID")
        ->check(uuidText());
    addDayOption(app, m_library.date);
  }

  int run(Context& context) override {
    if (m_library.id.empty()) m_library.id = convert::newLibraryId();
    m_library.date = revisionDay(m_library.date);
    context.interrupts.watchOutput(m_folder);
    convert::makeLibrary(m_folder, m_library);
    if (context.common.json)
      answerJson(librarySummary(convert::openLibrary(m_folder)));
    else if (!context.common.quiet)
      answer(formats::printable(m_folder) + ": a library without cases, " + m_library.id + "\n");
    return 0;
  }

private:
  std::string m_folder;
  convert::LibraryFile m_library;
};

}  // namespace

std::unique_ptr<Command> makeLibraryInitCommand() {
  return std::make_unique<LibraryInitCommand>();
}

}  // namespace lumen::app
