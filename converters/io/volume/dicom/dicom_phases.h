// SPDX-License-Identifier: Apache-2.0
// Several images at one position in a series: copies, and volumes of several times.
#pragma once

#include "converters/base/progress.h"
#include "converters/io/volume/dicom/dicom_folder.h"

namespace lumen::convert {

/// Takes the series of a folder apart, frame by frame. Images that equal another one at their position
/// are left out, if all that share a position do, and a remark counts them. A series of several volumes
/// at one place, or of several stacks, becomes one for each, if an element (kPhaseElements) tells them
/// apart; its name is the UID and that element. Throws as readDicomFrame().
void dividePhases(DicomFolder& folder, const Progress& progress);

}  // namespace lumen::convert
