// SPDX-License-Identifier: Apache-2.0
// Commands that make, change and show a library: init, update, remove, extract, list, index.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/engine/about_options.h"
#include "converters/engine/answers/library_answer.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/prepare_case.h"
#include "converters/library/index/change.h"
#include "converters/library/site/site.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

namespace fs = std::filesystem;

constexpr const char* kReportPage = "report.html";

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
    return {changeJson(convert::openLibrary(m_folder)),
            formats::printable(m_folder) + ": a library without cases, " + m_library.id + "\n"};
  }

private:
  std::string m_folder;
  convert::LibraryFile m_library;
};

class LibraryUpdateCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library update"; }
  [[nodiscard]] std::string summary() const override {
    return "Change the statements about cases of a library";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen library update siphons siphon-01 --title \"Right carotid siphon\" --laterality "
           "right\n"
           "  lumen library update siphons siphon-01 siphon-02 --doi \"\"      # takes it away";
  }

  void addRows(OptionTable& table) override {
    table.argument("LIBRARY", &m_library, "Library");
    table.argument("ID", &m_ids, "Cases to change", caseIdText()).many();
    addDayRow(table, m_day);
    addAboutRows(table, m_about);
  }

  Answer run(const RunContext& context) override {
    const std::string day = revisionDay(m_day);
    requireStatements(*context.table);
    convert::LibraryChange change(m_library, context.progress);
    const fs::path library = fs::canonical(m_library);
    std::vector<convert::IncomingCase> kept;  // until the change is committed
    kept.reserve(m_ids.size());
    std::vector<std::string> updated;
    for (const std::string& id : std::set(m_ids.begin(), m_ids.end())) {
      convert::CaseRecord record =
          convert::openRecord(library, convert::requireCase(change.library(), id));
      const convert::CaseAbout about = newAbout(record, *context.table);
      if (about == record.about) continue;
      warnOfPersonsIn(about, context.progress);
      const bool isTitled = about.title != record.about.title;
      record.about = about;
      kept.push_back(withFiles(record, library, isTitled, context));
      change.addOrReplace(kept.back().record, kept.back().folder());
      updated.push_back(id);
    }
    if (!updated.empty()) change.commit(day);
    return report(change, updated);
  }

private:
  /// Refuses a command that states nothing.
  static void requireStatements(const OptionTable& table) {
    const auto& rows = table.rows();
    const bool isStated = std::any_of(rows.begin(), rows.end(), [](const OptionRow& row) {
      return row.isGiven && !row.isArgument && row.group == kStatementsGroup;
    });
    if (!isStated)
      throw Error(ErrorKind::Usage,
                  "there is nothing to change: expected a statement, such as --title TEXT");
  }

  [[nodiscard]] convert::CaseAbout newAbout(const convert::CaseRecord& record,
                                            const OptionTable& table) const {
    convert::CaseAbout about = statedAbout(m_about, record.about, "");
    clearEmptied(table, about);
    if (about.title.empty()) about.title = defaultTitle(about, record.id);
    return about;
  }

  /// The case with its files as they are; a report, which shows the title, is made anew for another
  /// one.
  static convert::IncomingCase withFiles(const convert::CaseRecord& record, const fs::path& library,
                                         bool isTitled, const RunContext& context) {
    const fs::path data = library / convert::kPayload / record.id;
    convert::IncomingCase incoming(library);
    incoming.record = record;
    incoming.record.files.clear();
    bool hasReport = false;
    for (const convert::RecordedFile& file : record.files) {
      if (isTitled && file.path == kReportPage) {
        hasReport = true;
        continue;
      }
      const fs::path target = incoming.folder() / file.path;
      fs::create_directories(target.parent_path());
      convert::linkFile(data / file.path, target);
      incoming.record.files.push_back(file);
    }
    if (hasReport) addReportPage(data / convert::kCaseFile, incoming, context);
    return incoming;
  }

  [[nodiscard]] Answer report(const convert::LibraryChange& change,
                              const std::vector<std::string>& updated) const {
    const convert::LibraryFile& library = change.library();
    Json json = changeJson(library, change.gone(), updated);
    const std::string name = formats::printable(m_library) + ": ";
    if (updated.empty()) return {std::move(json), name + "every statement is there already\n"};
    std::string list;
    for (const std::string& id : updated)
      list += (list.empty() ? "" : "; ") + id + ", version " +
              std::to_string(convert::findCase(library, id)->version);
    return {std::move(json), name + list + "\n" + goneText(change.gone())};
  }

  std::string m_library, m_day;
  std::vector<std::string> m_ids;
  AboutArguments m_about;
};

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
    convert::LibraryChange change(m_library, context.progress);
    for (const std::string& id : m_ids) change.remove(id);
    change.commit(day);
    return {changeJson(change.library(), change.gone()),
            formats::printable(m_library) + ": " +
                counted(change.library().cases.size(), "case", "cases") + " left\n" +
                goneText(change.gone())};
  }

private:
  std::string m_library, m_day;
  std::vector<std::string> m_ids;
};

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
    Json json = changeJson(made);
    json["origin"] = {{"id", made.origin->id},
                      {"revision", made.origin->revision},
                      {"sha256", made.origin->sha256}};
    return {std::move(json), formats::printable(m_target) + ": " +
                                 counted(made.cases.size(), "case", "cases") + ", " + made.id +
                                 ", from revision " + std::to_string(made.origin->revision) +
                                 " of " + made.origin->id + "\n"};
  }

private:
  std::string m_source, m_target, m_title, m_id, m_day;
  std::vector<std::string> m_cases;
};

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

class LibraryIndexCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library index"; }
  [[nodiscard]] std::string summary() const override {
    return "Write the pages of a library, for people with a browser";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen library index siphons && xdg-open siphons/index.html\n"
           "  rsync -a siphons/ publisher.example:/srv/www/siphons/";
  }
  void addRows(OptionTable& table) override {
    table.argument("LIBRARY", &m_library,
                   "Folder of the library, in which index.html and site/ are made anew");
  }
  Answer run(const RunContext& context) override {
    const std::filesystem::path first = std::filesystem::path(m_library) / "index.html";
    const convert::SiteReport site = convert::writeSite(m_library, context.progress);
    return {Json{{"cases", site.cases}, {"pages", site.pages}, {"bytes", site.bytes}},
            formats::printable(first.string()) + ": " + counted(site.cases, "case", "cases") +
                ", " + counted(site.pages, "page", "pages") + "\n"};
  }

private:
  std::string m_library;
};

}  // namespace

std::unique_ptr<Command> makeLibraryInitCommand() {
  return std::make_unique<LibraryInitCommand>();
}

std::unique_ptr<Command> makeLibraryUpdateCommand() {
  return std::make_unique<LibraryUpdateCommand>();
}

std::unique_ptr<Command> makeLibraryRemoveCommand() {
  return std::make_unique<LibraryRemoveCommand>();
}

std::unique_ptr<Command> makeLibraryExtractCommand() {
  return std::make_unique<LibraryExtractCommand>();
}

std::unique_ptr<Command> makeLibraryListCommand() {
  return std::make_unique<LibraryListCommand>();
}

std::unique_ptr<Command> makeLibraryIndexCommand() {
  return std::make_unique<LibraryIndexCommand>();
}

}  // namespace lumen::engine
