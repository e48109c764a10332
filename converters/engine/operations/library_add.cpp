// SPDX-License-Identifier: Apache-2.0
// lumen library add: a case, with the files made from it, into a library.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/options/option_name.h"
#include "converters/base/text.h"
#include "converters/engine/about_options.h"
#include "converters/engine/answers/library_answer.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/prepare_case.h"
#include "converters/engine/scope.h"
#include "converters/library/index/change.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

constexpr int kMostTurns = 360;

/// Whether it is a SHA-256.
bool isDigest(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

class LibraryAddCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "library add"; }
  [[nodiscard]] std::string summary() const override { return "Add a case to a library"; }
  [[nodiscard]] std::string example() const override {
    return "  lumen library add siphons head.lumen --title \"Left carotid siphon\" --laterality "
           "left "
           "--modality XA \\\n"
           "      --consent \"Written consent\" --deidentification \"Only the case is given away\" "
           "--export sofa\n"
           "  lumen library add siphons better.lumen --id siphon-01 --replace --about siphon.json\n"
           "  lumen library add phantoms tube.lumen --synthetic --turntable 36";
  }

  void addRows(OptionTable& table) override {
    table.argument("LIBRARY", &m_library, "Library, as lumen library init makes it");
    table.argument("CASE", &m_case, "Case to add");
    table
        .add(kOption.id.name, &m_wishes.id, "NAME",
             "The case's id, which must not identify a patient [case- and a part of its digest]")
        .checkedBy(caseIdText());
    table.flag(kOption.replace.name, m_wishes.replace,
               "Replace the case with this id; statements, exports, pages, pictures and files that "
               "are not named again stay, made anew from the new case");
    table.flag("only", m_isOnly, "Keep nothing of the replaced case but what is named")
        .onlyWith(kOption.replace.name);
    addDayRow(table, m_day);
    addAboutRows(table, m_about);
    addFileRows(table);
  }

  Answer run(const RunContext& context) override {
    const convert::LibraryFile before = convert::openLibrary(m_library);
    const std::string day = revisionDay(m_day);
    if (!m_wishes.id.empty() && !m_wishes.replace) convert::requireNewId(before, m_wishes.id);
    const std::filesystem::path library = std::filesystem::canonical(m_library);
    requireInScope(*context.table, {}, context.progress);
    const convert::CaseAbout known = completeWishes(library, *context.table);
    const convert::IncomingCase incoming = prepareCase(
        m_case, statedAbout(m_about, known, before.licence), m_wishes, library, context);
    convert::LibraryChange change(library, context.progress);
    if (!m_wishes.replace) convert::requireNewId(change.library(), incoming.record.id);
    change.addOrReplace(incoming.record, incoming.folder());
    change.commit(day);
    return report(incoming.record, change);
  }

private:
  void addFileRows(OptionTable& table) {
    table.group("Files beside the case");
    table.flag("no-surface", m_noSurface, "Leave out the closed surface, surface.glb");
    std::vector<std::string> views = pictureViews();
    views.emplace_back("none");
    table
        .add("picture", &m_views, "WORD",
             "A picture from this side, or none; may be repeated: " + alternatives(views))
        .among(views)
        .many()
        .defaults("anterior");
    table.add("turntable", &m_wishes.turntable, "N", "Pictures around the case; 0: none")
        .in(WholeRange{0, kMostTurns});
    table
        .add("export", &m_wishes.targets, "NAME",
             "The folder of a target of lumen export; may be repeated")
        .many();
    table.flag("report", m_wishes.report, "The page of lumen report, report.html");
    table.flag("viewer", m_wishes.viewer,
               "The page of lumen view as one file, view.html: about 1 MB and the case");
    table.add("file", &m_wishes.files, "FILE", "Extra file to include; may be repeated")
        .checkedBy(fileName())
        .many();
    table
        .add("recipe", &m_wishes.recipe, "ID",
             "Digest of all that the case was made from, which the record keeps")
        .checkedBy([](const std::string& text) {
          return isDigest(text) ? std::string()
                                : "found " + formats::printable(text) +
                                      ", expected a SHA-256 of 64 hexadecimal digits";
        });
  }

  /// Adds to the wishes the parts that stay of a replaced case, and returns the statements about
  /// it.
  convert::CaseAbout completeWishes(const std::filesystem::path& library,
                                    const OptionTable& table) {
    m_wishes.surface = !m_noSurface;
    const bool hasViews = m_views != std::vector<std::string>{"none"};
    if (hasViews && std::find(m_views.begin(), m_views.end(), "none") != m_views.end())
      throw Error(ErrorKind::Usage,
                  "--picture: found none and another word, expected none alone, or sides");
    if (hasViews) m_wishes.views = m_views;
    m_wishes.areViewsAsked = !m_wishes.views.empty();
    std::optional<convert::CaseRecord> before;
    if (m_wishes.replace && m_wishes.id.empty()) m_wishes.id = idOfCase(m_case);
    if (m_wishes.replace && !m_isOnly) before = replacedVersion(library, m_wishes.id);
    if (before) keepWishes(*before, library, hasViews, !table.find("turntable")->isGiven, m_wishes);
    if (!before && m_views.empty()) m_wishes.views = {"anterior"};
    return before ? before->about : convert::CaseAbout();
  }

  [[nodiscard]] Answer report(const convert::CaseRecord& record,
                              const convert::LibraryChange& change) const {
    const convert::LibraryFile& library = change.library();
    const convert::LibraryEntry& entry = *convert::findCase(library, record.id);
    Json json = {{"id", entry.id},
                 {"version", entry.version},
                 {"title", entry.title},
                 {"revision", library.revision},
                 {"bytes", entry.bytes}};
    json["files"] = Json::array();
    for (const convert::RecordedFile& file : record.files)
      json["files"].push_back({{"path", file.path}, {"role", file.role}, {"bytes", file.bytes}});
    json["gone"] = change.gone();
    return {std::move(json), formats::printable(m_library) + ": " + entry.id + ", version " +
                                 std::to_string(entry.version) + ": " +
                                 counted(entry.files, "file", "files") + ", " +
                                 shownBytes(entry.bytes) + "\n" + goneText(change.gone())};
  }

  std::string m_library, m_case, m_day;
  AboutArguments m_about;
  CaseWishes m_wishes;
  std::vector<std::string> m_views;
  bool m_noSurface = false, m_isOnly = false;
};

}  // namespace

std::unique_ptr<Command> makeLibraryAddCommand() {
  return std::make_unique<LibraryAddCommand>();
}

}  // namespace lumen::engine
