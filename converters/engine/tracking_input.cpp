// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/tracking_input.h"

#include "converters/base/error.h"
#include "converters/base/warning.h"
#include "converters/engine/file_access.h"
#include "converters/engine/named_files.h"
#include "converters/stages/tracking/vessel_at_click.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

/// The result of `read`. An error about a file that is no volume but has other known content names
/// that content.
template <class Result>
Result readAs(Result (*read)(const InputFile&, const convert::ReadVolumeOptions&, const Progress&),
              const InputFile& file, const VolumeArguments& volume, Progress& progress) {
  try {
    return read(file, volume.options(), progress);
  } catch (const Error& error) {
    const std::string other = convert::notA(convert::ContentKind::Volume, file);
    if (error.kind() == ErrorKind::Cancelled || other.empty()) throw;
    throw invalidInput(file.path().string() + ": " + other);
  }
}

void reportAssumptions(const InputFile& file, const std::vector<std::string>& assumptions,
                       Progress& progress) {
  for (const std::string& assumption : assumptions)
    warn(progress, about(file.path().string(), {WarningCode::FileAssumption, assumption}));
}

}  // namespace

convert::VolumeHeader loadVolumeHeader(const InputFile& file, const FileFormat& format,
                                       const VolumeArguments& volume, Progress& progress) {
  convert::VolumeHeader header = readAs(format.readVolumeHeader, file, volume, progress);
  reportAssumptions(file, header.assumptions, progress);
  return header;
}

convert::Volume readVolumeFile(const InputFile& file, const FileFormat& format,
                               const VolumeArguments& volume, Progress& progress) {
  progress.begin("reading", 0);
  convert::Volume result = readAs(format.readVolume, file, volume, progress);
  progress.end();
  reportAssumptions(file, result.assumptions, progress);
  return result;
}

void warnOfVoxels(const convert::Volume& volume, const std::string& file, Progress& progress) {
  const std::string name = formats::printable(file) + ": ";
  try {
    if (const auto doubt = convert::doubtAbout(volume))
      warn(progress, {WarningCode::VolumeDoubt, name + *doubt});
  } catch (const Error& error) {
    throw Error(error.kind(), name + error.what());
  }
}

convert::Volume loadVolume(const InputFile& file, const FileFormat& format,
                           const VolumeArguments& volume, Progress& progress) {
  convert::Volume result = readVolumeFile(file, format, volume, progress);
  warnOfVoxels(result, file.path().string(), progress);
  return result;
}

std::optional<operations::NativePart> loadNative(const InputFile& file, Progress& progress) {
  if (file.empty()) return {};
  const FileFormat& format = volumeFormat(file, "scan without contrast", "scan without contrast");
  return operations::NativePart{readVolumeFile(file, format, {}, progress), file.name()};
}

std::vector<convert::SeedBranch> loadSeeds(const TrackArguments& track) {
  requireInput(track.seeds, "seeds file");
  if (const std::string other = convert::notA(convert::ContentKind::Seeds, track.seeds);
      !other.empty())
    throw invalidInput(track.seeds.name() + ": " + other);
  return convert::readSeeds(track.seeds, track.reading());
}

}  // namespace lumen::engine
