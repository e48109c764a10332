// SPDX-License-Identifier: Apache-2.0
// The open document and the parts that a session keeps about it.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
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
#include "viewer/session/series_choice.h"
#include "viewer/session/surfaces.h"
#include "viewer/session/vessel_tracking.h"

namespace lumen::viewer {

/// Parts that know nothing of one another, each of which guards itself; several operations share
/// the functions. All calls are thread-safe.
struct Workspace {
  explicit Workspace(SessionOptions options);
  ~Workspace() { end(); }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  /// Ends all background work for good.
  void end();

  /// The state as pages get it (viewer/README.md).
  [[nodiscard]] Json state() const;
  /// Sends the state to every page, and shows the surfaces of the document as it is now.
  void announce();
  void announceState() { events.send("state", state()); }
  void sendMessage(const char* severity, const std::string& sentence);
  /// Warns of node arrays that were dropped, as their values at new nodes are unknown.
  void warnOfDropped(const std::vector<std::string>& arrays);
  /// A message as a page may read it: printable, without paths of temporary files.
  [[nodiscard]] std::string shownText(std::string_view message) const;

  /// The document as the page saw it. Throws Conflict if it has changed since.
  [[nodiscard]] Moment momentFor(const Arguments& request) const;
  /// Throws Conflict if the document has changed since `from`.
  void requireNow(const Moment& from) const;
  /// Makes `document` the present one, as the change `name`. `hold` is then handed the document,
  /// and notes which parts of it files hold. Throws Conflict if the document has changed since
  /// `from`.
  void commit(const std::string& name, const Moment& from, Document document,
              const std::function<void(const Document&)>& hold = {});
  Json startJob(const std::string& name, bool changes, JobRunner::Work work);
  [[nodiscard]] Json revision() const { return {{"revision", history.now().revision}}; }

  /// The number of a file that is opened.
  int nextFile() { return ++lastFile; }
  [[nodiscard]] bool hasUnsaved() const { return saving.unsaved(history.now().document).any(); }
  /// Writes copies of unsaved parts and removes those of saved ones; returns the copies.
  std::vector<std::string> keepUnsaved();
  /// Looks for copies of an earlier program, which the state lists from then on.
  std::vector<std::string> findUnsaved();

  const SessionOptions options;
  /// Held while the document and what `saving` knows of it change together, and while it is saved;
  /// the parts' own mutexes are taken within it.
  std::mutex swapping;
  EventHub events;
  History history;
  DroppedFiles dropped;
  SeriesChoice series{dropped};
  Saving saving{options.unnamed};
  UnsavedWork unsavedWork;
  ChangedFiles changedFiles;
  Findings findings;
  DocumentPacks packs;
  TrackingCache tracking;
  OpenLibrary library;
  std::atomic<int> lastFile{0};
  Surfaces surfaces;
  JobRunner jobs;  ///< the last, so the first to end
};

}  // namespace lumen::viewer
