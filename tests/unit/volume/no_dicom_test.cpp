// SPDX-License-Identifier: Apache-2.0
// lumen as it is built with LUMEN_WITH_DICOM=OFF.
#include "converters/io/volume/dicom/dicom_series.h"
#include "fixtures.h"

namespace lumen::convert {
namespace {

class NoDicom : public FileTest {};

TEST_F(NoDicom, AFolderIsRefusedWithTheOptionThatWasOff) {
  std::filesystem::create_directory(path("series"));
  expectRefused(readRefusal(path("series")), {"4: ", "series", "DICOM", "LUMEN_WITH_DICOM"});
  expectRefused(
      refusal([&] { (void)readVolumeHeader(path("series"), VolumeFormat::Dicom, {}, Progress()); }),
      {"4: ", "LUMEN_WITH_DICOM"});
  Progress silent;
  expectRefused(refusal([&] { (void)listDicomSeries(path("series"), {}, silent); }),
                {"4: ", "LUMEN_WITH_DICOM"});
}

}  // namespace
}  // namespace lumen::convert
