// SPDX-License-Identifier: Apache-2.0
// Header of NRRD, MetaImage or NIfTI, the common result of their parsers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/text.h"
#include "converters/io/volume/nifti_header.h"
#include "converters/io/volume/read_volume_options.h"
#include "converters/io/volume/stored_voxels.h"
#include "converters/io/volume/text_header.h"
#include "converters/io/volume/volume_format.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

// Names of length units in headers.

/// Millimetres of the unit `name`, such as "mm", "Metres" or "um"; empty if it is unknown.
inline std::optional<double> millimetresPer(const std::string& name) {
  static const std::map<std::string, double> known = {
      {"mm", 1},           {"millimeter", 1},   {"millimetre", 1},    {"cm", 10},
      {"centimeter", 10},  {"centimetre", 10},  {"dm", 100},          {"m", 1000},
      {"meter", 1000},     {"metre", 1000},     {"um", 1e-3},         {"\xc2\xb5m", 1e-3},
      {"\xce\xbcm", 1e-3}, {"micron", 1e-3},    {"micrometer", 1e-3}, {"micrometre", 1e-3},
      {"nm", 1e-6},        {"nanometer", 1e-6}, {"nanometre", 1e-6},  {"in", 25.4},
      {"inch", 25.4}};
  std::string word = lowerCase(trimmed(name));
  auto found = known.find(word);
  if (found == known.end() && word.size() > 4 && word.back() == 's') {
    word.pop_back();
    found = known.find(word);
  }
  if (found == known.end()) return {};
  return found->second;
}

// Conversion of a header's lengths to millimetres, with the user's statements: equal for every
// format.

/// Geometry as a header states it.
struct StatedGeometry {
  /// Lengths are in the file's unit. A spacing is NaN along an axis whose spacing is not stated.
  VolumeGeometry geometry;
  std::optional<double> unit;  ///< mm of the file's unit; empty: the header states none
  std::string unitNote;  ///< the assumption where `unit` is empty; empty: it goes without saying
  std::string placedBy;  ///< of several transforms the one that counts; empty: there is one
};

/// The geometry in mm: spacing and unit are those of the options, else of the header, else 1 mm. An
/// assumed spacing, or an implausible one in an assumed unit, appends a sentence to `assumptions`.
/// Throws Error(InvalidInput), naming `path` and the option that helps, for a spacing that is
/// stated along some axes only, or is not positive, finite and within 1e-6 to 1e4 mm, and as
/// checkGeometry() does.
VolumeGeometry settledGeometry(const StatedGeometry& stated, const ReadVolumeOptions& options,
                               const std::filesystem::path& path,
                               std::vector<std::string>& assumptions);

/// Crops `geometry` to `box`. Throws Error(InvalidInput), naming `path`, unless the box holds at
/// least two voxels along each axis and lies within the volume.
void cropGeometry(VolumeGeometry& geometry, const CellBox& box, const std::filesystem::path& path);

struct ImageHeader {
  StatedGeometry stated;
  StoredVoxels voxels;   ///< with the files that the header names, resolved and allowed
  std::string encoding;  ///< encoding in the format's own words
  std::vector<std::string> assumptions;
};

/// The volume of this header, once the geometry is settled and the files can hold the voxels.
OpenVolume openImage(ImageHeader image, const ReadVolumeOptions& options,
                     const std::filesystem::path& path);

/// The sizes along a volume's three axes, the first three of `sizes`. Throws Error(InvalidInput)
/// unless there are three, and the product of all sizes fits a file.
std::array<int, 3> volumeSize(const std::filesystem::path& path,
                              const std::vector<std::int64_t>& sizes);

/// Selects the voxels of the volume that the options choose, in a file with axes of these sizes.
/// Throws as chosenVolume() does.
void chooseVoxels(const std::filesystem::path& path, const std::vector<std::int64_t>& sizes,
                  const ReadVolumeOptions& options, StoredVoxels& voxels,
                  std::size_t voxelsOfVolume);

// Placement of the axes of an NRRD file in space.

/// The geometry of a header with these `sizes`, one for each of its axes; axes of a voxel's
/// components or of time are dropped if they have one entry. An unknown unit appends a sentence to
/// `assumptions`. Throws Error(InvalidInput) unless three axes with consistent fields remain.
StatedGeometry nrrdGeometry(const TextHeader& header, const std::vector<std::int64_t>& sizes,
                            const ReadVolumeOptions& options,
                            std::vector<std::string>& assumptions);

// Conversion between NIfTI-1's header, in RAS, and lumen's geometry, in LPS.

/// The placement of the voxels by `header`. The sform is used if its axes are orthogonal and either
/// the qform is not stated, or the sform is the scanner's; the qform otherwise. A transform that is
/// invalid (numbers that are not finite, no rotation) is replaced by the other, and if none is
/// stated, the volume's own axes are used; this, transforms that disagree, and another spacing in
/// the sform that the options do not settle, append a sentence each to `assumptions`. Throws
/// Error(InvalidInput), naming `path`, if transforms are stated and none can be used.
StatedGeometry niftiGeometry(const NiftiHeader& header, const ReadVolumeOptions& options,
                             const std::filesystem::path& path,
                             std::vector<std::string>& assumptions);

/// The bytes before the voxels of a file of this volume: qform and sform are both written, as
/// scanner coordinates in mm. Throws Error(Unsupported), naming `path`, for more than 32767 voxels
/// along an axis.
std::string niftiHeader(const Volume& volume, const std::filesystem::path& path);

}  // namespace lumen::convert
