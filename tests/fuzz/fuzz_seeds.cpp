// SPDX-License-Identifier: Apache-2.0
// Seeds, which come from files only, so a target puts its input into one that is in memory: lumen's
// own, 3D Slicer's fiducials behind the sign by which they are known, or its Markups between the
// braces of a file that has the key `markups`. What is accepted must obey the rules of spec/seeds.md.
#include <cmath>
#include <set>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "converters/base/error.h"
#include "converters/io/seeds/place_seeds.h"
#include "converters/io/seeds/seeds.h"
#include "formats/container/printable.h"
#include "fuzz/fuzz_support.h"

namespace lumen::fuzz {
namespace {

/// One file in memory for the life of the program.
int memoryFile() {
  static const int file = memfd_create("seeds", 0);
  expect(file >= 0, "there is a file in memory");
  return file;
}

void checkRules(const std::vector<convert::SeedBranch>& branches) {
  std::set<std::string> labels;
  for (const convert::SeedBranch& branch : branches) {
    expect(!branch.label.empty() && branch.label.size() <= 255, "labels have 1 to 255 bytes");
    expect(!branch.points.empty(), "branches have a point");
    expect(!branch.parent || labels.count(*branch.parent) == 1, "parents come first");
    expect(labels.insert(branch.label).second, "labels are unique");
    for (const convert::SeedPoint& point : branch.points) {
      expect(point.position.allFinite(), "positions are finite");
      expect(!point.radius || *point.radius > 0, "radii are positive");
    }
    expect(!branch.direction || std::abs(branch.direction->norm() - 1) < 1e-9,
           "directions are unit vectors");
  }
}

/// Checks that seeds placed in a volume lie in it, with plausible radii, or are accounted for.
void checkPlaced(const std::vector<convert::SeedBranch>& branches) {
  convert::VolumeGeometry geometry;
  geometry.size = {64, 32, 16};
  geometry.spacing = {0.5, 0.5, 1.0};
  const convert::PlacedSeeds placed = convert::placeSeeds(branches, geometry, "seeds");
  expect(placed.seeds.size() + placed.leftOut.size() == branches.size(), "no seed is lost");
  for (const convert::SeedBranch& branch : placed.seeds)
    for (const convert::SeedPoint& point : branch.points)
      expect(geometry.containsWorld(point.position), "placed points lie inside");
}

enum class Format { Own, Fcsv, Markups };

std::string textOf(Format format, const std::string& input) {
  if (format == Format::Fcsv) return "#" + input;
  return format == Format::Markups ? "{\"markups\":[" + input + "]}" : input;
}

}  // namespace
}  // namespace lumen::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lumen;
  using namespace lumen::fuzz;
  const std::string text =
      textOf(Format::LUMEN_FUZZ_FORMAT, std::string(reinterpret_cast<const char*>(data), size));
  const int file = memoryFile();
  expect(ftruncate(file, 0) == 0, "the file can be emptied");
  expect(pwrite(file, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()),
         "the file can be written");
  try {
    const auto seeds = convert::readSeeds("/proc/self/fd/" + std::to_string(file));
    checkRules(seeds);
    checkPlaced(seeds);
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::InvalidInput, "bad seeds are invalid input");
    expect(formats::printable(error.what()) == error.what(), "messages are fit to print");
  }
  return 0;
}
