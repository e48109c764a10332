// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/write_volume.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/sha256.h"
#include "converters/io/volume/itk_image.h"
#include "converters/io/volume/nifti_file.h"
#include "converters/io/volume/read_volume.h"
#include "formats/case/atomic_file.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

bool isConstant(const Volume& volume) {
  return std::visit(
      [](const auto& voxels) {
        return std::adjacent_find(voxels.begin(), voxels.end(), std::not_equal_to<>()) ==
               voxels.end();
      },
      volume.voxels);
}

/// True if the file holds the volume's voxels: ITK may not notice that a disk is full. Constant
/// volumes are not read back.
bool readsBack(const Volume& volume, const fs::path& file, VolumeFormat format) {
  if (isConstant(volume)) return true;
  return readVolume(file, format, {}, Progress()).voxels == volume.voxels;
}

bool writeWhole(const Volume& volume, const fs::path& file, VolumeFormat format, bool compressed,
                const fs::path& name, const VolumeNotes& notes) {
  try {
    if (format == VolumeFormat::Nifti)
      writeNifti(volume, file, compressed, name);
    else
      return writeWithItk(volume, file, format, compressed, notes) &&
             readsBack(volume, file, format);
    return true;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::Unsupported) throw;
    return false;
  }
}

/// A hidden file beside `path` that holds the volume.
formats::PendingFile pendingVolume(const Volume& volume, const fs::path& path, VolumeFormat format,
                                   bool compressed, const VolumeNotes& notes) {
  if (format == VolumeFormat::Dicom) throw unsupported(path.string() + ": DICOM is not written");
  auto pending = formats::PendingFile::beside(path);
  if (!pending) throw failed(pending.error().message);
  if (!writeWhole(volume, pending->path(), format, compressed, path, notes))
    throw failed(
        path.string() +
        ": cannot be written; is the disk full, or the size of files limited (ulimit -f)?");
  return std::move(*pending);
}

}  // namespace

std::string encodeVolume(const Volume& volume, VolumeFormat format, bool compressed,
                         const VolumeNotes& notes) {
  const char* const ending = format == VolumeFormat::Nrrd    ? "nrrd"
                             : format == VolumeFormat::Nifti ? "nii"
                                                             : "mha";
  const fs::path place = fs::temp_directory_path() / (std::string("volume.") + ending);
  const formats::PendingFile pending = pendingVolume(volume, place, format, compressed, notes);
  return readWholeFile(pending.path(), "volume");
}

void writeVolume(const Volume& volume, const fs::path& path, VolumeFormat format, bool compressed) {
  auto pending = pendingVolume(volume, path, format, compressed, {});
  if (const auto written = pending.commit(); !written) throw failed(written.error().message);
}

formats::SourceVolume describeGeometry(const VolumeGeometry& g) {
  formats::SourceVolume source;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto e = static_cast<Eigen::Index>(a);
    source.size[a] = static_cast<std::uint32_t>(g.size[a]);
    source.spacing[a] = g.spacing[e];
    source.origin[a] = g.origin[e];
    for (std::size_t c = 0; c < 3; ++c)
      source.direction[3 * a + c] = g.direction(e, static_cast<Eigen::Index>(c));
  }
  return source;
}

formats::SourceVolume describeSource(const Volume& volume) {
  formats::SourceVolume source = describeGeometry(volume.geometry);
  source.sha256 =
      std::visit([](const auto& v) { return sha256(std::as_bytes(std::span(v))); }, volume.voxels);
  return source;
}

}  // namespace lumen::convert
