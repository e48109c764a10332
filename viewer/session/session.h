// SPDX-License-Identifier: Apache-2.0
// A session of the viewer: the document that pages look at and work on. See viewer/README.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "viewer/session/document/encoded_document.h"
#include "viewer/session/operations.h"
#include "viewer/session/workspace.h"

namespace lumen::viewer {

/// The front of the session's parts. All calls are thread-safe. Throws lumen::Error for a mistake
/// of the page or a refusal by a stage, and Conflict.
class Session {
public:
  explicit Session(SessionOptions options) : m_workspace(std::move(options)) {}
  /// Cancels the running work and waits for its end.
  ~Session() { m_workspace.end(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Opens a file that the user has named. Only before pages ask for anything.
  void open(const Opening& opening, Progress& progress) { m_files.open(opening, progress); }
  /// Pages choose among these cases. Once, before any other call.
  void openLibrary(CaseList list);
  /// `save` writes this file from now on.
  void saveTo(const std::filesystem::path& file) { m_workspace.saving.saveTo(file); }
  /// Lets pages choose among the series of a folder of DICOM (FileOperations). Only before pages ask
  /// for anything.
  bool offerSeries(const std::filesystem::path& folder, Progress& progress) {
    return m_files.offerSeries(folder, progress);
  }
  /// A place for a dropped file of DICOM (SeriesChoice::placeFor).
  std::filesystem::path seriesPlace(std::int64_t batch, const std::string& name,
                                    std::uint64_t bytes, std::uint64_t mostBytes) {
    return m_workspace.series.placeFor(batch, name, bytes, mostBytes);
  }
  /// A place for the bytes of a file that is dropped; `name` is a label.
  std::shared_ptr<const DroppedFile> placeFor(const std::string& name) {
    return m_workspace.dropped.placeFor(name);
  }
  Json openDropped(std::shared_ptr<const DroppedFile> file, const std::string& label, OpenAs as) {
    return m_operations.openDropped(std::move(file), label, as);
  }

  /// Looks whether files have changed on disk; pages get the state if the answer is another one.
  void lookAtFiles();
  /// Writes copies of unsaved parts, removes those of saved ones, and returns the copies.
  std::vector<std::string> keepUnsaved() { return m_workspace.keepUnsaved(); }
  /// Looks for copies of an earlier program, which pages offer from then on.
  std::vector<std::string> findUnsaved() { return m_workspace.findUnsaved(); }
  [[nodiscard]] bool unsaved() const { return m_workspace.hasUnsaved(); }

  [[nodiscard]] Json state() const { return m_workspace.state(); }
  [[nodiscard]] Moment now() const { return m_workspace.history.now(); }
  EventHub& events() { return m_workspace.events; }

  // Parts of the document for pages. Empty `bytes` if there is no such part.
  [[nodiscard]] Tagged library() const { return m_workspace.library.pack(); }
  /// The tables of the last measuring, as JSON; one of them as comma-separated values.
  [[nodiscard]] Tagged measures() const { return m_workspace.findings.measures(); }
  [[nodiscard]] Tagged measures(const std::string& kind) const {
    return m_workspace.findings.measures(kind);
  }
  Tagged casePack(Progress& progress) { return m_workspace.packs.casePack(now(), progress); }
  [[nodiscard]] Tagged caseFile() const { return viewer::caseFile(now()); }
  Tagged proposalsPack(Progress& progress) { return viewer::proposalsPack(now(), progress); }
  Tagged surfacePack(int level, bool quick);
  /// The surface of that level, once it is made. Throws Error(Cancelled).
  Tagged finishedSurface(int level, const Progress& progress);
  [[nodiscard]] Tagged seriesPicture(std::size_t index) const {
    return m_workspace.series.picture(index);
  }
  [[nodiscard]] Tagged meshPack(int id) const { return viewer::meshPack(now(), id); }
  Tagged deviationPack(int id, Progress& progress) {
    return viewer::deviationPack(now(), id, progress);
  }
  Tagged distancePack(int level, bool quick, Progress& progress);
  /// `role`: Volume or Second.
  std::shared_ptr<const VolumePack> volumePack(FileRole role, std::string& tag) {
    return m_workspace.packs.volumePack(now(), role, tag);
  }
  /// The document as a file (encoded_document.h).
  std::string encoded(const std::string& format, const SavingOptions& options, Progress& progress);

  /// Runs the operation that a page asks for: {"revision"} or {"job"}.
  Json run(formats::JsonValue request) { return m_operations.run(request); }
  /// The vessel near a click.
  Json vesselAtClick(formats::JsonValue request);
  bool cancel(int job) { return m_workspace.jobs.cancel(job); }
  void cancelAll();
  [[nodiscard]] bool isBusy() const { return m_workspace.jobs.running().has_value(); }
  /// Returns when no job runs.
  void wait() { m_workspace.jobs.wait(); }

private:
  Workspace m_workspace;
  FileOperations m_files{m_workspace};
  Operations m_operations{m_workspace};
};

}  // namespace lumen::viewer
