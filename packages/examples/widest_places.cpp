// SPDX-License-Identifier: Apache-2.0
// widest_places CASE OUT: prints the widest place of each vessel of a case, with the distance to its
// wall by libblob if the case has models, and writes the case without vessels narrower than 0.5 mm.
#include <algorithm>
#include <cstdio>

#include "blob.h"
#include "lumen/case.hpp"

namespace {

std::uint32_t widestNode(const lumen::VesselCase& value, const lumen_case_branch& branch) {
  const auto radii = value.radii();
  const float* first = radii.begin() + branch.first_node;
  return std::uint32_t(std::max_element(first, first + branch.node_count) - radii.begin());
}

void list(const lumen::VesselCase& value, const blob_model* wall) {
  for (std::size_t b = 0; b < value.branchCount(); ++b) {
    const lumen_case_branch branch = value.branch(b);
    const std::uint32_t node = widestNode(value, branch);
    const auto& centre = value.centres()[node];
    std::printf("%s: radius %.2f mm at (%.1f, %.1f, %.1f) LPS", branch.label, value.radii()[node],
                centre[0], centre[1], centre[2]);
    if (wall) {
      const double point[3] = {centre[0], centre[1], centre[2]};
      std::uint32_t cursor = node;
      blob_sample sample;
      blob_query(wall, BLOB_DISTANCE_EXACT, point, &cursor, &sample);
      std::printf(", wall %.2f mm away", -sample.distance);
    }
    std::printf("\n");
  }
}

void removeNarrow(lumen::VesselCase& value) {
  constexpr float kNarrow = 0.5f;
  for (std::size_t b = value.branchCount(); b-- > 1;)
    if (b < value.branchCount() && value.radii()[widestNode(value, value.branch(b))] < kNarrow)
      value.removeBranch(b);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  try {
    lumen::VesselCase value = lumen::VesselCase::open(arguments[1]);
    blob_model* wall = nullptr;
    (void)blob_model_open(arguments[1], nullptr, &wall);  // null for a case without models
    list(value, wall);
    blob_model_close(wall);
    removeNarrow(value);
    value.save(arguments[2]);
    std::printf("%zu vessels written\n", value.branchCount());
  } catch (const lumen::CaseError& error) {
    std::printf("%s\n", error.what());
    return 1;
  }
}
