// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/series_choice.h"

#include <algorithm>
#include <span>
#include <utility>

#include "formats/container/printable.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/packs/pack.h"

namespace lumen::viewer {

namespace {

using formats::printable;

constexpr std::size_t kMostFaults = 50;  // of files, in the state

Json seriesJson(const convert::DicomSeries& series) {
  const bool isSound = series.fault.empty();
  return {{"description", printable(series.description)},
          {"modality", printable(series.modality)},
          {"files", series.files},
          {"size", series.size},
          {"spacing_mm", isSound ? engine::vectorJson(series.spacing) : Json(nullptr)},
          {"fault", isSound ? Json(nullptr) : Json(printable(series.fault))}};
}

[[noreturn]] void refuseEnded() {
  throw Conflict("files of another page have come meanwhile; drop these again");
}

}  // namespace

std::string seriesLabel(const convert::DicomSeries& series, std::size_t number) {
  return series.description.empty() ? "series " + std::to_string(number + 1)
                                    : printable(series.description);
}

void SeriesChoice::take(std::int64_t batch, const std::string& name, std::uint64_t bytes,
                        std::uint64_t mostBytes, const std::function<std::string()>& read) {
  {
    const std::lock_guard lock(m_mutex);
    if (m_ended.contains(batch)) refuseEnded();
    Batch& own = m_batches[batch];
    own.last = ++m_taken;
    if (!own.files) own.files = std::make_shared<DroppedFiles>();
    if (own.count == kMostFiles)
      refuse("a series is chosen among at most " + std::to_string(kMostFiles) + " files");
    if (bytes > mostBytes || own.bytes > mostBytes - bytes)
      refuse("files of DICOM may have " + std::to_string(mostBytes) +
             " bytes in all; name their folder on the command line");
    makeRoom(bytes, mostBytes);
    ++own.count;
    own.bytes += bytes;
  }
  std::string body = read();
  const std::lock_guard lock(m_mutex);
  const auto own = m_batches.find(batch);
  if (own == m_batches.end()) refuseEnded();
  own->second.files->add(name, std::move(body));
}

void SeriesChoice::makeRoom(std::uint64_t bytes, std::uint64_t mostBytes) {
  const auto isFull = [&] {
    std::uint64_t sum = bytes;
    for (const auto& [number, one] : m_batches) sum += one.bytes;
    return m_batches.size() > kMostBatches || sum > mostBytes;
  };
  while (isFull() && m_batches.size() > 1) {
    const auto quietest = std::min_element(
        m_batches.begin(), m_batches.end(),
        [](const auto& a, const auto& b) { return a.second.last < b.second.last; });
    m_ended.insert(quietest->first);
    m_batches.erase(quietest);
  }
}

std::shared_ptr<const DroppedFiles> SeriesChoice::end(std::int64_t batch) {
  const std::lock_guard lock(m_mutex);
  if (m_ended.contains(batch)) refuseEnded();
  const auto own = m_batches.find(batch);
  if (own == m_batches.end()) refuse("no files of that number have come");
  const std::shared_ptr<const DroppedFiles> files = std::move(own->second.files);
  m_batches.erase(own);
  return files;
}

void SeriesChoice::offer(Opening folder, convert::DicomListing listing) {
  const std::lock_guard lock(m_mutex);
  m_folder = std::move(folder);
  m_listing = std::move(listing);
  ++m_revision;
}

Opening SeriesChoice::opening(const Arguments& request, const char* name) const {
  const std::lock_guard lock(m_mutex);
  if (request.whole("of") != static_cast<std::int64_t>(m_revision))
    throw Conflict("another folder is listed meanwhile; look, and choose again");
  const std::uint32_t index = request.index(name, m_listing.series.size());
  Opening opening = m_folder;
  opening.label = seriesLabel(m_listing.series[index], index);
  opening.series = m_listing.series[index].uid;
  return opening;
}

Json SeriesChoice::json() const {
  const std::lock_guard lock(m_mutex);
  if (m_folder.file.path().empty()) return nullptr;
  Json list = Json::array(), faults = Json::array();
  for (const convert::DicomSeries& series : m_listing.series) list.push_back(seriesJson(series));
  for (std::size_t i = 0; i < std::min(m_listing.faults.size(), kMostFaults); ++i)
    faults.push_back(printable(m_listing.faults[i]));
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
