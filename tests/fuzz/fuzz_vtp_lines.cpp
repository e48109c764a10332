// SPDX-License-Identifier: Apache-2.0
// Centerlines as lines of VTK.
#include <string_view>

#include "converters/base/error.h"
#include "converters/io/centerline/read_vtp.h"
#include "formats/container/printable.h"
#include "fuzz/centerline_checks.h"
#include "fuzz/fuzz_support.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lumen;
  using fuzz::expect;
  try {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    fuzz::checkCenterline(convert::parseVtpCenterline(text, "a.vtp"), false);
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::InvalidInput || error.kind() == ErrorKind::Unsupported,
           "a bad file is invalid input");
    expect(formats::printable(error.what()) == error.what(), "messages are fit to print");
  }
  return 0;
}
