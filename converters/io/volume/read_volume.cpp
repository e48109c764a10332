// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/read_volume.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <istream>
#include <string>
#include <system_error>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/io/volume/image_header.h"
#include "converters/io/volume/upright_grid.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

/// Refuses an error page that a server sent instead of the file.
void refuseWebPage(const InputFile& file) {
  std::array<char, 256> head{};
  file.open()->read(head.data(), head.size() - 1);
  std::string text(head.data());
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::size_t start = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (start == std::string::npos) return;
  text.erase(0, start);
  if (text.starts_with("<!doctype html") || text.starts_with("<html"))
    throw invalidInput(file.path().string() +
                       ": is a web page (HTML), not a volume; a server may have answered the "
                       "download with a page of its own");
}

/// Throws for a folder where the format is one of files, and for what is neither.
void checkPlace(const InputFile& file, const VolumeFormat& format,
                const ReadVolumeOptions& options) {
  const fs::path& path = file.path();
  std::error_code ignored;
  if (!file.isInMemory() && !fs::exists(path, ignored))
    throw invalidInput(path.string() + ": no such file or directory");
  const bool folder = file.isFolder();
  if (!format.isFolder && folder)
    throw invalidInput(path.string() + ": this is a folder; expected a file");
  if (!folder && !file.isInMemory() && !fs::is_regular_file(path, ignored))
    throw invalidInput(path.string() + ": this is a device or a pipe; expected a file");
  if (!format.isFolder && !options.series.empty())
    throw invalidInput(path.string() + ": is a file; a series can be chosen in DICOM only");
  if (!folder) refuseWebPage(file);
}

template <class T>
std::vector<T> cropped(const std::vector<T>& from, const CellBox& whole, const CellBox& box) {
  std::vector<T> to;
  to.reserve(box.count());
  CellBox rows = box;
  rows.size[0] = 1;
  rows.forEach([&](const Cell& start) {
    const T* row = from.data() + whole.index(start);
    to.insert(to.end(), row, row + box.size[0]);
  });
  return to;
}

void crop(Volume& volume, const CellBox& box, const fs::path& path) {
  const CellBox whole = volume.geometry.cells();
  cropGeometry(volume.geometry, box, path);
  std::visit([&](auto& voxels) { voxels = cropped(voxels, whole, box); }, volume.voxels);
}

OpenVolume open(const InputFile& file, const VolumeFormat& format, const ReadVolumeOptions& options,
                const Progress& progress) {
  checkPlace(file, format, options);
  progress.check();
  OpenVolume opened = format.open(file, options, progress);
  VolumeHeader& header = opened.header;
  moveFarOrigin(header.geometry, header.assumptions);
  opened.stored = standUpright(header.geometry);
  checkGeometry(header.geometry, file.path());
  if (opened.stored)
    header.resampled +=
        (header.resampled.empty() ? "" : "; ") + uprightSentence(*opened.stored, header.geometry);
  if (!header.resampled.empty()) header.assumptions.push_back(header.resampled);
  return opened;
}

}  // namespace

VolumeHeader readVolumeHeader(const InputFile& file, const VolumeFormat& format,
                              const ReadVolumeOptions& options, const Progress& progress) {
  VolumeHeader header = open(file, format, options, progress).header;
  if (options.crop) cropGeometry(header.geometry, *options.crop, file.path());
  return header;
}

Volume readVolume(const InputFile& file, const VolumeFormat& format,
                  const ReadVolumeOptions& options, const Progress& progress) {
  OpenVolume opened = open(file, format, options, progress);
  Volume volume{opened.header.geometry, {}, std::move(opened.header.assumptions), opened.padding};
  volume.voxels = opened.readVoxels(progress, volume.assumptions);
  progress.check();
  if (opened.stored) {
    checkVoxels(volume, file.path(), options.allowsConstant);
    resampleUpright(*opened.stored, volume, progress);
  }
  if (options.crop) crop(volume, *options.crop, file.path());
  checkVoxels(volume, file.path(), options.allowsConstant);
  progress.check();
  return volume;
}

}  // namespace lumen::convert
