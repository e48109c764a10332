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
  if (folders.size() == 1 && (*folders.begin() == "." || *folders.begin() == "..")) return {};
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

/// The names of the series that are images rather than segmentations of images, if there are any.
std::vector<std::string> imagesIn(const DicomFolder& folder) {
  std::vector<std::string> images, all;
  for (const auto& [name, files] : folder.series) {
    all.push_back(name);
    if (files[0].labels == DicomLabels::None) images.push_back(name);
  }
  return images.empty() ? all : images;
}

/// The volumes that one series of this name was divided into; empty if it was not.
std::vector<std::string> volumesOf(const DicomFolder& folder, const std::string& uid) {
  std::vector<std::string> volumes;
  for (const auto& [name, files] : folder.series)
    if (name.starts_with(uid + ", volume ")) volumes.push_back(name);
  return volumes;
}

[[noreturn]] void refuseChoice(const DicomFolder& folder, const std::vector<std::string>& volumes,
                               const ReadVolumeOptions& options, const InputFile& place) {
  throw invalidInput(
      place.path().string() + ": holds " + std::to_string(folder.series.size()) +
      " DICOM series; choose one with " + options.word("series") + ", by number or UID" +
      (volumes.size() == folder.series.size() ? ", or with " + options.word("volume-index") +
                                                    " 0 to " + std::to_string(volumes.size() - 1)
                                              : std::string()) +
      ":" + listing(folder, place));
}

/// The volume of the index that the options state, among those of the only series, or of the named one.
std::string chooseVolume(const DicomFolder& folder, const ReadVolumeOptions& options,
                         const InputFile& place) {
  const std::vector<std::string> images = imagesIn(folder);
  const std::string uid =
      options.series.empty() ? images[0].substr(0, images[0].find(", volume ")) : options.series;
  const std::vector<std::string> volumes = volumesOf(folder, uid);
  if (volumes.empty() || (options.series.empty() && volumes.size() != images.size()))
    throw invalidInput(place.path().string() + ": holds no series of several volumes alone; " +
                       options.word("volume-index") +
                       " is for those; it holds:" + listing(folder, place));
  const auto index = static_cast<std::size_t>(std::max(0, *options.volumeIndex));
  if (index >= volumes.size())
    throw invalidInput(place.path().string() + ": has no volume " + std::to_string(index) +
                       "; expected " + options.word("volume-index") + " 0 to " +
                       std::to_string(volumes.size() - 1));
  return volumes[index];
}

std::string chooseSeries(const DicomFolder& folder, const ReadVolumeOptions& options,
                         const InputFile& place) {
  const std::string path = place.path().string();
  const std::string& wanted = options.series;
  const auto& series = folder.series;
  if (series.empty() && !folder.faulty.empty()) throw *folder.faulty[0].fault;
  if (series.empty())
    throw invalidInput(path +
                       ": holds no DICOM images, and no folder below it does; lumen batch "
                       "takes a folder of other volumes" +
                       (folder.structures.empty()
                            ? ""
                            : "; " + printable(folder.structures[0].path().filename().string()) +
                                  " is a structure set, which is read if it is given itself"));
  if (options.volumeIndex) return chooseVolume(folder, options, place);
  if (wanted.empty()) {
    const std::vector<std::string> images = imagesIn(folder);
    if (images.size() == 1) return images[0];
    refuseChoice(folder, volumesOf(folder, images[0].substr(0, images[0].find(", volume "))),
                 options, place);
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
std::vector<InputFile> filesBelow(const InputFile& input, const Progress& progress, bool isFlat) {
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
    if (entry->is_directory(ignored) &&
        (isFlat || entry->path().filename().string().starts_with('.')))
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

InputFile folderOf(const InputFile& file) {
  const fs::path folder = file.path().parent_path();
  return InputFile(folder.empty() ? fs::path(".") : folder);
}

DicomFolder scanDicomFolder(const InputFile& folder, const Progress& progress, bool isFlat) {
  DicomFolder found;
  for (const InputFile& file : filesBelow(folder, progress, isFlat)) {
    progress.check();
    DicomScan scan = scanDicom(file);
    if (scan.fault)
      found.faulty.push_back(std::move(scan));
    else if (scan.image)
      found.series[scan.series].push_back(std::move(*scan.image));
    else {
      found.others.push_back(file);
      if (scan.storage == kDicomStructures) found.structures.push_back(file);
    }
  }
  dividePhases(found, progress);
  return found;
}

namespace {

/// Images of `found` by the options. `place`: the input, for messages.
DicomChoice choiceFrom(DicomFolder found, const InputFile& place,
                       const ReadVolumeOptions& options) {
  const std::string uid = chooseSeries(found, options, place);
  DicomChoice choice;
  const std::set<fs::path> folders = foldersOf(found.series[uid], place);
  for (const DicomScan& scan : found.faulty) {
    const bool isOfOther =
        !scan.series.empty() && scan.series != uid && !uid.starts_with(scan.series + ", volume ");
    if (isOfOther || (scan.series.empty() && !folders.contains(placeOf(scan.file, place))))
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

/// The meaning of a file that is no folder.
DicomChoice choiceOf(const InputFile& file, const ReadVolumeOptions& options,
                     const Progress& progress) {
  DicomScan scan = scanDicom(file);
  if (scan.fault) throw *scan.fault;
  if (scan.storage == kDicomDirectory && !file.isInMemory())
    return choiceFrom(scanDicomFolder(folderOf(file), progress), folderOf(file), options);
  if (!scan.image)
    throw invalidInput(file.path().string() +
                       (scan.storage.empty()
                            ? ": is no file of DICOM; expected one, or a folder of a series"
                            : ": has no pixels, and is of the storage class \"" +
                                  printable(scan.storage) +
                                  "\" (0002,0002); expected images, a segmentation or a structure "
                                  "set"));
  const bool isWhole =
      scan.image->frames > 1 || scan.image->labels != DicomLabels::None || file.isInMemory();
  if (isWhole) {
    DicomFolder one;
    one.series[scan.series].push_back(std::move(*scan.image));
    dividePhases(one, progress);
    return choiceFrom(std::move(one), file, options);
  }
  DicomFolder found = scanDicomFolder(folderOf(file), progress, true);
  std::erase_if(found.series, [&](const auto& entry) {
    return entry.first != scan.series && !entry.first.starts_with(scan.series + ", volume ");
  });
  return choiceFrom(std::move(found), folderOf(file), options);
}

}  // namespace

DicomChoice findDicomSeries(const InputFile& input, const ReadVolumeOptions& options,
                            const Progress& progress) {
  return input.isFolder() ? choiceFrom(scanDicomFolder(input, progress), input, options)
                          : choiceOf(input, options, progress);
}

}  // namespace lumen::convert
