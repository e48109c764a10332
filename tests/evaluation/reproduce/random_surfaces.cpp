// SPDX-License-Identifier: Apache-2.0
// lumen_random_surfaces FIRST COUNT [THICKNESS [FOLDER]]: the closed surfaces of random trees that touch, cross, bend
// tighter than their radius and change it at once, by number, with a wall of THICKNESS such as 0.2r; 0 is no wall.
// Prints those with a fault, then their number. FOLDER gets the cases of those with a fault.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "formats/case/case_file.h"
#include "tests/unit/surface/random_trees.h"

int main(int count, char** words) {
  if (count < 3) {
    std::fputs("lumen_random_surfaces FIRST COUNT [THICKNESS [FOLDER]]\n", stderr);
    return 2;
  }
  const std::uint64_t first = std::strtoull(words[1], nullptr, 10),
                      cases = std::strtoull(words[2], nullptr, 10);
  lumen::convert::ClosedSurfaceOptions options;
  if (count > 3 && words[3] != std::string("0"))
    options.thickness = lumen::convert::parseLength(words[3], "THICKNESS");
  std::size_t faults = 0;
  for (std::uint64_t number = first; number < first + cases; ++number) {
    const lumen::formats::Case trees = lumen::test::randomTrees(number);
    const std::string fault = lumen::test::faultOf(trees, options);
    if (fault.empty()) continue;
    if (count > 4) {
      const auto file = std::filesystem::path(words[4]) / (std::to_string(number) + ".lumen");
      if (!lumen::formats::writeCaseFile(trees, file)) {
        std::fprintf(stderr, "lumen_random_surfaces: cannot write %s\n", file.c_str());
        return 2;
      }
    }
    ++faults;
    std::printf("%llu: %s\n", static_cast<unsigned long long>(number), fault.c_str());
    std::fflush(stdout);
  }
  std::printf("%llu cases, %zu with a fault\n", static_cast<unsigned long long>(cases), faults);
  return faults == 0 ? 0 : 1;
}
