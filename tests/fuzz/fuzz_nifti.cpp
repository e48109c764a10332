// SPDX-License-Identifier: Apache-2.0
// A file of NIfTI-1, header and voxels, plain or compressed.
#include "fuzz/fuzz_support.h"
#include "fuzz/volume_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lumen::fuzz::readVolumeOf(data, size, "v.nii", lumen::convert::VolumeFormat::Nifti);
  return 0;
}
