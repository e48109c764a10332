// SPDX-License-Identifier: Apache-2.0
// Operations on files: open, read again, close, save, recover.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "converters/base/progress.h"
#include "viewer/session/opening.h"
#include "viewer/session/workspace.h"

namespace lumen::viewer {

/// Reading is a job and answers {"job"}; the others answer {"revision"}. Each throws Error(Usage)
/// for a request that does not fit, and Conflict. One call at a time, but `open`.
class FileOperations {
public:
  explicit FileOperations(Workspace& workspace) : m_workspace(workspace) {}

  /// Opens a file that the user has named, which cannot be undone, or a dropped one.
  void open(const Opening& opening, Progress& progress);
  /// Lets pages choose among the series of a folder of DICOM that the user has named. False for a
  /// folder of one series, or none.
  bool offerSeries(const std::filesystem::path& folder, Progress& progress);
  /// Looks through dropped files of DICOM: opens their only series, or lets pages choose.
  Json listSeries(const Arguments& request);
  /// One of the listed series, as the volume or as the second one.
  Json openSeries(const Arguments& request);
  Json closeSeries();
  Json openDropped(std::shared_ptr<const DroppedFile> file, const std::string& label, OpenAs as);
  /// Opens a case of the library in place of all that is open.
  Json openCase(const Arguments& request);
  Json reload(const Arguments& request, const Moment& from);
  Json close(const Arguments& request, const Moment& from);
  Json save(const Arguments& request, const Moment& from);
  /// Takes the unsaved work of an earlier program, or removes it.
  Json recover(const Arguments& request, const Moment& from);
  Json forget(const Arguments& request);

private:
  std::string openOnlySeries(SeriesFolder folder, OpenAs as, Progress& progress);
  std::string openListed(std::size_t index, Progress& progress);
  void reloadFile(const OpenFile& file, const Moment& from, Progress& progress);
  [[nodiscard]] std::filesystem::path foundCopy(const Arguments& request) const;

  Workspace& m_workspace;
};

}  // namespace lumen::viewer
