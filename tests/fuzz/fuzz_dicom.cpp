// SPDX-License-Identifier: Apache-2.0
// A folder of DICOM files.
#include "fuzz/fuzz_support.h"
#include "fuzz/volume_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lumen::fuzz::readSeriesOf(data, size);
  return 0;
}
