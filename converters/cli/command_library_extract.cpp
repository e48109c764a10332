// SPDX-License-Identifier: Apache-2.0
// lumen library extract: cases of a library as a library of their own.
#include "converters/cli/about_options.h"
#include "converters/cli/command.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/library_report.h"
#include "converters/library/extract.h"
#include "formats/container/printable.h"

namespace lumen::app {

namespace {

class LibraryExtractCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library extract"; }
  [[nodiscard]] std::string summary() const override {
    return "Make a new library of some cases of another, with an id of its own";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen library extract siphons for-a-friend --case siphon-01";
  }

  void bind(CLI::App& app) override {
    addFile(app, "LIBRARY", m_source, "Library that has the cases");
    addFile(app, "NEW", m_target, "Folder to make; it may not exist, or must be empty");
    app.add_option("--case", m_cases, "Case to take over; may be repeated")
        ->type_name("ID")
        ->required()
        ->allow_extra_args(false)
        ->check(caseIdText());
    app.add_option("--title", m_title, "Title [the other library's]")
        ->type_name("TEXT")
        ->check(textOf(1, 255));
    app.add_option("--id", m_id, "The new library's id [a random one]")
        ->type_name("UUID")
        ->check(uuidText());
    addDayOption(app, m_day);
  }

  int run(Context& context) override {
    convert::LibraryFile library = convert::openLibrary(m_source);
    library.id = m_id.empty() ? convert::newLibraryId() : m_id;
    if (!m_title.empty()) library.title = m_title;
    library.date = revisionDay(m_day);
    context.interrupts.watchOutput(m_target);
    const convert::LibraryFile made =
        convert::extractCases(m_source, m_target, m_cases, library, context.progress);
    if (context.common.json) {
      Json json = librarySummary(made);
      json["origin"] = {{"id", made.origin->id},
                        {"revision", made.origin->revision},
                        {"sha256", made.origin->sha256}};
      answerJson(json);
    } else if (!context.common.quiet) {
      answer(formats::printable(m_target) + ": " + counted(made.cases.size(), "case", "cases") +
             ", " + made.id + ", from revision " + std::to_string(made.origin->revision) + " of " +
             made.origin->id + "\n");
    }
    return 0;
  }

private:
  std::string m_source, m_target, m_title, m_id, m_day;
  std::vector<std::string> m_cases;
};

}  // namespace

std::unique_ptr<Command> makeLibraryExtractCommand() {
  return std::make_unique<LibraryExtractCommand>();
}

}  // namespace lumen::app
