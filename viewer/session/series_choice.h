// SPDX-License-Identifier: Apache-2.0
// A folder of DICOM, of whose series a page chooses one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "converters/io/volume/dicom/dicom_series.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/dropped_files.h"
#include "viewer/session/opening.h"
#include "viewer/session/packs/pack.h"

namespace lumen::viewer {

/// A folder that the user has named, or one that holds dropped files, which goes with this object.
struct SeriesFolder {
  std::filesystem::path path;
  std::string label;                        ///< for people; any text
  std::shared_ptr<const DroppedFile> kept;  ///< null for a folder that was named
};

/// Takes files that are dropped one after the other, and keeps the listing of a folder until
/// another one comes. All calls are thread-safe.
class SeriesChoice {
public:
  static constexpr std::size_t kMostFiles = 20000;  ///< limit: of one batch

  explicit SeriesChoice(DroppedFiles& dropped) : m_dropped(dropped) {}

  /// A place for one more file of the batch with that number; another number begins a new batch.
  /// `name` is a label; `bytes` its size. Throws Error(Usage) for more than `mostBytes` in a batch,
  /// or more than kMostFiles.
  std::filesystem::path placeFor(std::int64_t batch, const std::string& name, std::uint64_t bytes,
                                 std::uint64_t mostBytes);
  /// The folder of that batch, which ends. Throws Error(Usage) if there is none.
  SeriesFolder take(std::int64_t batch);

  /// Pages choose among these from now on.
  void offer(SeriesFolder folder, convert::DicomListing listing);
  void clear();
  /// How to open a series of the listing whose revision is `of` in the request. Throws Error(Usage) if
  /// there is none, and Conflict if the listing is another one.
  [[nodiscard]] Opening opening(const Arguments& request, const char* name) const;

  /// The listing as the state has it (viewer/README.md); null if there is none.
  [[nodiscard]] Json json() const;
  [[nodiscard]] std::uint64_t revision() const;
  /// The pack `seriesPicture`; empty if there is none.
  [[nodiscard]] Tagged picture(std::size_t index) const;

private:
  DroppedFiles& m_dropped;
  mutable std::mutex m_mutex;  ///< guards all that follow
  std::shared_ptr<const DroppedFile> m_batch;
  std::int64_t m_batchNumber = -1;
  std::size_t m_files = 0;
  std::uint64_t m_bytes = 0, m_revision = 0;
  SeriesFolder m_folder;
  convert::DicomListing m_listing;
};

/// The name of a series for people.
std::string seriesLabel(const convert::DicomSeries& series, std::size_t number);

}  // namespace lumen::viewer
