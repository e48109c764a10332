// SPDX-License-Identifier: Apache-2.0
#include "converters/app/stages.h"

#include "converters/app/file_access.h"
#include "converters/common/error.h"

namespace lumen::app {

namespace {

/// What cannot be read as a volume may be something else altogether.
convert::Volume readVolume(const std::filesystem::path& file, const FileFormat& format,
                           const VolumeArguments& volume, Progress& progress) {
  try {
    return format.readVolume(file, volume.options(), progress);
  } catch (const Error& error) {
    const std::string other = notA(ContentKind::Volume, file);
    if (error.kind() == ErrorKind::Cancelled || other.empty()) throw;
    throw invalidInput(file.string() + ": " + other);
  }
}

void tellAssumptions(const std::filesystem::path& file, const std::vector<std::string>& assumptions,
                     Progress& progress) {
  for (const std::string& assumption : assumptions)
    progress.warn(file.string() + ": " + assumption);
}

}  // namespace

convert::Volume loadVolume(const std::filesystem::path& file, const FileFormat& format,
                           const VolumeArguments& volume, Progress& progress) {
  progress.begin("reading", 0);
  convert::Volume result = readVolume(file, format, volume, progress);
  progress.end();
  tellAssumptions(file, result.assumptions, progress);
  return result;
}

std::vector<convert::SeedBranch> loadSeeds(const TrackArguments& track) {
  if (track.seeds.empty())
    throw Error(ErrorKind::Usage,
                "a volume needs --seeds FILE, which says where its vessels begin");
  requireInput(track.seeds, "seeds file");
  if (const std::string other = notA(ContentKind::Seeds, track.seeds); !other.empty())
    throw invalidInput(track.seeds + ": " + other);
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
