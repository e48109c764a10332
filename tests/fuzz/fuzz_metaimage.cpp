// SPDX-License-Identifier: Apache-2.0
// A file of MetaImage, header and voxels.
#include "fuzz/fuzz_support.h"
#include "fuzz/volume_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lumen::fuzz::readVolumeOf(data, size, "v.mha", lumen::convert::VolumeFormat::MetaImage);
  return 0;
}
