// SPDX-License-Identifier: Apache-2.0
#include "converters/io/seeds/case_seeds.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <string_view>
#include <utility>

#include "converters/base/error.h"
#include "converters/io/seeds/seeds_parse.h"
#include "formats/container/container.h"
#include "formats/container/printable.h"
#include "formats/view/case_chunks.h"

namespace lumen::convert {
namespace {

using formats::OtherChunk;

bool isSeeds(const OtherChunk& chunk) {
  return chunk.type == formats::chunkName(formats::chunk::kSeeds);
}

std::set<std::string> vesselsOf(const formats::Case& value) {
  std::set<std::string> labels;
  for (const formats::Branch& branch : value.tree.branches) labels.insert(branch.label);
  return labels;
}

/// A vessel that was deleted since is no parent any more.
void dropUnknownParents(std::vector<SeedBranch>& seeds, std::set<std::string> known) {
  for (const SeedBranch& seed : seeds) known.insert(seed.label);
  for (SeedBranch& seed : seeds)
    if (seed.parent && !known.contains(*seed.parent)) seed.parent.reset();
}

}  // namespace

std::vector<SeedBranch> seedsOf(const formats::Case& value, const std::string& name,
                                const FieldWord& word) {
  const auto chunk = std::find_if(value.otherChunks.begin(), value.otherChunks.end(), isSeeds);
  if (chunk == value.otherChunks.end()) return {};
  const std::string place = name + ": its seeds";
  if (chunk->version != 1 || chunk->encoding != 0)
    throw invalidInput(formats::printable(place) + " have version " +
                       std::to_string(chunk->version) + " and encoding " +
                       std::to_string(chunk->encoding) + "; expected 1 and 0");
  std::string text(chunk->bytes.size(), '\0');
  if (!text.empty()) std::memcpy(text.data(), chunk->bytes.data(), text.size());
  JsonFile json(text, place);
  std::vector<SeedBranch> seeds = parseSeeds(JsonPlace(json), {{}, {}, word});
  const std::set<std::string> vessels = vesselsOf(value);
  dropUnknownParents(seeds, vessels);
  return checkedSeeds(std::move(seeds), place, vessels);
}

void setSeeds(formats::Case& value, const std::vector<SeedBranch>& seeds) {
  std::erase_if(value.otherChunks, isSeeds);
  if (seeds.empty()) return;
  const std::string text = seedsText(seeds);
  OtherChunk chunk{formats::chunkName(formats::chunk::kSeeds), 1, true, 0, text.size()};
  chunk.bytes.resize(text.size());
  std::memcpy(chunk.bytes.data(), text.data(), text.size());
  value.otherChunks.insert(value.otherChunks.begin(), std::move(chunk));
}

bool holdsSeeds(const formats::Case& value, const std::vector<SeedBranch>& seeds) {
  try {
    return seedsText(seedsOf(value, "")) == seedsText(seeds);
  } catch (const Error&) {
    return false;
  }
}

std::vector<SeedBranch> markTracked(std::vector<SeedBranch> seeds,
                                    const std::vector<SeedFailure>& failures) {
  std::set<std::string_view> failed;
  for (const SeedFailure& failure : failures) failed.insert(failure.label);
  for (SeedBranch& seed : seeds) seed.isTracked = !failed.contains(seed.label);
  return seeds;
}

void dropOtherParents(std::vector<SeedBranch>& seeds) {
  dropUnknownParents(seeds, {});
}

SeedCounts countSeeds(const formats::Case& value, const std::string& name) {
  SeedCounts counts;
  for (const SeedBranch& seed : seedsOf(value, name))
    ++(seed.isTracked ? counts.tracked : counts.waiting);
  return counts;
}

}  // namespace lumen::convert
