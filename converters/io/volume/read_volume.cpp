// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/read_volume.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <system_error>
#include <utility>

#include "converters/io/volume/image_file.h"
#include "converters/io/volume/nifti_file.h"
#include "converters/io/volume/read_dicom.h"
#include "converters/io/volume/stated_geometry.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

Volume read(const fs::path& path, VolumeFormat format, const ReadVolumeOptions& options,
            const Progress& progress) {
  switch (format) {
    case VolumeFormat::Dicom:
      return readDicom(path, options, progress);
    case VolumeFormat::Nifti:
      return readNifti(path, options, progress);
    case VolumeFormat::Nrrd:
    case VolumeFormat::MetaImage:
      break;
  }
  return readImageFile(path, format, options, progress);
}

VolumeHeader readHeader(const fs::path& path, VolumeFormat format, const ReadVolumeOptions& options,
                        const Progress& progress) {
  switch (format) {
    case VolumeFormat::Dicom:
      return readDicomHeader(path, options, progress);
    case VolumeFormat::Nifti:
      return readNiftiHeader(path, options, progress);
    case VolumeFormat::Nrrd:
    case VolumeFormat::MetaImage:
      break;
  }
  return readImageFileHeader(path, format, options, progress);
}

/// Throws unless there is a folder for DICOM, and a file for another format.
void checkPlace(const fs::path& path, VolumeFormat format, const std::string& series) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) throw invalidInput(path.string() + ": no such file or directory");
  const bool folder = fs::is_directory(path, ignored);
  if (format == VolumeFormat::Dicom && !folder)
    throw invalidInput(path.string() +
                       ": this is a file; a DICOM series is read from the folder that holds it");
  if (format != VolumeFormat::Dicom && folder)
    throw invalidInput(path.string() + ": this is a folder; expected a file");
  if (!folder && !fs::is_regular_file(path, ignored))
    throw invalidInput(path.string() + ": this is a device or a pipe; expected a file");
  if (!folder && !series.empty())
    throw invalidInput(path.string() +
                       ": is a file; a series can be chosen in a DICOM directory only");
}

/// Refuses values that are not finite, and a volume in which nothing can be found.
template <class T>
void checkValues(const std::vector<T>& voxels, const fs::path& path) {
  if constexpr (std::is_floating_point_v<T>) {
    const auto bad =
        std::count_if(voxels.begin(), voxels.end(), [](T v) { return !std::isfinite(v); });
    if (bad > 0)
      throw invalidInput(path.string() + ": " + std::to_string(bad) +
                         " of its voxels are not finite; expected numbers within a float's range");
  }
  const bool constant = std::all_of(voxels.begin(), voxels.end(),
                                    [&](T v) { return !(v < voxels[0]) && !(v > voxels[0]); });
  if (constant) {
    std::ostringstream text;
    text << path.string() << ": every voxel is " << +voxels[0]
         << "; expected an image with vessels in it";
    throw invalidInput(text.str());
  }
}

template <class T>
std::vector<T> cropped(const std::vector<T>& from, const std::array<int, 3>& size,
                       const IndexBox& box) {
  const auto at = [](int v) { return static_cast<std::size_t>(v); };
  std::vector<T> to;
  to.reserve(at(box.high[0] - box.low[0] + 1) * at(box.high[1] - box.low[1] + 1) *
             at(box.high[2] - box.low[2] + 1));
  for (int k = box.low[2]; k <= box.high[2]; ++k)
    for (int j = box.low[1]; j <= box.high[1]; ++j) {
      const T* row = from.data() + (at(k) * at(size[1]) + at(j)) * at(size[0]);
      to.insert(to.end(), row + box.low[0], row + box.high[0] + 1);
    }
  return to;
}

void crop(Volume& volume, const IndexBox& box, const fs::path& path) {
  const std::array<int, 3> size = volume.geometry.size;
  cropGeometry(volume.geometry, box, path);
  std::visit([&](auto& voxels) { voxels = cropped(voxels, size, box); }, volume.voxels);
}

}  // namespace

VolumeHeader readVolumeHeader(const fs::path& path, VolumeFormat format,
                              const ReadVolumeOptions& options, const Progress& progress) {
  checkPlace(path, format, options.series);
  progress.check();
  VolumeHeader header = readHeader(path, format, options, progress);
  if (options.crop) cropGeometry(header.geometry, *options.crop, path);
  return header;
}

Volume readVolume(const fs::path& path, VolumeFormat format, const ReadVolumeOptions& options,
                  const Progress& progress) {
  checkPlace(path, format, options.series);
  progress.check();
  Volume volume = read(path, format, options, progress);
  progress.check();
  if (options.crop) crop(volume, *options.crop, path);
  std::visit([&](const auto& voxels) { checkValues(voxels, path); }, volume.voxels);
  progress.check();
  return volume;
}

}  // namespace lumen::convert
