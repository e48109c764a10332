// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/series_choice.h"

#include <algorithm>
#include <array>
#include <span>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "formats/container/printable.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/packs/pack.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;
using formats::printable;

constexpr std::size_t kMostFaults = 50;  // of files, in the state

Json seriesJson(const convert::DicomSeries& series, const DroppedFiles& dropped) {
  const bool isSound = series.fault.empty();
  return {
      {"description", printable(series.description)},
      {"modality", printable(series.modality)},
      {"files", series.files},
      {"size", series.size},
      {"spacing", isSound ? Json({series.spacing.x(), series.spacing.y(), series.spacing.z()})
                          : Json(nullptr)},
      {"fault", isSound ? Json(nullptr) : Json(dropped.withoutFolder(printable(series.fault)))}};
}

}  // namespace

std::string seriesLabel(const convert::DicomSeries& series, std::size_t number) {
  return series.description.empty() ? "series " + std::to_string(number + 1)
                                    : printable(series.description);
}

fs::path SeriesChoice::placeFor(std::int64_t batch, const std::string& name, std::uint64_t bytes,
                                std::uint64_t mostBytes) {
  const std::lock_guard lock(m_mutex);
  if (batch != m_batchNumber || !m_batch) {
    m_batch = m_dropped.placeFor("dicom");
    m_batchNumber = batch;
    m_files = 0;
    m_bytes = 0;
  }
  if (m_files == kMostFiles)
    refuse("a series is chosen among at most " + std::to_string(kMostFiles) + " files");
  if (bytes > mostBytes || m_bytes > mostBytes - bytes)
    refuse("files of DICOM may have " + std::to_string(mostBytes) +
           " bytes in all; name their folder on the command line");
  ++m_files;
  m_bytes += bytes;
  const std::string own = harmlessName(name);
  // the place of one file is in a folder of its own, which holds all of them
  const fs::path folder = m_batch->path().parent_path();
  fs::path place = folder / own;
  // equal names come from several folders
  std::error_code ignored;
  if (fs::exists(place, ignored)) place = folder / (std::to_string(m_files) + "-" + own);
  return place;
}

SeriesFolder SeriesChoice::take(std::int64_t batch) {
  const std::lock_guard lock(m_mutex);
  if (!m_batch || batch != m_batchNumber) refuse("no files of that number have come");
  const auto folder = std::exchange(m_batch, nullptr);
  return {folder->path().parent_path(), "dropped files", folder};
}

void SeriesChoice::offer(SeriesFolder folder, convert::DicomListing listing) {
  const std::lock_guard lock(m_mutex);
  m_folder = std::move(folder);
  m_listing = std::move(listing);
  ++m_revision;
}

void SeriesChoice::clear() {
  offer({}, {});
}

Opening SeriesChoice::opening(const Arguments& request, const char* name) const {
  const std::lock_guard lock(m_mutex);
  if (request.whole("of") != static_cast<std::int64_t>(m_revision))
    throw Conflict("another folder is listed meanwhile; look, and choose again");
  const std::uint32_t index = request.index(name, m_listing.series.size());
  const convert::DicomSeries& series = m_listing.series[index];
  Opening opening{m_folder.path, seriesLabel(series, index)};
  opening.dropped = m_folder.kept != nullptr;
  opening.series = series.uid;
  opening.kept = m_folder.kept;
  return opening;
}

Json SeriesChoice::json() const {
  const std::lock_guard lock(m_mutex);
  if (m_folder.path.empty()) return nullptr;
  Json list = Json::array(), faults = Json::array();
  for (const convert::DicomSeries& series : m_listing.series)
    list.push_back(seriesJson(series, m_dropped));
  for (std::size_t i = 0; i < std::min(m_listing.faults.size(), kMostFaults); ++i)
    faults.push_back(m_dropped.withoutFolder(printable(m_listing.faults[i])));
  return {{"folder", printable(m_folder.label)},
          {"list", std::move(list)},
          {"faults", std::move(faults)},
          {"faulty", m_listing.faults.size()},
          {"others", m_listing.others}};
}

std::uint64_t SeriesChoice::revision() const {
  const std::lock_guard lock(m_mutex);
  return m_revision;
}

Tagged SeriesChoice::picture(std::size_t index) const {
  const std::lock_guard lock(m_mutex);
  if (index >= m_listing.series.size()) return {};
  const convert::GreyPicture& picture = m_listing.series[index].picture;
  if (picture.pixel.empty()) return {};
  PackWriter pack;
  pack.add("pixel", std::span(picture.pixel),
           {static_cast<std::size_t>(picture.height), static_cast<std::size_t>(picture.width)});
  return tagged(std::to_string(m_revision) + "-" + std::to_string(index), pack.bytes());
}

}  // namespace lumen::viewer
