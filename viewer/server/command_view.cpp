// SPDX-License-Identifier: Apache-2.0
// lumen view: the viewer, as a page that this program serves.
#include "viewer/server/command_view.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/state_folder.h"
#include "converters/base/warning.h"
#include "converters/engine/file_access.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/library/index/change.h"
#include "formats/container/printable.h"
#include "viewer/routes/html_page.h"
#include "viewer/server/browser.h"
#include "viewer/server/server.h"
#include "viewer/server/serverless.h"
#include "viewer/session/free_memory.h"
#include "viewer/session/source_match.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kCancelCheckInterval{100};  // most delay of Ctrl-C
constexpr std::chrono::seconds kFileCheckInterval{1};  // between two looks at the files on disk
constexpr std::chrono::seconds kBackupInterval{5};     // between two copies of unsaved work
constexpr std::chrono::seconds kIdleTimeout{60};       // a page that is loaded again takes seconds

class ViewCommand : public engine::Command {
public:
  [[nodiscard]] std::string name() const override { return "view"; }
  [[nodiscard]] std::string summary() const override {
    return "See, click and correct: a page in the browser, or as one file";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen view head.nrrd head.lumen\n"
           "  lumen view ct.nrrd head.lumen mr.nii.gz\n"
           "  lumen view ct.nrrd chest.lumen --label-map labels.nii.gz\n"
           "  lumen view cases/\n"
           "  lumen view heart.lumen --time 0.3\n"
           "  lumen view siphons --case siphon-01\n"
           "  lumen view head.lumen --html head.html\n"
           "  lumen view --serverless site\n"
           "It ends with Ctrl-C, or when the last page has been gone for a minute; both are a "
           "normal "
           "end, with exit code 0.";
  }

  void addRows(OptionTable& table) override {
    OptionRow& files = table.argument(
        "FILE", &m_files,
        "Volumes, cases, seeds, centerlines and meshes, in any order; of two cases the second is "
        "the truth. A second volume is seen over or beside the first, for which options of volumes "
        "count. A case that is not there yet, beside a volume, is where the page saves. A "
        "folder "
        "of DICOM is a volume; of several series the page chooses one. Or one folder of cases, "
        "among "
        "which the page chooses");
    files.isRequired = false;
    files.many();
    table.add(
        "case", &m_case, "ID",
        "The first FILE is a library that lumen library made: open this case of it, which the page "
        "saves elsewhere");
    table
        .add(
            "at", &m_at, "X,Y,Z",
            "Place at which the page looks first, mm, LPS [the widest vessel]; a first minus needs "
            "an equals sign: --at=-3,1,2")
        .checkedBy(engine::placeFault);
    engine::addTimeRow(table, m_options.time).help =
        "Time of the case's motion that the page shows first, s; without it, the case at rest";
    table.flag("no-browser", m_noBrowser, "Print the address only, and open no browser")
        .without("html");
    table.flag("keep", m_keep, "Go on when the last page has been gone for a minute")
        .without("html");
    table.add("port", &m_port, "N", "Port of 127.0.0.1 to listen on; 0: any that is free")
        .in(WholeRange{0, 65535})
        .without("html");
    table.file("html", m_html, "Write the page as one file, and serve nothing");
    table
        .flag("html-volume", m_htmlVolume,
              "With --html: the volume too, around the case and with 8 bits a voxel")
        .onlyWith("html");
    table
        .flag("html-points", m_htmlPoints,
              "With --html: the wall points too, which are most of a case")
        .onlyWith("html");
    table.file("serverless", m_serverless,
               "Write the page with the engine as a folder of static files, which any web server "
               "can hold, and serve nothing: a visitor's files stay in the browser. It may not "
               "exist, or must be empty");
    engine::addVolumeRows(table, m_options.volume);
    engine::addLabelMapRows(table, m_options.labels);
    table.find("label-map")->without("html");
    for (OptionRow& row : table.rows())
      if (!row.isArgument && row.name != "serverless") row.notBeside("serverless");
  }

  engine::Answer run(const engine::RunContext& context) override {
    if (!m_serverless.empty()) return writeSite(context);
    findCaseOfLibrary();
    engine::requireInScope(*context.table, {contentOfFiles(), kAnyContent, filesText(), {}},
                           context.progress);
    if (!m_html.empty()) engine::requireWritable(m_html, convert::ContentKind::Other);
    if (const auto folder = stateFolder()) m_options.unnamed = *folder / "lumen";
    if (!m_at.empty()) m_options.look = engine::placeIn(m_at);
    returnLargeBlocks();
    Session session(m_options);
    if (!openFolder(session)) openFiles(session, context);
    requireMotion(session, context);
    warnOfUnsaved(session, context);
    if (!m_html.empty()) return writeHtml(session, context);
    return serve(session, context);
  }

private:
  /// Puts the case of a library in its place. Throws Error(InvalidInput) for a folder that is no
  /// library, Error(Usage) for a case that it lacks.
  void findCaseOfLibrary() {
    if (m_case.empty()) return;
    if (m_files.empty()) throw Error(ErrorKind::Usage, "--case needs a library as the first FILE");
    std::string& file = m_files.front();
    const convert::LibraryFile library = convert::openLibrary(file);
    file = (fs::path(file) / convert::kPayload / convert::requireCase(library, m_case).id /
            convert::kCaseFile)
               .string();
  }

  /// Whether the file is the case of a library, which the page saves elsewhere.
  [[nodiscard]] bool isOfLibrary(const std::string& file) const {
    return !m_case.empty() && file == m_files.front();
  }

  /// A file's name for people.
  [[nodiscard]] std::string labelOf(const std::string& file) const {
    return isOfLibrary(file) ? m_case + ".lumen" : fs::path(file).filename().string();
  }

  /// Contents of the given files, as far as options depend on them.
  [[nodiscard]] ContentMask contentOfFiles() const {
    ContentMask content = engine::kFittedCase;
    if (isFolderOfCases()) return content;
    for (const std::string& file : m_files) {
      std::error_code ignored;
      if (fs::exists(file, ignored) && openingRole({file, file}) != FileRole::Seeds)
        content |= engine::inputContent(engine::inputFormat(file, ""), false);
    }
    return content;
  }

  [[nodiscard]] std::string filesText() const {
    return m_files.empty() ? "the empty page" : m_files.front();
  }

  /// One folder that holds cases; one without is a series of images.
  [[nodiscard]] bool isFolderOfCases() const {
    return m_files.size() == 1 && fs::is_directory(m_files.front()) &&
           !casesIn(m_files.front()).cases.empty();
  }

  bool openFolder(Session& session) const {
    if (!isFolderOfCases()) return false;
    if (!m_html.empty())
      throw Error(ErrorKind::Usage,
                  m_files.front() + ": --html shows one case, not a folder of them");
    session.openLibrary(casesIn(m_files.front()));
    return true;
  }

  /// Refuses a time for a case that does not move.
  void requireMotion(const Session& session, const engine::RunContext& context) const {
    if (!m_options.time) return;
    const auto value = session.now().document.value;
    if (value && value->motion) return;
    const std::string file = formats::printable(value ? caseFile() : filesText());
    engine::refuseUnused(*context.table->find("time"),
                         isFolderOfCases()
                             ? "is for one case, and " + file + " is a folder of them"
                             : "is for cases with a motion, and " + file + " has none",
                         context.progress);
  }

  /// The first case among the files.
  [[nodiscard]] std::string caseFile() const {
    const auto found = std::find_if(m_files.begin(), m_files.end(), [](const std::string& file) {
      return openingRole({file, file}) == FileRole::Case;
    });
    return found == m_files.end() ? filesText() : *found;
  }

  /// Warns of unsaved work of an earlier program.
  void warnOfUnsaved(Session& session, const engine::RunContext& context) const {
    if (!m_html.empty()) return;
    for (const std::string& file : session.findUnsaved())
      warn(context.progress,
           {WarningCode::ViewUnsaved, formats::printable(file) + " holds work that was not saved",
            "the page offers it under \"Files\""});
  }

  /// Volumes first, which seeds in voxels need, then cases.
  void openFiles(Session& session, const engine::RunContext& context) {
    const std::optional<std::string> output = newCase();
    if (m_options.labels.labelMaps.size() > 1)
      throw Error(ErrorKind::Usage, "--label-map: the page shows one label map, not several");
    for (const FileRole wanted :
         {FileRole::Volume, FileRole::Case, FileRole::Mesh, FileRole::Seeds})
      for (const std::string& file : m_files)
        if (file != output && openingRole({file, file}) == wanted &&
            !offerSeries(session, file, wanted, context))
          openOne(session, file, wanted, context);
    for (const InputFile& map : m_options.labels.labelMaps) {
      const fs::path& path = map.path();
      const fs::path name = (path.has_filename() ? path : path.parent_path()).filename();
      session.open({map, name.string(), OpenAs::Labels}, context.progress);
    }
    if (output) session.saving.saveTo(*output);
    if (const auto doubt = secondDoubt(session.now().document))
      warn(context.progress, {WarningCode::CaseOtherVolume, *doubt});
  }

  /// A folder of several series of DICOM, among which the page chooses.
  bool offerSeries(Session& session, const std::string& file, FileRole role,
                   const engine::RunContext& context) const {
    std::error_code ignored;
    return role == FileRole::Volume && m_html.empty() && m_options.volume.series.empty() &&
           fs::is_directory(file, ignored) && session.offerSeries(file, context.progress);
  }

  void openOne(Session& session, const std::string& file, FileRole role,
               const engine::RunContext& context) const {
    const OpenAs as = roleOfFurther(session.now().document, file, role);
    session.open({file, labelOf(file), as}, context.progress);
    const engine::FileFormat* format =
        role == FileRole::Case ? &engine::inputFormat(file, "") : nullptr;
    if (format != nullptr && engine::canWriteCase(*format) && as == OpenAs::Auto &&
        !isOfLibrary(file))
      session.saving.saveTo(file);
  }

  /// A second case is the truth, a second volume is seen with the first.
  [[nodiscard]] OpenAs roleOfFurther(const Document& document, const std::string& file,
                                     FileRole role) const {
    if (role == FileRole::Case && document.value) return OpenAs::Truth;
    if (role != FileRole::Volume || !document.volume) return OpenAs::Auto;
    if (!m_html.empty())
      throw Error(ErrorKind::Usage, file + ": --html shows one volume, not a second beside it");
    if (document.second)
      throw Error(ErrorKind::Usage,
                  file + ": two volumes can be seen together, and this is one more");
    return OpenAs::Second;
  }

  /// The file that is not there yet, if it can be made: a case of a volume.
  [[nodiscard]] std::optional<std::string> newCase() const {
    bool hasVolume = false, hasCase = false;
    std::optional<std::string> output;
    for (const std::string& file : m_files) {
      std::error_code ignored;
      if (fs::exists(file, ignored)) {
        const FileRole role = openingRole({file, file});
        hasVolume = hasVolume || role == FileRole::Volume;
        hasCase = hasCase || role == FileRole::Case;
      } else if (!output && (file.ends_with(".lumen") || file.ends_with(".lumen.json"))) {
        output = file;
      } else {
        engine::requireInput(file, "file");
      }
    }
    if (output && (!hasVolume || hasCase)) engine::requireInput(*output, "file");
    if (output) engine::requireWritable(*output, convert::ContentKind::Case);
    return output;
  }

  engine::Answer writeSite(const engine::RunContext& context) const {
    if (!m_files.empty())
      throw Error(ErrorKind::Usage,
                  m_files.front() +
                      ": --serverless writes the page alone, into which people drop "
                      "their files");
    engine::requireInScope(*context.table, {}, context.progress);
    const std::uint64_t bytes = writeServerless(m_serverless);
    return {{{"serverless", m_serverless}, {"bytes", bytes}},
            m_serverless + ": " + std::to_string(bytes) + " bytes; a web server makes it a page\n"};
  }

  engine::Answer writeHtml(Session& session, const engine::RunContext& context) {
    const Document document = session.now().document;
    const auto refuse = [&](const char* option, const std::string& needed) {
      const OptionRow& row = *context.table->find(option);
      if (row.isGiven)
        engine::refuseUnused(row, "is for " + needed + ", and " + filesText() + " has none",
                             context.progress);
    };
    if (!document.volume) refuse("html-volume", "a volume beside the case");
    if (!document.value || !document.value->points) refuse("html-points", "cases with wall points");
    HtmlOptions options;
    options.volume = m_htmlVolume;
    options.points = m_htmlPoints;
    const std::string page = htmlPage(session, findPageFiles(), options, context.progress);
    engine::writeText(page, m_html);
    return {{{"html", m_html}, {"bytes", page.size()}},
            m_html + ": " + std::to_string(page.size()) + " bytes\n"};
  }

  engine::Answer serve(Session& session, const engine::RunContext& context) {
    PageFiles page = findPageFiles();
    if (page.empty())
      warn(context.progress, {WarningCode::ViewBrowser,
                              "the page of the viewer was not built, so there is nothing to see",
                              "./bootstrap.sh demo builds it, with npm"});
    Server server(session, std::move(page), {m_port});
    context.answerEarly({{{"address", server.address()}}, server.address() + "\n", 0, true});
    if (!m_noBrowser && !openBrowser(server.address()))
      warn(context.progress,
           {WarningCode::ViewBrowser, "no browser could be opened", "open the address in one"});
    waitForEnd(session, context);
    // first: a job that cannot be cancelled may outlast the grace of an interrupt
    session.keepUnsaved();
    session.cancelAll();
    session.jobs.wait();
    server.stop();
    for (const std::string& file : session.keepUnsaved())
      warn(context.progress,
           {WarningCode::ViewUnsaved, "unsaved work is in " + formats::printable(file)});
    return {};
  }

  /// Until Ctrl-C, or until the last page has been gone for long enough.
  void waitForEnd(Session& session, const engine::RunContext& context) const {
    Clock::time_point lastLook = Clock::now(), lastKept = lastLook;
    IdleTimeout idle(kIdleTimeout, lastLook);
    bool kept = true;
    while (!context.progress.cancelled()) {
      std::this_thread::sleep_for(kCancelCheckInterval);
      const auto now = Clock::now();
      const bool isOver =
          idle.isOver(session.events.count(), session.jobs.running().has_value(), now);
      if (isOver && !m_keep) return;
      if (now - lastLook < kFileCheckInterval) continue;
      lastLook = now;
      session.lookAtFiles();
      if (now - lastKept < kBackupInterval) continue;
      lastKept = now;
      kept = keep(session, context, kept);
    }
  }

  /// Writes copies of unsaved work; false if that failed, which is reported once.
  static bool keep(Session& session, const engine::RunContext& context, bool before) {
    try {
      session.keepUnsaved();
      return true;
    } catch (const std::exception& error) {
      if (before)
        warn(context.progress, {WarningCode::ViewUnsaved,
                                "unsaved work cannot be kept: " + std::string(error.what())});
      return false;
    }
  }

  std::vector<std::string> m_files;
  std::string m_html, m_serverless, m_case, m_at;
  bool m_noBrowser = false, m_keep = false, m_htmlVolume = false, m_htmlPoints = false;
  int m_port = 0;
  SessionOptions m_options;
};

}  // namespace

std::unique_ptr<engine::Command> makeViewCommand() {
  return std::make_unique<ViewCommand>();
}

}  // namespace lumen::viewer
