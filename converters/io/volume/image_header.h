// SPDX-License-Identifier: Apache-2.0
// Header of NRRD, MetaImage or NIfTI, the common result of their parsers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/length_unit.h"
#include "converters/base/text.h"
#include "converters/io/volume/nifti_header.h"
#include "converters/io/volume/read_volume_options.h"
#include "converters/io/volume/stored_voxels.h"
#include "converters/io/volume/text_header.h"
#include "converters/io/volume/volume_format.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

// Conversion of a header's lengths to millimetres, with the user's statements: equal for every
// format.

/// Geometry as a header states it.
struct StatedGeometry {
  /// Lengths are in the file's unit. A spacing is NaN along an axis whose spacing is not stated.
  VolumeGeometry geometry;
  std::optional<double> unit;  ///< mm of the file's unit; empty: the header states none
  std::string unitNote;  ///< the assumption where `unit` is empty; empty: it goes without saying
  std::string placedBy;  ///< of several transforms the one that counts; empty: there is one
  /// Voxels of one volume that lie together, where an axis of several volumes comes before axes of
  /// space; 0: all do.
  std::uint64_t together = 0;
};

/// The geometry in mm: spacing and unit are those of the options, else of the header, else 1 mm. An
/// assumed spacing, or an implausible one in an assumed unit, appends a sentence to `assumptions`.
/// Throws Error(InvalidInput), naming `path` and the option that helps, for a spacing that is
/// stated along some axes only, or is not positive, finite and within 1e-6 to 1e4 mm. The axes may
/// lean (upright_grid.h).
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
/// components or of time are dropped if they have one entry. An axis of several entries that are
/// volumes (time, a list, and, if the options choose one of them, a vector) may stand anywhere. An unknown unit appends a sentence to
/// `assumptions`. Throws Error(InvalidInput) unless three axes with consistent fields remain.
StatedGeometry nrrdGeometry(const TextHeader& header, const std::vector<std::int64_t>& sizes,
                            const ReadVolumeOptions& options,
                            std::vector<std::string>& assumptions);

// Conversion between NIfTI-1's header, in RAS, and lumen's geometry, in LPS.

/// The placement of the voxels by `header`: by the transform of the higher code, by the sform of equal
/// ones. An sform of the scanner or of another scan (codes 1 and 2) whose axes lean counts whatever the
/// codes, if the qform, which holds no lean, is more than half a voxel off; one of a template (3 to 5)
/// that leans counts only without a qform. A transform that is
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
