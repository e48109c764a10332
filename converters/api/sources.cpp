// SPDX-License-Identifier: Apache-2.0
// The functions of lumen/engine.h that take options and inputs.
#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "converters/api/handle.h"
#include "converters/base/error.h"
#include "converters/base/input_file.h"
#include "converters/engine/scope.h"
#include "converters/engine/tracking_input.h"
#include "converters/io/seeds/seeds.h"
#include "converters/io/volume/label_table.h"
#include "converters/io/volume/volume_checks.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"
#include "formats/container/printable.h"

namespace lumen::engine::api {
namespace {

/// Options whose value names a file, which this interface opens none of.
constexpr std::array<std::string_view, 5> kFiles = {"seeds", "label-map", "centerline",
                                                    "corrections", "allow-detached"};

void refuseFile(std::string_view name, const std::string& value) {
  const std::vector<std::string>& tables = convert::builtInLabelTables();
  const bool isTable =
      name == "label-table" && std::find(tables.begin(), tables.end(), value) == tables.end();
  if (isTable || std::find(kFiles.begin(), kFiles.end(), name) != kFiles.end())
    throw Error(ErrorKind::Usage, std::string(name) +
                                      ": names a file, and this interface opens none; "
                                      "expected its bytes among the inputs");
}

/// Whether a part of the inputs is there. Throws Error(Usage) for one without its bytes or name.
bool isThere(const lumen_engine_file& file) {
  if (!file.name && !file.bytes && file.size == 0) return false;
  if (!file.name || (!file.bytes && file.size > 0))
    throw Error(ErrorKind::Usage, "an input has no name or no bytes; expected both, or neither");
  return true;
}

InputFile inputOf(const lumen_engine_file& file) {
  return {std::filesystem::path(file.name),
          std::string_view(static_cast<const char*>(file.bytes), file.size)};
}

operations::LabelPart regionsOf(const lumen_engine_file& file, const Options& options,
                                Progress& progress) {
  const InputFile input = inputOf(file);
  const FileFormat& format = inputFormat(input, "");
  if (format.readVolume == nullptr)
    throw invalidInput(formats::printable(file.name) +
                       ": is no volume; expected a volume of labels");
  return {readVolumeFile(input, format, {}, progress), file.name,
          options.values().source.mask.names(input)};
}

void load(const lumen_engine_inputs& inputs, Options options, lumen_engine_source& to,
          Progress& progress) {
  if (!isThere(inputs.main)) throw Error(ErrorKind::Usage, "the main input is missing");
  const InputFile input = inputOf(inputs.main);
  const FileFormat& format = inputFormat(input, "");
  if (isThere(inputs.seeds)) {
    const TrackArguments& track = options.values().track;
    to.seeds = convert::readSeeds(inputOf(inputs.seeds), track.reading());
    to.seedsName = inputs.seeds.name;
  }
  if (isThere(inputs.label_map)) to.regionsName = inputs.label_map.name;
  options.give("label-map", to.regionsName);
  operations::Source& source = to.source.emplace();
  if (format.kind == FormatKind::Case) {
    source.name = inputs.main.name;
    source.value = format.readCase(input);
    to.content = kUnfittedCase;
    return;
  }
  source = loadSource(input, format, options.values().source, !to.seeds.empty(), progress);
  if (!to.regionsName.empty()) source.regions = regionsOf(inputs.label_map, options, progress);
  to.content = inputContent(format, source.labels.has_value());
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
  convert::checkGeometry(geometry, name);
  volume.voxels = voxelsOf(from, geometry.voxelCount());
  convert::checkVoxels(volume.voxels, name);
  return volume;
}

}  // namespace
}  // namespace lumen::engine::api

using namespace lumen;
using namespace lumen::engine;
using namespace lumen::engine::api;

extern "C" {

const char* lumen_engine_version(void) noexcept {
  return LUMEN_VERSION;
}

lumen_engine_status lumen_engine_options_create(lumen_engine_options** out,
                                                lumen_engine_fault* fault) noexcept {
  if (!out) return refuseNull(fault, "lumen_engine_options_create");
  *out = nullptr;
  return guarded(fault, [&] { *out = new lumen_engine_options; });
}

void lumen_engine_options_free(lumen_engine_options* options) noexcept {
  delete options;
}

lumen_engine_status lumen_engine_options_set(lumen_engine_options* options, const char* name,
                                             const char* value,
                                             lumen_engine_fault* fault) noexcept {
  if (!options || !name || !value) return refuseNull(fault, "lumen_engine_options_set");
  return guarded(fault, [&] {
    refuseFile(name, value);
    options->table.set(name, {value});
  });
}

lumen_engine_status lumen_engine_load(const lumen_engine_inputs* inputs,
                                      const lumen_engine_options* options,
                                      const lumen_engine_listener* listener,
                                      lumen_engine_source** out,
                                      lumen_engine_fault* fault) noexcept {
  if (out) *out = nullptr;
  if (!inputs || !out) return refuseNull(fault, "lumen_engine_load");
  return guarded(fault, [&] {
    auto source = std::make_unique<lumen_engine_source>();
    listenTo(listener,
             [&](Progress& progress) { load(*inputs, Options(options), *source, progress); });
    *out = source.release();
  });
}

lumen_engine_status lumen_engine_take_volume(const lumen_engine_volume* volume, const char* name,
                                             int holds_labels, const lumen_engine_options* options,
                                             lumen_engine_source** out,
                                             lumen_engine_fault* fault) noexcept {
  if (out) *out = nullptr;
  if (!volume || !volume->data || !name || !out)
    return refuseNull(fault, "lumen_engine_take_volume");
  return guarded(fault, [&] {
    auto made = std::make_unique<lumen_engine_source>();
    operations::Source& source = made->source.emplace();
    source.name = name;
    convert::Volume taken = volumeOf(*volume, name);
    if (holds_labels != 0)
      source.labels = operations::LabelPart{
          std::move(taken), name, Options(options).values().source.mask.names({name, ""})};
    else
      source.grey = std::move(taken);
    made->content = holds_labels != 0 ? kFileLabels : kFileImage;
    *out = made.release();
  });
}

void lumen_engine_free_source(lumen_engine_source* source) noexcept {
  delete source;
}

}  // extern "C"
