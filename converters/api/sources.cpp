// SPDX-License-Identifier: Apache-2.0
// The functions of lumen/engine.h that take inputs.
#include <array>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "converters/api/handle.h"
#include "converters/api/options.h"
#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/scope.h"
#include "converters/engine/source_input.h"
#include "converters/engine/tracking_input.h"
#include "converters/io/content/file_content.h"
#include "converters/io/volume/upright_grid.h"
#include "converters/io/volume/volume_checks.h"
#include "formats/container/printable.h"

namespace lumen::engine::api {
namespace {

/// Options of files of volumes, which say nothing of an array.
constexpr std::array<const char*, 6> kOfFiles = {"series", "fill-gaps", "volume-index",
                                                 "crop",   "spacing",   "unit"};

/// Whether a part of the inputs is there. Throws Error(Usage) for one without its bytes or name.
bool isThere(const lumen_engine_file& file, const char* part) {
  if (!file.name && !file.bytes && file.size == 0) return false;
  if (!file.name || (!file.bytes && file.size > 0))
    throw Error(ErrorKind::Usage, std::string(part) + " has no " + (file.name ? "bytes" : "name") +
                                      "; expected both, or neither");
  return true;
}

InputFile inputOf(const lumen_engine_file& file) {
  return {std::filesystem::path(file.name),
          std::string_view(static_cast<const char*>(file.bytes), file.size)};
}

/// The format by the name's ending, as no option states it.
const FileFormat& formatOf(const InputFile& file) {
  const std::string name = lowerCase(file.name());
  for (const FileFormat& format : fileFormats())
    for (const std::string_view ending : format.endings)
      if (canRead(format) && name.ends_with(ending)) return inputFormat(file, "");
  const convert::FileContent content = convert::detectContent(file);
  const bool isKnown = content.kind != convert::ContentKind::Unknown;
  throw unsupported(
      formats::printable(file.name()) + ": " + (isKnown ? content.sentence() + ", but " : "") +
      "its name has no ending of a format that lumen reads; expected " + formatEndings(canRead));
}

template <class T>
convert::Voxels copied(const lumen_engine_volume& volume, std::size_t count) {
  std::vector<T> voxels(count);
  std::memcpy(voxels.data(), volume.data, count * sizeof(T));
  return voxels;
}

convert::Voxels voxelsOf(const lumen_engine_volume& volume, std::size_t count) {
  switch (volume.type) {
    case LUMEN_ENGINE_INT16:
      return copied<std::int16_t>(volume, count);
    case LUMEN_ENGINE_UINT8:
      return copied<std::uint8_t>(volume, count);
    case LUMEN_ENGINE_UINT16:
      return copied<std::uint16_t>(volume, count);
    case LUMEN_ENGINE_FLOAT32:
      return copied<float>(volume, count);
  }
  throw Error(ErrorKind::Usage, "the type of the voxels is " +
                                    std::to_string(static_cast<int>(volume.type)) +
                                    "; expected one of lumen_engine_type");
}

convert::Volume volumeOf(const lumen_engine_volume& from, const std::string& name) {
  convert::Volume volume;
  convert::VolumeGeometry& geometry = volume.geometry;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const Eigen::Vector3d axis(from.affine[0][a], from.affine[1][a], from.affine[2][a]);
    geometry.size[static_cast<std::size_t>(a)] = from.size[a];
    geometry.spacing[a] = axis.norm();
    geometry.direction.col(a) = axis / axis.norm();
    geometry.origin[a] = from.affine[a][3];
  }
  convert::moveFarOrigin(geometry, volume.assumptions);
  const std::size_t count = geometry.voxelCount();
  const std::optional<convert::VolumeGeometry> stored = convert::standUpright(geometry);
  convert::checkGeometry(geometry, name);
  volume.voxels = voxelsOf(from, count);
  convert::checkVoxels(volume, name);
  if (!stored) return volume;
  volume.assumptions.push_back(convert::uprightSentence(*stored, geometry));
  convert::resampleUpright(*stored, volume, Progress());
  return volume;
}

/// An array as a source.
operations::Source sourceOf(const lumen_engine_volume& array, const Options& options, bool isSeeded,
                            Progress& progress) {
  requireGiven("lumen_engine_load",
               {{"inputs->volume->name", array.name}, {"inputs->volume->data", array.data}});
  for (const char* const option : kOfFiles)
    if (const OptionRow& row = *options.table().find(option); row.isGiven)
      throw Error(ErrorKind::Usage, row.shownName() + " is for files, and " +
                                        formats::printable(array.name) + " is an array");
  return volumeSource(volumeOf(array, array.name), InputFile(array.name, std::string_view()),
                      options.values().source.mask, isSeeded, progress);
}

void load(const lumen_engine_inputs& inputs, Options options, lumen_engine_source& to,
          Progress& progress) {
  if (isThere(inputs.main, "inputs.main") == (inputs.volume != nullptr))
    throw Error(ErrorKind::Usage, std::string("the inputs have ") +
                                      (inputs.volume ? "both main and" : "neither main nor") +
                                      " volume; expected one of them");
  for (const auto& [option, name, file] : kInputParts) {
    if (!isThere(inputs.*file, name)) continue;
    options.give(option, inputOf(inputs.*file));
    to.files.emplace_back(option, (inputs.*file).name);
  }
  requireCompatible(options.table());
  const ConvertOptions& values = options.values();
  if (!values.track.seeds.empty()) to.seeds = loadSeeds(values.track);
  if (const InputFile& file = values.corrected; !file.empty())
    to.corrected = operations::CorrectedCase{readCase(file), file.name()};
  for (const InputFile& map : values.source.mask.labelMaps) formatOf(map);
  operations::Source& source = to.source.emplace();
  if (inputs.volume) {
    source = sourceOf(*inputs.volume, options, !to.seeds.empty(), progress);
    to.content = source.labels ? kFileLabels : kFileImage;
  } else {
    const InputFile file = inputOf(inputs.main);
    const FileFormat& format = formatOf(file);
    if (format.kind == FormatKind::Case) {
      source.name = file.name();
      source.value = format.readCase(file);
    } else {
      source = loadSource(file, format, values.source, !to.seeds.empty(), progress);
    }
    to.content = source.value ? kUnfittedCase : inputContent(format, source.labels.has_value());
  }
  requireInScope(options.table(), {to.content, kAnyContent, source.name, {}}, progress);
}

}  // namespace
}  // namespace lumen::engine::api

using namespace lumen;
using namespace lumen::engine;
using namespace lumen::engine::api;

extern "C" {

int lumen_engine_interface(void) noexcept {
  return LUMEN_ENGINE_INTERFACE;
}

const char* lumen_engine_version(void) noexcept {
  return LUMEN_VERSION;
}

lumen_engine_status lumen_engine_load(const lumen_engine_inputs* inputs,
                                      const lumen_engine_options* options,
                                      const lumen_engine_listener* listener,
                                      lumen_engine_source** out,
                                      lumen_engine_fault* fault) noexcept {
  if (out) *out = nullptr;
  return guarded(fault, [&] {
    requireGiven("lumen_engine_load", {{"inputs", inputs}, {"out", out}});
    auto source = std::make_unique<lumen_engine_source>();
    listenTo(listener,
             [&](Progress& progress) { load(*inputs, Options(options), *source, progress); });
    *out = source.release();
  });
}

void lumen_engine_free_source(lumen_engine_source* source) noexcept {
  delete source;
}

}  // extern "C"
