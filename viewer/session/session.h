// SPDX-License-Identifier: Apache-2.0
// A session of the viewer: the document that pages look at and work on, and the parts that are kept
// about it. See viewer/README.md.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "viewer/session/document/arguments.h"
#include "viewer/session/document/dropped_files.h"
#include "viewer/session/document/encoded_document.h"
#include "viewer/session/document/history.h"
#include "viewer/session/document/saving.h"
#include "viewer/session/document/unsaved_work.h"
#include "viewer/session/document_packs.h"
#include "viewer/session/events.h"
#include "viewer/session/findings.h"
#include "viewer/session/job_runner.h"
#include "viewer/session/library.h"
#include "viewer/session/opening.h"
#include "viewer/session/series_choice.h"
#include "viewer/session/surfaces.h"
#include "viewer/session/vessel_tracking.h"

namespace lumen::viewer {

/// Its parts know nothing of one another, and each guards itself. All calls are thread-safe. They
/// throw lumen::Error for a mistake of the page or a refusal by a stage, and Conflict.
class Session {
public:
  explicit Session(SessionOptions settings);
  /// Cancels the running work and waits for its end.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Opens a file that the user has named, which cannot be undone and comes before pages ask for
  /// anything; or one that a page has dropped.
  void open(const Opening& opening, Progress& progress);
  /// Lets pages choose among the series of a folder of DICOM that the user has named. False for a
  /// folder of one series, or none. Only before pages ask for anything.
  bool offerSeries(const std::filesystem::path& folder, Progress& progress);
  /// Pages choose among these cases. Once, before any other call.
  void openLibrary(CaseList list);

  /// Runs the operation that a page asks for (viewer/README.md): {"revision"} or {"job"}. Takes
  /// requests one at a time: no other comes between the look at the document and the change of it,
  /// or the start of the job that will change it.
  Json run(formats::JsonValue request);
  /// Opens a dropped file as a job: {"job"}. `name` is a label; `isFirst` as in Opening.
  Json openDropped(const std::string& name, std::string bytes, OpenAs as, bool isFirst);
  /// The vessel near a click.
  Json vesselAtClick(formats::JsonValue request);
  void cancelAll();
  /// With one thread (SessionOptions): runs the job that waits, or else makes a surface that is
  /// wanted. False if there is neither.
  bool work() { return jobs.runWaiting() || surfaces.makeNext(); }

  [[nodiscard]] Moment now() const { return history.now(); }
  /// The state as pages get it (viewer/README.md).
  [[nodiscard]] Json state() const;
  // Parts of the document for pages. Empty `bytes` if there is no such part.
  Tagged surfacePack(int level, bool quick);
  /// The surface of that level, once it is made. Throws Error(Cancelled).
  Tagged finishedSurface(int level, Progress& progress);
  Tagged distancePack(int level, bool quick, Progress& progress);

  /// Looks whether files have changed on disk; pages get the state if the answer is another one.
  void lookAtFiles();
  [[nodiscard]] bool hasUnsaved() const { return saving.unsaved(now().document).any(); }
  /// Writes copies of unsaved parts, removes those of saved ones, and returns the copies.
  std::vector<std::string> keepUnsaved();
  /// Looks for copies of an earlier program, which the state lists from then on.
  std::vector<std::string> findUnsaved();

  // For operations.

  /// Sends the state to every page, and shows the surfaces of the document as it is now.
  void announce();
  void announceState() { events.send("state", state()); }
  void sendMessage(const char* severity, const std::string& sentence);
  /// Warns of node arrays that were dropped, as their values at new nodes are unknown.
  void warnOfDropped(const std::vector<std::string>& arrays);
  /// Throws Conflict if the document has changed since `from`.
  void requireNow(const Moment& from) const;
  /// Makes `document` the present one, as the change `name`, and returns {"revision"}. `hold` is then
  /// handed the document, and notes which parts of it files hold. Throws Conflict if the document has
  /// changed since `from`.
  Json commit(const std::string& name, const Moment& from, Document document,
              const std::function<void(const Document&)>& hold = {});
  Json startJob(const std::string& name, bool changes, JobRunner::Work work) {
    return {{"job", jobs.start(name, changes, std::move(work))}};
  }
  [[nodiscard]] Json revision() const { return {{"revision", now().revision}}; }
  /// The number of a file that is opened.
  int nextFile() { return ++lastFile; }

  const SessionOptions options;
  /// Held while the document and what `saving` knows of it change together, and while it is saved;
  /// the parts' own mutexes are taken within it.
  std::mutex swapping;
  EventHub events;
  History history;
  SeriesChoice series;
  Saving saving{options.unnamed};
  UnsavedWork unsavedWork;
  ChangedFiles changedFiles;
  Findings findings;
  DocumentPacks packs;
  TrackingCache tracking;
  Library library;
  std::atomic<int> lastFile{0};
  Surfaces surfaces;
  JobRunner jobs;  ///< the last, so the first to end

private:
  std::mutex m_gate;  ///< held while a request is taken, not while its job runs
};

}  // namespace lumen::viewer
