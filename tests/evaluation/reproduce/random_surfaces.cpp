// SPDX-License-Identifier: Apache-2.0
// lumen_random_surfaces FIRST COUNT [THICKNESS]: the closed surfaces of random trees that touch, cross, bend tighter
// than their radius and change it at once, by number, with a wall of THICKNESS such as 0.2r. Prints those with a fault,
// then their number.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/unit/surface/random_trees.h"

int main(int count, char** words) {
  if (count < 3) {
    std::fputs("lumen_random_surfaces FIRST COUNT [THICKNESS]\n", stderr);
    return 2;
  }
  const std::uint64_t first = std::strtoull(words[1], nullptr, 10),
                      cases = std::strtoull(words[2], nullptr, 10);
  lumen::convert::ClosedSurfaceOptions options;
  if (count > 3) options.thickness = lumen::convert::parseLength(words[3], "THICKNESS");
  std::size_t faults = 0;
  for (std::uint64_t number = first; number < first + cases; ++number) {
    const std::string fault = lumen::test::faultOf(lumen::test::randomTrees(number), options);
    if (fault.empty()) continue;
    ++faults;
    std::printf("%llu: %s\n", static_cast<unsigned long long>(number), fault.c_str());
    std::fflush(stdout);
  }
  std::printf("%llu cases, %zu with a fault\n", static_cast<unsigned long long>(cases), faults);
  return faults == 0 ? 0 : 1;
}
