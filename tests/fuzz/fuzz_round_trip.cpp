// SPDX-License-Identifier: Apache-2.0
// Differential: a case that our reader accepts is the same after every way of writing and reading
// it again, and its canonical bytes are a fixed point.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "formats/case/case_field.h"
#include "formats/case/case_file.h"
#include "formats/case/reachability.h"
#include "formats/view/case_view.h"
#include "fuzz/fuzz_support.h"

namespace {

using namespace lumen::formats;
using lumen::fuzz::expect;

// JSON states raw sizes of chunks of others up to 2^63 - 1 (other-chunk.schema.json).
bool hasJson(const Case& value) {
  for (const OtherChunk& chunk : value.otherChunks)
    if (chunk.rawSize > static_cast<std::uint64_t>(INT64_MAX)) return false;
  return true;
}

void compareView(const Case& value, const CaseView& view) {
  const CenterlineTree& tree = value.tree;
  expect(view.nodeCount() == tree.nodeCount() && view.branchCount() == tree.branches.size() &&
             view.links.size() == tree.links.size(),
         "the view has as much as the case");
  for (std::size_t i = 0; i < tree.nodeCount(); ++i)
    expect(view.nodeCentre[i][0] == tree.centre[i].x && view.nodeRadius[i] == tree.radius[i] &&
               view.nodeParent[i] == tree.parent[i],
           "the view has the same nodes");
  for (std::size_t i = 0; i < tree.branches.size(); ++i)
    expect(view.label(view.branch(i)) == tree.branches[i].label, "the view has the same labels");
  expect(view.hasPoints == value.points.has_value() &&
             view.models.has_value() == value.models.has_value() &&
             view.motion.has_value() == value.motion.has_value(),
         "the view has the same parts");
  if (!view.motion) return;
  expect(view.motion->pose.size() == value.motion->pose.size() &&
             view.motion->period == value.motion->period &&
             std::ranges::equal(view.motion->time, value.motion->time) &&
             std::ranges::equal(view.motion->node, value.motion->node),
         "the view has the same motion");
}

void pushThrough(const Case& value) {
  const Reachability found = measureReachability(value.tree, caseField(value));
  double sum = found.reachable;
  for (const Barrier& barrier : found.barriers) {
    expect(barrier.node < value.tree.nodeCount(), "a barrier is at a node");
    sum += barrier.beyond;
  }
  expect(!(std::abs(sum - found.total) > 1e-6 * found.total),
         "every length is reachable or beyond");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = lumen::fuzz::bytesOf(data, size);
  std::vector<std::byte> file(bytes.begin(), bytes.end());
  lumen::fuzz::resign(file);
  const auto first = decodeBinary(file);
  if (!first) return 0;
  const std::vector<std::byte> canonical = encodeBinary(*first);
  const auto second = decodeBinary(canonical);
  expect(second && *second == *first, "binary gives back a case");
  expect(encodeBinary(*second) == canonical, "canonical bytes stay the same");
  const auto view = viewCase(canonical, Verify::All);
  expect(static_cast<bool>(view), "a canonical file can be viewed");
  compareView(*first, *view);
  if (first->models) pushThrough(*first);
  if (hasJson(*first)) {
    const auto json = decodeJson(encodeJson(*first));
    expect(json && encodeBinary(*json) == canonical, "JSON gives back the same bytes");
  }
  EncodeOptions small;
  small.compress = true;
  const auto compressed = decodeBinary(encodeBinary(*first, small));
  expect(compressed && *compressed == *first, "zstd gives back a case");
  if (!first->points || first->points->position.empty()) return 0;
  small.pointBits = 1 + static_cast<int>(size % 30);
  Case rounded = *first;
  quantisePoints(rounded, small.pointBits);
  const auto draco = decodeBinary(encodeBinary(*first, small));
  expect(draco && *draco == rounded, "Draco gives the points that quantisePoints() gives");
  return 0;
}
