// SPDX-License-Identifier: Apache-2.0
// Replacement of the DICOM reader where lumen is built without it.
#include "converters/base/error.h"
#include "converters/io/volume/dicom/dicom_series.h"
#include "converters/io/volume/volume_format.h"

namespace lumen::convert {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path) {
  throw unsupported(path.string() +
                    ": DICOM is not read, because this lumen was built without it "
                    "(LUMEN_WITH_DICOM); convert the series to NRRD or NIfTI first");
}

OpenVolume openDicom(const InputFile& folder, const ReadVolumeOptions& /*options*/,
                     const Progress& /*progress*/) {
  refuse(folder.path());
}

}  // namespace

constinit const VolumeFormat VolumeFormat::Dicom{openDicom, nullptr, true};

DicomListing listDicomSeries(const InputFile& folder, const ReadVolumeOptions& /*options*/,
                             Progress& /*progress*/) {
  refuse(folder.path());
}

}  // namespace lumen::convert
