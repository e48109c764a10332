// SPDX-License-Identifier: Apache-2.0
// A folder of DICOM, of whose series a page chooses one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "converters/io/volume/dicom/dicom_series.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/dropped_files.h"
#include "viewer/session/opening.h"
#include "viewer/session/packs/pack.h"

namespace lumen::viewer {

/// Takes files that are dropped one after the other, and keeps the listing of a folder until
/// another one comes. All calls are thread-safe.
class SeriesChoice {
public:
  static constexpr std::size_t kMostFiles = 20000;  ///< limit: of one batch
  static constexpr std::size_t kMostBatches = 8;    ///< limit: of pages that send at one time

  /// Takes one more file of the batch with that number; another number begins a new batch beside it.
  /// `name` is a label; `read` gives its bytes, at most `bytes`. Batches have `mostBytes` in all: the
  /// one that has waited longest for a file ends where they have more, or are more than kMostBatches.
  /// Throws Error(Usage) for more than `mostBytes` in a batch, or more than kMostFiles, Conflict for
  /// a batch that has ended for others, and as `read`.
  void take(std::int64_t batch, const std::string& name, std::uint64_t bytes,
            std::uint64_t mostBytes, const std::function<std::string()>& read);
  /// The files of that batch, which ends. Throws Error(Usage) if there is none, and Conflict if it
  /// has ended for others.
  std::shared_ptr<const DroppedFiles> end(std::int64_t batch);

  /// Pages choose among these series of `folder` from now on.
  void offer(Opening folder, convert::DicomListing listing);
  void clear() { offer({"", {}}, {}); }
  /// How to open a series of the listing whose revision is `of` in the request. Throws Error(Usage) if
  /// there is none, and Conflict if the listing is another one.
  [[nodiscard]] Opening opening(const Arguments& request, const char* name) const;

  /// The listing as the state has it (viewer/README.md); null if there is none.
  [[nodiscard]] Json json() const;
  [[nodiscard]] std::uint64_t revision() const;
  /// The pack `series_picture`; empty if there is none.
  [[nodiscard]] Tagged picture(std::size_t index) const;

private:
  /// Files that a page has sent.
  struct Batch {
    std::shared_ptr<DroppedFiles> files;
    std::size_t count = 0;
    std::uint64_t bytes = 0, last = 0;  ///< `last`: the number of its last file among all
  };
  /// Ends batches but that of the last file until `bytes` more fit.
  void makeRoom(std::uint64_t bytes, std::uint64_t mostBytes);

  mutable std::mutex m_mutex;  ///< guards all that follow
  std::map<std::int64_t, Batch> m_batches;
  std::set<std::int64_t> m_ended;
  std::uint64_t m_taken = 0, m_revision = 0;
  Opening m_folder{"", {}};  ///< without a name: there is none
  convert::DicomListing m_listing;
};

/// The name of a series for people.
std::string seriesLabel(const convert::DicomSeries& series, std::size_t number);

}  // namespace lumen::viewer
