// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/dicom_folder.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/io/volume/dicom/dicom_phases.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using formats::printable;

constexpr std::size_t kMostFiles = 500000;

/// The folder of a file, below `folder`; the folder itself is ".".
fs::path placeOf(const InputFile& file, const InputFile& folder) {
  return file.path().parent_path().lexically_relative(folder.isInMemory() ? fs::path()
                                                                          : folder.path());
}

/// Folders of a series' images, below `folder`, sorted.
std::set<fs::path> foldersOf(const std::vector<DicomImage>& images, const InputFile& folder) {
  std::set<fs::path> folders;
  for (const DicomImage& image : images) folders.insert(placeOf(image.file, folder));
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
std::string listing(const DicomFolder& folder, const InputFile& place) {
  std::string text;
  int number = 0;
  for (const auto& [uid, images] : folder.series) {
    const DicomImage& first = images[0];
    text += "\n  " + std::to_string(++number) + ": " + printable(uid) + " (" +
            counted(images.size(), "file", "files");
    for (const std::string& word : {first.modality, first.description})
      if (!word.empty()) text += ", " + printable(word);
    text += ", " + std::to_string(first.columns) + " x " + std::to_string(first.rows) +
            placeText(foldersOf(images, place)) + ")";
  }
  return text;
}

std::string chooseSeries(const DicomFolder& folder, const ReadVolumeOptions& options,
                         const InputFile& place) {
  const std::string path = place.path().string();
  const std::string& wanted = options.series;
  const auto& series = folder.series;
  if (series.empty() && !folder.faulty.empty()) throw *folder.faulty[0].fault;
  if (series.empty())
    throw invalidInput(path + ": holds no DICOM images, and no folder below it does");
  if (wanted.empty()) {
    if (series.size() == 1) return series.begin()->first;
    throw invalidInput(path + ": holds " + std::to_string(series.size()) +
                       " DICOM series; choose one with " + options.word("series") +
                       ", by number or UID:" + listing(folder, place));
  }
  if (series.contains(wanted)) return wanted;
  std::size_t number = 0;
  const auto* const end = wanted.data() + wanted.size();
  const auto parsed = std::from_chars(wanted.data(), end, number);
  if (parsed.ec == std::errc() && parsed.ptr == end && number >= 1 && number <= series.size())
    return std::next(series.begin(), static_cast<std::ptrdiff_t>(number) - 1)->first;
  throw invalidInput(path + ": has no series \"" + wanted +
                     "\"; it holds:" + listing(folder, place));
}

/// Files below a folder, sorted. A folder below it that cannot be listed is an error: a series
/// might lack slices without a word.
std::vector<InputFile> filesBelow(const InputFile& input, const Progress& progress) {
  const auto inOrder = [](std::vector<InputFile> all) {
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.path() < b.path(); });
    return all;
  };
  if (input.files() != nullptr) return inOrder(*input.files());
  const fs::path& folder = input.path();
  std::vector<InputFile> files;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    progress.check();
    std::error_code ignored;
    if (entry->is_directory(ignored) && entry->path().filename().string().starts_with('.'))
      entry.disable_recursion_pending();
    if (!entry->is_regular_file(ignored)) continue;
    files.emplace_back(entry->path());
    if (files.size() > kMostFiles)
      throw invalidInput(folder.string() + ": more than " + std::to_string(kMostFiles) +
                         " files lie below it; expected the folder of one patient's images");
  }
  if (error) throw invalidInput(folder.string() + ": cannot be listed (" + error.message() + ")");
  return inOrder(std::move(files));
}

}  // namespace

DicomFolder scanDicomFolder(const InputFile& folder, const Progress& progress) {
  DicomFolder found;
  for (const InputFile& file : filesBelow(folder, progress)) {
    progress.check();
    DicomScan scan = scanDicom(file);
    if (scan.fault)
      found.faulty.push_back(std::move(scan));
    else if (scan.image)
      found.series[scan.series].push_back(std::move(*scan.image));
    else
      found.others.push_back(file);
  }
  dividePhases(found, progress);
  return found;
}

DicomChoice findDicomSeries(const InputFile& folder, const ReadVolumeOptions& options,
                            const Progress& progress) {
  DicomFolder found = scanDicomFolder(folder, progress);
  const std::string uid = chooseSeries(found, options, folder);
  DicomChoice choice;
  const std::set<fs::path> folders = foldersOf(found.series[uid], folder);
  for (const DicomScan& scan : found.faulty) {
    const bool isOfOther =
        !scan.series.empty() && scan.series != uid && !uid.starts_with(scan.series + ", volume ");
    if (isOfOther || (scan.series.empty() && !folders.contains(placeOf(scan.file, folder))))
      continue;
    if (!options.skipFaulty) throw *scan.fault;
    // the sentence begins with the path
    const std::string fault = scan.fault->what(), before = scan.file.path().string() + ": ";
    choice.assumptions.push_back(
        printable(scan.file.path().filename().string()) +
        " is left out: " + (fault.starts_with(before) ? fault.substr(before.size()) : fault));
  }
  for (const std::string& remark : found.remarks[uid]) choice.assumptions.push_back(remark);
  choice.images = std::move(found.series[uid]);
  return choice;
}

}  // namespace lumen::convert
