// SPDX-License-Identifier: Apache-2.0
// lumen library extract: cases of a library as a library of their own.
#include "converters/engine/about_options.h"
#include "converters/engine/answers/library_answer.h"
#include "converters/engine/operations/operations.h"
#include "converters/library/change.h"
#include "formats/container/printable.h"

namespace lumen::engine {

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

  void addRows(OptionTable& table) override {
    table.argument("LIBRARY", &m_source, "Library that has the cases");
    table.argument("NEW", &m_target, "Folder to make; it may not exist, or must be empty");
    table.add("case", &m_cases, "ID", "Case to take over; may be repeated")
        .required()
        .many()
        .checkedBy(caseIdText());
    table.add("title", &m_title, "TEXT", "Title [the other library's]")
        .checkedBy(checkTextLength(1, 255));
    table.add("id", &m_id, "UUID", "The new library's id [a random one]").checkedBy(uuidText());
    addDayRow(table, m_day);
  }

  Answer run(const RunContext& context) override {
    convert::LibraryFile library = convert::openLibrary(m_source);
    library.id = m_id.empty() ? convert::newLibraryId() : m_id;
    if (!m_title.empty()) library.title = m_title;
    library.date = revisionDay(m_day);
    const convert::LibraryFile made =
        convert::extractCases(m_source, m_target, m_cases, library, context.progress);
    Json json = librarySummary(made);
    json["gone"] = Json::array();
    json["origin"] = {{"id", made.origin->id},
                      {"revision", made.origin->revision},
                      {"sha256", made.origin->sha256}};
    json["updated"] = Json::array();
    return {std::move(json), formats::printable(m_target) + ": " +
                                 counted(made.cases.size(), "case", "cases") + ", " + made.id +
                                 ", from revision " + std::to_string(made.origin->revision) +
                                 " of " + made.origin->id + "\n"};
  }

private:
  std::string m_source, m_target, m_title, m_id, m_day;
  std::vector<std::string> m_cases;
};

}  // namespace

std::unique_ptr<Command> makeLibraryExtractCommand() {
  return std::make_unique<LibraryExtractCommand>();
}

}  // namespace lumen::engine
