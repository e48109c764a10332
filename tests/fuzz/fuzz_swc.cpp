// SPDX-License-Identifier: Apache-2.0
// Centerlines as SWC, and the chains that they are made of.
#include <string_view>

#include "converters/centerline/read_swc.h"
#include "converters/common/error.h"
#include "formats/container/printable.h"
#include "fuzz/fuzz_support.h"

namespace {

using namespace lumen;
using fuzz::expect;

void checkPoints(const convert::CenterlineFile& file) {
  expect(!file.points.empty(), "a file has a point");
  for (std::size_t i = 0; i < file.points.size(); ++i) {
    const convert::CenterlinePoint& point = file.points[i];
    expect(point.position.allFinite(), "positions are finite");
    expect(point.radius > 0, "radii are positive");
    expect(point.parent >= convert::kNoPoint && point.parent < static_cast<std::int32_t>(i),
           "parents come first");
  }
}

void checkChains(const convert::CenterlineFile& file) {
  const std::vector<convert::CenterlineChain> chains = convert::chainsOf(file);
  std::vector<bool> seen(file.points.size(), false);
  for (std::size_t c = 0; c < chains.size(); ++c) {
    expect(!chains[c].points.empty(), "chains have a point");
    expect(chains[c].parent >= -1 && chains[c].parent < static_cast<std::int32_t>(c),
           "chains hang on one before");
    if (chains[c].parent >= 0)
      expect(
          chains[c].parentSample < chains[static_cast<std::size_t>(chains[c].parent)].points.size(),
          "chains hang on a point of their parent");
    for (const std::int32_t point : chains[c].points) {
      expect(!seen.at(static_cast<std::size_t>(point)), "no point is in two chains");
      seen[static_cast<std::size_t>(point)] = true;
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const convert::CenterlineFile file =
        convert::parseSwc(std::string_view(reinterpret_cast<const char*>(data), size), "tree.swc");
    checkPoints(file);
    checkChains(file);
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::InvalidInput, "a bad file is invalid input");
    expect(formats::printable(error.what()) == error.what(), "messages are fit to print");
  }
  return 0;
}
