// SPDX-License-Identifier: Apache-2.0
// Cases in both encodings, and their compressed chunks.
#include <algorithm>
#include <cmath>

#include "formats/case/case_field.h"
#include "formats/case/case_file.h"
#include "formats/case/chunk_codec.h"
#include "formats/case/reachability.h"
#include "formats/view/case_view.h"
#include "fuzz/fuzz.h"

namespace lumen::fuzz {
namespace {

using namespace lumen::formats;

void readEveryWay(std::span<const std::byte> bytes) {
  const auto decoded = decodeBinary(bytes);
  constexpr std::size_t kMaxIssues = 5;
  const ValidationReport report = validateBytes(bytes, kMaxIssues);
  expect(report.valid() == static_cast<bool>(decoded) || !hasContainerMagic(bytes),
         "the validator and the reader accept the same files");
  expect(report.issues.size() <= kMaxIssues, "no more issues than were asked for");
  const auto whole = viewCase(bytes, Verify::All);
  const auto structure = viewCase(bytes, Verify::Structure);
  expect(static_cast<bool>(structure) || !whole, "what is all right has a right structure");
  if (structure)
    for (std::size_t i = 0; i < structure->branchCount(); ++i)
      (void)structure->label(structure->branch(i));
  if (!decoded) return;
  expect(static_cast<bool>(validate(*decoded)), "what was read obeys the rules");
  if (whole) expect(whole->nodeCount() == decoded->tree.nodeCount(), "the view has all nodes");
}

/// The binary encoding, as it came and with its checksums made right: all readers of it agree.
void binary(std::span<const std::byte> input) {
  std::vector<std::byte> file(input.begin(), input.end());  // aligned, which a view needs
  readEveryWay(file);
  resign(file);
  readEveryWay(file);
}

/// The JSON encoding: what is accepted is given back by both encodings.
void json(std::span<const std::byte> input) {
  if (hasContainerMagic(input)) return;
  const auto decoded = decodeJson(textOf(input));
  const auto report = validateBytes(input);
  if (!decoded) {
    expect(!report.valid(), "the validator refuses what the reader refuses");
    return;
  }
  expect(report.valid(), "the validator accepts what the reader accepts");
  expect(static_cast<bool>(validate(*decoded)), "what was read obeys the rules");
  const auto json = decodeJson(encodeJson(*decoded));
  expect(json && *json == *decoded, "JSON gives back a case");
  const auto bytes = encodeBinary(*decoded);
  const auto binary = decodeBinary(bytes);
  expect(binary && *binary == *decoded, "the binary encoding gives back a case from JSON");
}

/// A Draco chunk behind four bytes of raw size: decoded to that size, or refused. Sizes beyond the legal
/// expansion are refused before a chunk is decoded.
void draco(std::span<const std::byte> input) {
  if (input.size() < 4) return;
  const auto rawSize = loadLittle<std::uint32_t>(input.data());
  const auto stored = input.subspan(4);
  if (rawSize > kMaxExpansion * stored.size()) return;
  const auto raw = decodeDraco(stored, rawSize);
  expect(!raw || raw->size() == rawSize, "a chunk decodes to its raw size");
}

Chunk chunkOf(std::span<const std::byte> stored, std::uint64_t rawSize) {
  Chunk chunk;
  chunk.type = chunkType("NRAD");
  chunk.encoding = static_cast<std::uint8_t>(ChunkEncoding::Zstd);
  chunk.rawSize = rawSize;
  chunk.stored = stored;
  return chunk;
}

/// A zstd chunk behind four bytes of raw size: decoded to that size, or refused; and what is compressed
/// here is given back.
void zstd(std::span<const std::byte> input) {
  if (input.size() < 4) return;
  const auto rawSize = loadLittle<std::uint32_t>(input.data());
  const auto stored = input.subspan(4);
  IssueList issues(1);
  if (rawSize <= kMaxExpansion * stored.size()) {
    const auto raw = decodeChunk(chunkOf(stored, rawSize), issues);
    expect(raw ? raw->size() == rawSize : issues.failed(), "a chunk decodes, or has an issue");
  }
  if (const auto compressed = compressZstd(input)) {
    IssueList none(1);
    const auto raw = decodeChunk(chunkOf(*compressed, input.size()), none);
    expect(raw && std::equal(raw->begin(), raw->end(), input.begin(), input.end()),
           "what was compressed is given back");
  }
}

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

/// Differential: a case that our reader accepts is the same after every way of writing and reading it
/// again, and its canonical bytes are a fixed point.
void roundTrip(std::span<const std::byte> input) {
  std::vector<std::byte> file(input.begin(), input.end());
  resign(file);
  const auto first = decodeBinary(file);
  if (!first) return;
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
  if (!first->points || first->points->position.empty()) return;
  small.pointBits = 1 + static_cast<int>(input.size() % 30);
  Case rounded = *first;
  quantisePoints(rounded, small.pointBits);
  const auto draco = decodeBinary(encodeBinary(*first, small));
  expect(draco && *draco == rounded, "Draco gives the points that quantisePoints() gives");
}

constexpr Target kTargets[] = {{"binary", binary},
                               {"json", json},
                               {"draco", draco},
                               {"zstd", zstd},
                               {"round_trip", roundTrip}};

}  // namespace

std::span<const Target> caseTargets() {
  return kTargets;
}

}  // namespace lumen::fuzz
