// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/dicom_folder.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using formats::printable;

constexpr std::size_t kMostFiles = 500000;

/// Folders of a series' images, below `folder`, sorted; the folder itself is ".".
std::set<fs::path> foldersOf(const std::vector<DicomImage>& images, const fs::path& folder) {
  std::set<fs::path> folders;
  for (const DicomImage& image : images)
    folders.insert(image.file.parent_path().lexically_relative(folder));
  return folders;
}

/// ", in DISC/SE0 and 3 more folders"; empty for images of the folder itself.
std::string placeText(const std::set<fs::path>& folders) {
  if (folders.size() == 1 && *folders.begin() == ".") return {};
  std::string text = ", in " + printable(folders.begin()->string());
  if (folders.size() > 1)
    text += " and " + counted(folders.size() - 1, "more folder", "more folders");
  return text;
}

/// One line per series: number, UID, files, modality, description, size of an image, folder.
std::string listing(const DicomFolder& folder, const fs::path& path) {
  std::string text;
  int number = 0;
  for (const auto& [uid, images] : folder.series) {
    const DicomImage& first = images[0];
    text += "\n  " + std::to_string(++number) + ": " + printable(uid) + " (" +
            counted(images.size(), "file", "files");
    for (const std::string& word : {first.modality, first.description})
      if (!word.empty()) text += ", " + printable(word);
    text += ", " + std::to_string(first.columns) + " x " + std::to_string(first.rows) +
            placeText(foldersOf(images, path)) + ")";
  }
  return text;
}

std::string chooseSeries(const DicomFolder& folder, const ReadVolumeOptions& options,
                         const fs::path& path) {
  const std::string& wanted = options.series;
  const auto& series = folder.series;
  if (series.empty() && !folder.faulty.empty()) throw *folder.faulty[0].fault;
  if (series.empty())
    throw invalidInput(path.string() + ": holds no DICOM images, and no folder below it does");
  if (wanted.empty()) {
    if (series.size() == 1) return series.begin()->first;
    throw invalidInput(path.string() + ": holds " + std::to_string(series.size()) +
                       " DICOM series; choose one with " + options.word("series") +
                       ", by number or UID:" + listing(folder, path));
  }
  if (series.contains(wanted)) return wanted;
  std::size_t number = 0;
  const auto* const end = wanted.data() + wanted.size();
  const auto parsed = std::from_chars(wanted.data(), end, number);
  if (parsed.ec == std::errc() && parsed.ptr == end && number >= 1 && number <= series.size())
    return std::next(series.begin(), static_cast<std::ptrdiff_t>(number) - 1)->first;
  throw invalidInput(path.string() + ": has no series \"" + wanted +
                     "\"; it holds:" + listing(folder, path));
}

/// Files below a folder, sorted. A folder below it that cannot be listed is an error: a series
/// might lack slices without a word.
std::vector<fs::path> filesBelow(const fs::path& folder, const Progress& progress) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    progress.check();
    std::error_code ignored;
    if (entry->is_directory(ignored) && entry->path().filename().string().starts_with('.'))
      entry.disable_recursion_pending();
    if (!entry->is_regular_file(ignored)) continue;
    files.push_back(entry->path());
    if (files.size() > kMostFiles)
      throw invalidInput(folder.string() + ": more than " + std::to_string(kMostFiles) +
                         " files lie below it; expected the folder of one patient's images");
  }
  if (error) throw invalidInput(folder.string() + ": cannot be listed (" + error.message() + ")");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

DicomFolder scanDicomFolder(const fs::path& folder, const Progress& progress) {
  const std::vector<fs::path> files = filesBelow(folder, progress);
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
  const std::string uid = chooseSeries(found, options, folder);
  DicomChoice choice;
  const std::set<fs::path> folders = foldersOf(found.series[uid], folder);
  for (const DicomScan& scan : found.faulty) {
    const bool isOfOther = !scan.series.empty() && scan.series != uid;
    const fs::path place = scan.file.parent_path().lexically_relative(folder);
    if (isOfOther || (scan.series.empty() && !folders.contains(place))) continue;
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
