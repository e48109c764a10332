// SPDX-License-Identifier: Apache-2.0
// lumen view: the viewer, as a page that this program serves.
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "converters/base/error.h"
#include "converters/cli/command.h"
#include "converters/cli/options.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/file_access.h"
#include "converters/engine/report.h"
#include "formats/container/printable.h"
#include "viewer/server/browser.h"
#include "viewer/server/html_page.h"
#include "viewer/server/idle.h"
#include "viewer/server/server.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kTick{100};    // most delay of Ctrl-C
constexpr std::chrono::seconds kLook{1};           // between two looks at the files on disk
constexpr std::chrono::seconds kKeep{5};           // between two copies of unsaved work
constexpr std::chrono::seconds kWithoutPages{60};  // a page that is loaded again takes seconds

class ViewCommand : public app::Command {
public:
  [[nodiscard]] std::string name() const override { return "view"; }
  [[nodiscard]] std::string summary() const override {
    return "See, click and correct: a page in the browser, or as one file";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen view head.nrrd head.lumen\n"
           "  lumen view cases/\n"
           "  lumen view head.lumen --html head.html\n"
           "It ends with Ctrl-C, or when the last page has been gone for a minute; both are a "
           "normal "
           "end, with exit code 0.";
  }

  void bind(CLI::App& app) override {
    app.add_option("FILE", m_files,
                   "Volumes, cases, seeds, centerlines and meshes, in any order; of two cases the "
                   "second is the truth. A case that is not there yet, beside a volume, is where "
                   "the page saves. Or one folder of cases, among which the page chooses")
        ->type_name("")
        ->check(app::fileName());
    app.add_flag("--no-browser", m_noBrowser, "Print the address only, and open no browser");
    app.add_flag("--keep", m_keep, "Go on when the last page has been gone for a minute");
    app.add_option("--port", m_port, "Port of 127.0.0.1 to listen on; 0: any that is free")
        ->type_name("N")
        ->check(app::wholeIn(0, 65535))
        ->capture_default_str();
    app.add_option("--html", m_html, "Write the page as one file, and serve nothing")
        ->type_name("FILE")
        ->check(app::fileName());
    app.add_flag("--html-volume", m_htmlVolume,
                 "With --html: the volume too, around the case and with 8 bits a voxel");
    app.add_flag("--html-points", m_htmlPoints,
                 "With --html: the wall points too, which are most of a case");
    app::addVolumeOptions(app, m_options.volume);
  }

  int run(app::Context& context) override {
    if ((m_htmlVolume || m_htmlPoints) && m_html.empty())
      throw Error(ErrorKind::Usage, std::string(m_htmlVolume ? "--html-volume" : "--html-points") +
                                        " needs --html FILE");
    if (!m_html.empty()) app::requireWritable(m_html, app::ContentKind::Other);
    Session session(m_options);
    if (!openFolder(session)) openFiles(session, context);
    warnOfUnsaved(session, context);
    if (!m_html.empty()) return writeHtml(session, context);
    return serve(session, context);
  }

private:
  /// A folder that holds cases; one without is a series of images.
  bool openFolder(Session& session) const {
    if (m_files.size() != 1 || !fs::is_directory(m_files.front())) return false;
    CaseList list = casesIn(m_files.front());
    if (list.cases.empty()) return false;
    if (!m_html.empty())
      throw Error(ErrorKind::Usage,
                  m_files.front() + ": --html shows one case, not a folder of them");
    session.openLibrary(std::move(list));
    return true;
  }

  /// Warns of unsaved work of an earlier program.
  void warnOfUnsaved(Session& session, app::Context& context) const {
    if (!m_html.empty()) return;
    for (const std::string& file : session.findUnsaved())
      context.progress.warn(formats::printable(file) +
                            " holds work that was not saved; the page offers it under \"Files\"");
  }

  /// Volumes first, which seeds in voxels need, then cases.
  void openFiles(Session& session, app::Context& context) {
    const std::optional<std::string> output = newCase();
    for (const FileRole wanted :
         {FileRole::Volume, FileRole::Case, FileRole::Mesh, FileRole::Seeds})
      for (const std::string& file : m_files)
        if (file != output && roleOf({file, file}) == wanted)
          openOne(session, file, wanted, context);
    if (output) session.saveTo(*output);
  }

  static void openOne(Session& session, const std::string& file, FileRole role,
                      app::Context& context) {
    const bool isTruth = role == FileRole::Case && session.now().document.value != nullptr;
    session.open({file, fs::path(file).filename().string(), false, isTruth}, context.progress);
    const app::FileFormat* format = role == FileRole::Case ? &app::inputFormat(file, "") : nullptr;
    if (format != nullptr && app::canWriteCase(*format) && !isTruth) session.saveTo(file);
  }

  /// The file that is not there yet, if it can be made: a case of a volume.
  [[nodiscard]] std::optional<std::string> newCase() const {
    bool hasVolume = false, hasCase = false;
    std::optional<std::string> output;
    for (const std::string& file : m_files) {
      std::error_code ignored;
      if (fs::exists(file, ignored)) {
        const FileRole role = roleOf({file, file});
        hasVolume = hasVolume || role == FileRole::Volume;
        hasCase = hasCase || role == FileRole::Case;
      } else if (!output && (file.ends_with(".lumen") || file.ends_with(".lumen.json"))) {
        output = file;
      } else {
        app::requireInput(file, "file");
      }
    }
    if (output && (!hasVolume || hasCase)) app::requireInput(*output, "file");
    if (output) app::requireWritable(*output, app::ContentKind::Case);
    return output;
  }

  int writeHtml(Session& session, app::Context& context) {
    context.interrupts.watchOutput(m_html);
    HtmlOptions options;
    options.volume = m_htmlVolume;
    options.points = m_htmlPoints;
    const std::string page = htmlPage(session, findPageFiles(), options, context.progress);
    app::writeText(page, m_html);
    if (context.common.json)
      app::answerJson({{"html", m_html}, {"bytes", page.size()}});
    else if (!context.common.quiet)
      app::answer(m_html + ": " + std::to_string(page.size()) + " bytes\n");
    return 0;
  }

  int serve(Session& session, app::Context& context) {
    PageFiles page = findPageFiles();
    if (page.empty())
      context.progress.warn(
          "the page of the viewer was not built, so there is nothing to see; ./bootstrap.sh demo "
          "builds it, with npm");
    Server server(session, std::move(page), {m_port});
    // dropped files lie there; an interrupt removes them, too
    context.interrupts.watchOutput(fs::temp_directory_path() / "lumen-view");
    if (context.common.json)
      app::answerJson({{"address", server.address()}});
    else
      app::answer(server.address() + "\n");
    std::fflush(stdout);
    if (!m_noBrowser && !openBrowser(server.address()))
      context.progress.warn("no browser could be opened; open the address in one");
    waitForEnd(session, context);
    // first: a job that cannot be cancelled may outlast the grace of an interrupt
    session.keepUnsaved();
    session.cancelAll();
    session.wait();
    server.stop();
    for (const std::string& file : session.keepUnsaved())
      context.progress.warn("unsaved work is in " + formats::printable(file));
    return 0;
  }

  /// Until Ctrl-C, or until the last page has been gone for long enough.
  void waitForEnd(Session& session, const app::Context& context) const {
    Clock::time_point lastLook = Clock::now(), lastKept = lastLook;
    IdleEnd idle(kWithoutPages, lastLook);
    bool kept = true;
    while (!context.progress.cancelled()) {
      std::this_thread::sleep_for(kTick);
      const auto now = Clock::now();
      const bool isOver = idle.isOver(session.events().count(), session.isBusy(), now);
      if (isOver && !m_keep) return;
      if (now - lastLook < kLook) continue;
      lastLook = now;
      session.lookAtFiles();
      if (now - lastKept < kKeep) continue;
      lastKept = now;
      kept = keep(session, context, kept);
    }
  }

  /// Writes copies of unsaved work; false if that failed, which is reported once.
  static bool keep(Session& session, const app::Context& context, bool before) {
    try {
      session.keepUnsaved();
      return true;
    } catch (const std::exception& error) {
      if (before)
        context.progress.warn("unsaved work cannot be kept: " + std::string(error.what()));
      return false;
    }
  }

  std::vector<std::string> m_files;
  std::string m_html;
  bool m_noBrowser = false, m_keep = false, m_htmlVolume = false, m_htmlPoints = false;
  int m_port = 0;
  SessionOptions m_options;
};

}  // namespace

}  // namespace lumen::viewer

namespace lumen::app {

std::unique_ptr<Command> makeViewCommand() {
  return std::make_unique<viewer::ViewCommand>();
}

}  // namespace lumen::app
