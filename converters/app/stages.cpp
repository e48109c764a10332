// SPDX-License-Identifier: Apache-2.0
#include "converters/app/stages.h"

#include "converters/app/file_access.h"
#include "converters/common/error.h"

namespace lumen::app {

namespace {

void tellAssumptions(const std::filesystem::path& file, const std::vector<std::string>& assumptions,
                     bool strict, Progress& progress) {
  for (const std::string& assumption : assumptions) {
    const std::string text = file.string() + ": " + assumption;
    if (strict) throw invalidInput(text);
    progress.warn(text);
  }
}

}  // namespace

convert::Volume loadVolume(const std::filesystem::path& file, const FileFormat& format,
                           const VolumeArguments& volume, bool strict, Progress& progress) {
  progress.begin("reading", 0);
  convert::Volume result = format.readVolume(file, volume.options(), progress);
  progress.end();
  tellAssumptions(file, result.assumptions, strict, progress);
  return result;
}

std::vector<convert::SeedBranch> loadSeeds(const TrackArguments& track) {
  if (track.seeds.empty())
    throw Error(ErrorKind::Usage,
                "a volume needs --seeds FILE, which says where its vessels begin");
  requireInput(track.seeds, "seeds file");
  return convert::readSeeds(track.seeds);
}

convert::TrackResult trackSeeds(const convert::Volume& volume,
                                const std::vector<convert::SeedBranch>& seeds,
                                const std::string& origin, const convert::TrackOptions& options,
                                Progress& progress) {
  convert::checkSeedsInside(seeds, volume.geometry, origin);
  convert::TrackResult result = convert::track(volume, seeds, options, progress);
  for (const auto& failure : result.failures)
    progress.warn("seed " + failure.label + " started no track: " + failure.reason);
  for (const auto& missed : result.missedPoints)
    progress.warn("seed " + missed.label + " does not pass through its " + missed.reason);
  if (result.result.tree.nodeCount() == 0)
    throw failed(origin + ": none of its " + std::to_string(seeds.size()) +
                 " seeds started a track; nothing is written");
  return result;
}

}  // namespace lumen::app
