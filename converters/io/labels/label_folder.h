// SPDX-License-Identifier: Apache-2.0
// A folder with a file for each structure, as TotalSegmentator writes it, as one map of labels.
#pragma once

#include <string>

#include "converters/base/input_file.h"
#include "converters/base/progress.h"
#include "converters/io/labels/label_table.h"
#include "converters/io/volume/read_volume_options.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// True for a folder on this disk that has a file of NIfTI, NRRD or MetaImage in it, and none of
/// DICOM in it or below. Files whose names begin with a dot do not count.
bool isLabelFolder(const InputFile& folder);

struct FolderMap {
  VolumeHeader header;  ///< of the whole: the geometry, and the sizes of all files together
  Volume voxels;
  LabelTable table;  ///< names are those of the files without their endings
  /// A sentence if structures overlap, one for each that has voxels outside of the map, and the
  /// assumptions of the header.
  std::vector<std::string> remarks;
};

/// The map of a folder. Labels are 1, 2, ... in the order of the names of the files, also of those
/// without a voxel.
///
/// - The grid is the finest of all files, of equal ones the first. Files with another grid are
///   placed by position: a voxel of the map is of the structure whose nearest voxel is.
/// - A voxel of several structures is of one that is a vessel or another lumen, by the role of its
///   name, rather than of one that is not, and never of a region if it is of another; of equals it
///   is of the one with the smaller volume, and then of the first.
///
/// Throws Error(InvalidInput), naming the file, for a file with more than one value beside 0, for
/// more than 255 files, and if no structure has a voxel; as readVolume() otherwise.
FolderMap readLabelFolder(const InputFile& folder, const ReadVolumeOptions& options,
                          const Progress& progress);

}  // namespace lumen::convert
