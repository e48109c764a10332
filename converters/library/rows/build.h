// SPDX-License-Identifier: Apache-2.0
// Making the cases of a list, each by commands of lumen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "converters/base/options/operation.h"
#include "converters/base/progress.h"
#include "converters/library/rows/build_list.h"

namespace lumen::convert {

/// Parts of a build, which may run on machines of their own.
enum class BuildPhase : std::uint8_t {
  All,     ///< make the cases, and put them into the library
  Make,    ///< leave them in the folder for work
  Collect  ///< put those that are there into the library, and make none
};

struct BuildOptions {
  /// Does an operation, and appends its messages to a file. Throws Error(Cancelled).
  std::function<OperationEnd(const Operation&, const std::filesystem::path& log)> run;
  std::string version;         ///< version of lumen: another one makes every case again
  std::filesystem::path work;  ///< where rows are made; a run continues another's files
  int jobs = 1;                ///< rows at once
  /// Profile of lumen check: cases of volumes that it does not pass stay out of the library; empty:
  /// all go in.
  std::string profile;
  std::set<std::string>
      checkOptions;  ///< names of the options of a row that lumen check takes, too
  std::function<bool(const BuildRow&)> isVolume;  ///< whether the row's case can be checked
  std::set<std::string> accepted;                 ///< ids of cases that go in whatever the verdict
  std::string day;                                ///< YYYY-MM-DD: of the revisions that come of it
  BuildPhase phase = BuildPhase::All;
  bool isResumed = false;  ///< cases that the library has by their ids stay, whatever their inputs
  std::string place;       ///< machine and process, for notes on rows
};

/// State of a row; one that buildLibrary() returns is one of the last four.
enum class RowState : std::uint8_t {
  Waiting,      ///< nobody has begun it
  Running,      ///< a process makes it now
  Interrupted,  ///< the process that made it ended before the row did
  Made,         ///< in this run; or its case lies in the folder for work
  Kept,         ///< its case is in the library
  Failed,
  NeedsPerson  ///< its case waits in the folder for work for a person's look
};

/// "waiting", "running", "interrupted", "made", "kept", "failed", "needs a person".
const char* rowWord(RowState state);

/// Outcome of a row.
struct RowResult {
  std::size_t line = 0;  ///< its first line in the list
  std::string id;
  RowState state = RowState::Failed;
  double seconds = 0;
  int code = 0;     ///< exit code of the command that failed
  std::string why;  ///< its message
  std::size_t warnings = 0;
  std::filesystem::path log;      ///< standard error of the row's commands, where it failed
  std::vector<std::string> view;  ///< words that open the viewer, where a person is needed
};

/// Makes the folder for work, and marks one that it made, or found empty, as lumen's own. Throws
/// Error(Failed).
void claimWorkFolder(const std::filesystem::path& folder);

/// Removes a folder for work that is marked, with everything in it. A folder without the mark is
/// somebody's, and stays.
void removeWorkFolder(const std::filesystem::path& folder);

/// Makes every row whose recipe is not that of the case in the library, and puts it there, as far as
/// `options.phase` goes; cases are put into the library in batches, each atomic. A row that fails, or
/// needs a person, is passed over; the case of the latter waits in the folder for work, where its
/// corrections count. Each row leaves a note in that folder (row_note.h). Results are in the order
/// of the list. Throws Error(Cancelled), after which the next run uses the rows made by then;
/// Error(Failed) where neither the library nor the folder for work can be written.
std::vector<RowResult> buildLibrary(const std::vector<BuildRow>& rows,
                                    const std::filesystem::path& library,
                                    const BuildOptions& options, Progress& progress);

}  // namespace lumen::convert
