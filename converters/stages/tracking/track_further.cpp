// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/track_further.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>
#include <utility>

#include "converters/base/edit_steps.h"
#include "converters/stages/tracking/case_of_tracks.h"
#include "converters/stages/tracking/known_tracks.h"
#include "converters/stages/tracking/vessel_tracks.h"
#include "formats/case/node_origin.h"
#include "formats/case/validate.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

std::string quotedLabel(const std::string& label) {
  std::string text(1, '"');
  text += formats::printable(label);
  text += '"';
  return text;
}

void requireNewLabels(const formats::Case& known, const std::vector<SeedBranch>& seeds) {
  std::set<std::string> labels;
  for (const formats::Branch& branch : known.tree.branches) labels.insert(branch.label);
  for (const SeedBranch& seed : seeds) {
    if (seed.points.empty())
      throw invalidInput("the seed " + quotedLabel(seed.label) +
                         " has no points; expected one or more");
    if (!labels.insert(seed.label).second)
      throw invalidInput("the name " + quotedLabel(seed.label) +
                         " is that of another branch or seed; expected one that none has");
  }
}

/// Appends seeds to those of known branches, what they hang on first.
void appendParentsFirst(std::vector<SeedBranch> seeds, std::vector<SeedBranch>& all) {
  std::set<std::string> known;
  for (const SeedBranch& seed : all) known.insert(seed.label);
  while (!seeds.empty()) {
    const std::size_t before = seeds.size();
    std::vector<SeedBranch> later;
    for (SeedBranch& seed : seeds) {
      const bool isDue = !seed.parent || known.contains(*seed.parent);
      if (isDue) known.insert(seed.label);
      (isDue ? all : later).push_back(std::move(seed));
    }
    seeds = std::move(later);
    if (seeds.size() == before)
      throw invalidInput("the parent of " + quotedLabel(seeds[0].label) + ", " +
                         quotedLabel(*seeds[0].parent) +
                         ", is no branch of the case and no seed that hangs on one");
  }
}

/// Puts the wall points of known branches in the place of those that the case has, where they differ.
/// Returns the nodes.
std::vector<std::uint32_t> takePoints(const std::vector<TrackedBranch>& branches, std::size_t known,
                                      formats::Case& out) {
  std::vector<std::uint32_t> changed;
  formats::PointSets points;
  points.offset.push_back(0);
  for (std::size_t b = 0; b < known; ++b)
    for (const TrackedNode& node : branches[b].nodes) {
      const auto index = static_cast<std::uint32_t>(points.offset.size() - 1);
      if (out.points) {
        const auto first = out.points->position.begin();
        const auto& offset = out.points->offset;
        if (!std::equal(first + offset[index], first + offset[index + 1], node.points.begin(),
                        node.points.end()))
          changed.push_back(index);
      }
      points.position.insert(points.position.end(), node.points.begin(), node.points.end());
      points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
    }
  out.points = std::move(points);
  return changed;
}

std::string sentenceOn(const SeedBranch& seed) {
  const Eigen::Vector3d& p = seed.points[0].position;
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), " from (%.6g, %.6g, %.6g) mm", p.x(), p.y(), p.z());
  return "tracked " + quotedLabel(seed.label) + text.data();
}

void dropOtherArrays(FurtherTracks& out) {
  std::erase_if(out.result.nodeArrays, [&](const formats::NodeArray& array) {
    if (array.name == formats::kOriginArray) return false;
    out.droppedArrays.push_back(array.name);
    return true;
  });
}

}  // namespace

FurtherTracks trackFurther(const TrackingVolume& volume, const formats::Case& known,
                           const std::vector<SeedBranch>& seeds, Progress& progress) {
  requireNewLabels(known, seeds);
  KnownTracks tracks(known);
  const std::size_t count = tracks.seeds.size();
  appendParentsFirst(seeds, tracks.seeds);
  FurtherTracks out;
  out.result = known;
  out.firstNewNode = static_cast<std::uint32_t>(known.tree.nodeCount());
  out.firstNewBranch = static_cast<std::uint32_t>(count);
  if (seeds.empty()) return out;
  trackVessels(volume, tracks.seeds, count, tracks.branches, progress);
  static_cast<TrackRemarks&>(out) = remarksOn(tracks.seeds, tracks.branches, count);
  const auto isTracked = [&](std::size_t i) { return !tracks.branches[i].nodes.empty(); };
  for (std::size_t i = count; i < tracks.seeds.size(); ++i)
    if (isTracked(i)) recordEdit(out.result.metadata, sentenceOn(tracks.seeds[i]));
  if (out.failures.size() == seeds.size()) return out;
  out.changed = takePoints(tracks.branches, count, out.result);
  dropOtherArrays(out);
  appendTracks(tracks.seeds, tracks.branches, count, out.result);
  formats::dropDependentChunks(out.result);
  if (const auto valid = formats::validate(out.result); !valid)
    throw invalidInput("the tracked vessels break a rule of the format: " + valid.error().text());
  return out;
}

}  // namespace lumen::convert
