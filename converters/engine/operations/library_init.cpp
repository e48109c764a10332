// SPDX-License-Identifier: Apache-2.0
// lumen library init: a library without cases.
#include "converters/engine/about_options.h"
#include "converters/engine/answers/library_answer.h"
#include "converters/engine/operations/operations.h"
#include "converters/library/change.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

class LibraryInitCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library init"; }
  [[nodiscard]] std::string summary() const override { return "Make a library without cases"; }
  [[nodiscard]] std::string example() const override {
    return "  lumen library init siphons --title \"Carotid siphons\" --publisher \"A hospital\" "
           "--licence CC-BY-4.0";
  }

  void addRows(OptionTable& table) override {
    table.argument("LIBRARY", &m_folder, "Folder to make; it may not exist, or must be empty");
    table.add("title", &m_library.title, "TEXT", "Title")
        .required()
        .checkedBy(checkTextLength(1, 255));
    table
        .add("licence", &m_library.licence, "SPDX",
             "Licence of the library's own files, and of cases that state none: an SPDX expression "
             "such as CC-BY-4.0")
        .required()
        .checkedBy(licence());
    table.add("description", &m_library.description, "TEXT", "Description")
        .checkedBy(checkTextLength(0, 4096));
    table.add("publisher", &m_library.publisher, "TEXT", "Publisher")
        .checkedBy(checkTextLength(0, 255));
    table.add("id", &m_library.id, "UUID", "The library's id [a random one]").checkedBy(uuidText());
    addDayRow(table, m_library.date);
  }

  Answer run(const RunContext& /*context*/) override {
    if (m_library.id.empty()) m_library.id = convert::newLibraryId();
    m_library.date = revisionDay(m_library.date);
    convert::makeLibrary(m_folder, m_library);
    Json json = librarySummary(convert::openLibrary(m_folder));
    json["gone"] = Json::array();
    json["updated"] = Json::array();
    json["origin"] = nullptr;
    return {std::move(json),
            formats::printable(m_folder) + ": a library without cases, " + m_library.id + "\n"};
  }

private:
  std::string m_folder;
  convert::LibraryFile m_library;
};

}  // namespace

std::unique_ptr<Command> makeLibraryInitCommand() {
  return std::make_unique<LibraryInitCommand>();
}

}  // namespace lumen::engine
