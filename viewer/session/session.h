// SPDX-License-Identifier: Apache-2.0
// The document that pages look at and work on, and what is done to it. See viewer/README.md.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/progress.h"
#include "converters/cli/options.h"
#include "converters/stages/tracking/tracking_volume.h"
#include "formats/case/atomic_file.h"
#include "viewer/session/arguments.h"
#include "viewer/session/document.h"
#include "viewer/session/events.h"
#include "viewer/session/history.h"
#include "viewer/session/job_runner.h"
#include "viewer/session/library.h"
#include "viewer/session/opening.h"
#include "viewer/session/surfaces.h"
#include "viewer/session/unsaved_files.h"
#include "viewer/session/volume_pack.h"

namespace lumen::viewer {

/// What was asked for does not go with what has happened meanwhile.
class Conflict : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// What work is done with, as on the command line.
struct SessionOptions {
  app::VolumeArguments volume;
  app::TrackArguments track;
  app::FitArguments fit;
};

/// Bytes with a name: `tag` differs where the bytes do.
struct Tagged {
  std::string tag;
  std::shared_ptr<const std::string> bytes;
};

/// All calls are thread-safe. Throws lumen::Error for what the page did wrong or a stage refused,
/// and Conflict.
class Session {
public:
  explicit Session(SessionOptions options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // session_files.cpp
  /// Opens a file that the user has named, before anything else is done, or one that was dropped.
  void open(const Opening& opening, Progress& progress);
  /// `save` writes here from now on.
  void saveTo(const std::filesystem::path& file);
  /// `save` has nowhere to write, so pages download; what is not saved is kept as if it came from `place`.
  void saveNowhere(const std::filesystem::path& place);
  /// A place for the bytes of a file that is dropped, in a private folder that goes with this
  /// object. `name` is a label; of it, only harmless letters are used.
  std::filesystem::path placeFor(const std::string& name);
  /// Opens a file that was dropped, as a job. It is removed after that.
  Json openDropped(const std::filesystem::path& file, const std::string& label, bool asTruth);
  /// Looks whether files have changed on disk, and tells.
  void lookAtFiles();

  // session_unsaved.cpp
  /// Writes what has not been saved beside where it would be saved, unless it is there already, and
  /// removes what has been saved since. Gives the files that there are.
  std::vector<std::string> keepUnsaved();
  /// Looks for what an earlier program has left so, which the page offers from then on; the files.
  std::vector<std::string> findUnsaved();

  // session_library.cpp
  /// The page chooses among these cases. Once, before anything else is done.
  void openLibrary(CaseList list);
  /// Its JSON. Empty `bytes` if there is none.
  [[nodiscard]] Tagged library() const;

  // session_state.cpp
  [[nodiscard]] Json state();
  EventHub& events() { return m_events; }

  // session_parts.cpp. Empty `bytes` if there is no such part.
  Tagged casePack(Progress& progress);
  Tagged caseFile();
  Tagged surfacePack(int level, bool quick);
  /// The surface of that level, once it has been made. Throws Error(Cancelled).
  Tagged finishedSurface(int level, const Progress& progress);
  Tagged meshPack(int id);
  Tagged distancePack(int level, bool quick, Progress& progress);
  std::shared_ptr<const VolumePack> volumePack(std::string& tag);
  [[nodiscard]] Moment now() const { return m_history.now(); }

  // session_work.cpp
  /// Does what the page asks for: {"revision"} or {"job"}.
  Json run(formats::JsonValue request);
  Json snap(formats::JsonValue request);
  bool cancel(int job) { return m_jobs.cancel(job); }
  void cancelAll();
  [[nodiscard]] bool isBusy() const { return m_jobs.running().has_value(); }
  /// Until no job runs.
  void wait() { m_jobs.wait(); }

  // session_saving.cpp
  /// The case, its mesh, its centerline or the seeds as a file of that format, as `lumen convert`
  /// with these options would write it: pairs of a name without hyphens, and a value.
  std::string encoded(const std::string& format,
                      const std::vector<std::pair<std::string, std::string>>& options,
                      Progress& progress);
  [[nodiscard]] bool unsaved() const;

private:
  void changed();
  [[nodiscard]] Moment momentFor(const Arguments& request) const;
  void commit(const std::string& name, const Moment& from, Document document);
  Json startJob(const std::string& name, bool changes, JobRunner::Work work);
  void requireIdle() const;
  /// Whether the case and the seeds have changed since they were read or saved.
  [[nodiscard]] std::pair<bool, bool> unsavedParts() const;
  std::string shownText(std::string_view message) const;

  /// The volume as tracking and snapping take it; it is made once.
  std::shared_ptr<const convert::TrackingVolume> trackingVolume(const Document& document,
                                                                const Seeds& clicks,
                                                                Progress& progress);
  void tellDropped(const std::vector<std::string>& arrays);

  Json seedOperation(const std::string& op, const Arguments& request, const Moment& from);
  Json editOperation(const std::string& op, const Arguments& request, const Moment& from);
  Json track(const Arguments& request, const Moment& from);
  Json fit(const Moment& from);
  Json check(const Moment& from);
  Json compare(const Moment& from);
  Json save(const Arguments& request);
  Json step(bool forward);
  Json openCase(const Arguments& request);
  Json reload(const Arguments& request, const Moment& from);
  Json recover(const Arguments& request, const Moment& from);
  Json forget(const Arguments& request);
  /// Where the document would be saved.
  [[nodiscard]] std::filesystem::path savingPlace(const Document& document) const;
  /// The file that `save` writes, or none: not that of a case that another, dropped one has replaced. Call it
  /// with the mutex held.
  [[nodiscard]] std::filesystem::path saveTarget(const Document& document) const;
  [[nodiscard]] std::filesystem::path leftBehind(const Arguments& request) const;

  const SessionOptions m_options;
  EventHub m_events;
  History m_history;
  std::unique_ptr<formats::PendingFolder> m_folder;  ///< of dropped files

  mutable std::mutex m_mutex;  ///< guards what follows
  int m_lastFile = 0, m_lastDropped = 0;
  bool m_jobChanges = false;  ///< the job that runs will change the document
  std::filesystem::path m_saveTo;
  std::filesystem::path m_keepAt;  ///< where m_saveTo is empty
  FileStamp m_saveStamp;
  std::shared_ptr<const formats::Case> m_savedCase;
  std::shared_ptr<const Seeds> m_savedSeeds;
  std::set<int> m_changedFiles;
  std::vector<std::filesystem::path> m_leftBehind;  ///< by an earlier program
  std::optional<std::size_t> m_openCase;            ///< of the library
  Json m_check, m_figures;                          ///< null, or answers for the next two
  std::shared_ptr<const formats::Case> m_checkedCase, m_comparedCase, m_comparedTruth;
  std::shared_ptr<const formats::Case> m_packedCase;
  Tagged m_casePack, m_caseFile;
  std::shared_ptr<const convert::Volume> m_packedVolume;
  std::shared_ptr<const VolumePack> m_volumePack;

  std::mutex m_unsavedMutex;  ///< guards the next; taken before the other
  UnsavedFiles m_unsaved;

  std::mutex m_trackingMutex;  ///< guards the next three
  std::shared_ptr<const convert::TrackingVolume> m_tracking;
  std::shared_ptr<const convert::Volume> m_trackedVolume;
  formats::Step m_trackStep;

  Surfaces m_surfaces;
  std::unique_ptr<Library> m_library;
  JobRunner m_jobs;  ///< the last, so the first to end
};

}  // namespace lumen::viewer
