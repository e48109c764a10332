// SPDX-License-Identifier: Apache-2.0
// Centerlines by the reader LUMEN_FUZZ_FORMAT: points, chains, and the case that is made of them if
// their radii allow one.
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/io/centerline/case_of_centerline.h"
#include "converters/io/centerline/read_swc.h"
#include "converters/io/centerline/read_tre.h"
#include "converters/io/centerline/read_vtp.h"
#include "formats/case/validate.h"
#include "formats/container/printable.h"
#include "fuzz/fuzz_support.h"

namespace lumen::fuzz {
namespace {

void checkPoints(const convert::CenterlineFile& file, bool hasRadii) {
  expect(!file.points.empty(), "a file has a point");
  for (std::size_t i = 0; i < file.points.size(); ++i) {
    const convert::CenterlinePoint& point = file.points[i];
    expect(point.position.allFinite(), "positions are finite");
    expect(hasRadii ? point.radius > 0 : point.radius >= 0, "radii are positive");
    expect(point.vessel >= convert::kNoVessel &&
               point.vessel < static_cast<std::int32_t>(file.vessels.size()),
           "vessels are of the file");
    expect(point.parent >= convert::kNoPoint && point.parent < static_cast<std::int32_t>(i),
           "parents come first");
  }
}

void checkChains(const convert::CenterlineFile& file) {
  const std::vector<convert::CenterlineChain> chains = convert::centerlineChains(file);
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

void checkCase(convert::CenterlineFile file) {
  convert::toPatientSpace(file, {});
  try {
    const formats::Case value = convert::caseOfCenterline(file, "a");
    if (!value.tree.centre.empty()) expect(bool(formats::validate(value)), "cases are valid");
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::InvalidInput, "a tree without a case is invalid input");
  }
}

}  // namespace
}  // namespace lumen::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lumen;
  using namespace lumen::fuzz;
  convert::CenterlineFile (*const parse)(std::string_view, const std::string&) =
      convert::LUMEN_FUZZ_FORMAT;
  const bool isVtp = parse == convert::parseVtpCenterline;  // which may lack radii
  try {
    convert::CenterlineFile file =
        parse(std::string_view(reinterpret_cast<const char*>(data), size), "tree");
    checkPoints(file, !isVtp);
    checkChains(file);
    checkCase(std::move(file));
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::InvalidInput ||
               (isVtp && error.kind() == ErrorKind::Unsupported),
           "a bad file is invalid input");
    expect(formats::printable(error.what()) == error.what(), "messages are fit to print");
  }
  return 0;
}
