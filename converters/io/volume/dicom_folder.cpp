// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom_folder.h"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/option_name.h"
#include "converters/base/text.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using formats::printable;

/// One line per series: number, UID, files, description, size of an image.
std::string listing(const DicomFolder& folder) {
  std::string text;
  int number = 0;
  for (const auto& [uid, images] : folder.series) {
    const DicomImage& first = images[0];
    text += "\n  " + std::to_string(++number) + ": " + printable(uid) + " (" +
            counted(images.size(), "file", "files");
    if (!first.description.empty()) text += ", " + printable(first.description);
    text += ", " + std::to_string(first.columns) + " x " + std::to_string(first.rows) + ")";
  }
  return text;
}

std::string chooseSeries(const DicomFolder& folder, const std::string& wanted,
                         const fs::path& path) {
  const auto& series = folder.series;
  if (series.empty() && !folder.faulty.empty()) throw *folder.faulty[0].fault;
  if (series.empty())
    throw invalidInput(path.string() +
                       ": holds no DICOM images (its subdirectories are not searched)");
  if (wanted.empty()) {
    if (series.size() == 1) return series.begin()->first;
    throw invalidInput(path.string() + ": holds " + std::to_string(series.size()) +
                       " DICOM series; choose one with " + kOption.series.shown() +
                       ", by number or UID:" + listing(folder));
  }
  if (series.contains(wanted)) return wanted;
  std::size_t number = 0;
  const auto* const end = wanted.data() + wanted.size();
  const auto parsed = std::from_chars(wanted.data(), end, number);
  if (parsed.ec == std::errc() && parsed.ptr == end && number >= 1 && number <= series.size())
    return std::next(series.begin(), static_cast<std::ptrdiff_t>(number) - 1)->first;
  throw invalidInput(path.string() + ": has no series \"" + wanted +
                     "\"; it holds:" + listing(folder));
}

}  // namespace

DicomFolder scanDicomFolder(const fs::path& folder, const Progress& progress) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored)) files.push_back(entry->path());
  }
  if (error) throw invalidInput(folder.string() + ": cannot be listed (" + error.message() + ")");
  std::sort(files.begin(), files.end());
  DicomFolder found;
  for (const fs::path& file : files) {
    progress.check();
    DicomScan scan = scanDicom(file);
    if (scan.fault)
      found.faulty.push_back(std::move(scan));
    else if (scan.image)
      found.series[scan.series].push_back(std::move(*scan.image));
    else
      found.others.push_back(file);
  }
  return found;
}

DicomChoice findDicomSeries(const fs::path& folder, const ReadVolumeOptions& options,
                            const Progress& progress) {
  DicomFolder found = scanDicomFolder(folder, progress);
  const std::string uid = chooseSeries(found, options.series, folder);
  DicomChoice choice;
  for (const DicomScan& scan : found.faulty) {
    if (scan.series != uid && !scan.series.empty()) continue;
    if (!options.skipFaulty) throw *scan.fault;
    // the sentence begins with the path, which may be temporary
    const std::string fault = scan.fault->what(), before = scan.file.string() + ": ";
    choice.assumptions.push_back(printable(scan.file.filename().string()) + " is left out: " +
                                 (fault.starts_with(before) ? fault.substr(before.size()) : fault));
  }
  choice.images = std::move(found.series[uid]);
  return choice;
}

}  // namespace lumen::convert
