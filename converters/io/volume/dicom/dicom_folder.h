// SPDX-License-Identifier: Apache-2.0
// The DICOM series of a folder and of all folders below it.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/volume/dicom/dicom_image.h"
#include "converters/io/volume/read_volume_options.h"

namespace lumen::convert {

/// The files of a folder and of all folders below it, in the order of their paths. Links to folders
/// and hidden folders are passed over.
struct DicomFolder {
  /// By instance UID, and what divides several volumes of one series (dicom_phases.h).
  std::map<std::string, std::vector<DicomImage>> series;
  std::map<std::string, std::vector<std::string>> remarks;  ///< of series, a sentence each
  std::vector<DicomScan> faulty;
  std::vector<InputFile> others;      ///< files that are no DICOM images
  std::vector<InputFile> structures;  ///< of `others` those that are structure sets
};

/// Throws Error(InvalidInput) for a folder that cannot be listed, and one with more than half a
/// million files below it; Error(Cancelled).
/// `isFlat`: without the folders below it.
DicomFolder scanDicomFolder(const InputFile& folder, const Progress& progress, bool isFlat = false);

/// The folder of a file on this disk.
InputFile folderOf(const InputFile& file);

/// The images of one series.
struct DicomChoice {
  std::vector<DicomImage> images;
  std::vector<std::string> assumptions;  ///< files that were left out (`skipFaulty`)
};

/// The series that the options name (its instance UID, the name of one of its volumes, or its number in the listing, from 1; empty:
/// the only one). Throws Error(InvalidInput) if there is no such series or several (the message
/// lists them); the fault of a file that belongs to the series, or that names none and lies in
/// a folder of the series, unless the options leave such files out; Error(Cancelled).
///
/// A file in place of a folder is a DICOMDIR, whose folder it stands for; one of several frames, or a
/// segmentation, which stands for itself; or a slice, which stands for its series in its folder.
DicomChoice findDicomSeries(const InputFile& input, const ReadVolumeOptions& options,
                            const Progress& progress);

}  // namespace lumen::convert
