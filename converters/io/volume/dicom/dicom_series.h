// SPDX-License-Identifier: Apache-2.0
// A folder of DICOM, for a person who chooses one of its series. No element that names a person is
// read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/input_file.h"
#include "converters/base/progress.h"
#include "converters/io/volume/read_volume_options.h"

namespace lumen::convert {

/// A small picture in grey, rows from top to bottom.
struct GreyPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixel;
};

struct DicomSeries {
  std::string uid;                    ///< chooses it (`ReadVolumeOptions::series`)
  std::string description, modality;  ///< as the files have them; any text
  std::size_t files = 0;
  std::array<int, 3> size{};                          ///< columns, rows, slices
  Eigen::Vector3d spacing = Eigen::Vector3d::Zero();  ///< mm; 0 where `fault` is not empty
  std::string fault;    ///< why it cannot be opened as a volume; empty: it can
  GreyPicture picture;  ///< its middle slice; empty if its pixels cannot be read
};

struct DicomListing {
  std::vector<DicomSeries> series;  ///< in the order of their UIDs
  std::vector<std::string> faults;  ///< one for each file that cannot be read; names the file
  std::size_t others = 0;           ///< files that are no DICOM images
};

/// Looks through the files of `folder` and of the folders below it. A file that cannot be read is
/// listed and stops nothing. The options state a spacing that files lack. Throws
/// Error(InvalidInput) for a folder that cannot be listed, Error(Unsupported) where lumen is built
/// without DICOM, and Error(Cancelled).
DicomListing listDicomSeries(const InputFile& folder, const ReadVolumeOptions& options,
                             Progress& progress);

}  // namespace lumen::convert
