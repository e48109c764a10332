// SPDX-License-Identifier: Apache-2.0
// lumen library update: other statements about cases of a library, whose files stay.
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "converters/base/error.h"
#include "converters/engine/about_options.h"
#include "converters/engine/answers/library_answer.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/prepare_case.h"
#include "converters/library/change.h"
#include "converters/library/incoming_case.h"
#include "converters/library/revision_files.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

namespace fs = std::filesystem;

constexpr const char* kReportPage = "report.html";

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
    convert::openLibrary(m_library);
    requireStatements(*context.table);
    const fs::path library = fs::canonical(m_library);
    convert::LibraryChange change(library, context.progress);
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
    Json json = librarySummary(library);
    json["gone"] = change.gone();
    json["origin"] = nullptr;
    json["updated"] = updated;
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

}  // namespace

std::unique_ptr<Command> makeLibraryUpdateCommand() {
  return std::make_unique<LibraryUpdateCommand>();
}

}  // namespace lumen::engine
