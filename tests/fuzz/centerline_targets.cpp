// SPDX-License-Identifier: Apache-2.0
// Centerlines, the chains that they are made of, and the case that is made of them if their radii allow
// one.
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/io/centerline/case_of_centerline.h"
#include "converters/io/centerline/centerline_readers.h"
#include "formats/case/validate.h"
#include "formats/container/printable.h"
#include "fuzz/fuzz.h"

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

/// Text that `parse` accepts obeys the rules; all else is refused as bad input, or as input of another kind
/// where the format (VTK's) holds more than centerlines with radii.
template <class Parse>
void check(Parse parse, bool hasRadii) {
  try {
    convert::CenterlineFile file = parse();
    checkPoints(file, hasRadii);
    checkChains(file);
    checkCase(std::move(file));
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::InvalidInput ||
               (!hasRadii && error.kind() == ErrorKind::Unsupported),
           "a bad file is invalid input");
    expect(formats::printable(error.what()) == error.what(), "messages are fit to print");
  }
}

void swc(std::span<const std::byte> input) {
  check([&] { return convert::parseSwc(textOf(input), "tree.swc"); }, true);
}

void tre(std::span<const std::byte> input) {
  check([&] { return convert::parseTre(textOf(input), "a.tre"); }, true);
}

void vtpLines(std::span<const std::byte> input) {
  check([&] { return convert::parseVtpCenterline(textOf(input), "a.vtp"); }, false);
}

void vtkLines(std::span<const std::byte> input) {
  check([&] { return convert::parseVtkCenterline(textOf(input), "a.vtk"); }, false);
}

void graphml(std::span<const std::byte> input) {
  check([&] { return convert::parseGraphml(textOf(input), "a.graphml"); }, false);
}

/// Nodes and edges, with a line of dashes between them.
void graphCsv(std::span<const std::byte> input) {
  constexpr std::string_view kBetween = "\n--\n";
  const std::string_view text = textOf(input);
  const std::size_t end = std::min(text.find(kBetween), text.size());
  const InputFile nodes("a_nodes.csv", text.substr(0, end));
  const InputFile edges("a_edges.csv", text.substr(std::min(end + kBetween.size(), text.size())));
  const std::vector<InputFile> files = {nodes, edges};
  check([&] { return convert::readGraphCsv(InputFile("a", files)); }, false);
}

void spatialGraph(std::span<const std::byte> input) {
  check([&] { return convert::parseSpatialGraph(textOf(input), "a.am"); }, false);
}

void vmv(std::span<const std::byte> input) {
  check([&] { return convert::parseVmv(textOf(input), "a.vmv"); }, true);
}

void simVascular(std::span<const std::byte> input) {
  check([&] { return convert::parseSimVascular(textOf(input), "a.ctgr"); }, false);
}

constexpr Target kTargets[] = {{"swc", swc},
                               {"tre", tre},
                               {"vtp_lines", vtpLines},
                               {"vtk_lines", vtkLines},
                               {"graphml", graphml},
                               {"graph_csv", graphCsv},
                               {"spatial_graph", spatialGraph},
                               {"vmv", vmv},
                               {"simvascular", simVascular}};

}  // namespace

std::span<const Target> centerlineTargets() {
  return kTargets;
}

}  // namespace lumen::fuzz
