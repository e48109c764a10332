// SPDX-License-Identifier: Apache-2.0
// The JSON encoding: what is accepted is given back by both encodings.
#include <string_view>

#include "formats/case/case_file.h"
#include "fuzz/fuzz_support.h"

using namespace lumen::formats;
using lumen::fuzz::expect;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  if (hasContainerMagic(lumen::fuzz::bytesOf(data, size))) return 0;
  const auto decoded = decodeJson(text);
  const auto report = validateBytes(lumen::fuzz::bytesOf(data, size));
  if (!decoded) {
    expect(!report.valid(), "the validator refuses what the reader refuses");
    return 0;
  }
  expect(report.valid(), "the validator accepts what the reader accepts");
  expect(static_cast<bool>(validate(*decoded)), "what was read obeys the rules");
  const auto json = decodeJson(encodeJson(*decoded));
  expect(json && *json == *decoded, "JSON gives back a case");
  const auto bytes = encodeBinary(*decoded);
  const auto binary = decodeBinary(bytes);
  expect(binary && *binary == *decoded, "the binary encoding gives back a case from JSON");
  return 0;
}
